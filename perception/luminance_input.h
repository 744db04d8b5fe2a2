#pragma once

#include <cstddef>
#include <vector>

#include "perception/image.h"

namespace perception {

/// Luminance that filters can be run on. Internal to the threshold model.
struct LuminanceInput {
  Image luminance;                              ///< one channel, finite, >= 0
  std::vector<std::size_t> non_finite_indices;  ///< pixels that were filled from their surround
  NonFinite non_finite;
  std::size_t negative_pixels = 0;  ///< set to 0
};

/// Luminance of light; non-finite pixels take the mean of the finite ones in the smallest square
/// around them that has any (half-sides 1, 2, 4, ...), 0 if there is none at all.
/// @param light  encoding luminance_cd_m2: one channel, or R, G, B (weights of ITU-R BT.709)
/// @throws base::InputError for another encoding or channels
LuminanceInput luminance_input(const Image& light);

}  // namespace perception
