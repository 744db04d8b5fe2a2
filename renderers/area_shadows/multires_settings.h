#pragma once

#include <vector>

#include "perception/base/parameter_spec.h"
#include "renderers/area_shadows/discontinuity_pyramid.h"
#include "renderers/area_shadows/fragment_light.h"
#include "renderers/area_shadows/fragment_refinement.h"
#include "renderers/area_shadows/rbf_upsampling.h"

namespace renderers::area_shadows {

enum class Upsampling { rbf, multi_pass, nearest };

/// Parameters of `multires-shadows`, typed. Meanings: `multires_parameters`.
struct MultiresSettings {
  DiscontinuitySettings discontinuities;
  RefinementSettings refinement;
  FragmentLightSettings light;
  Upsampling upsampling = Upsampling::rbf;
  bool upsamples_visibility = true;  ///< or irradiance
  RbfUpsamplingSettings rbf;
  int rays_per_quadrant = 16;
  bool reuses_bits = true;  ///< irradiance from the bits of tests; or by rays of its own
  bool has_audit = false;   ///< also lights every pixel, to count what was missed
};

std::vector<base::ParameterSpec> multires_parameters();
std::vector<base::Preset> multires_presets();
/// @throws base::InputError if the rays are not a power of two
MultiresSettings multires_settings(const base::Parameters& parameters);

/// The parameters of the discontinuity pyramid and what they mean, for all who split by it.
std::vector<base::ParameterSpec> discontinuity_parameters();
DiscontinuitySettings discontinuity_settings(const base::Parameters& parameters);

}  // namespace renderers::area_shadows
