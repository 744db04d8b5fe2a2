#include "tests/renderers/clustered_visibility/convolution_oracle.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace test_clustered_visibility {

namespace {

/// Length of [low, high] within a texel along one axis, in uv.
double covered_length(double low, double high, int texel, int size_px) {
  const double begin = static_cast<double>(texel) / size_px;
  const double end = static_cast<double>(texel + 1) / size_px;
  return std::max(0.0, std::min(high, end) - std::max(low, begin));
}

/// Factor of sin(c_k t) in S.
double series_weight(const ConvolutionSeries& series, int k) {
  return 2.0 * series_damping(series, k) / series_frequency(k);
}

}  // namespace

double series_frequency(int k) { return std::numbers::pi * (2.0 * k - 1.0); }

double series_damping(const ConvolutionSeries& series, int k) {
  const double share = static_cast<double>(k) / series.terms;
  return std::exp(-series.damping * share * share);
}

double series_step(const ConvolutionSeries& series, double t) {
  double step = 0.5;
  for (int k = 1; k <= series.terms; ++k) {
    step += series_weight(series, k) * std::sin(series_frequency(k) * t);
  }
  return step;
}

double series_offset(const ConvolutionSeries& series) { return 0.5 / series.terms; }

double fixed_step(const ConvolutionSeries& series, StepFix fix, double t) {
  const double step = fix == StepFix::scale ? 2.0 * series_step(series, t)
                                            : series_step(series, t + series_offset(series));
  return std::clamp(step, 0.0, 1.0);
}

BasisMeans basis_means(const ConvolutionSeries& series, const Kernel& kernel) {
  const std::vector<double> zeros(static_cast<std::size_t>(series.terms), 0.0);
  BasisMeans means{zeros, zeros, zeros, zeros, 0.0};
  for (const KernelTexel& texel : kernel) {
    means.z += texel.weight * texel.z;
    for (int k = 1; k <= series.terms; ++k) {
      const auto entry = static_cast<std::size_t>(k - 1);
      const double sine = texel.weight * std::sin(series_frequency(k) * texel.z);
      const double cosine = texel.weight * std::cos(series_frequency(k) * texel.z);
      means.sine[entry] += sine;
      means.cosine[entry] += cosine;
      means.z_sine[entry] += texel.z * sine;
      means.z_cosine[entry] += texel.z * cosine;
    }
  }
  return means;
}

double filtered_step(const ConvolutionSeries& series, const BasisMeans& means, double d) {
  // sin(c (z - d)) = sin(c z) cos(c d) - cos(c z) sin(c d).
  double step = 0.5;
  for (int k = 1; k <= series.terms; ++k) {
    const auto entry = static_cast<std::size_t>(k - 1);
    const double angle = series_frequency(k) * d;
    step += series_weight(series, k) *
            (means.sine[entry] * std::cos(angle) - means.cosine[entry] * std::sin(angle));
  }
  return step;
}

double filtered_visibility(const ConvolutionSeries& series, const BasisMeans& means, double d,
                           StepFix fix) {
  const double step = fix == StepFix::scale
                          ? 2.0 * filtered_step(series, means, d)
                          : filtered_step(series, means, d - series_offset(series));
  return std::clamp(step, 0.0, 1.0);
}

BlockerSums blocker_sums(const ConvolutionSeries& series, const BasisMeans& means, double d) {
  // fbar z = z - S z = z / 2 - sum_k weight_k z sin(c_k (z - d)).
  double numerator = 0.5 * means.z;
  for (int k = 1; k <= series.terms; ++k) {
    const auto entry = static_cast<std::size_t>(k - 1);
    const double angle = series_frequency(k) * d;
    numerator -= series_weight(series, k) *
                 (means.z_sine[entry] * std::cos(angle) - means.z_cosine[entry] * std::sin(angle));
  }
  return {numerator, 1.0 - filtered_step(series, means, d)};
}

double raw_blocker_depth(const BlockerSums& sums) { return sums.numerator / sums.denominator; }

std::optional<double> corrected_blocker_depth(const ConvolutionSeries& series,
                                              const BasisMeans& means, double d, StepFix fix) {
  if (fix == StepFix::offset) {
    const BlockerSums sums = blocker_sums(series, means, d - series_offset(series));
    if (sums.denominator < kLeastBlockedFraction) return std::nullopt;
    return sums.numerator / sums.denominator;
  }
  const BlockerSums sums = blocker_sums(series, means, d);
  const double blocked_fraction = 2.0 * sums.denominator - 1.0;
  if (blocked_fraction < kLeastBlockedFraction) return std::nullopt;
  return (sums.numerator - (1.0 - sums.denominator) * d) / blocked_fraction;
}

double search_angle_rad(double multiplier, double area_m2, double cos_at_light, double distance_m) {
  assert(area_m2 >= 0.0 && cos_at_light >= 0.0 && distance_m > 0.0);
  return multiplier * std::atan(std::sqrt(area_m2 * cos_at_light) / distance_m);
}

double penumbra_width(double d, double z, double size) {
  assert(z > 0.0);
  return (d - z) * size / z;
}

double kernel_angle_rad(double d, double z, double size) {
  return std::atan(penumbra_width(d, z, size) / d);
}

double paper_kernel_width_uv(double angle_rad) { return angle_rad / std::numbers::pi; }

double conformal_kernel_width_uv(double angle_rad, double map_radius) {
  return 0.25 * angle_rad * (1.0 + map_radius * map_radius);
}

double exact_kernel_width_uv(double angle_rad, double polar_rad) {
  assert(polar_rad + 0.5 * angle_rad < std::numbers::pi);
  // r = tan(theta / 2); circles stay circles, and this one's diameter lies along the radius.
  const double outer = std::tan(0.5 * (polar_rad + 0.5 * angle_rad));
  const double inner = std::tan(0.5 * (polar_rad - 0.5 * angle_rad));
  return 0.5 * (outer - inner);
}

Kernel box_kernel(const DepthMap& map, const glm::dvec2& center_uv, double width_uv) {
  const glm::dvec2 low = center_uv - 0.5 * width_uv;
  const glm::dvec2 high = center_uv + 0.5 * width_uv;
  Kernel kernel;
  double area = 0.0;
  for (int y = 0; y < map.size_px; ++y) {
    const double height = covered_length(low.y, high.y, y, map.size_px);
    if (height <= 0.0) continue;
    for (int x = 0; x < map.size_px; ++x) {
      const double width = covered_length(low.x, high.x, x, map.size_px);
      if (width <= 0.0) continue;
      const auto index = static_cast<std::size_t>(y * map.size_px + x);
      kernel.push_back({map.z[index], width * height});
      area += width * height;
    }
  }
  assert(area > 0.0);
  for (KernelTexel& texel : kernel) texel.weight /= area;
  return kernel;
}

double exact_visibility(const Kernel& kernel, double d) {
  double lit = 0.0;
  for (const KernelTexel& texel : kernel) lit += d <= texel.z ? texel.weight : 0.0;
  return lit;
}

std::optional<double> exact_blocker_depth(const Kernel& kernel, double d) {
  double sum = 0.0;
  double blocked = 0.0;
  for (const KernelTexel& texel : kernel) {
    if (texel.z >= d) continue;
    sum += texel.weight * texel.z;
    blocked += texel.weight;
  }
  if (blocked <= 0.0) return std::nullopt;
  return sum / blocked;
}

Kernel two_plane_kernel(const TwoPlanes& planes) {
  return {{planes.z_blocker, planes.blocked_fraction},
          {planes.z_background, 1.0 - planes.blocked_fraction}};
}

BlockerSums two_plane_sums(const ConvolutionSeries& series, const TwoPlanes& planes, double d) {
  const double blocker =
      planes.blocked_fraction * (1.0 - series_step(series, planes.z_blocker - d));
  const double background =
      (1.0 - planes.blocked_fraction) * (1.0 - series_step(series, planes.z_background - d));
  return {blocker * planes.z_blocker + background * planes.z_background, blocker + background};
}

double two_plane_raw_depth(double blocked_fraction, double z_blocker, double d) {
  const double unblocked = 0.5 * (1.0 - blocked_fraction);
  return (blocked_fraction * z_blocker + unblocked * d) / (blocked_fraction + unblocked);
}

double two_plane_scale_depth(const ConvolutionSeries& series, double z_blocker, double d) {
  const double light_left = series_step(series, z_blocker - d);
  return z_blocker - (d - z_blocker) * light_left / (1.0 - 2.0 * light_left);
}

}  // namespace test_clustered_visibility
