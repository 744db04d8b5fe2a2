#include "renderers/shadow_maps/hemicube_maps.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <string>
#include <utility>

#include <fmt/core.h>

#include "renderers/opengl/program.h"
#include "renderers/shadow_maps/shader_files.h"

namespace renderers::shadow_maps {

namespace {

constexpr std::uint32_t kOriginBinding = 3;
constexpr std::uint32_t kSphereBinding = 4;
constexpr std::uint32_t kListBinding = 5;
constexpr std::uint32_t kDrawBinding = 6;
constexpr int kFaces = 5;
constexpr int kTileSize_px = 8;
constexpr std::uint32_t kNoTriangle = 0xffffffffU;
/// Distance of the near plane over the scene's diagonal: what is nearer to the centre is not seen.
constexpr float kNearest = 1e-6F;

/// A layer's faces in the atlas, in half faces; shaders/hemicube.glsl knows the same.
constexpr glm::ivec2 kBlock(4, 3);
constexpr std::array<glm::ivec2, kFaces> kCorners{
    {glm::ivec2(0, 0), glm::ivec2(2, 0), glm::ivec2(2, 1), glm::ivec2(0, 2), glm::ivec2(2, 2)}};

opengl::ProgramSource source_of(std::initializer_list<const char*> passes) {
  opengl::ProgramSource source{shader_files(), {}};
  for (const char* pass : passes) {
    source.stages.push_back("renderers/shadow_maps/shaders/" + std::string(pass) + ".glsl");
  }
  return source;
}

}  // namespace

HemicubeMaps::HemicubeMaps(std::shared_ptr<opengl::Context> context,
                           const HemicubeMapSettings& settings)
    : context_(std::move(context)), settings_(settings) {}

void HemicubeMaps::reserve(const HemisphereMaps& maps, const opengl::GpuScene& scene) {
  const opengl::Limits& limits = context_->limits();
  const auto width = static_cast<double>(settings_.face_scale) * maps.size_px();
  face_px_ = 2 * std::max(1, static_cast<int>(std::lround(0.5 * width)));
  const glm::ivec2 block_px = kBlock * (face_px_ / 2);
  if (block_px.x > limits.texture_size_px) {
    throw UnsupportedError(fmt::format("hemicubes of {0} x {0} px: {1} allows {2} px", face_px_,
                                       context_->facts().renderer, limits.texture_size_px / 2));
  }
  const std::int64_t list_bytes =
      std::int64_t{kFaces} * scene.triangle_count() * std::int64_t{sizeof(std::uint32_t)};
  const std::int64_t most_columns = limits.texture_size_px / block_px.x;
  const std::int64_t most =
      std::min({std::int64_t{settings_.layers_at_once}, std::int64_t{maps.layers()},
                limits.storage_block_bytes / list_bytes,
                most_columns * (limits.texture_size_px / block_px.y)});
  layers_at_once_ = static_cast<int>(std::max<std::int64_t>(1, most));
  columns_ = static_cast<int>(std::min<std::int64_t>(layers_at_once_, most_columns));

  lists_.reserve(context_, static_cast<std::size_t>(layers_at_once_ * list_bytes));
  draws_.reserve(context_,
                 static_cast<std::size_t>(layers_at_once_ * kFaces) * sizeof(opengl::DrawCommand));
  opengl::TextureShape shape{.format = opengl::TextureFormat::r32ui,
                             .width_px = columns_ * block_px.x,
                             .height_px = (layers_at_once_ + columns_ - 1) / columns_ * block_px.y};
  if (!atlas_.is_empty() && atlas_.shape() == shape) return;
  target_ = opengl::Framebuffer();
  atlas_.reshape(context_, shape);
  shape.format = opengl::TextureFormat::depth32f;
  depth_.reshape(context_, shape);
  target_ = opengl::Framebuffer(context_, &atlas_, &depth_);
}

void HemicubeMaps::fill(HemisphereMaps& maps, const opengl::GpuScene& scene,
                        const MapOrigins& origins, int first, int count) {
  assert(count <= maps.layers());
  maps.clear();
  maps.set_near_m(settings_.near_share * scene.bounds().diagonal_m());
  if (scene.triangle_count() == 0 || count == 0) return;
  reserve(maps, scene);
  spheres_.load(scene);
  for (int layer = 0; layer < count; layer += layers_at_once_) {
    const Batch batch{.scene = scene,
                      .origins = origins,
                      .near_m = maps.near_m(),
                      .first_origin = first + layer,
                      .first_layer = layer,
                      .layers = std::min(layers_at_once_, count - layer)};
    list_triangles(batch);
    draw_faces(batch);
    resample(maps, batch);
  }
  context_->check("drawing hemicube shadow maps");
}

opengl::Program& HemicubeMaps::bound_program(std::initializer_list<const char*> passes,
                                             const Batch& batch) {
  opengl::Program& program = context_->program(source_of(passes));
  program.storage(0, batch.scene.triangles());
  program.storage(kOriginBinding, *batch.origins.buffer);
  program.set("origin_stride", batch.origins.stride);
  program.set("first_origin", batch.first_origin);
  program.set("layer_count", batch.layers);
  program.set("near_m", batch.near_m);
  program.set("face_px", face_px_);
  program.set("atlas_columns", columns_);
  return program;
}

void HemicubeMaps::list_triangles(const Batch& batch) {
  opengl::Program& program = bound_program({"hemicube_lists.comp"}, batch);
  program.storage(kSphereBinding, spheres_.spheres());
  program.storage(kListBinding, lists_);
  program.storage(kDrawBinding, draws_);
  program.set("triangle_count", batch.scene.triangle_count());
  program.dispatch(static_cast<std::uint32_t>(batch.layers));
}

int HemicubeMaps::draw_count(int maps) { return kFaces * maps; }

void HemicubeMaps::draw_faces(const Batch& batch) {
  atlas_.clear_words(kNoTriangle);
  depth_.clear({0.0F, 0.0F, 0.0F, 0.0F});
  opengl::Program& program = bound_program({"hemicube_face.vert", "hemicube_face.frag"}, batch);
  program.storage(kListBinding, lists_);
  program.set("triangle_count", batch.scene.triangle_count());
  program.set("nearest_m", kNearest * batch.scene.bounds().diagonal_m());
  opengl::RasterPass pass(target_, opengl::DepthTest::nearer, 1);
  for (int layer = 0; layer < batch.layers; ++layer) {
    program.set("layer", layer);
    const glm::ivec2 block = kBlock * glm::ivec2(layer % columns_, layer / columns_);
    for (int face = 0; face < kFaces; ++face) {
      program.set("face", face);
      const glm::ivec2 corner = block + kCorners[static_cast<std::size_t>(face)];
      pass.viewport(corner * (face_px_ / 2), {face_px_, face == 0 ? face_px_ : face_px_ / 2});
      program.draw_triangles(draws_, layer * kFaces + face);
    }
  }
}

void HemicubeMaps::resample(const HemisphereMaps& maps, const Batch& batch) {
  opengl::Program& program = bound_program({"hemicube_resample.comp"}, batch);
  program.image(0, maps.distances(), opengl::Access::read_write);
  program.image(1, atlas_, opengl::Access::read);
  program.set("size_px", maps.size_px());
  program.set("first_layer", batch.first_layer);
  const std::uint32_t tiles = opengl::groups_for(maps.size_px(), kTileSize_px);
  program.dispatch(tiles, tiles, static_cast<std::uint32_t>(batch.layers));
}

std::int64_t HemicubeMaps::memory_bytes() const {
  std::int64_t bytes = spheres_.memory_bytes() +
                       static_cast<std::int64_t>(lists_.size_bytes() + draws_.size_bytes());
  for (const opengl::Texture* texture : {&atlas_, &depth_}) {
    if (!texture->is_empty()) bytes += size_bytes_of(texture->shape());
  }
  return bytes;
}

}  // namespace renderers::shadow_maps
