#include "renderers/texel_atlas/charts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <tuple>
#include <utility>

#include <glm/geometric.hpp>

namespace renderers::texel_atlas {

namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

/// Edge of an object from one corner to another, by coordinates.
struct DirectedEdge {
  std::uint32_t object = 0;
  glm::dvec3 from{0.0};
  glm::dvec3 to{0.0};

  auto key() const { return std::tie(object, from.x, from.y, from.z, to.x, to.y, to.z); }
  friend bool operator<(const DirectedEdge& a, const DirectedEdge& b) { return a.key() < b.key(); }
};

DirectedEdge edge_of(const WorldTriangle& triangle, std::size_t corner) {
  return {triangle.object, triangle.corners[corner], triangle.corners[(corner + 1) % 3]};
}

/// Which triangle lies across each edge; kNone: none, or several.
class Neighbours {
 public:
  explicit Neighbours(const WorldTriangles& world) : world_(world) {
    edges_.reserve(3 * world.triangles.size());
    for (std::uint32_t i = 0; i < world.triangles.size(); ++i) {
      for (std::size_t corner = 0; corner < 3; ++corner) {
        edges_.emplace_back(edge_of(world.triangles[i], corner), i);
      }
    }
    std::sort(edges_.begin(), edges_.end());
  }

  std::uint32_t across(std::uint32_t triangle, std::size_t corner) const {
    DirectedEdge edge = edge_of(world_.triangles[triangle], corner);
    std::swap(edge.from, edge.to);
    const auto less = [](const auto& entry, const DirectedEdge& value) {
      return entry.first < value;
    };
    const auto found = std::lower_bound(edges_.begin(), edges_.end(), edge, less);
    if (found == edges_.end() || edge < found->first) return kNone;
    const auto next = found + 1;
    const bool is_manifold = next == edges_.end() || edge < next->first;
    return is_manifold ? found->second : kNone;
  }

 private:
  const WorldTriangles& world_;
  std::vector<std::pair<DirectedEdge, std::uint32_t>> edges_;
};

bool is_degenerate(const WorldTriangle& triangle) {
  const double length = glm::length(triangle.scaled_normal());
  return !(length > 0.0) || !std::isfinite(length);
}

glm::dvec3 unit_normal(const WorldTriangle& triangle) {
  return glm::normalize(triangle.scaled_normal());
}

/// A frame's rectangle around the triangles; `direction` gives the u axis, in the plane.
Chart boxed(const WorldTriangles& world, const std::vector<std::uint32_t>& triangles,
            const glm::dvec3& normal, const glm::dvec3& direction) {
  Chart chart;
  chart.axis_u = glm::normalize(direction - glm::dot(direction, normal) * normal);
  chart.axis_v = glm::cross(normal, chart.axis_u);
  glm::dvec2 least(std::numeric_limits<double>::infinity());
  glm::dvec2 greatest(-std::numeric_limits<double>::infinity());
  for (const std::uint32_t i : triangles) {
    for (const glm::dvec3& corner : world.triangles[i].corners) {
      const glm::dvec2 place(glm::dot(corner, chart.axis_u), glm::dot(corner, chart.axis_v));
      least = glm::min(least, place);
      greatest = glm::max(greatest, place);
    }
  }
  const glm::dvec3& any = world.triangles[triangles.front()].corners[0];
  chart.origin = least.x * chart.axis_u + least.y * chart.axis_v + glm::dot(any, normal) * normal;
  chart.size_m = greatest - least;
  return chart;
}

/// The smallest of the rectangles along the edges of the first triangles.
Chart framed(const WorldTriangles& world, std::vector<std::uint32_t> triangles) {
  constexpr std::size_t kMostTriedTriangles = 32;
  glm::dvec3 normal(0.0);
  for (const std::uint32_t i : triangles) normal += world.triangles[i].scaled_normal();
  normal = glm::normalize(normal);
  std::optional<Chart> best;
  for (std::size_t t = 0; t < std::min(triangles.size(), kMostTriedTriangles); ++t) {
    const WorldTriangle& triangle = world.triangles[triangles[t]];
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const glm::dvec3 edge = triangle.corners[(corner + 1) % 3] - triangle.corners[corner];
      Chart tried = boxed(world, triangles, normal, edge);
      const auto area = [](const Chart& chart) { return chart.size_m.x * chart.size_m.y; };
      // Equal up to rounding: the first, so that the choice does not hang on the last digit.
      constexpr double kClearlySmaller = 1.0 - 1e-9;
      if (!best || area(tried) < kClearlySmaller * area(*best)) best = std::move(tried);
    }
  }
  best->triangles = std::move(triangles);
  return std::move(*best);
}

/// All triangles reached from a seed whose normals are near the seed's.
std::vector<std::uint32_t> grow(const WorldTriangles& world, const Neighbours& neighbours,
                                std::uint32_t seed, double least_cosine,
                                std::vector<bool>& is_taken) {
  const glm::dvec3 normal = unit_normal(world.triangles[seed]);
  std::vector<std::uint32_t> group{seed};
  is_taken[seed] = true;
  for (std::size_t next = 0; next < group.size(); ++next) {
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const std::uint32_t other = neighbours.across(group[next], corner);
      if (other == kNone || is_taken[other]) continue;
      if (glm::dot(unit_normal(world.triangles[other]), normal) < least_cosine) continue;
      is_taken[other] = true;
      group.push_back(other);
    }
  }
  return group;
}

}  // namespace

glm::dvec2 Chart::project(const glm::dvec3& point) const {
  const glm::dvec3 offset = point - origin;
  return {glm::dot(offset, axis_u), glm::dot(offset, axis_v)};
}

std::vector<Chart> make_charts(const WorldTriangles& world, const ChartSettings& settings) {
  std::vector<Chart> charts;
  std::vector<bool> is_taken(world.triangles.size());
  for (std::size_t i = 0; i < is_taken.size(); ++i) is_taken[i] = is_degenerate(world.triangles[i]);
  if (settings.kind == ChartKind::triangle) {
    for (std::uint32_t i = 0; i < world.triangles.size(); ++i) {
      if (!is_taken[i]) charts.push_back(framed(world, {i}));
    }
    return charts;
  }
  const Neighbours neighbours(world);
  const double least_cosine = std::cos(settings.normal_angle_deg * std::numbers::pi / 180.0);
  for (std::uint32_t i = 0; i < world.triangles.size(); ++i) {
    if (is_taken[i]) continue;
    charts.push_back(framed(world, grow(world, neighbours, i, least_cosine, is_taken)));
  }
  return charts;
}

std::vector<Chart> split_chart(const WorldTriangles& world, const Chart& chart) {
  std::vector<Chart> parts;
  for (const std::uint32_t i : chart.triangles) parts.push_back(framed(world, {i}));
  return parts;
}

}  // namespace renderers::texel_atlas
