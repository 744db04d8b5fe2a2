#pragma once

#include <span>
#include <string>
#include <string_view>

#include "renderers/contract/renderer.h"

namespace renderers {

/// Every renderer of the program, in the order of DESIGN section 2.
std::span<const RendererInfo> renderer_list();

/// @throws base::InputError with the nearest known name
const RendererInfo& find_renderer(std::string_view name, const base::Place& place);

/// The preset by name. @throws base::InputError listing the renderer's presets
const base::Preset& find_preset(const RendererInfo& info, std::string_view name,
                                const base::Place& place);

/// Features of the scene that the renderer does not support, as names; empty if it can render it.
std::vector<std::string> unsupported_features(const RendererInfo& info, const scene::Scene& scene);

/// The graphics platforms by name, in the order in which "auto" tries them.
std::vector<std::string> device_platforms();

/// Makes a trial context. A broken driver may crash or hang: call it in a process of its own.
/// @param platform  one of device_platforms()
/// @throws base::DeviceError, UnsupportedError if the platform cannot be used, and why
DeviceFacts probe_device(const std::string& platform);

}  // namespace renderers
