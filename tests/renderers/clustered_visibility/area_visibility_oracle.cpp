#include "tests/renderers/clustered_visibility/area_visibility_oracle.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "renderers/shadow_maps/hemisphere_projection.h"
#include "tests/renderers/clustered_visibility/moment_oracle.h"

namespace test_clustered_visibility {

namespace {

/// Adds the texels below one texel of a level.
void add_texel(const DepthMap& map, int level, glm::ivec2 texel, double weight, Kernel& kernel) {
  const int side = map.size_px >> level;
  texel.x = std::clamp(texel.x, 0, side - 1);
  texel.y = std::clamp(texel.y, 0, side - 1);
  for (int y = texel.y << level; y < (texel.y + 1) << level; ++y) {
    for (int x = texel.x << level; x < (texel.x + 1) << level; ++x) {
      const double z = map.z[static_cast<std::size_t>(y * map.size_px + x)];
      kernel.push_back({z, std::ldexp(weight, -2 * level)});
    }
  }
}

void add_bilinear(const DepthMap& map, int level, const glm::dvec2& uv, double weight,
                  Kernel& kernel) {
  const double side = map.size_px >> level;
  const glm::dvec2 place = uv * side - 0.5;
  const glm::dvec2 corner(std::floor(place.x), std::floor(place.y));
  const glm::dvec2 part = place - corner;
  for (int i = 0; i < 4; ++i) {
    const glm::ivec2 step(i & 1, i >> 1);
    add_texel(
        map, level, glm::ivec2(corner) + step,
        weight * (step.x == 1 ? part.x : 1.0 - part.x) * (step.y == 1 ? part.y : 1.0 - part.y),
        kernel);
  }
}

}  // namespace

Kernel level_kernel(const DepthMap& map, const glm::dvec2& center_uv, double level) {
  const int last = static_cast<int>(std::lround(std::log2(map.size_px)));
  const double own = std::clamp(level, 0.0, static_cast<double>(last));
  const int finer = std::min(static_cast<int>(own), last);
  const double part = own - finer;
  Kernel kernel;
  add_bilinear(map, finer, center_uv, 1.0 - part, kernel);
  if (part > 0.0) add_bilinear(map, finer + 1, center_uv, part, kernel);
  return kernel;
}

SeenReceiver seen_from(const cv::AreaLight& area, float near_m, const glm::vec3& position,
                       const glm::vec3& normal) {
  namespace maps = renderers::shadow_maps;
  const glm::dvec3 axis(area.axis);
  const glm::dvec3 offset =
      glm::dvec3(position) - glm::dvec3(area.position) - double{near_m} * axis;
  const glm::dvec3 local = offset * maps::hemisphere_frame(axis);
  const glm::dvec2 place = maps::hemisphere_position(local);
  const double distance_m = glm::length(local);
  return {0.5 * place + 0.5, glm::length(place), distance_m, local.z / distance_m,
          std::abs(glm::dot(offset, glm::dvec3(normal))) / distance_m};
}

double AreaVisibilityOracle::width(double angle_rad, const SeenReceiver& seen) const {
  const double uv = settings_.kernel == cv::KernelWidth::paper
                        ? paper_kernel_width_uv(angle_rad)
                        : conformal_kernel_width_uv(angle_rad, seen.radius);
  return std::min(uv, 1.0);
}

double AreaVisibilityOracle::rise(const SeenReceiver& seen, double kernel_width) const {
  const double sine = std::sqrt(std::max(1.0 - seen.receiver_cosine * seen.receiver_cosine, 0.0));
  const double slope = sine / std::max(seen.receiver_cosine, 0.1);
  // A width of the map spans (1 + r^2) / 4 of a radian (conformal_kernel_width_uv).
  const double angle =
      std::max(kernel_width, 1.0 / map_.size_px) * 4.0 / (1.0 + seen.radius * seen.radius);
  return slope * 0.5 * angle;
}

Kernel AreaVisibilityOracle::kernel(const SeenReceiver& seen, double kernel_width) const {
  const bool is_series = settings_.test == cv::AreaTest::cssm;
  if (is_series && convolution_.prefilter == cv::Prefilter::sat) {
    return box_kernel(map_, seen.uv, std::max(kernel_width, 1.0 / map_.size_px));
  }
  const double finer = double{is_series ? settings_.finer_levels : settings_.moments.finer_levels};
  const double texels = std::max(kernel_width * map_.size_px, 1.0);
  return level_kernel(map_, seen.uv, std::max(std::log2(texels) - finer, 0.0));
}

std::optional<double> AreaVisibilityOracle::series_blocker(const SeenReceiver& seen,
                                                           double kernel_width,
                                                           double depth) const {
  constexpr double kNear = 0.01;
  const BasisMeans means = basis_means(series_, kernel(seen, kernel_width));
  const double biased =
      depth * (1.0 - std::min(double{settings_.slope_bias} * rise(seen, kernel_width), 0.5));
  const bool is_corrected = settings_.blocker == cv::BlockerDepth::corrected;
  const bool is_offset = is_corrected && fix() == StepFix::offset;
  const BlockerSums sums =
      blocker_sums(series_, means, is_offset ? biased - series_offset(series_) : biased);
  const double share = is_corrected && !is_offset ? 2.0 * sums.denominator - 1.0 : sums.denominator;
  const double least = is_corrected ? kLeastBlockedFraction : 0.0;
  if (std::abs(share - least) < kNear) return std::nullopt;
  if (share <= least) return depth;
  return is_corrected ? *corrected_blocker_depth(series_, means, biased, fix())
                      : raw_blocker_depth(sums);
}

AreaVisibilityOracle::Blockers AreaVisibilityOracle::moment_blockers(const SeenReceiver& seen,
                                                                     double kernel_width,
                                                                     double depth) const {
  const int taps = settings_.moments.taps;
  const double reached = std::max(kernel_width, 2.0 / map_.size_px);
  const double share = double{settings_.moments.slope} * rise(seen, reached);
  const double reach = std::max(std::min(share, 0.15) * depth, 1e-6);
  Blockers mean;
  for (int i = 0; i < taps * taps; ++i) {
    SeenReceiver part = seen;
    part.uv += kernel_width * ((glm::dvec2(i % taps, i / taps) + 0.5) / double(taps) - 0.5);
    const Blockers blockers = blockers_in(kernel(part, kernel_width / taps), depth, reach);
    mean.mass += blockers.mass / (taps * taps);
    mean.depths += blockers.depths / (taps * taps);
  }
  return mean;
}

AreaVisibilityOracle::Blockers AreaVisibilityOracle::blockers_in(const Kernel& kernel, double depth,
                                                                 double reach) const {
  const Moments moments = moments_of(kernel);
  Moments even{1.0, 0.0, 1.0 / 3.0, 0.0, 1.0 / 5.0};
  const double bias = double{settings_.moments.bias};
  for (std::size_t i = 0; i < even.size(); ++i)
    even[i] = (1.0 - bias) * moments[i] + bias * even[i];
  const MomentAtoms atoms = atoms_of(even, 2.0 * depth - 1.0);
  Blockers blockers;
  for (std::size_t i = 0; i < 2; ++i) {
    const double z = 0.5 * atoms.depth[i] + 0.5;
    const double mass =
        std::clamp(atoms.mass[i], 0.0, 1.0) * std::clamp((depth - z) / reach - 1.0, 0.0, 1.0);
    blockers.mass += mass;
    blockers.depths += mass * z;
  }
  return blockers;
}

std::optional<double> AreaVisibilityOracle::blocker_depth(const SeenReceiver& seen,
                                                          double kernel_width, double depth) const {
  std::optional<double> z;
  if (settings_.test == cv::AreaTest::cssm) {
    z = series_blocker(seen, kernel_width, depth);
    if (!z) return z;
  } else {
    const Blockers blockers = moment_blockers(seen, kernel_width, depth);
    if (blockers.mass <= 0.0) return depth;
    const double own = double{settings_.moments.blocked_bias};
    z = (blockers.depths + own * depth) / (blockers.mass + own);
  }
  return std::clamp(*z, 0.0, depth);
}

double AreaVisibilityOracle::lit_share(const SeenReceiver& seen, double kernel_width, double depth,
                                       double blocker) const {
  if (settings_.test == cv::AreaTest::msm) {
    return std::clamp(1.0 - moment_blockers(seen, kernel_width, depth).mass, 0.0, 1.0);
  }
  const double biased =
      depth * (1.0 - std::min(double{settings_.slope_bias} * rise(seen, kernel_width), 0.5));
  const double share =
      filtered_visibility(series_, basis_means(series_, kernel(seen, kernel_width)), biased, fix());
  const double contact = double{settings_.contact_strength} *
                         std::exp(-double{settings_.contact_range} * (depth - blocker));
  return std::pow(share, 1.0 + contact);
}

std::optional<double> AreaVisibilityOracle::visibility(const cv::AreaLight& area,
                                                       const SeenReceiver& seen) const {
  const double depth = seen.distance_m * double{area.shape.y};
  const double search = width(search_angle_rad(double{settings_.search_scale}, double{area.shape.z},
                                               seen.cosine, seen.distance_m),
                              seen);
  const std::optional<double> blocker = blocker_depth(seen, search, depth);
  if (!blocker) return std::nullopt;
  if (*blocker >= depth) return 1.0;
  const double size_m =
      double{area.shape.x} * (settings_.is_foreshortened ? std::sqrt(seen.cosine) : 1.0);
  const double penumbra_m = penumbra_width(depth, std::max(*blocker, 1e-4), size_m);
  return lit_share(seen, width(std::atan2(penumbra_m, seen.distance_m), seen), depth, *blocker);
}

}  // namespace test_clustered_visibility
