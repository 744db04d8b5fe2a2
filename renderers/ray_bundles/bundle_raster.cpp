#include "renderers/ray_bundles/bundle_raster.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <glm/geometric.hpp>

#include "perception/base/parallel.h"

namespace renderers::ray_bundles {

namespace {

constexpr std::size_t kChunkTriangles = 2048;

/// Fixed point: 14 bits of pixels and 16 below; products of two differences fit 64 bits.
constexpr int kSubpixelBits = 16;
constexpr std::int64_t kSubpixels = std::int64_t{1} << kSubpixelBits;

using FixedPoint = glm::vec<2, std::int64_t>;

struct Corner {
  FixedPoint at{0};
  glm::dvec2 place_px{0.0};
};

/// First pixel whose centre is not before a coordinate.
int first_pixel(std::int64_t at) {
  return static_cast<int>((at + kSubpixels / 2 - 1) >> kSubpixelBits);
}

/// e(x, y) = a x + b y + c over pixels, >= 0 inside the triangle and on the edges that are its own.
struct Edge {
  std::int64_t per_x = 0;
  std::int64_t per_y = 0;
  std::int64_t at_origin = 0;

  /// Left side of p -> q, counter-clockwise triangles; of the pixels' centres.
  Edge(const FixedPoint& p, const FixedPoint& q) {
    const std::int64_t a = p.y - q.y;
    const std::int64_t b = q.x - p.x;
    per_x = a * kSubpixels;
    per_y = b * kSubpixels;
    const std::int64_t half = kSubpixels / 2;
    at_origin = a * (half - p.x) + b * (half - p.y);
    // Of two triangles with this edge, one runs through it upwards, or along +x if it is level.
    const bool is_own = a > 0 || (a == 0 && b > 0);
    if (!is_own) at_origin -= 1;
  }

  /// Narrows [begin, end) of a row to the pixels inside.
  void narrow(int row, int& begin, int& end) const {
    const std::int64_t at_row = at_origin + per_y * row;
    if (per_x == 0) {
      if (at_row < 0) end = begin;
      return;
    }
    // The quotient in floating point, put right in integers.
    const double root = -static_cast<double>(at_row) / static_cast<double>(per_x);
    const double bounded = std::clamp(root, static_cast<double>(begin), static_cast<double>(end));
    int x = static_cast<int>(bounded);
    const auto inside = [&](int at) { return at_row + per_x * at >= 0; };
    if (per_x > 0) {
      while (x < end && !inside(x)) ++x;
      while (x > begin && inside(x - 1)) --x;
      begin = x;
    } else {
      while (x < end && inside(x)) ++x;
      while (x > begin && !inside(x - 1)) --x;
      end = x;
    }
  }
};

}  // namespace

/// The frame in double precision, axes in units of pixels.
struct BundleRaster::Projection {
  explicit Projection(const BundleFrame& frame)
      : axis_x(glm::dvec3(frame.axis_x) / static_cast<double>(frame.pixel_m)),
        axis_y(glm::dvec3(frame.axis_y) / static_cast<double>(frame.pixel_m)),
        direction(frame.direction),
        origin_px(glm::dot(glm::dvec3(frame.corner), axis_x),
                  glm::dot(glm::dvec3(frame.corner), axis_y)),
        origin_m(glm::dot(glm::dvec3(frame.corner), direction)),
        width_px(frame.width_px),
        height_px(frame.height_px) {}

  Corner place(const glm::vec3& point) const {
    const glm::dvec3 p(point);
    Corner corner;
    corner.place_px = glm::dvec2(glm::dot(p, axis_x), glm::dot(p, axis_y)) - origin_px;
    // Any rounding serves that is the same for the same point.
    corner.at = FixedPoint(corner.place_px * static_cast<double>(kSubpixels) + 0.5);
    return corner;
  }
  double depth_m(const glm::vec3& point) const {
    return glm::dot(glm::dvec3(point), direction) - origin_m;
  }

  glm::dvec3 axis_x;
  glm::dvec3 axis_y;
  glm::dvec3 direction;
  glm::dvec2 origin_px;
  double origin_m;
  int width_px;
  int height_px;
};

BundleRaster::BundleRaster(const texel_atlas::WorldTriangles& world,
                           const texel_atlas::TexelAtlas& atlas)
    : atlas_(atlas) {
  sources_.reserve(world.triangles.size());
  for (const texel_atlas::WorldTriangle& triangle : world.triangles) {
    const texel_atlas::TriangleMap& map = atlas.map_of(triangle.object, triangle.triangle);
    if (map.chart == texel_atlas::kNoTexel) continue;
    const auto& corners = triangle.corners;
    sources_.push_back(
        {{glm::vec3(corners[0]), glm::vec3(corners[1]), glm::vec3(corners[2])}, map});
  }
  chunks_.resize((sources_.size() + kChunkTriangles - 1) / kChunkTriangles);
}

void BundleRaster::fill(const BundleFrame& frame, BundleLists& lists) {
  lists.reset(frame);
  const std::size_t bands = lists.band_count();
  draw_all(frame, bands);
  base::parallel_for(bands, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t band = begin; band < end; ++band) fill_band(frame, band, lists.band(band));
  });
}

void BundleRaster::draw_all(const BundleFrame& frame, std::size_t band_count) {
  base::parallel_for(chunks_.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t chunk = begin; chunk < end; ++chunk) draw(frame, band_count, chunk);
  });
}

void BundleRaster::draw(const BundleFrame& frame, std::size_t band_count, std::size_t index) {
  Chunk& chunk = chunks_[index];
  chunk.planes.clear();
  if (chunk.bands.size() < band_count) chunk.bands.resize(band_count);
  for (std::vector<Span>& band : chunk.bands) band.clear();
  const std::size_t first = index * kChunkTriangles;
  const std::size_t end = std::min(sources_.size(), first + kChunkTriangles);
  const Projection projection(frame);
  for (std::size_t i = first; i < end; ++i) draw_triangle(projection, sources_[i], chunk);
}

void BundleRaster::draw_triangle(const Projection& projection, const Source& source,
                                 Chunk& chunk) const {
  const std::array<Corner, 3> c{projection.place(source.corners[0]),
                                projection.place(source.corners[1]),
                                projection.place(source.corners[2])};
  const FixedPoint least = glm::min(c[0].at, glm::min(c[1].at, c[2].at));
  const FixedPoint greatest = glm::max(c[0].at, glm::max(c[1].at, c[2].at));
  const int x_begin = std::max(0, first_pixel(least.x));
  const int x_end = std::min(projection.width_px, first_pixel(greatest.x + 1));
  const int y_begin = std::max(0, first_pixel(least.y));
  const int y_end = std::min(projection.height_px, first_pixel(greatest.y + 1));
  if (x_begin >= x_end || y_begin >= y_end) return;
  const FixedPoint u = c[1].at - c[0].at;
  const FixedPoint v = c[2].at - c[0].at;
  const std::int64_t twice_area = u.x * v.y - u.y * v.x;
  if (twice_area == 0) return;

  // The front looks back along the direction if its corners run clockwise here: x, y and the
  // direction are right-handed, and we look along the latter.
  const bool is_counter_clockwise = twice_area > 0;
  const std::array<std::size_t, 3> order = is_counter_clockwise
                                               ? std::array<std::size_t, 3>{0, 1, 2}
                                               : std::array<std::size_t, 3>{0, 2, 1};
  const std::array<Edge, 3> edges{Edge(c[order[0]].at, c[order[1]].at),
                                  Edge(c[order[1]].at, c[order[2]].at),
                                  Edge(c[order[2]].at, c[order[0]].at)};
  const auto plane_index = static_cast<std::uint32_t>(chunk.planes.size());
  bool is_seen = false;
  for (int row = y_begin; row < y_end; ++row) {
    int begin = x_begin;
    int end = x_end;
    for (const Edge& edge : edges) edge.narrow(row, begin, end);
    if (begin >= end) continue;
    is_seen = true;
    chunk.bands[static_cast<std::size_t>(row / BundleLists::kBandRows)].push_back(
        {plane_index, row, begin, end});
  }
  if (!is_seen) return;

  chunk.planes.push_back(
      plane_of(projection, source, {c[0].place_px, c[1].place_px, c[2].place_px}));
  chunk.planes.back().near_is_back = is_counter_clockwise ? 1U : 0U;
}

BundleRaster::Plane BundleRaster::plane_of(const Projection& projection, const Source& source,
                                           const std::array<glm::dvec2, 3>& places_px) {
  // Weights of the second and third corner per pixel.
  const glm::dvec2 u = places_px[1] - places_px[0];
  const glm::dvec2 v = places_px[2] - places_px[0];
  const double area = u.x * v.y - u.y * v.x;
  // Rounding to the raster may have given a line an area: its first corner stands for it.
  const double scale = area != 0.0 ? 1.0 / area : 0.0;
  const glm::dvec2 second = scale * glm::dvec2(v.y, -v.x);
  const glm::dvec2 third = scale * glm::dvec2(-u.y, u.x);
  const std::array<double, 3> depth_m{projection.depth_m(source.corners[0]),
                                      projection.depth_m(source.corners[1]),
                                      projection.depth_m(source.corners[2])};
  Plane plane;
  plane.corner_px = glm::vec2(places_px[0]);
  plane.depth_m = static_cast<float>(depth_m[0]);
  plane.depth_slope =
      glm::vec2((depth_m[1] - depth_m[0]) * second + (depth_m[2] - depth_m[0]) * third);
  plane.least_depth_m = static_cast<float>(*std::min_element(depth_m.begin(), depth_m.end()));
  plane.greatest_depth_m = static_cast<float>(*std::max_element(depth_m.begin(), depth_m.end()));
  plane.place = source.map.corner;
  const glm::dvec2 along_u(source.map.along_u);
  const glm::dvec2 along_v(source.map.along_v);
  plane.place_dx = glm::vec2(second.x * along_u + third.x * along_v);
  plane.place_dy = glm::vec2(second.y * along_u + third.y * along_v);
  plane.chart = source.map.chart;
  return plane;
}

void BundleRaster::fill_band(const BundleFrame& frame, std::size_t index,
                             BundleLists::Band& band) const {
  const int first_row = static_cast<int>(index) * BundleLists::kBandRows;
  const int rows = std::min(BundleLists::kBandRows, frame.height_px - first_row);
  const auto width = static_cast<std::size_t>(frame.width_px);
  const std::size_t lines = static_cast<std::size_t>(rows) * width;
  thread_local std::vector<std::uint32_t> next;
  const auto line_of = [&](const Span& span) {
    return static_cast<std::size_t>(span.row - first_row) * width;
  };

  // Count, then the places where lists begin, then fill.
  next.assign(lines + 1, 0);
  for (const Chunk& chunk : chunks_) {
    for (const Span& span : chunk.bands[index]) {
      std::uint32_t* counts = next.data() + line_of(span);
      for (int x = span.begin; x < span.end; ++x) ++counts[x];
    }
  }
  std::uint32_t total = 0;
  for (std::uint32_t& count : next) total += std::exchange(count, total);
  band.nodes.resize(total);
  for (const Chunk& chunk : chunks_) {
    for (const Span& span : chunk.bands[index]) {
      std::uint32_t* places = next.data() + line_of(span);
      for (int x = span.begin; x < span.end; ++x) {
        band.nodes[places[x]++] = node_of(span, chunk.planes[span.plane], x);
      }
    }
  }
  next.pop_back();
  order_lines(frame, next, band);
}

/// Each list in order; what a duplicate leaves free is closed up.
/// @param ends  where each line's nodes end in the band
void BundleRaster::order_lines(const BundleFrame& frame, const std::vector<std::uint32_t>& ends,
                               BundleLists::Band& band) const {
  const float tie_m = tie_distance_m(frame);
  std::size_t begin = 0;
  std::size_t kept = 0;
  for (const std::size_t end : ends) {
    const std::size_t count =
        order_nodes({band.nodes.data() + begin, end - begin}, tie_m, atlas_.texels());
    if (kept != begin) {
      std::copy_n(band.nodes.begin() + static_cast<std::ptrdiff_t>(begin), count,
                  band.nodes.begin() + static_cast<std::ptrdiff_t>(kept));
    }
    kept += count;
    begin = end;
    band.ends.push_back(static_cast<std::uint32_t>(kept));
  }
  band.nodes.resize(kept);
}

ListNode BundleRaster::node_of(const Span& span, const Plane& plane, int column) const {
  const glm::vec2 at =
      glm::vec2(static_cast<float>(column), static_cast<float>(span.row)) + 0.5F - plane.corner_px;
  const glm::vec2 place = plane.place + at.y * plane.place_dy + at.x * plane.place_dx;
  const float depth_m =
      std::clamp(plane.depth_m + at.y * plane.depth_slope.y + at.x * plane.depth_slope.x,
                 plane.least_depth_m, plane.greatest_depth_m);
  return {depth_m, 2 * atlas_.texel_at_position(plane.chart, place) + plane.near_is_back};
}

}  // namespace renderers::ray_bundles
