#include "metrics/multi_scale_similarity.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "metrics/metric_input.h"
#include "metrics/score_pooling.h"
#include "metrics/structural_similarity.h"
#include "perception/base/errors.h"

namespace metrics {
namespace {

/// Applies combine(a, b, c, d) to every 2 x 2 pixels; an odd last row or column is used twice.
template <typename Value, typename Combine>
Plane<Value> halved(const Plane<Value>& fine, const Combine& combine) {
  Plane<Value> coarse((fine.width_px + 1) / 2, (fine.height_px + 1) / 2);
  for_each_row(coarse.height_px, [&](int y) {
    const Value* upper = fine.row(2 * y);
    const Value* lower = fine.row(std::min(2 * y + 1, fine.height_px - 1));
    Value* out = coarse.row(y);
    for (int x = 0; x < coarse.width_px; ++x) {
      const int left = 2 * x;
      const int right = std::min(2 * x + 1, fine.width_px - 1);
      out[x] = combine(upper[left], upper[right], lower[left], lower[right]);
    }
  });
  return coarse;
}

Plane<double> mean_of_fours(const Plane<double>& fine) {
  return halved(fine,
                [](double a, double b, double c, double d) { return 0.25 * ((a + b) + (c + d)); });
}

Plane<float> largest_of_fours(const Plane<float>& fine) {
  return halved(fine, [](float a, float b, float c, float d) {
    return std::max(std::max(a, b), std::max(c, d));
  });
}

Plane<double> as_double(const Plane<float>& values) {
  Plane<double> result(values.width_px, values.height_px);
  std::copy(values.values.begin(), values.values.end(), result.values.begin());
  return result;
}

/// Multiplies a full-size plane by the terms of a scale, each to the power of its weight.
/// @param scale  0 for full size; a term covers 2^scale x 2^scale pixels
void multiply_by_terms(const Plane<double>& terms, int scale, double weight,
                       Plane<double>& product) {
  Plane<double> factors(terms.width_px, terms.height_px);
  for_each_row(terms.height_px, [&](int y) {
    for (int x = 0; x < terms.width_px; ++x) {
      factors.row(y)[x] = std::pow(std::max(terms.row(y)[x], 0.0), weight);
    }
  });
  for_each_row(product.height_px, [&](int y) {
    const double* factor = factors.row(y >> scale);
    double* out = product.row(y);
    for (int x = 0; x < product.width_px; ++x) out[x] *= factor[x >> scale];
  });
}

int resolved_scales(const Plane<double>& plane, const MultiScaleOptions& options) {
  const int fitting = fitting_scales(plane.width_px, plane.height_px);
  if (options.scales <= fitting) return options.scales == 0 ? fitting : options.scales;
  throw base::InputError(fmt::format(
      "metric \"{}\": {} scales need a shorter side of {} pixels, the images are {}x{}; accepted: "
      "scales=1 to {}, or scales=0 for as many as fit",
      options.metric, options.scales, kSsimWindowPx << (options.scales - 1), plane.width_px,
      plane.height_px, fitting));
}

/// The two images at the present scale.
class Comparison {
 public:
  Comparison(Plane<double> reference, Plane<double> test, const Image* mask)
      : reference_(std::move(reference)),
        test_(std::move(test)),
        product_(reference_.width_px, reference_.height_px) {
    std::fill(product_.values.begin(), product_.values.end(), 1.0);
    if (mask == nullptr) return;
    mask_ = Plane<float>(mask->width_px, mask->height_px);
    mask_.values = mask->pixels;
  }

  /// Mean term of the present scale. @param is_coarsest  its term has the luminance factor, too
  double compare(int scale, double weight, bool is_coarsest) {
    const SimilarityMaps maps = similarity_maps(reference_, test_);
    const Plane<double> terms =
        is_coarsest ? similarity_index(maps) : as_double(maps.contrast_structure);
    multiply_by_terms(terms, scale, weight, product_);
    return pool_similarity(terms, mask_.values).mean;
  }

  void go_to_next_scale() {
    reference_ = mean_of_fours(reference_);
    test_ = mean_of_fours(test_);
    if (!mask_.values.empty()) mask_ = largest_of_fours(mask_);
  }

  Image map() const {
    Image map = perception::make_gray_image(product_.width_px, product_.height_px, "error",
                                            perception::Encoding::scene_linear);
    for (std::size_t i = 0; i < map.pixels.size(); ++i) {
      map.pixels[i] = static_cast<float>(1.0 - product_.values[i]);
    }
    return map;
  }

 private:
  Plane<double> reference_;
  Plane<double> test_;
  Plane<double> product_;  ///< of the terms so far, at full size
  Plane<float> mask_;      ///< empty if there is none
};

class MultiScaleSimilarity : public Metric {
 public:
  explicit MultiScaleSimilarity(int scales) : scales_(scales) {}

  Score evaluate(const ImagePair& pair, const ViewingConditions& viewing) const override {
    const InputImage reference = display_input(pair.reference, viewing, "ms-ssim");
    const InputImage test = display_input(pair.test, viewing, "ms-ssim");
    return score_multi_scale(display_luma(reference.image()), display_luma(test.image()), pair.mask,
                             {"ms-ssim", scales_});
  }

 private:
  int scales_;
};

}  // namespace

int fitting_scales(int width_px, int height_px) {
  int side = std::min(width_px, height_px);
  int scales = 1;
  for (; scales < kMsSsimScales && side >= 2 * kSsimWindowPx; ++scales) side /= 2;
  return scales;
}

Score score_multi_scale(const Plane<double>& reference, const Plane<double>& test,
                        const Image* mask, const MultiScaleOptions& options) {
  const int scales = resolved_scales(reference, options);
  // Fewer scales than the paper's share the sum of all weights.
  const auto first = kMsSsimWeights.begin();
  const double gain = std::accumulate(first, kMsSsimWeights.end(), 0.0) /
                      std::accumulate(first, first + scales, 0.0);
  Comparison comparison(reference, test, mask);
  Score score;
  score.value = 1.0;
  int negative = 0;
  for (int i = 0; i < scales; ++i) {
    const bool is_coarsest = i + 1 == scales;
    const double weight = gain * kMsSsimWeights[static_cast<std::size_t>(i)];
    const double mean = comparison.compare(i, weight, is_coarsest);
    score.value *= std::pow(std::max(mean, 0.0), weight);
    score.details.push_back({fmt::format("scale_{}_mean", i + 1), mean});
    if (mean < 0.0) ++negative;
    if (!is_coarsest) comparison.go_to_next_scale();
  }
  score.details.push_back({"scales", static_cast<double>(scales)});
  score.details.push_back({"negative_scales", static_cast<double>(negative)});
  score.map = comparison.map();
  return score;
}

base::ParameterSpec scales_parameter() {
  return base::integer_parameter(
      "scales", 0, {0.0, static_cast<double>(kMsSsimScales)}, "",
      "number of scales; 0: 5, or as many as fit into a small image, whose weights are then scaled "
      "up to the same sum (ours; the paper has 5)");
}

MetricInfo ms_ssim_info() {
  MetricInfo info;
  info.name = "ms-ssim";
  info.summary =
      "Multi-scale structural similarity of display luma: product over five octaves of the mean "
      "contrast-structure term, at the coarsest of the mean SSIM, to published powers. The map is "
      "1 - the product at each pixel.";
  info.source = "Wang, Simoncelli, Bovik 2003, doi:10.1109/ACSSC.2003.1292216";
  info.better = Better::higher;
  info.input = "sRGB-encoded";
  info.identical_value = 1.0;
  info.parameters = {scales_parameter()};
  info.map_scale = {0.0, 1.0, false, ""};
  info.create = [](const base::Parameters& parameters) -> std::unique_ptr<Metric> {
    return std::make_unique<MultiScaleSimilarity>(static_cast<int>(parameters.integer("scales")));
  };
  return info;
}

}  // namespace metrics
