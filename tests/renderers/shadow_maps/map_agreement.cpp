#include "tests/renderers/shadow_maps/map_agreement.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "renderers/shadow_maps/hemisphere_projection.h"

namespace renderers::test {

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

constexpr int kSteps = 2;  // to each side of a position

/// Distances along the rays at and around a position, within the hemisphere.
std::vector<float> distances_around(const SeenFrom& seen, const glm::dvec2& position,
                                    double reach) {
  std::vector<float> distances;
  for (int dy = -kSteps; dy <= kSteps; ++dy) {
    for (int dx = -kSteps; dx <= kSteps; ++dx) {
      glm::dvec2 moved = position + reach / kSteps * glm::dvec2(dx, dy);
      moved /= std::fmax(1.0, glm::length(moved));
      distances.push_back(ray_distance(seen.bench, seen.origin, seen.near_m, moved));
    }
  }
  return distances;
}

}  // namespace

bool is_alike(float a, float b, float tolerance) {
  return a == b || std::fabs(a - b) <= tolerance * std::fmin(a, b);
}

Excuse rounding_excuse(const SeenFrom& seen) {
  return [&seen](const glm::dvec2& position, float distance) {
    return std::ranges::any_of(distances_around(seen, position, 2e-5), [distance](float around) {
      return is_alike(around, distance, 1e-3F);
    });
  };
}

Excuse silhouette_excuse(const SeenFrom& seen, double reach) {
  return [&seen, reach](const glm::dvec2& position, float) {
    const auto [least, greatest] = std::ranges::minmax(distances_around(seen, position, reach));
    return least < kInfinity && greatest > 1.1F * least;
  };
}

Agreement agreement_of(const SeenFrom& seen, int size_px, const std::vector<float>& distances,
                       const Excuse& excuse, float tolerance) {
  Agreement agreement;
  std::vector<double> errors;
  for (int y = 0; y < size_px; ++y) {
    for (int x = 0; x < size_px; ++x) {
      const float distance = distances[static_cast<std::size_t>(y * size_px + x)];
      if (!shadow_maps::hemisphere_texel_is_used({x, y}, size_px)) {
        EXPECT_EQ(distance, kInfinity) << "beyond the rim";
        continue;
      }
      ++agreement.texels;
      const glm::dvec2 position = shadow_maps::hemisphere_texel_position({x, y}, size_px);
      const float truth = ray_distance(seen.bench, seen.origin, seen.near_m, position);
      if (std::isfinite(truth) && std::isfinite(distance)) {
        errors.push_back(std::fabs(static_cast<double>(distance) / truth - 1.0));
      }
      if (is_alike(truth, distance, tolerance)) continue;
      ++agreement.differing;
      if (!excuse(position, distance)) ++agreement.unexplained;
    }
  }
  if (errors.empty()) return agreement;
  std::ranges::nth_element(errors, errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2));
  agreement.median_error = errors[errors.size() / 2];
  return agreement;
}

}  // namespace renderers::test
