#include "renderers/many_lights/gather.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>

#include "renderers/many_lights/shader_files.h"
#include "renderers/opengl/program.h"

namespace renderers::many_lights {

namespace {

constexpr int kLocalSize = 8;
constexpr int kSplitLocalSize = 8;  ///< of split.comp.glsl
constexpr std::uint32_t kMaterialsBinding = 1;
constexpr std::uint32_t kLightsBinding = 3;

opengl::TextureShape float_shape(const glm::ivec2& size_px) {
  return {.format = opengl::TextureFormat::rgba32f, .width_px = size_px.x, .height_px = size_px.y};
}

/// Pixels that one thread makes, so that a light is loaded once for all of them. A lookup in the
/// light's own map outweighs that load, and so do powers, where small groups are idle more often;
/// neighbours in the naive order belong to different classes.
glm::ivec2 pixels_per_thread(const GatherLights& lights, GatherOrder order, bool is_glossy) {
  if (lights.maps != nullptr || order == GatherOrder::naive || is_glossy) return {1, 1};
  return {4, 2};
}

/// First class whose run ends beyond a light: the least s with (s + 1) N / n^2 > light.
int class_of_light(int light, int light_count, int classes) {
  return static_cast<int>((static_cast<std::int64_t>(light + 1) * classes + light_count - 1) /
                          light_count) -
         1;
}

}  // namespace

/// One call of `add`.
struct Gather::Work {
  const opengl::GeometryBuffer& surfaces;
  const opengl::GpuScene& scene;
  const GatherLights& lights;
  const GatherSettings& settings;

  glm::ivec2 size_px() const { return {surfaces.width_px(), surfaces.height_px()}; }
  /// Pixels of a class, of the largest one.
  glm::ivec2 cells() const {
    return (size_px() + glm::ivec2(settings.interleave - 1)) / settings.interleave;
  }
  std::array<const opengl::Texture*, 4> maps() const {
    return {&surfaces.position(), &surfaces.geometric_normal(), &surfaces.shading_normal(),
            &surfaces.albedo()};
  }
};

Gather::Gather(std::shared_ptr<opengl::Context> context) : context_(std::move(context)) {}

void Gather::begin(const opengl::GeometryBuffer& surfaces, const GatherSettings& settings) {
  const glm::ivec2 size_px(surfaces.width_px(), surfaces.height_px());
  targets_.irradiance.reshape(context_, float_shape(size_px));
  targets_.irradiance.clear({0.0F, 0.0F, 0.0F, 0.0F});
  if (settings.with_glossy) {
    targets_.glossy.reshape(context_, float_shape(size_px));
    targets_.glossy.clear({0.0F, 0.0F, 0.0F, 0.0F});
  }
}

void Gather::add(const opengl::GeometryBuffer& surfaces, const opengl::GpuScene& scene,
                 const GatherLights& lights, const GatherSettings& settings, GatherOrder order) {
  assert(settings.interleave >= 1 && lights.first >= 0 && lights.batch >= 0);
  assert(lights.first + lights.batch <= lights.count);
  assert(static_cast<std::int64_t>(lights.count) * settings.interleave * settings.interleave <=
         std::numeric_limits<int>::max());
  if (lights.batch == 0) return;
  const Work work{surfaces, scene, lights, settings};
  if (order == GatherOrder::split_merge) split(work);
  run(work, order, Lobe::diffuse);
  if (settings.with_glossy) run(work, order, Lobe::glossy);
  if (order == GatherOrder::split_merge) merge(work);
}

void Gather::run(const Work& work, GatherOrder order, Lobe lobe) {
  const GatherVisibility* visibility = work.lights.visibility;
  opengl::ProgramSource source{shader_files(), {"renderers/many_lights/shaders/gather.comp.glsl"}};
  if (visibility != nullptr) source = {visibility->files, {visibility->shader}};
  const glm::ivec2 pixels = pixels_per_thread(work.lights, order, lobe == Lobe::glossy);
  source.defines = {{"LOCAL_SIZE", std::to_string(kLocalSize)},
                    {"PIXELS_X", std::to_string(pixels.x)},
                    {"PIXELS_Y", std::to_string(pixels.y)}};
  if (order == GatherOrder::naive) source.defines.emplace_back("ORDER_NAIVE", "1");
  if (order == GatherOrder::split_merge) source.defines.emplace_back("ORDER_SPLIT", "1");
  if (work.settings.geometry_clamp > 0.0F) source.defines.emplace_back("WITH_CLAMP", "1");
  if (lobe == Lobe::glossy) source.defines.emplace_back("GLOSSY", "1");
  if (lobe == Lobe::glossy && work.scene.has_ggx()) source.defines.emplace_back("WITH_GGX", "1");
  if (visibility != nullptr) {
    source.defines.insert(source.defines.end(), visibility->defines.begin(),
                          visibility->defines.end());
  } else if (work.lights.maps != nullptr) {
    source.defines.emplace_back("WITH_HEMISPHERE_MAPS", "1");
  }
  opengl::Program& program = context_->program(source);

  const bool is_split = order == GatherOrder::split_merge;
  for (std::uint32_t i = 0; i < 4; ++i) {
    program.sampler(i, is_split ? split_surfaces_[i] : *work.maps()[i]);
  }
  const GatherTargets& targets = is_split ? split_targets_ : targets_;
  program.image(0, lobe == Lobe::diffuse ? targets.irradiance : targets.glossy,
                opengl::Access::read_write);
  if (lobe == Lobe::glossy) program.storage(kMaterialsBinding, work.scene.materials());
  bind_lights(program, work);
  program.set("size_px", work.size_px());
  program.set("cells", work.cells());
  program.set("interleave", work.settings.interleave);
  program.set("geometry_clamp", work.settings.geometry_clamp);
  program.set("camera_position", work.settings.camera_position);
  if (order == GatherOrder::naive) {
    program.dispatch(opengl::groups_for(work.size_px().x, kLocalSize),
                     opengl::groups_for(work.size_px().y, kLocalSize));
  } else {
    dispatch_classes(program, work, kLocalSize * pixels);
  }
}

void Gather::bind_lights(opengl::Program& program, const Work& work) const {
  program.storage(kLightsBinding, *work.lights.lights);
  if (work.lights.visibility != nullptr) {
    work.lights.visibility->bind(program);
  } else if (work.lights.maps != nullptr) {
    shadow_maps::bind_hemisphere_maps(program, *work.lights.maps, work.lights.bias);
  }
  program.set("light_count", work.lights.count);
  program.set("first_light", work.lights.first);
  program.set("end_light", work.lights.first + work.lights.batch);
}

void Gather::dispatch_classes(opengl::Program& program, const Work& work,
                              const glm::ivec2& tile) const {
  const int classes = work.settings.interleave * work.settings.interleave;
  const int count = work.lights.count;
  const int first = class_of_light(work.lights.first, count, classes);
  const int last = class_of_light(work.lights.first + work.lights.batch - 1, count, classes);
  program.set("first_class", first);
  program.dispatch(static_cast<std::uint32_t>(last - first + 1),
                   opengl::groups_for(work.cells().x, tile.x),
                   opengl::groups_for(work.cells().y, tile.y));
}

void Gather::split(const Work& work) {
  const glm::ivec2 sorted_px = work.cells() * work.settings.interleave;
  opengl::Program& program =
      context_->program({shader_files(), {"renderers/many_lights/shaders/split.comp.glsl"}});
  program.set("size_px", work.size_px());
  program.set("cells", work.cells());
  program.set("interleave", work.settings.interleave);
  const auto sort = [&](const opengl::Texture& from, opengl::Texture& to) {
    to.reshape(context_, float_shape(sorted_px));
    program.sampler(0, from);
    program.image(0, to, opengl::Access::write);
    program.dispatch(opengl::groups_for(work.size_px().x, kSplitLocalSize),
                     opengl::groups_for(work.size_px().y, kSplitLocalSize));
  };
  for (std::size_t i = 0; i < 4; ++i) sort(*work.maps()[i], split_surfaces_[i]);
  sort(targets_.irradiance, split_targets_.irradiance);
  if (work.settings.with_glossy) sort(targets_.glossy, split_targets_.glossy);
}

void Gather::merge(const Work& work) {
  opengl::Program& program = context_->program(
      {shader_files(), {"renderers/many_lights/shaders/split.comp.glsl"}, {{"MERGE", "1"}}});
  program.set("size_px", work.size_px());
  program.set("cells", work.cells());
  program.set("interleave", work.settings.interleave);
  const auto sort = [&](const opengl::Texture& from, const opengl::Texture& to) {
    program.sampler(0, from);
    program.image(0, to, opengl::Access::write);
    program.dispatch(opengl::groups_for(work.size_px().x, kSplitLocalSize),
                     opengl::groups_for(work.size_px().y, kSplitLocalSize));
  };
  sort(split_targets_.irradiance, targets_.irradiance);
  if (work.settings.with_glossy) sort(split_targets_.glossy, targets_.glossy);
}

std::int64_t Gather::memory_bytes() const {
  std::int64_t bytes = 0;
  const auto add = [&](const opengl::Texture& texture) {
    if (!texture.is_empty()) bytes += opengl::size_bytes_of(texture.shape());
  };
  for (const opengl::Texture& texture : split_surfaces_) add(texture);
  for (const GatherTargets* targets : {&targets_, &split_targets_}) {
    add(targets->irradiance);
    add(targets->glossy);
  }
  return bytes;
}

}  // namespace renderers::many_lights
