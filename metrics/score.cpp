#include <cmath>
#include <memory>

#include <fmt/format.h>

#include "metrics/finite_pixels.h"
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

/// The score of a pair that may hold values which are not finite.
Score score_after_search(const Metric& metric, const ImagePair& pair,
                         const ViewingConditions& viewing, const ScoreOptions& options) {
  const NonFinitePixels found = find_non_finite({&pair.reference, 1}, {&pair.test, 1}, pair.mask);
  const bool is_refused = found.inside > 0 && !options.ignore_non_finite;
  Score result = is_refused ? not_a_number(found, pair.reference.width_px)
                            : score_finite(metric, pair, found, viewing);
  add_non_finite(found, result);
  return result;
}

}  // namespace

Score score(const MetricChoice& choice, const ImagePair& pair, const ViewingConditions& viewing,
            const ScoreOptions& options) {
  require_pair(pair);
  const InputImage reference = rgb_input(pair.reference);
  const InputImage test = rgb_input(pair.test);
  const ImagePair rgb{reference.image(), test.image(), pair.reference_variance, pair.mask};
  const std::unique_ptr<Metric> metric = choice.info->create(choice.parameters);

  Score result;
  bool is_finite = false;
  if (pair.mask == nullptr && metric->shows_non_finite()) {
    result = metric->evaluate(rgb, viewing);
    is_finite = std::isfinite(result.value);
  }
  if (!is_finite) result = score_after_search(*metric, rgb, viewing, options);
  if (!options.with_map) result.map.reset();
  return result;
}

}  // namespace metrics
