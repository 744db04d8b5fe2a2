#pragma once

#include <cstddef>
#include <span>

#include "metrics/metric.h"

namespace metrics {

/// Pixels whose R, G or B is NaN or infinite in one of the images.
struct NonFinitePixels {
  std::size_t inside = 0;   ///< of the mask
  std::size_t outside = 0;  ///< of the mask: they take no part anyway
  std::size_t first = 0;    ///< index of the first one inside
};

/// @param reference, test  R, G, B, all of one size
/// @param mask  one channel of 0 and 1, of that size; null: every pixel takes part
NonFinitePixels find_non_finite(std::span<const Image> reference, std::span<const Image> test,
                                const Image* mask);

/// Copies in which a non-finite pixel is replaced by the other image's (black if that is not finite
/// either, or has another encoding), so that metrics which look at neighbourhoods see no difference
/// there, and a mask without these pixels.
struct FinitePair {
  Image reference;
  Image test;
  Image mask;
};
FinitePair make_finite(const Image& reference, const Image& test, const Image* mask);

/// The score of images with non-finite pixels: NaN, with the position of the first one.
Score not_a_number(const NonFinitePixels& found, int width_px);

/// Writes the number of non-finite pixels into a score.
void add_non_finite(const NonFinitePixels& found, Score& score);

}  // namespace metrics
