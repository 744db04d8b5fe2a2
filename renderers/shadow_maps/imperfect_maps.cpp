#include "renderers/shadow_maps/imperfect_maps.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <span>
#include <string>
#include <utility>

#include <fmt/core.h>

#include "renderers/opengl/gpu_stage.h"
#include "renderers/opengl/program.h"
#include "renderers/shadow_maps/shader_files.h"

namespace renderers::shadow_maps {

namespace {

constexpr int kLocalSize = 64;
constexpr int kTileSize_px = 8;
constexpr std::uint32_t kOriginBinding = 3;
constexpr std::uint32_t kPointBinding = 4;

opengl::ProgramSource source_of(const std::string& pass) {
  return {shader_files(), {"renderers/shadow_maps/shaders/" + pass + ".comp.glsl"}};
}

}  // namespace

ImperfectMaps::ImperfectMaps(std::shared_ptr<opengl::Context> context,
                             const ImperfectMapSettings& settings)
    : context_(std::move(context)), settings_(settings) {}

void ImperfectMaps::require_room() const {
  const std::int64_t limit_bytes = context_->limits().storage_block_bytes;
  const std::int64_t set_bytes = static_cast<std::int64_t>(settings_.point_sets) *
                                 static_cast<std::int64_t>(sizeof(ScenePoint));
  if (settings_.points_per_map * set_bytes <= limit_bytes) return;
  throw UnsupportedError(fmt::format("imperfect shadow maps: {} points per map; {} has room for {}",
                                     settings_.points_per_map, context_->facts().renderer,
                                     limit_bytes / set_bytes));
}

void ImperfectMaps::load(const scene::Scene& scene, StageTimer& timer) {
  require_room();
  std::vector<ScenePoint> points;
  {
    const auto stage = timer.stage("points");
    points = points_of(scene);
    near_m_ = settings_.near_share * bounding_box(scene).diagonal_m();
  }
  opengl::GpuStage stage(*context_, timer, "upload");
  has_points_ = !points.empty();
  if (!has_points_) return;
  const std::span<const ScenePoint> all(points);
  points_.reserve(context_, all.size_bytes());
  points_.write(all);
  stage.add_bytes(0, static_cast<std::int64_t>(all.size_bytes()));
}

std::vector<ScenePoint> ImperfectMaps::points_of(const scene::Scene& scene) {
  left_behind_ = 0;
  if (!settings_.keeps_points) {
    return scene_points(scene, settings_.point_sets, settings_.points_per_map);
  }
  if (dealt_) {
    left_behind_ = dealt_->move(scene);
  } else {
    dealt_.emplace(scene, settings_.point_sets, settings_.points_per_map);
  }
  return dealt_->points();
}

void ImperfectMaps::fill(HemisphereMaps& maps, const MapOrigins& origins, int first, int count) {
  assert(count <= maps.layers());
  maps.clear();
  maps.set_near_m(near_m_);
  if (!has_points_ || count == 0) return;
  opengl::Program& splat = context_->program(source_of("splat_points"));
  splat.storage(kOriginBinding, *origins.buffer);
  splat.storage(kPointBinding, points_);
  splat.image(0, maps.distances(), opengl::Access::read_write);
  splat.set("size_px", maps.size_px());
  splat.set("origin_stride", origins.stride);
  splat.set("first_origin", first);
  splat.set("layer_count", count);
  splat.set("near_m", near_m_);
  splat.set("point_sets", settings_.point_sets);
  splat.set("points_per_map", settings_.points_per_map);
  splat.set("max_splat_px", static_cast<float>(settings_.max_splat_px));
  splat.set("splat_scale", settings_.splat_scale);
  splat.set("is_disc", settings_.splat_shape == SplatShape::disc ? 1 : 0);
  splat.dispatch(opengl::groups_for(settings_.points_per_map, kLocalSize),
                 static_cast<std::uint32_t>(count));
  fill_holes(maps, count);
  context_->check("drawing imperfect shadow maps");
}

void ImperfectMaps::fill_holes(HemisphereMaps& maps, int count) {
  // The coarsest level still has two texels.
  const int halvings = std::bit_width(static_cast<unsigned>(maps.size_px())) - 2;
  const int levels = std::min(settings_.pull_push_levels, halvings);
  if (levels <= 0) return;
  coarse_.reshape(context_, {.format = opengl::TextureFormat::r32ui,
                             .width_px = maps.size_px() / 2,
                             .height_px = maps.size_px() / 2,
                             .layers = maps.layers(),
                             .levels = levels});
  const auto run = [&](const char* pass, int level, int width_px) {
    opengl::Program& program = context_->program(source_of(pass));
    program.image(0, level == 0 ? maps.distances() : coarse_, opengl::Access::read_write,
                  std::max(level - 1, 0));
    program.image(1, coarse_, opengl::Access::read_write, level);
    const std::uint32_t tiles = opengl::groups_for(width_px, kTileSize_px);
    program.dispatch(tiles, tiles, static_cast<std::uint32_t>(count));
  };
  for (int level = 0; level < levels; ++level) {
    run("pull_distances", level, maps.size_px() >> (level + 1));
  }
  for (int level = levels - 1; level >= 0; --level) {
    run("push_distances", level, maps.size_px() >> level);
  }
}

std::int64_t ImperfectMaps::memory_bytes() const {
  const std::int64_t coarse_bytes = coarse_.is_empty() ? 0 : size_bytes_of(coarse_.shape());
  return static_cast<std::int64_t>(points_.size_bytes()) + coarse_bytes;
}

}  // namespace renderers::shadow_maps
