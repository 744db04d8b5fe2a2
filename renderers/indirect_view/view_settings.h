#pragma once

#include <cstdint>
#include <vector>

#include "perception/base/parameter_spec.h"
#include "renderers/contract/renderer.h"
#include "renderers/indirect_view/hemisphere_rays.h"

namespace renderers::indirect_view {

/// Parameters of a picture, typed. Meanings: `view_parameters`.
struct ViewSettings {
  std::int64_t samples = 8;  ///< camera rays per pixel
  Part part = Part::all;
};

std::vector<base::ParameterSpec> view_parameters();
ViewSettings view_settings_of(const base::Parameters& parameters);

/// `gather_rays` and `gather_sequence`.
std::vector<base::ParameterSpec> hemisphere_parameters();
HemisphereRays hemisphere_rays_of(const base::Parameters& parameters);

/// Entries of the renderer list that the techniques of this kit share: claims, what they support,
/// progressive unit; without name, summary, source, parameters, create.
RendererInfo view_info();

}  // namespace renderers::indirect_view
