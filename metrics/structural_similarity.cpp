#include "metrics/structural_similarity.h"

#include <array>
#include <cmath>
#include <utility>

#include "metrics/metric_input.h"
#include "metrics/score_pooling.h"
#include "perception/color_conversion.h"

namespace metrics {
namespace {

constexpr double kC1 = kSsimK1 * kSsimK1;
constexpr double kC2 = kSsimK2 * kSsimK2;
constexpr int kRadiusPx = kSsimWindowPx / 2;

/// The Gaussian window along one axis, sum 1.
Kernel<double> ssim_window() {
  Kernel<double> window;
  double sum = 0.0;
  for (int i = -kRadiusPx; i <= kRadiusPx; ++i) {
    window.weights.push_back(std::exp(-0.5 * i * i / (kSsimSigmaPx * kSsimSigmaPx)));
    sum += window.weights.back();
  }
  for (double& weight : window.weights) weight /= sum;
  return window;
}

/// Local means of x, y, x^2, y^2, x y (Eq. 14 to 16 in terms of raw moments).
constexpr std::size_t kMoments = 5;
using Moments = std::array<Plane<double>, kMoments>;

Moments moments_along_rows(const Plane<double>& x, const Plane<double>& y,
                           const Kernel<double>& window) {
  Moments moments;
  for (auto& plane : moments) plane = Plane<double>(x.width_px, x.height_px);
  for_each_row(x.height_px, [&](int row) {
    std::array<PaddedRow<double>, kMoments> inputs{
        PaddedRow<double>(x.width_px, kRadiusPx), PaddedRow<double>(x.width_px, kRadiusPx),
        PaddedRow<double>(x.width_px, kRadiusPx), PaddedRow<double>(x.width_px, kRadiusPx),
        PaddedRow<double>(x.width_px, kRadiusPx)};
    for (int i = 0; i < x.width_px; ++i) {
      const double a = x.row(row)[i];
      const double b = y.row(row)[i];
      const std::array<double, kMoments> values{a, b, a * a, b * b, a * b};
      for (std::size_t m = 0; m < kMoments; ++m) inputs[m].data()[i] = values[m];
    }
    for (std::size_t m = 0; m < kMoments; ++m) {
      inputs[m].repeat_ends();
      inputs[m].filter(window, moments[m].row(row));
    }
  });
  return moments;
}

PooledSimilarity pool_inside(const Plane<double>& map, std::span<const float> mask, int border_px) {
  double sum = 0.0;
  std::size_t pixels = 0;
  for (int y = border_px; y < map.height_px - border_px; ++y) {
    double row_sum = 0.0;
    for (int x = border_px; x < map.width_px - border_px; ++x) {
      const auto i = static_cast<std::size_t>(y) * static_cast<std::size_t>(map.width_px) +
                     static_cast<std::size_t>(x);
      if (!mask.empty() && mask[i] == 0.0F) continue;
      row_sum += map.values[i];
      ++pixels;
    }
    sum += row_sum;
  }
  return {pixels > 0 ? sum / static_cast<double>(pixels) : 0.0, pixels};
}

class StructuralSimilarity : public Metric {
 public:
  Score evaluate(const ImagePair& pair, const ViewingConditions& viewing) const override {
    const InputImage reference = display_input(pair.reference, viewing, "ssim");
    const InputImage test = display_input(pair.test, viewing, "ssim");
    return score_similarity(display_luma(reference.image()), display_luma(test.image()), pair.mask);
  }
};

}  // namespace

PooledSimilarity pool_similarity(const Plane<double>& map, std::span<const float> mask) {
  const PooledSimilarity inside = pool_inside(map, mask, kRadiusPx);
  return inside.pixels > 0 ? inside : pool_inside(map, mask, 0);
}

Plane<double> similarity_index(const SimilarityMaps& maps) {
  Plane<double> index(maps.luminance.width_px, maps.luminance.height_px);
  for (std::size_t i = 0; i < index.values.size(); ++i) {
    index.values[i] = double{maps.luminance.values[i]} * double{maps.contrast_structure.values[i]};
  }
  return index;
}

Score score_similarity(const Plane<double>& reference, const Plane<double>& test,
                       const Image* mask) {
  const SimilarityMaps maps = similarity_maps(reference, test);
  const PooledSimilarity pooled = pool_similarity(similarity_index(maps), mask_values(mask));
  Score score;
  score.value = pooled.mean;  // Eq. 17
  score.details.push_back({"pooled_pixels", static_cast<double>(pooled.pixels)});
  Image map = perception::make_gray_image(reference.width_px, reference.height_px, "error",
                                          perception::Encoding::scene_linear);
  for (std::size_t i = 0; i < map.pixels.size(); ++i) {
    map.pixels[i] = 1.0F - maps.luminance.values[i] * maps.contrast_structure.values[i];
  }
  score.map = std::move(map);
  return score;
}

Plane<double> display_luma(const Image& display) {
  Plane<double> luma(display.width_px, display.height_px);
  constexpr auto kWeights = perception::kRec709Luma;
  for_each_row(display.height_px, [&](int y) {
    const float* rgb = &display.pixels[display.offset(0, y)];
    double* out = luma.row(y);
    for (int x = 0; x < display.width_px; ++x, rgb += 3) {
      out[x] = double{kWeights[0]} * double{rgb[0]} + double{kWeights[1]} * double{rgb[1]} +
               double{kWeights[2]} * double{rgb[2]};
    }
  });
  return luma;
}

SimilarityMaps similarity_maps(const Plane<double>& reference, const Plane<double>& test) {
  const Kernel<double> window = ssim_window();
  const Moments along_rows = moments_along_rows(reference, test, window);
  SimilarityMaps maps{Plane<float>(reference.width_px, reference.height_px),
                      Plane<float>(reference.width_px, reference.height_px)};
  const auto width = static_cast<std::size_t>(reference.width_px);
  for_each_row(reference.height_px, [&](int y) {
    std::array<std::vector<double>, kMoments> m;
    for (std::size_t i = 0; i < kMoments; ++i) {
      m[i].resize(width);
      filter_across_rows(along_rows[i], y, window, m[i].data());
    }
    float* luminance = maps.luminance.row(y);
    float* contrast_structure = maps.contrast_structure.row(y);
    for (std::size_t x = 0; x < width; ++x) {
      // Eq. 13, as a product of its two factors.
      const double mean_product = m[0][x] * m[1][x];
      const double mean_squares = m[0][x] * m[0][x] + m[1][x] * m[1][x];
      const double covariance = m[4][x] - mean_product;
      const double variances = m[2][x] + m[3][x] - mean_squares;
      luminance[x] = static_cast<float>((2.0 * mean_product + kC1) / (mean_squares + kC1));
      contrast_structure[x] = static_cast<float>((2.0 * covariance + kC2) / (variances + kC2));
    }
  });
  return maps;
}

MetricInfo ssim_info() {
  MetricInfo info;
  info.name = "ssim";
  info.summary =
      "Mean structural similarity (2 mx my + C1)(2 sxy + C2) / ((mx^2 + my^2 + C1)(sx^2 + sy^2 + "
      "C2)) of display luma in 11 x 11 Gaussian windows inside the image. The map is 1 - SSIM.";
  info.source = "Wang et al. 2004, doi:10.1109/TIP.2003.819861";
  info.better = Better::higher;
  info.input = "sRGB-encoded";
  info.identical_value = 1.0;
  info.map_scale = {0.0, 1.0, false, ""};
  info.create = [](const base::Parameters&) -> std::unique_ptr<Metric> {
    return std::make_unique<StructuralSimilarity>();
  };
  return info;
}

}  // namespace metrics
