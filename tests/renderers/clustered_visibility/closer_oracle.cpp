#include "tests/renderers/clustered_visibility/closer_oracle.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "renderers/shadow_maps/hemisphere_projection.h"

namespace test_clustered_visibility {

namespace maps = renderers::shadow_maps;

namespace {

constexpr int kMostSteps = 16;          ///< through a box, along a side
constexpr double kBias_texels = 0.25;   ///< of the distance compared with (LookupBias)
constexpr double kRounding = 2e-5;      ///< the same, of the receiver's distance
constexpr double kUndecided = 4e-6;     ///< of the receiver's distance
constexpr double kUndecided_px = 1e-3;  ///< between a box's edge and a texel's centre

bool is_near_integer(double value) { return std::abs(value - std::round(value)) < kUndecided_px; }

}  // namespace

CloserOracle::CloserOracle(const cv::AreaVisibilitySettings& settings, const cv::AreaLight& area,
                           float near_m, DepthMap map)
    : settings_(settings), area_(area), near_m_(double{near_m}), map_(std::move(map)) {}

CloserOracle::Receiver CloserOracle::receiver(const glm::vec3& position,
                                              const glm::vec3& normal) const {
  const glm::dvec3 axis(area_.axis);
  const glm::dmat3 frame = maps::hemisphere_frame(axis);
  Receiver receiver;
  receiver.local = (glm::dvec3(position) - glm::dvec3(area_.position) - near_m_ * axis) * frame;
  receiver.normal = glm::dvec3(normal) * frame;
  receiver.place = maps::hemisphere_position(receiver.local);
  receiver.distance_m = glm::length(receiver.local);
  receiver.cosine = receiver.local.z / receiver.distance_m;
  return receiver;
}

double CloserOracle::compared_m(const glm::ivec2& texel, const Receiver& receiver) const {
  // Where the texel's ray meets the receiver's plane, at most the receiver's own distance.
  const glm::dvec3 ray =
      maps::hemisphere_direction(maps::hemisphere_texel_position(texel, map_.size_px));
  const double plane_m = glm::dot(receiver.local, receiver.normal) / glm::dot(ray, receiver.normal);
  const double own_m = plane_m > 0.0 ? std::min(receiver.distance_m, plane_m) : receiver.distance_m;
  const double texel_m = 2.0 * (1.0 + receiver.cosine) / map_.size_px * receiver.distance_m;
  return own_m - kBias_texels * texel_m - kRounding * receiver.distance_m;
}

CloserOracle::Texels CloserOracle::look_at(const glm::ivec2& least, const glm::ivec2& greatest,
                                           const Receiver& receiver) const {
  const glm::ivec2 size = greatest - least + 1;
  const glm::ivec2 steps = glm::min(size, glm::ivec2(kMostSteps));
  Texels texels;
  double blockers = 0.0;
  for (int i = 0; i < steps.x * steps.y; ++i) {
    const glm::ivec2 step(i % steps.x, i / steps.x);
    const glm::ivec2 texel = least + (2 * step + 1) * size / (2 * steps);
    const double blocker_m =
        map_.z[static_cast<std::size_t>(texel.y * map_.size_px + texel.x)] / double{area_.shape.y};
    const double difference_m = blocker_m - compared_m(texel, receiver);
    if (std::abs(difference_m) < kUndecided * receiver.distance_m) texels.is_decided = false;
    if (difference_m >= 0.0) continue;
    blockers += 1.0;
    texels.blocker_m += blocker_m;
  }
  texels.blocked = blockers / (steps.x * steps.y);
  if (blockers > 0.0) texels.blocker_m /= blockers;
  return texels;
}

CloserOracle::Texels CloserOracle::look_in_box(const Receiver& receiver, double width_uv) const {
  // Texels whose centres lie in the box; at least the one at its centre.
  const glm::dvec2 center_px = (0.5 * receiver.place + 0.5) * static_cast<double>(map_.size_px);
  const double half_px = 0.5 * width_uv * map_.size_px;
  const glm::ivec2 own =
      glm::clamp(glm::ivec2(glm::floor(center_px)), glm::ivec2(0), glm::ivec2(map_.size_px - 1));
  const glm::dvec2 low = center_px - half_px - 0.5;
  const glm::dvec2 high = center_px + half_px - 0.5;
  Texels texels = look_at(
      glm::clamp(glm::ivec2(glm::ceil(low)), glm::ivec2(0), own),
      glm::clamp(glm::ivec2(glm::floor(high)), own, glm::ivec2(map_.size_px - 1)), receiver);
  for (const double edge : {low.x, low.y, high.x, high.y, center_px.x, center_px.y}) {
    if (is_near_integer(edge)) texels.is_decided = false;
  }
  return texels;
}

double CloserOracle::width_uv(double angle_rad, const Receiver& receiver) const {
  const double width = settings_.kernel == cv::KernelWidth::paper
                           ? paper_kernel_width_uv(angle_rad)
                           : conformal_kernel_width_uv(angle_rad, glm::length(receiver.place));
  return std::min(width, 1.0);
}

std::optional<double> CloserOracle::visibility(const glm::vec3& position,
                                               const glm::vec3& normal) const {
  const Receiver receiver = this->receiver(position, normal);
  if (receiver.local.z <= 0.0) return 1.0;
  if (settings_.test == cv::AreaTest::hard) {
    const Texels texel = look_in_box(receiver, 0.0);
    return texel.is_decided ? std::optional(1.0 - texel.blocked) : std::nullopt;
  }
  const double search = search_angle_rad(double{settings_.search_scale}, double{area_.shape.z},
                                         receiver.cosine, receiver.distance_m);
  const Texels found = look_in_box(receiver, width_uv(search, receiver));
  if (!found.is_decided) return std::nullopt;
  if (found.blocked == 0.0 || found.blocker_m >= receiver.distance_m) return 1.0;
  const double size_m =
      double{area_.shape.x} * (settings_.is_foreshortened ? std::sqrt(receiver.cosine) : 1.0);
  const double angle = kernel_angle_rad(receiver.distance_m, found.blocker_m, size_m);
  const Texels texels = look_in_box(receiver, width_uv(angle, receiver));
  return texels.is_decided ? std::optional(1.0 - texels.blocked) : std::nullopt;
}

}  // namespace test_clustered_visibility
