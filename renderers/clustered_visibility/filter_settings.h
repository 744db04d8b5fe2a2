#pragma once

#include <vector>

#include "perception/base/parameter_spec.h"
#include "renderers/clustered_visibility/area_visibility.h"
#include "renderers/clustered_visibility/convolution_maps.h"

namespace renderers::clustered_visibility {

/// Parameters of the renderer that say how maps of area lights are filtered and read.
std::vector<base::ParameterSpec> filter_parameters();

/// Reads them; `area.test` stays as it is.
void read_filter_settings(const base::Parameters& parameters, AreaVisibilitySettings& area,
                          ConvolutionSettings& convolution);

}  // namespace renderers::clustered_visibility
