#pragma once

#include <string_view>

namespace tests {

/// Metrics that judge one feature of a picture (a shadow, its border, the dark, single pixels) and
/// are silent on every other error. NaN is theirs where the reference has no such feature.
inline bool judges_one_feature(std::string_view metric) {
  return metric == "contrast-kept" || metric == "edge-excess" || metric == "holes" ||
         metric == "leak" || metric == "penumbra-width";
}

/// Those whose feature the waves of `wavy_picture` lack, or show at one place only.
inline bool is_blind_to_noise_on_waves(std::string_view metric) {
  return metric == "leak" || metric == "penumbra-width";
}

}  // namespace tests
