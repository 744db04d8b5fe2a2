#include "metrics/finite_pixels.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "metrics/score_pooling.h"
#include "metrics/separable_filter.h"

namespace metrics {
namespace {

bool is_finite_pixel(const Image& rgb, std::size_t pixel) {
  const float* values = &rgb.pixels[3 * pixel];
  return std::isfinite(values[0]) && std::isfinite(values[1]) && std::isfinite(values[2]);
}

/// True if a row holds only finite values: one addition carries the exponent of all others, 255,
/// into the sign.
bool is_finite_row(const Image& rgb, int y) {
  constexpr std::uint32_t kExponent = 0x7f800000U;
  constexpr std::uint32_t kOne = 0x00800000U;
  const float* values = &rgb.pixels[rgb.offset(0, y)];
  const std::size_t count = 3 * static_cast<std::size_t>(rgb.width_px);
  std::uint32_t carried = 0;
  for (std::size_t i = 0; i < count; ++i) {
    carried |= (std::bit_cast<std::uint32_t>(values[i]) & kExponent) + kOne;
  }
  return (carried >> 31) == 0;
}

/// Which rows have a value that is not finite in one of the images.
std::vector<char> non_finite_rows(std::span<const Image> reference, std::span<const Image> test) {
  std::vector<char> rows(static_cast<std::size_t>(reference.front().height_px));
  for_each_row(reference.front().height_px, [&](int y) {
    const auto is_finite = [y](const Image& image) { return is_finite_row(image, y); };
    rows[static_cast<std::size_t>(y)] =
        !std::all_of(reference.begin(), reference.end(), is_finite) ||
        !std::all_of(test.begin(), test.end(), is_finite);
  });
  return rows;
}

}  // namespace

NonFinitePixels find_non_finite(std::span<const Image> reference, std::span<const Image> test,
                                const Image* mask) {
  NonFinitePixels found;
  if (reference.empty()) return found;
  const std::vector<char> has_any = non_finite_rows(reference, test);
  const auto width = static_cast<std::size_t>(reference.front().width_px);
  for (std::size_t i = 0; i < reference.front().pixel_count(); ++i) {
    if (has_any[i / width] == 0) {
      i += width - 1;
      continue;
    }
    const auto is_finite = [i](const Image& image) { return is_finite_pixel(image, i); };
    if (std::all_of(reference.begin(), reference.end(), is_finite) &&
        std::all_of(test.begin(), test.end(), is_finite)) {
      continue;
    }
    if (!takes_part(mask, i)) {
      ++found.outside;
      continue;
    }
    if (found.inside++ == 0) found.first = i;
  }
  return found;
}

FinitePair make_finite(const Image& reference, const Image& test, const Image* mask) {
  FinitePair finite{reference, test, {}};
  finite.mask = mask != nullptr
                    ? *mask
                    : perception::make_gray_image(reference.width_px, reference.height_px, "mask",
                                                  perception::Encoding::scene_linear);
  if (mask == nullptr) finite.mask.pixels.assign(finite.mask.pixels.size(), 1.0F);
  const bool is_comparable = reference.encoding == test.encoding;
  for (std::size_t i = 0; i < reference.pixel_count(); ++i) {
    const bool has_reference = is_finite_pixel(reference, i);
    const bool has_test = is_finite_pixel(test, i);
    if (has_reference && has_test) continue;
    finite.mask.pixels[i] = 0.0F;
    const Image* source = has_reference ? &reference : has_test ? &test : nullptr;
    for (std::size_t c = 3 * i; c < 3 * i + 3; ++c) {
      const float value = is_comparable && source != nullptr ? source->pixels[c] : 0.0F;
      finite.reference.pixels[c] = value;
      finite.test.pixels[c] = value;
    }
  }
  return finite;
}

Score not_a_number(const NonFinitePixels& found, int width_px) {
  Score score;
  score.value = std::numeric_limits<double>::quiet_NaN();
  const auto width = static_cast<std::size_t>(width_px);
  score.details.push_back({"first_non_finite_x_px", static_cast<double>(found.first % width)});
  score.details.push_back({"first_non_finite_y_px", static_cast<double>(found.first / width)});
  return score;
}

void add_non_finite(const NonFinitePixels& found, Score& score) {
  score.non_finite_pixels = found.inside;
  if (found.outside == 0) return;
  score.details.push_back({"non_finite_pixels_outside_mask", static_cast<double>(found.outside)});
}

}  // namespace metrics
