#include "renderers/area_shadows/grid_shadows.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include "perception/base/parallel.h"
#include "renderers/area_shadows/screen_shadows_renderer.h"
#include "renderers/area_shadows/shadow_tracer.h"

namespace renderers::area_shadows {

namespace {

constexpr std::size_t kNodeGrain = 16;
constexpr std::size_t kRowGrain = 4;

struct GridSettings {
  int spacing_px = 4;
  bool upsamples_visibility = true;
};

/// The grid's nodes: every `spacing_px`-th pixel each way, and the last.
class Grid {
 public:
  Grid(int side_px, int spacing_px) : spacing_px_(spacing_px) {
    for (int at = 0; at < side_px; at += spacing_px) nodes_.push_back(at);
    if (nodes_.back() != side_px - 1) nodes_.push_back(side_px - 1);
  }
  const std::vector<int>& nodes() const { return nodes_; }
  /// The node at or before a pixel, and the share of the next one.
  struct Cell {
    std::size_t first = 0;
    std::size_t second = 0;
    float share = 0.0F;
  };
  Cell cell_of(int at_px) const {
    Cell cell;
    cell.first = std::min(static_cast<std::size_t>(at_px / spacing_px_), nodes_.size() - 1);
    if (at_px == nodes_.back()) cell.first = nodes_.size() - 1;
    cell.second = std::min(cell.first + 1, nodes_.size() - 1);
    const int width = nodes_[cell.second] - nodes_[cell.first];
    if (width > 0) {
      cell.share = static_cast<float>(at_px - nodes_[cell.first]) / static_cast<float>(width);
    }
    return cell;
  }

 private:
  int spacing_px_;
  std::vector<int> nodes_;
};

class GridShadows {
 public:
  GridShadows(const ShadowJob& job, const GridSettings& settings, StageTimer& timer)
      : job_(job),
        settings_(settings),
        tracer_(job.visibility, job.surfaces, job.lights, timer),
        columns_(job.surfaces.width_px, settings.spacing_px),
        rows_(job.surfaces.height_px, settings.spacing_px),
        nodes_(columns_.nodes().size() * rows_.nodes().size()) {}

  /// Lights the nodes. @return rays
  std::uint64_t light_nodes();
  /// Interpolates the pixels between, or lights those that no node around them can tell about.
  struct Filled {
    std::uint64_t pixels = 0;  ///< lit themselves
    std::uint64_t rays = 0;
  };
  Filled fill(std::vector<glm::vec3>& irradiance);
  std::size_t node_count() const { return nodes_.size(); }

 private:
  std::size_t node_pixel(std::size_t node) const {
    const std::size_t columns = columns_.nodes().size();
    return job_.surfaces.index(columns_.nodes()[node % columns], rows_.nodes()[node / columns]);
  }
  bool interpolate(int x, int y, glm::vec3& value) const;

  const ShadowJob& job_;
  const GridSettings& settings_;
  ShadowTracer tracer_;
  Grid columns_;
  Grid rows_;
  std::vector<PixelLight> nodes_;
};

std::uint64_t GridShadows::light_nodes() {
  std::vector<std::uint32_t> pixels;
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    const std::size_t pixel = node_pixel(i);
    if (job_.surfaces.pixels[pixel].is_surface()) {
      pixels.push_back(static_cast<std::uint32_t>(pixel));
    }
  }
  const std::uint64_t rays = tracer_.trace_pixels(pixels);
  base::parallel_for(nodes_.size(), kNodeGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const std::size_t pixel = node_pixel(i);
      if (job_.surfaces.pixels[pixel].is_surface()) nodes_[i] = tracer_.light_of(pixel);
    }
  });
  return rays;
}

/// Bilinear among the four nodes around, as far as they are on the pixel's surface.
/// @return false if none is
bool GridShadows::interpolate(int x, int y, glm::vec3& value) const {
  const Grid::Cell column = columns_.cell_of(x);
  const Grid::Cell row = rows_.cell_of(y);
  const PixelSurface& surface = job_.surfaces.at(x, y);
  glm::vec3 sum(0.0F);
  float weights = 0.0F;
  for (int corner = 0; corner < 4; ++corner) {
    const bool is_right = corner % 2 == 1;
    const bool is_below = corner / 2 == 1;
    const std::size_t i = is_right ? column.second : column.first;
    const std::size_t j = is_below ? row.second : row.first;
    const float weight =
        (is_right ? column.share : 1.0F - column.share) * (is_below ? row.share : 1.0F - row.share);
    const PixelSurface& other = job_.surfaces.at(columns_.nodes()[i], rows_.nodes()[j]);
    if (weight <= 0.0F || !is_same_surface(surface, other, {})) continue;
    const PixelLight& node = nodes_[j * columns_.nodes().size() + i];
    glm::vec3 node_value = node.irradiance;
    if (settings_.upsamples_visibility) {
      for (int c = 0; c < 3; ++c) {
        node_value[c] = node.open[c] > 0.0F ? node.irradiance[c] / node.open[c] : 0.0F;
      }
    }
    sum += weight * node_value;
    weights += weight;
  }
  if (weights <= 0.0F) return false;
  value = sum / weights;
  if (settings_.upsamples_visibility && value != glm::vec3(0.0F)) {
    value *= open_irradiance(job_.lights, surface.receiver);
  }
  return true;
}

GridShadows::Filled GridShadows::fill(std::vector<glm::vec3>& irradiance) {
  std::vector<std::uint8_t> is_missing(irradiance.size(), 0);
  const auto rows = static_cast<std::size_t>(job_.surfaces.height_px);
  base::parallel_for(rows, kRowGrain, [&](std::size_t begin, std::size_t end) {
    for (auto y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
      for (int x = 0; x < job_.surfaces.width_px; ++x) {
        const std::size_t pixel = job_.surfaces.index(x, y);
        if (!job_.surfaces.pixels[pixel].is_surface()) continue;
        is_missing[pixel] = interpolate(x, y, irradiance[pixel]) ? 0 : 1;
      }
    }
  });
  std::vector<std::uint32_t> missing;
  for (std::size_t pixel = 0; pixel < is_missing.size(); ++pixel) {
    if (is_missing[pixel] != 0) missing.push_back(static_cast<std::uint32_t>(pixel));
  }
  const std::uint64_t rays = tracer_.trace_pixels(missing);
  base::parallel_for(missing.size(), kNodeGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      irradiance[missing[i]] = tracer_.light_of(missing[i]).irradiance;
    }
  });
  return {missing.size(), rays};
}

ShadowResult solve(const ShadowJob& job, const GridSettings& settings, StageTimer& timer) {
  ShadowResult result;
  result.irradiance.resize(job.surfaces.pixels.size());
  std::optional<GridShadows> grid;
  std::uint64_t node_rays = 0;
  {
    const auto stage = timer.stage("gather");
    const auto inner = timer.stage("irradiance");
    grid.emplace(job, settings, timer);
    node_rays = grid->light_nodes();
  }
  const auto stage = timer.stage("upsample");
  const GridShadows::Filled filled = grid->fill(result.irradiance);
  const auto number = [](auto value) { return static_cast<double>(value); };
  result.rays = number(node_rays + filled.rays);
  result.counters = {{"fragments", number(grid->node_count() + filled.pixels)},
                     {"grid_nodes", number(grid->node_count())},
                     {"filled_pixels", number(filled.pixels)}};
  return result;
}

std::unique_ptr<Renderer> create(const base::Parameters& parameters, const Devices& devices) {
  const std::int64_t points = parameters.integer("light_points");
  check_power_of_two("grid-shadows", "light_points", points);
  const GridSettings settings{static_cast<int>(parameters.integer("spacing")),
                              parameters.text("upsampled") == "visibility"};
  return make_screen_shadows_renderer(
      {static_cast<int>(points), ray_tracing::kGroupPoints, backend_of(parameters)},
      [settings](const ShadowJob& job, StageTimer& timer) { return solve(job, settings, timer); },
      devices);
}

}  // namespace

RendererInfo grid_shadows_info() {
  RendererInfo info = screen_shadows_info();
  info.name = "grid-shadows";
  info.summary =
      "Direct light of area lights at every n-th pixel each way, interpolated along surfaces.";
  info.source = "ours, after Kopf et al. 2007, doi:10.1145/1276377.1276497";
  info.parameters = {
      backend_parameter(),
      base::integer_parameter("spacing", 4, {1.0, 256.0}, "pixels",
                              "Between nodes; ours: fragments of level 2."),
      base::integer_parameter("light_points", 64, {4.0, 256.0}, "points",
                              "Points of each light, a power of two; as the others."),
      base::choice_parameter("upsampled", {"visibility", "irradiance"}, "visibility",
                             "irradiance, or its share of the unoccluded one, which each pixel "
                             "finds for itself; ours.")};
  info.presets = {{"paper", {{"upsampled", base::ParameterValue(std::string("irradiance"))}}},
                  {"best", {}}};
  info.create = create;
  return info;
}

}  // namespace renderers::area_shadows
