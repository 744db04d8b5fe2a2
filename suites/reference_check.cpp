#include "suites/reference_check.h"

#include <cmath>

#include <nlohmann/json.hpp>

#include "perception/color_conversion.h"

namespace suites {
namespace {

/// Two-sided probability of a normal variable beyond 3 sigma.
constexpr double kBeyondThreeSigma = 0.0026997961;
/// Share of pixels beyond 3 sigma that heavy-tailed pixels of an unbiased estimate may reach; ours.
constexpr double kMaxOutsideShare = 0.02;
/// Largest z of the mean over all pixels; ours.
constexpr double kMaxMeanZ = 4.0;

/// Luminance of a pixel and an upper bound of its variance: the standard deviation of a weighted
/// sum is at most the weighted sum of the standard deviations, whatever the correlation.
struct PixelLuminance {
  double value = 0.0;
  double variance = 0.0;
};

PixelLuminance luminance_at(const ReferenceEstimate& estimate, int x, int y) {
  PixelLuminance luminance;
  double deviation = 0.0;
  for (int c = 0; c < 3; ++c) {
    const double weight = perception::kRec709Luma[static_cast<std::size_t>(c)];
    luminance.value += weight * static_cast<double>(estimate.all.at(x, y, c));
    deviation += weight * std::sqrt(static_cast<double>(estimate.variance.at(x, y, c)));
  }
  luminance.variance = deviation * deviation;
  return luminance;
}

}  // namespace

nlohmann::ordered_json z_test(const ReferenceEstimate& a, const ReferenceEstimate& b) {
  std::int64_t outside = 0;
  double worst_z = -1.0;
  int worst_x = 0;
  int worst_y = 0;
  double difference_sum = 0.0;
  double variance_sum = 0.0;
  for (int y = 0; y < a.all.height_px; ++y) {
    for (int x = 0; x < a.all.width_px; ++x) {
      const PixelLuminance pa = luminance_at(a, x, y);
      const PixelLuminance pb = luminance_at(b, x, y);
      const double difference = pb.value - pa.value;
      const double variance = pa.variance + pb.variance;
      difference_sum += difference;
      variance_sum += variance;
      // Two equal pixels without variance agree; two unequal ones cannot.
      const double z = difference == 0.0 ? 0.0 : std::abs(difference) / std::sqrt(variance);
      if (z > 3.0) ++outside;
      if (z <= worst_z) continue;
      worst_z = z;
      worst_x = x;
      worst_y = y;
    }
  }
  const auto pixels = static_cast<double>(a.all.pixel_count());
  const double mean_z = difference_sum == 0.0 ? 0.0 : difference_sum / std::sqrt(variance_sum);
  const double max_outside = kMaxOutsideShare * pixels;
  const bool is_ok = static_cast<double>(outside) <= max_outside && std::abs(mean_z) <= kMaxMeanZ;
  return nlohmann::ordered_json{{"ok", is_ok},
                                {"pixels", a.all.pixel_count()},
                                {"outside_3_sigma", outside},
                                {"expected_outside", kBeyondThreeSigma * pixels},
                                {"max_outside", max_outside},
                                {"worst_pixel", {worst_x, worst_y}},
                                {"worst_z", worst_z},
                                {"mean_z", mean_z},
                                {"samples", {a.samples, b.samples}}};
}

}  // namespace suites
