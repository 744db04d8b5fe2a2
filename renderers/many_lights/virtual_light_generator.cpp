#include "renderers/many_lights/virtual_light_generator.h"

#include <algorithm>
#include <cassert>
#include <optional>
#include <span>
#include <utility>

#include <glm/vec4.hpp>

#include "renderers/many_lights/shader_files.h"
#include "renderers/opengl/gpu_stage.h"
#include "renderers/opengl/program.h"

namespace renderers::many_lights {

namespace {

constexpr std::int64_t kLocalSize = 64;  ///< of sample_map.comp.glsl
constexpr std::uint32_t kLightsBinding = 3;
constexpr std::uint32_t kSamplesBinding = 4;

/// `MapSample` of sample_map.comp.glsl.
struct MapSample {
  glm::vec4 flux{0.0F};
  glm::ivec4 where{0};
};

opengl::ProgramSource sample_program() {
  return {shader_files(), {"renderers/many_lights/shaders/sample_map.comp.glsl"}};
}

}  // namespace

/// The samples that one view's map answers.
struct VirtualLightGenerator::ViewSamples {
  std::size_t view = 0;  ///< among all emitters'
  const opengl::View* from = nullptr;
  int size_px = 0;
  std::vector<MapSample> samples;
};

VirtualLightGenerator::VirtualLightGenerator(std::shared_ptr<opengl::Context> context,
                                             const GeneratorSettings& settings)
    : context_(std::move(context)), settings_(settings) {
  assert(settings.light_count > 0);
  lights_ = opengl::Buffer(context_,
                           static_cast<std::size_t>(settings.light_count) * sizeof(VirtualLight));
}

bool VirtualLightGenerator::has_point_sets() const {
  return std::ranges::any_of(emitters_, has_point_set);
}

void VirtualLightGenerator::load(const scene::Scene& scene) {
  settings_.emitters.point_set = 0;
  emitters_ = make_emitters(scene, settings_.emitters);
  deal_lights();
  forget_maps(0);
}

void VirtualLightGenerator::use_point_set(const scene::Scene& scene, int point_set) {
  settings_.emitters.point_set = point_set;
  std::size_t lights_views = 0;
  for (const Emitter& emitter : emitters_) {
    if (!has_point_set(emitter)) lights_views += emitter.views.size();
  }
  remake_point_sets(scene, settings_.emitters, emitters_);
  deal_lights();
  forget_maps(lights_views);
}

void VirtualLightGenerator::deal_lights() {
  std::vector<double> weights;
  for (const Emitter& emitter : emitters_) weights.push_back(luminance(emitter.flux));
  counts_ = light_counts(weights, settings_.light_count);
  slots_ = assign_lights(weights, settings_.light_count);
  emitters_left_out_ = static_cast<int>(std::ranges::count(counts_, 0));
}

void VirtualLightGenerator::forget_maps(std::size_t first_view) {
  std::vector<int> sizes_px;
  first_view_.clear();
  for (const Emitter& emitter : emitters_) {
    first_view_.push_back(sizes_px.size());
    sizes_px.insert(sizes_px.end(), emitter.views.size(), size_px_of(emitter));
  }
  maps_.resize(sizes_px.size());
  kept_bytes_ = 0;
  for (std::size_t view = 0; view < maps_.size(); ++view) {
    Map& map = maps_[view];
    if (view >= first_view) map.is_current = false;
    if (map.kept && map.kept->width_px() != sizes_px[view]) map.kept.reset();
    if (map.kept) kept_bytes_ += map.kept->memory_bytes();
  }
  std::erase_if(spare_, [&](const auto& spare) {
    return std::ranges::find(sizes_px, spare.first) == sizes_px.end();
  });
}

int VirtualLightGenerator::size_px_of(const Emitter& emitter) const {
  switch (emitter.kind) {
    case EmitterKind::area:
      return settings_.area_map_size_px;
    case EmitterKind::environment:
      return settings_.environment_map_size_px;
    case EmitterKind::point:
    case EmitterKind::spot:
      break;
  }
  return settings_.map_size_px;
}

std::vector<VirtualLightGenerator::ViewSamples> VirtualLightGenerator::draw_samples(
    int pass) const {
  std::vector<ViewSamples> views(maps_.size());
  for (std::size_t i = 0; i < slots_.size(); ++i) {
    const auto e = static_cast<std::size_t>(slots_[i].emitter);
    const Emitter& emitter = emitters_[e];
    const EmittedSample drawn = emitter.sample(slots_[i].index, counts_[e], pass);
    // Outside a spot's cone: the light stays as empty as the buffer was made.
    if (luminance(drawn.flux) <= 0.0) continue;
    ViewSamples& view = views[first_view_[e] + static_cast<std::size_t>(drawn.view)];
    view.from = &emitter.views[static_cast<std::size_t>(drawn.view)];
    view.size_px = size_px_of(emitter);
    const glm::ivec2 texel(drawn.map_position * static_cast<double>(view.size_px));
    view.samples.push_back(
        {glm::vec4(drawn.flux, 0.0), {texel.x, texel.y, static_cast<int>(i), 0}});
  }
  for (std::size_t view = 0; view < views.size(); ++view) views[view].view = view;
  std::erase_if(views, [](const ViewSamples& view) { return view.samples.empty(); });
  return views;
}

void VirtualLightGenerator::free_maps_but(std::span<const ViewSamples> views) {
  for (std::size_t view = 0; view < maps_.size(); ++view) {
    Map& map = maps_[view];
    if (!map.kept || map.is_current) continue;
    if (std::ranges::binary_search(views, view, {}, &ViewSamples::view)) continue;
    kept_bytes_ -= map.kept->memory_bytes();
    map.kept.reset();
  }
}

opengl::GeometryBuffer& VirtualLightGenerator::map_buffer(std::size_t view, int size_px) {
  Map& map = maps_[view];
  if (map.kept) return *map.kept;
  auto& spare = spare_[size_px];
  if (!spare) spare = std::make_unique<opengl::GeometryBuffer>(context_, size_px, size_px);
  const std::int64_t bytes = spare->memory_bytes();
  if (kept_bytes_ + bytes > settings_.kept_map_bytes) return *spare;
  kept_bytes_ += bytes;
  map.kept = std::move(spare);
  return *map.kept;
}

std::vector<const opengl::GeometryBuffer*> VirtualLightGenerator::draw_maps(
    std::span<const ViewSamples> views, const opengl::GpuScene& scene, StageTimer& timer) {
  const auto is_drawn = [&](const ViewSamples& view) { return maps_[view.view].is_current; };
  std::optional<opengl::GpuStage> stage;
  if (!std::ranges::all_of(views, is_drawn)) stage.emplace(*context_, timer, "map");
  std::vector<const opengl::GeometryBuffer*> drawn;
  for (const ViewSamples& view : views) {
    Map& map = maps_[view.view];
    if (map.is_current) {
      drawn.push_back(map.kept.get());
      continue;
    }
    opengl::GeometryBuffer& buffer = map_buffer(view.view, view.size_px);
    buffer.render(scene, *view.from);
    drawn.push_back(&buffer);
    map.is_current = map.kept != nullptr;
    ++maps_drawn_;
    // The next one would overwrite a buffer that is not kept.
    if (!map.is_current) break;
  }
  return drawn;
}

void VirtualLightGenerator::fetch(const opengl::GeometryBuffer& map, const ViewSamples& view,
                                  int first_sample) {
  opengl::Program& program = context_->program(sample_program());
  program.storage(kLightsBinding, lights_);
  program.storage(kSamplesBinding, samples_);
  program.sampler(0, map.position());
  program.sampler(1, map.geometric_normal());
  program.sampler(2, map.shading_normal());
  program.sampler(3, map.albedo());
  const auto count = static_cast<int>(view.samples.size());
  program.set("first_sample", first_sample);
  program.set("sample_count", count);
  program.set("emitter", view.from->is_orthographic ? glm::vec4(-view.from->forward, 0.0F)
                                                    : glm::vec4(view.from->origin, 1.0F));
  program.dispatch(opengl::groups_for(count, kLocalSize));
}

void VirtualLightGenerator::generate(const opengl::GpuScene& scene, int pass, StageTimer& timer) {
  const auto stage = timer.stage("lights");
  maps_drawn_ = 0;
  lights_.fill(0);
  const std::vector<ViewSamples> views = draw_samples(pass);
  free_maps_but(views);
  std::vector<MapSample> samples;
  for (const ViewSamples& view : views) {
    samples.insert(samples.end(), view.samples.begin(), view.samples.end());
  }
  if (samples.empty()) return;
  samples_.reserve(context_, samples.size() * sizeof(MapSample));
  samples_.write(std::span<const MapSample>(samples));

  std::span<const ViewSamples> left(views);
  int first_sample = 0;
  while (!left.empty()) {
    const auto maps = draw_maps(left, scene, timer);
    const opengl::GpuStage sample_stage(*context_, timer, "sample");
    for (std::size_t i = 0; i < maps.size(); ++i) {
      fetch(*maps[i], left[i], first_sample);
      first_sample += static_cast<int>(left[i].samples.size());
    }
    left = left.subspan(maps.size());
  }
  context_->check("making virtual lights");
}

LightTotals VirtualLightGenerator::read_totals() const {
  LightTotals totals;
  for (const auto& light :
       lights_.read<VirtualLight>(static_cast<std::size_t>(settings_.light_count))) {
    totals.valid += light.position.w > 0.0F ? 1 : 0;
    totals.flux += glm::dvec3(light.flux);
  }
  return totals;
}

std::int64_t VirtualLightGenerator::memory_bytes() const {
  std::int64_t bytes = kept_bytes_ + static_cast<std::int64_t>(lights_.size_bytes()) +
                       static_cast<std::int64_t>(samples_.size_bytes());
  for (const auto& [size_px, spare] : spare_) {
    if (spare) bytes += spare->memory_bytes();
  }
  return bytes;
}

}  // namespace renderers::many_lights
