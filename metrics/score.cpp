#include <cmath>
#include <limits>
#include <optional>

#include <fmt/format.h>

#include "metrics/metric_input.h"
#include "metrics/metric_list.h"
#include "metrics/score_pooling.h"
#include "perception/base/errors.h"

namespace metrics {
namespace {

std::string size_text(const Image& image) {
  return fmt::format("{}x{}", image.width_px, image.height_px);
}

void require_size(const Image& image, const char* name, const Image& reference) {
  if (image.has_size_of(reference)) return;
  throw base::InputError(
      fmt::format("the reference is {} pixels, the {} {}; accepted: images of the same size",
                  size_text(reference), name, size_text(image)));
}

void require_mask(const Image& mask, const Image& reference) {
  require_size(mask, "mask", reference);
  if (mask.channel_count() != 1) {
    throw base::InputError(fmt::format("the mask has {} channels; accepted: one channel of 0 and 1",
                                       mask.channel_count()));
  }
  for (const float value : mask.pixels) {
    if (value == 0.0F || value == 1.0F) continue;
    throw base::InputError(
        fmt::format("the mask holds the value {}; accepted: 0 (left out) and 1", value));
  }
  if (pooled_pixel_count(reference, &mask) == 0) {
    throw base::InputError("the mask leaves no pixel; accepted: a mask with at least one 1");
  }
}

void require_pair(const ImagePair& pair) {
  require_size(pair.test, "test", pair.reference);
  if (pair.reference.pixel_count() == 0) {
    throw base::InputError("the images have no pixels; accepted: at least 1x1");
  }
  if (pair.reference_variance != nullptr) {
    require_size(*pair.reference_variance, "reference's variance", pair.reference);
  }
  if (pair.mask != nullptr) require_mask(*pair.mask, pair.reference);
}

bool is_finite_pixel(const Image& rgb, std::size_t pixel) {
  const float* values = &rgb.pixels[3 * pixel];
  return std::isfinite(values[0]) && std::isfinite(values[1]) && std::isfinite(values[2]);
}

/// Pixels that are not finite in either image.
struct NonFinitePixels {
  std::size_t inside = 0;   ///< of the mask
  std::size_t outside = 0;  ///< of the mask: they take no part anyway
  std::size_t first = 0;    ///< index of the first one inside
};

NonFinitePixels find_non_finite(const Image& reference, const Image& test, const Image* mask) {
  NonFinitePixels found;
  for (std::size_t i = 0; i < reference.pixel_count(); ++i) {
    if (is_finite_pixel(reference, i) && is_finite_pixel(test, i)) continue;
    if (!takes_part(mask, i)) {
      ++found.outside;
      continue;
    }
    if (found.inside++ == 0) found.first = i;
  }
  return found;
}

/// Copies in which a non-finite pixel is replaced by the other image's (black if that is not finite
/// either, or has another encoding), so that metrics which look at neighbourhoods see no difference
/// there, and a mask without these pixels.
struct FinitePair {
  Image reference;
  Image test;
  Image mask;
};

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

Score score_finite(const Metric& metric, const ImagePair& pair, const NonFinitePixels& found,
                   const ViewingConditions& viewing) {
  if (found.inside + found.outside == 0) return metric.evaluate(pair, viewing);
  const FinitePair finite = make_finite(pair.reference, pair.test, pair.mask);
  if (pooled_pixel_count(finite.mask, &finite.mask) == 0) {
    throw base::InputError("no pixel is finite in both images; nothing is left to score");
  }
  return metric.evaluate({finite.reference, finite.test, pair.reference_variance, &finite.mask},
                         viewing);
}

}  // namespace

Score score(const MetricChoice& choice, const ImagePair& pair, const ViewingConditions& viewing,
            const ScoreOptions& options) {
  require_pair(pair);
  const InputImage reference = rgb_input(pair.reference);
  const InputImage test = rgb_input(pair.test);
  const ImagePair rgb{reference.image(), test.image(), pair.reference_variance, pair.mask};
  const NonFinitePixels found = find_non_finite(rgb.reference, rgb.test, pair.mask);

  const bool is_refused = found.inside > 0 && !options.ignore_non_finite;
  Score result = is_refused
                     ? not_a_number(found, rgb.reference.width_px)
                     : score_finite(*choice.info->create(choice.parameters), rgb, found, viewing);
  result.non_finite_pixels = found.inside;
  if (found.outside > 0) {
    result.details.push_back(
        {"non_finite_pixels_outside_mask", static_cast<double>(found.outside)});
  }
  if (!options.with_map) result.map.reset();
  return result;
}

}  // namespace metrics
