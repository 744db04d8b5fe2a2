// Pass: light of virtual lights at the pixels of a geometry buffer (gather.glsl); WITH_HEMISPHERE_MAPS:
// light first_light + l is seen through layer l of hemispherical maps, else by everything.
#ifdef WITH_HEMISPHERE_MAPS
#define WITH_VISIBILITY 1
#endif
#include "renderers/many_lights/shaders/gather.glsl"
#ifdef WITH_HEMISPHERE_MAPS
#include "renderers/shadow_maps/shaders/hemisphere_map.glsl"

float light_visibility(VirtualLight light, int index, Receiver receiver) {
  return hemisphere_visibility(uint(index), light.position.xyz, light.geometric_normal.xyz,
                               receiver.position, receiver.geometric_normal);
}
#endif
