#include "renderers/shadow_maps/vertex_maps.h"

#include <algorithm>
#include <cassert>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include <fmt/core.h>

#include "renderers/opengl/gpu_stage.h"
#include "renderers/opengl/program.h"
#include "renderers/shadow_maps/shader_files.h"
#include "renderers/shadow_maps/tessellation.h"

namespace renderers::shadow_maps {

namespace {

constexpr std::uint32_t kOriginBinding = 3;
constexpr std::uint32_t kVertexBinding = 4;
constexpr int kTileSize_px = 8;

const std::string kPass = "renderers/shadow_maps/shaders/vertex_map";

opengl::ProgramSource draw_source(LayerChoice choice) {
  opengl::ProgramSource source{shader_files(), {kPass + ".vert.glsl"}};
  if (choice == LayerChoice::vs_layer) source.defines.emplace_back("VERTEX_LAYER", "1");
  if (choice == LayerChoice::gs_layer) {
    source.defines.emplace_back("GEOMETRY_LAYER", "1");
    source.stages.push_back(kPass + ".geom.glsl");
  }
  source.stages.push_back(kPass + ".frag.glsl");
  return source;
}

void set_origins(opengl::Program& program, const MapOrigins& origins, int first, int count) {
  program.storage(kOriginBinding, *origins.buffer);
  program.set("origin_stride", origins.stride);
  program.set("first_origin", first);
  program.set("layer_count", count);
}

void set_depth(opengl::Program& program, const opengl::GpuScene& scene, float near_m) {
  program.set("near_m", near_m);
  program.set("bounds_least", scene.bounds().least);
  program.set("bounds_greatest", scene.bounds().greatest);
}

}  // namespace

VertexMaps::VertexMaps(std::shared_ptr<opengl::Context> context, const VertexMapSettings& settings)
    : context_(std::move(context)), settings_(settings) {
  const bool has_vertex_layers = context_->limits().has_vertex_layers;
  if (settings_.layer_choice == LayerChoice::automatic) {
    settings_.layer_choice = has_vertex_layers ? LayerChoice::vs_layer : LayerChoice::gs_layer;
  }
  if (settings_.layer_choice == LayerChoice::vs_layer && !has_vertex_layers) {
    throw UnsupportedError(
        fmt::format("shadow maps whose vertex shader chooses the layer: {} has no "
                    "ARB_shader_viewport_layer_array; gs_layer and per_layer do the same",
                    context_->facts().renderer));
  }
}

void VertexMaps::load(const scene::Scene& scene, StageTimer& timer) {
  const auto most =
      static_cast<std::size_t>(context_->limits().storage_block_bytes) / sizeof(glm::uvec3);
  std::optional<TriangleList> pieces;
  {
    const auto stage = timer.stage("tessellation");
    const float longest_m = settings_.edge_share * bounding_box(scene).diagonal_m();
    pieces = tessellated(scene, longest_m, most);
  }
  if (!pieces) {
    throw UnsupportedError(fmt::format(
        "shadow maps of triangles cut to {} of the scene's diagonal: {} has room for {} pieces",
        settings_.edge_share, context_->facts().renderer, most));
  }
  opengl::GpuStage stage(*context_, timer, "upload");
  piece_count_ = static_cast<int>(pieces->triangles.size());
  if (piece_count_ == 0) return;
  const std::span<const glm::vec3> vertices(pieces->vertices);
  const std::span<const glm::uvec3> triangles(pieces->triangles);
  vertices_.reserve(context_, vertices.size_bytes());
  vertices_.write(vertices);
  triangles_.reserve(context_, triangles.size_bytes());
  triangles_.write(triangles);
  stage.add_bytes(0, static_cast<std::int64_t>(vertices.size_bytes() + triangles.size_bytes()));
}

void VertexMaps::reserve(const HemisphereMaps& maps) {
  const opengl::TextureShape shape{.format = opengl::TextureFormat::depth32f,
                                   .width_px = maps.size_px(),
                                   .height_px = maps.size_px(),
                                   .layers = maps.layers()};
  if (!depth_.is_empty() && depth_.shape() == shape) return;
  targets_.clear();
  depth_.reshape(context_, shape);
  if (settings_.layer_choice != LayerChoice::per_layer) {
    targets_.emplace_back(context_, nullptr, &depth_);
    return;
  }
  for (int layer = 0; layer < maps.layers(); ++layer) {
    targets_.emplace_back(context_, depth_, layer);
  }
}

int VertexMaps::draw_count(int maps) const {
  return settings_.layer_choice == LayerChoice::per_layer ? maps : std::min(maps, 1);
}

void VertexMaps::draw(opengl::Program& program, int count) {
  const bool is_per_layer = settings_.layer_choice == LayerChoice::per_layer;
  const int draws = draw_count(count);
  for (int i = 0; i < draws; ++i) {
    const opengl::RasterPass pass(targets_[static_cast<std::size_t>(i)], opengl::DepthTest::nearer,
                                  1);
    program.set("first_layer", i);
    program.draw_indexed_triangles(triangles_, 3 * piece_count_, is_per_layer ? 1 : count);
  }
}

void VertexMaps::fill(HemisphereMaps& maps, const opengl::GpuScene& scene,
                      const MapOrigins& origins, int first, int count) {
  assert(count <= maps.layers());
  maps.clear();
  maps.set_near_m(settings_.near_share * scene.bounds().diagonal_m());
  if (piece_count_ == 0 || count == 0) return;
  reserve(maps);
  depth_.clear({0.0F, 0.0F, 0.0F, 0.0F});

  opengl::Program& drawing = context_->program(draw_source(settings_.layer_choice));
  drawing.storage(kVertexBinding, vertices_);
  set_origins(drawing, origins, first, count);
  set_depth(drawing, scene, maps.near_m());
  draw(drawing, count);

  opengl::Program& resolve = context_->program({shader_files(), {kPass + "_resolve.comp.glsl"}});
  resolve.sampler(0, depth_);
  resolve.image(0, maps.distances(), opengl::Access::write);
  set_origins(resolve, origins, first, count);
  set_depth(resolve, scene, maps.near_m());
  const std::uint32_t tiles = opengl::groups_for(maps.size_px(), kTileSize_px);
  resolve.dispatch(tiles, tiles, static_cast<std::uint32_t>(count));
  context_->check("drawing shadow maps by their vertices");
}

std::int64_t VertexMaps::memory_bytes() const {
  const std::int64_t depth_bytes = depth_.is_empty() ? 0 : size_bytes_of(depth_.shape());
  return static_cast<std::int64_t>(vertices_.size_bytes() + triangles_.size_bytes()) + depth_bytes;
}

}  // namespace renderers::shadow_maps
