#include "renderers/texel_atlas/texel_builder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <glm/geometric.hpp>

#include "renderers/ray_tracing/surface_brdf.h"
#include "renderers/texel_atlas/polygon_clipping.h"

namespace renderers::texel_atlas {

namespace {

using Corners = std::array<glm::dvec2, 3>;

/// Part of one triangle in a cell.
struct Part {
  std::size_t cell = 0;
  std::uint32_t triangle = 0;  ///< index into WorldTriangles::triangles
  double cell_share = 0.0;     ///< of the cell's area
  double area_m2 = 0.0;
  glm::dvec2 centroid{0.0};  ///< cells from the chart's corner
  glm::vec3 albedo{0.0F};
  glm::vec3 emission{0.0F};
};

/// Weights of the second and third corner at a point of the plane.
glm::dvec2 barycentrics_at(const Corners& t, const glm::dvec2& point) {
  const glm::dvec2 u = t[1] - t[0];
  const glm::dvec2 v = t[2] - t[0];
  const glm::dvec2 p = point - t[0];
  const double determinant = u.x * v.y - u.y * v.x;
  glm::dvec2 weights((p.x * v.y - p.y * v.x) / determinant, (u.x * p.y - u.y * p.x) / determinant);
  weights = glm::max(weights, glm::dvec2(0.0));
  const double sum = weights.x + weights.y;
  return sum > 1.0 ? weights / sum : weights;
}

Polygon rectangle(const glm::dvec2& low, const glm::dvec2& high) {
  Polygon polygon;
  polygon.count = 4;
  polygon.corners = {low, glm::dvec2(high.x, low.y), high, glm::dvec2(low.x, high.y)};
  return polygon;
}

/// Most cells of a large triangle need no clipping.
bool holds_rectangle(const Corners& t, const glm::dvec2& low, const glm::dvec2& high) {
  const glm::dvec2 center = 0.5 * (low + high);
  const glm::dvec2 half = 0.5 * (high - low);
  const glm::dvec2 u = t[1] - t[0];
  const glm::dvec2 v = t[2] - t[0];
  const double turn = u.x * v.y - u.y * v.x < 0.0 ? -1.0 : 1.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const glm::dvec2 edge = turn * (t[(i + 1) % 3] - t[i]);
    const glm::dvec2 offset = center - t[i];
    // The corner farthest outside this edge.
    const double side = edge.x * offset.y - edge.y * offset.x;
    if (side < std::fabs(edge.x) * half.y + std::fabs(edge.y) * half.x) return false;
  }
  return true;
}

class ChartCutter {
 public:
  ChartCutter(const WorldTriangles& world, const ray_tracing::RayScene& rays, const Chart& chart,
              const ChartPlace& place)
      : world_(world), rays_(rays), chart_(chart), place_(place) {}

  ChartTexels cut();

 private:
  Corners corners_of(std::uint32_t triangle) const;
  void add_parts(std::uint32_t triangle);
  void sort_parts(std::size_t cells);
  void measure_colors(const Corners& corners, const Polygon& polygon, Part& part) const;
  Texel texel_of(const Part* begin, const Part* end) const;
  void join_small_pieces(const std::vector<double>& shares, ChartTexels& result) const;

  const WorldTriangles& world_;
  const ray_tracing::RayScene& rays_;
  const Chart& chart_;
  const ChartPlace& place_;
  std::vector<Part> parts_;
};

Corners ChartCutter::corners_of(std::uint32_t triangle) const {
  Corners corners;
  for (std::size_t i = 0; i < 3; ++i) {
    corners[i] = chart_.project(world_.triangles[triangle].corners[i]) * place_.texels_per_m;
  }
  return corners;
}

void ChartCutter::add_parts(std::uint32_t triangle) {
  const Corners corners = corners_of(triangle);
  const double projected =
      measure(clip_to_rectangle(corners, glm::dvec2(-1.0), glm::dvec2(place_.size) + 1.0)).area;
  if (!(projected > 0.0)) return;
  const double m2_per_cell = world_.triangles[triangle].area_m2() / projected;
  const glm::dvec2 least = glm::min(corners[0], glm::min(corners[1], corners[2]));
  const glm::dvec2 greatest = glm::max(corners[0], glm::max(corners[1], corners[2]));
  const glm::ivec2 last = place_.size - 1;
  const glm::ivec2 begin = glm::clamp(glm::ivec2(glm::floor(least)), glm::ivec2(0), last);
  const glm::ivec2 end = glm::clamp(glm::ivec2(glm::floor(greatest)), glm::ivec2(0), last);
  for (int y = begin.y; y <= end.y; ++y) {
    for (int x = begin.x; x <= end.x; ++x) {
      // Cells at the rectangle's edge take what rounding puts beyond it.
      const glm::dvec2 low(x == 0 ? -1.0 : x, y == 0 ? -1.0 : y);
      const glm::dvec2 high(x == last.x ? x + 2.0 : x + 1.0, y == last.y ? y + 2.0 : y + 1.0);
      const Polygon polygon = holds_rectangle(corners, low, high)
                                  ? rectangle(low, high)
                                  : clip_to_rectangle(corners, low, high);
      const Piece piece = measure(polygon);
      if (!(piece.area > 0.0)) continue;
      Part& part = parts_.emplace_back();
      part.cell = static_cast<std::size_t>(y) * static_cast<std::size_t>(place_.size.x) +
                  static_cast<std::size_t>(x);
      part.triangle = triangle;
      part.cell_share = piece.area;
      part.area_m2 = piece.area * m2_per_cell;
      part.centroid = piece.centroid;
      measure_colors(corners, polygon, part);
    }
  }
}

/// Mean albedo and emission over a polygon, each triangle of its fan by the midpoints of its edges.
/// Source: Strang and Fix 1973, "An Analysis of the Finite Element Method", Table 4.1 (recalled):
/// exact for quadratic functions.
void ChartCutter::measure_colors(const Corners& corners, const Polygon& polygon, Part& part) const {
  const WorldTriangle& source = world_.triangles[part.triangle];
  const scene::Scene& scene = rays_.scene();
  const int material_index = scene.objects[source.object].material;
  const scene::Material& material = scene.materials[static_cast<std::size_t>(material_index)];
  part.albedo = material.albedo;
  part.emission = material.emission;
  const bool has_albedo = material.albedo_texture != scene::kNoTexture;
  const bool has_emission = material.emission_texture != scene::kNoTexture;
  if (!has_albedo && !has_emission) return;
  glm::dvec3 albedo(0.0);
  glm::dvec3 emission(0.0);
  double weight_sum = 0.0;
  const auto add = [&](const glm::dvec2& place, double weight) {
    const ray_tracing::SurfacePoint point = rays_.point_on_triangle(
        source.object, source.triangle, glm::vec2(barycentrics_at(corners, place)));
    const auto lookup = [&](int texture) {
      return scene::sample_texture(scene.textures[static_cast<std::size_t>(texture)], point.uv);
    };
    if (has_albedo) albedo += weight * glm::dvec3(lookup(material.albedo_texture));
    if (has_emission) emission += weight * glm::dvec3(lookup(material.emission_texture));
    weight_sum += weight;
  };
  for (std::size_t i = 1; i + 1 < polygon.count; ++i) {
    const glm::dvec2& a = polygon.corners[0];
    const glm::dvec2& b = polygon.corners[i];
    const glm::dvec2& c = polygon.corners[i + 1];
    const double area = std::fabs((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x));
    add(0.5 * (a + b), area);
    add(0.5 * (b + c), area);
    add(0.5 * (c + a), area);
  }
  if (has_albedo) part.albedo *= glm::vec3(albedo / weight_sum);
  if (has_emission) part.emission *= glm::vec3(emission / weight_sum);
}

/// One texel of the parts in a cell. Its point is the parts' centroid where one of them holds it,
/// else the centroid of the largest.
Texel ChartCutter::texel_of(const Part* begin, const Part* end) const {
  const Part* largest = std::max_element(
      begin, end, [](const Part& a, const Part& b) { return a.cell_share < b.cell_share; });
  double area_m2 = 0.0;
  double share = 0.0;
  glm::dvec2 centroid(0.0);
  glm::dvec3 albedo(0.0);
  glm::dvec3 emission(0.0);
  for (const Part* part = begin; part != end; ++part) {
    area_m2 += part->area_m2;
    share += part->cell_share;
    centroid += part->cell_share * part->centroid;
    albedo += part->area_m2 * glm::dvec3(part->albedo);
    emission += part->area_m2 * glm::dvec3(part->emission);
  }
  centroid /= share;
  const Part* holder = end - begin == 1 ? begin : nullptr;
  for (const Part* part = begin; part != end && !holder; ++part) {
    const Corners corners = corners_of(part->triangle);
    const glm::dvec2 weights = barycentrics_at(corners, centroid);
    const glm::dvec2 held = (1.0 - weights.x - weights.y) * corners[0] + weights.x * corners[1] +
                            weights.y * corners[2];
    constexpr double kRounding = 1e-9;
    if (glm::distance(held, centroid) < kRounding) holder = part;
  }
  if (!holder) {
    holder = largest;
    centroid = largest->centroid;
  }
  const WorldTriangle& source = world_.triangles[holder->triangle];
  Texel texel;
  texel.point =
      rays_.point_on_triangle(source.object, source.triangle,
                              glm::vec2(barycentrics_at(corners_of(holder->triangle), centroid)));
  texel.area_m2 = static_cast<float>(area_m2);
  texel.albedo = glm::vec3(albedo / area_m2);
  texel.emission = glm::vec3(emission / area_m2);
  const auto width = static_cast<std::size_t>(place_.size.x);
  texel.cell = place_.corner + glm::ivec2(begin->cell % width, begin->cell / width);
  return texel;
}

void ChartCutter::join_small_pieces(const std::vector<double>& shares, ChartTexels& result) const {
  constexpr double kSmallShare = 0.25;
  const glm::ivec2 size = place_.size;
  const auto cell_at = [&](int x, int y) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(size.x) +
           static_cast<std::size_t>(x);
  };
  const auto large_neighbour = [&](int x, int y) {
    std::uint32_t found = kNoTexel;
    double largest = kSmallShare;
    for (int ny = std::max(0, y - 1); ny <= std::min(size.y - 1, y + 1); ++ny) {
      for (int nx = std::max(0, x - 1); nx <= std::min(size.x - 1, x + 1); ++nx) {
        const double share = shares[cell_at(nx, ny)];
        if (share < largest || (found != kNoTexel && share == largest)) continue;
        largest = share;
        found = result.cells[cell_at(nx, ny)];
      }
    }
    return found;
  };
  std::vector<std::uint32_t> target(result.texels.size());
  for (std::uint32_t i = 0; i < target.size(); ++i) target[i] = i;
  for (int y = 0; y < size.y; ++y) {
    for (int x = 0; x < size.x; ++x) {
      const std::uint32_t own = result.cells[cell_at(x, y)];
      if (own == kNoTexel || shares[cell_at(x, y)] >= kSmallShare) continue;
      const std::uint32_t other = large_neighbour(x, y);
      if (other != kNoTexel) target[own] = other;
    }
  }
  std::vector<std::uint32_t> new_index(target.size(), kNoTexel);
  std::vector<Texel> kept;
  for (std::uint32_t i = 0; i < target.size(); ++i) {
    if (target[i] != i) continue;
    new_index[i] = static_cast<std::uint32_t>(kept.size());
    kept.push_back(result.texels[i]);
  }
  for (std::uint32_t i = 0; i < target.size(); ++i) {
    if (target[i] == i) continue;
    Texel& joined = kept[new_index[target[i]]];
    const Texel& small = result.texels[i];
    const float area_m2 = joined.area_m2 + small.area_m2;
    joined.albedo = (joined.area_m2 * joined.albedo + small.area_m2 * small.albedo) / area_m2;
    joined.emission = (joined.area_m2 * joined.emission + small.area_m2 * small.emission) / area_m2;
    joined.area_m2 = area_m2;
  }
  for (std::uint32_t& cell : result.cells) {
    if (cell != kNoTexel) cell = new_index[target[cell]];
  }
  result.texels = std::move(kept);
}

/// A counting sort by cell, parts of a cell in the order of the triangles.
void ChartCutter::sort_parts(std::size_t cells) {
  std::vector<std::size_t> next(cells, 0);
  for (const Part& part : parts_) ++next[part.cell];
  std::size_t total = 0;
  for (std::size_t& count : next) total += std::exchange(count, total);
  std::vector<Part> sorted(parts_.size());
  for (const Part& part : parts_) sorted[next[part.cell]++] = part;
  parts_ = std::move(sorted);
}

ChartTexels ChartCutter::cut() {
  for (const std::uint32_t triangle : chart_.triangles) add_parts(triangle);
  const std::size_t cells =
      static_cast<std::size_t>(place_.size.x) * static_cast<std::size_t>(place_.size.y);
  sort_parts(cells);
  ChartTexels result;
  result.cells.assign(cells, kNoTexel);
  std::vector<double> shares(cells, 0.0);
  for (std::size_t begin = 0; begin < parts_.size();) {
    const std::size_t cell = parts_[begin].cell;
    std::size_t end = begin;
    for (; end < parts_.size() && parts_[end].cell == cell; ++end) {
      shares[cell] += parts_[end].cell_share;
    }
    constexpr double kMostShare = 1.001;
    result.overlaps = result.overlaps || shares[cell] > kMostShare;
    result.cells[cell] = static_cast<std::uint32_t>(result.texels.size());
    result.texels.push_back(texel_of(parts_.data() + begin, parts_.data() + end));
    begin = end;
  }
  join_small_pieces(shares, result);
  return result;
}

}  // namespace

ChartTexels cut_chart(const WorldTriangles& world, const ray_tracing::RayScene& rays,
                      const Chart& chart, const ChartPlace& place) {
  return ChartCutter(world, rays, chart, place).cut();
}

}  // namespace renderers::texel_atlas
