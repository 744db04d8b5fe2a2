#include "renderers/opengl/context.h"
#include "renderers/renderer_list.h"

namespace renderers {

std::vector<std::string> device_platforms() { return opengl::platform_names(); }

DeviceFacts probe_device(const std::string& platform) { return opengl::probe(platform); }

}  // namespace renderers
