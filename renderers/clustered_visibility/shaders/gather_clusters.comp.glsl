// Pass: light of virtual lights at the pixels of a geometry buffer (gather.glsl), each light as far
// as its area light is seen; the lights of a run are sorted by cluster.

#include "renderers/many_lights/shaders/gather.glsl"
#include "renderers/clustered_visibility/shaders/area_visibility.glsl"

void begin_group(int group) { look_at_area(group); }

float light_visibility(VirtualLight light, int index, Receiver receiver) {
  return area_visibility(receiver.position, receiver.geometric_normal);
}
