#include "renderers/instant_radiosity/instant_radiosity_renderer.h"

#include <cassert>
#include <memory>
#include <optional>

#include <glm/vec2.hpp>

#include "perception/base/parallel.h"
#include "renderers/contract/sample_schedule.h"
#include "renderers/instant_radiosity/indirect_light.h"
#include "renderers/instant_radiosity/instant_radiosity_settings.h"
#include "renderers/many_lights/bias_compensation.h"
#include "renderers/many_lights/direct_part.h"
#include "renderers/ray_tracing/light_sampler.h"
#include "renderers/ray_tracing/ray_scene.h"
#include "renderers/ray_tracing/sample_sequence.h"

namespace renderers::instant_radiosity {

namespace {

using perception::Image;

constexpr int kWordsPerPixel = 4;  ///< rgba32f textures

/// Point of the pixels that a set looks through, from the centre: the centre first, then scrambled
/// Sobol' points, which share nothing with the Halton points of the lights.
glm::vec2 offset_of(int set) {
  if (set == 0) return glm::vec2(0.0F);
  constexpr std::uint64_t kScrambling = 1;
  ray_tracing::SampleSequence numbers(ray_tracing::SequenceKind::sobol, kScrambling,
                                      static_cast<std::uint32_t>(set));
  return glm::vec2(numbers.next()) - glm::vec2(0.5F);
}

/// Rays of the CPU's parts.
struct RayCounts {
  std::uint64_t direct = 0;
  std::uint64_t compensation = 0;
};

/// A picture on its way: sums over the sets of what is made on the CPU, empty until it is.
struct Picture {
  Picture(const RenderJob& rendered, double geometry_clamp)
      : job(rendered),
        clamp(geometry_clamp),
        seed(ray_tracing::hash_combine(job.seed, static_cast<std::uint64_t>(job.frame_index))) {}

  Image black() const {
    return perception::make_rgb_image(job.width_px, job.height_px,
                                      perception::Encoding::scene_linear);
  }
  /// Adds the mean over the sets of one of the sums.
  void add_mean(const Image& sum, Image& image) const {
    const float share = 1.0F / static_cast<float>(sets);
    for (std::size_t i = 0; i < sum.pixels.size(); ++i) image.pixels[i] += sum.pixels[i] * share;
  }

  const RenderJob& job;
  double clamp;  ///< 1/m2; 0: none
  std::uint64_t seed;
  Image direct;
  Image compensation;
  RayCounts rays;
  std::int64_t sets = 0;
};

class InstantRadiosityRenderer final : public Renderer {
 public:
  InstantRadiosityRenderer(const base::Parameters& parameters, const Devices& devices)
      : settings_(settings_of(parameters)), devices_(devices) {}

  void prepare(const scene::Scene& scene, StageTimer& timer) override {
    if (indirect_) indirect_->restart();
    load(scene, "build", timer);
  }
  void update(const scene::Scene& scene, StageTimer& timer) override {
    load(scene, "scene_update", timer);
  }
  Frame render(const RenderJob& job, StageTimer& timer) override;

 private:
  void load(const scene::Scene& scene, const char* stage_name, StageTimer& timer);
  void add_set(Picture& picture, StageTimer& timer);
  void add_direct(Picture& picture, std::uint32_t set, StageTimer& timer) const;
  void add_compensation(Picture& picture, std::uint32_t set, StageTimer& timer);
  bool is_compensated(const Picture& picture) const {
    return settings_.compensation_rays > 0 && picture.clamp > 0.0;
  }
  Image indirect_image(const Picture& picture, StageTimer& timer) const;
  static Image radiance_image(const Picture& picture, const Image& indirect, StageTimer& timer);
  void add_details(const Picture& picture, Frame& frame);

  Settings settings_;
  Devices devices_;
  std::shared_ptr<opengl::Context> context_;
  std::optional<IndirectLight> indirect_;
  const scene::Scene* scene_ = nullptr;
  double clamp_ = 0.0;
  // The sampler refers to the rays.
  std::unique_ptr<ray_tracing::RayScene> rays_;
  std::unique_ptr<ray_tracing::LightSampler> lights_;
};

void InstantRadiosityRenderer::load(const scene::Scene& scene, const char* stage_name,
                                    StageTimer& timer) {
  const base::ThreadLimit limit(devices_.threads);
  if (!context_) context_ = opengl::Context::of(devices_);
  scene_ = &scene;
  {
    const auto stage = timer.stage(stage_name);
    if (!indirect_) indirect_.emplace(context_, settings_);
    clamp_ = many_lights::geometry_clamp_of(settings_, scene);
    indirect_->load(scene, timer);
    lights_.reset();
    if (settings_.needs_rays()) {
      rays_ = std::make_unique<ray_tracing::RayScene>(scene, timer);
      if (settings_.compensation_rays > 0) {
        lights_ = std::make_unique<ray_tracing::LightSampler>(*rays_);
      }
    }
  }
  indirect_->make_lights(0, timer);
}

Frame InstantRadiosityRenderer::render(const RenderJob& job, StageTimer& timer) {
  assert(indirect_);
  const double start_s = steady_seconds();
  const base::ThreadLimit limit(devices_.threads);
  const SampleSchedule schedule(job, settings_.samples);
  double not_counted_s = 0.0;
  Picture picture(job, clamp_);
  {
    const auto stage = timer.stage("visibility");
    indirect_->begin(job, clamp_);
  }
  while (const auto range =
             schedule.next(picture.sets, steady_seconds() - start_s - not_counted_s)) {
    while (picture.sets < range->end) add_set(picture, timer);
    if (!job.checkpoint || !SampleSchedule::is_checkpoint(picture.sets)) continue;
    const double pause_s = steady_seconds();
    std::optional<Image> image;
    {
      const auto stage = timer.stage("readback");
      image = radiance_image(picture, indirect_image(picture, timer), timer);
    }
    job.checkpoint(*image, picture.sets);
    not_counted_s += steady_seconds() - pause_s;
  }
  Frame frame;
  Image indirect = indirect_image(picture, timer);
  frame.radiance = radiance_image(picture, indirect, timer);
  const auto stage = timer.stage("readback");
  frame.aovs.push_back({"indirect", std::move(indirect)});
  add_details(picture, frame);
  return frame;
}

void InstantRadiosityRenderer::add_set(Picture& picture, StageTimer& timer) {
  const auto set = static_cast<std::uint32_t>(picture.sets);
  indirect_->add({static_cast<int>(set), offset_of(static_cast<int>(set))}, rays_.get(), timer);
  if (is_compensated(picture)) add_compensation(picture, set, timer);
  if (settings_.part == Part::all) add_direct(picture, set, timer);
  ++picture.sets;
}

void InstantRadiosityRenderer::add_direct(Picture& picture, std::uint32_t set,
                                          StageTimer& timer) const {
  const auto stage = timer.stage("transport");
  const auto inner = timer.stage("direct");
  picture.rays.direct += many_lights::add_direct_light(
      *rays_, picture.job, settings_, {offset_of(static_cast<int>(set)), picture.seed, set},
      picture.direct);
}

void InstantRadiosityRenderer::add_compensation(Picture& picture, std::uint32_t set,
                                                StageTimer& timer) {
  const auto stage = timer.stage("transport");
  const auto inner = timer.stage("compensation");
  many_lights::BiasCompensationSettings settings;
  settings.geometry_clamp = static_cast<float>(picture.clamp);
  settings.rays = settings_.compensation_rays;
  settings.camera_position = picture.job.camera.position;
  settings.seed = picture.seed;
  settings.pass = set;
  const many_lights::CompensatedLight light =
      many_lights::compensate_bias(*rays_, *lights_, indirect_->surfaces(), settings);
  if (picture.compensation.is_empty()) picture.compensation = picture.black();
  for (std::size_t pixel = 0; pixel < light.radiance.size(); ++pixel) {
    for (glm::length_t channel = 0; channel < 3; ++channel) {
      picture.compensation.pixels[pixel * 3 + static_cast<std::size_t>(channel)] +=
          light.radiance[pixel][channel];
    }
  }
  picture.rays.compensation += light.short_rays + light.shadow_rays;
}

Image InstantRadiosityRenderer::indirect_image(const Picture& picture, StageTimer& timer) const {
  std::vector<float> gathered;
  {
    const auto stage = timer.stage("readback");
    gathered = indirect_->read_radiance();
  }
  const auto stage = timer.stage("transport");
  Image image = picture.black();
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    image.pixels[i] = gathered[i / 3 * kWordsPerPixel + i % 3];
  }
  picture.add_mean(picture.compensation, image);
  return image;
}

Image InstantRadiosityRenderer::radiance_image(const Picture& picture, const Image& indirect,
                                               StageTimer& timer) {
  const auto stage = timer.stage("transport");
  Image image = indirect;
  picture.add_mean(picture.direct, image);
  return image;
}

void InstantRadiosityRenderer::add_details(const Picture& picture, Frame& frame) {
  const many_lights::SurfaceImage& surfaces = indirect_->surfaces();
  const std::vector<float> irradiance = indirect_->read_irradiance();
  Image albedo = picture.black();
  Image normal = albedo;
  Image received = albedo;
  for (std::size_t i = 0; i < albedo.pixels.size(); ++i) {
    const auto channel = static_cast<glm::length_t>(i % 3);
    albedo.pixels[i] = surfaces.albedo[i / 3][channel];
    normal.pixels[i] = surfaces.shading_normal[i / 3][channel];
    received.pixels[i] = irradiance[i / 3 * kWordsPerPixel + i % 3];
  }
  if (settings_.part == Part::all) {
    Image direct = picture.black();
    picture.add_mean(picture.direct, direct);
    frame.aovs.push_back({"direct", std::move(direct)});
  }
  frame.aovs.push_back({"irradiance", std::move(received)});
  frame.aovs.push_back({"albedo", std::move(albedo)});
  frame.aovs.push_back({"normal", std::move(normal)});

  const many_lights::LightTotals totals = indirect_->generator().read_totals();
  if (totals.is_dark()) frame.notes.push_back("no light reaches a surface: no indirect light");
  const int left_out = indirect_->generator().emitters_left_out();
  if (left_out > 0) {
    frame.notes.push_back(std::to_string(left_out) +
                          " sources of light got no virtual light: there are more than vpls");
  }
  const std::size_t left_behind = indirect_->imperfect_points_left_behind();
  if (left_behind > 0) {
    frame.notes.push_back(std::to_string(left_behind) +
                          " points of imperfect maps stay where they were dealt: the triangles of "
                          "their objects have changed");
  }
  const VisibilityCounts& counts = indirect_->counts();
  frame.counters = {
      {"vpls", static_cast<double>(settings_.virtual_lights)},
      {"valid_vpls", static_cast<double>(totals.valid)},
      {"emitters", static_cast<double>(indirect_->generator().emitters().size())},
      {"shadow_maps", static_cast<double>(counts.maps)},
      {"rays", static_cast<double>(counts.rays + picture.rays.direct + picture.rays.compensation)},
      {"visibility_rays", static_cast<double>(counts.rays)},
      {"occluded_rays", static_cast<double>(counts.occluded)},
      {"triangles", static_cast<double>(indirect_->scene().triangle_count())},
      {"device_bytes", static_cast<double>(indirect_->memory_bytes())},
      {"samples", static_cast<double>(picture.sets)}};
  frame.samples = picture.sets;
  frame.device = context_->facts().renderer;
  frame.gl_platform = opengl::to_string(context_->platform());
}

std::unique_ptr<Renderer> create(const base::Parameters& parameters, const Devices& devices) {
  return std::make_unique<InstantRadiosityRenderer>(parameters, devices);
}

}  // namespace

RendererInfo renderer_info() {
  RendererInfo info;
  info.name = "instant-radiosity";
  info.summary = "One bounce of light from virtual point lights, visibility by rays, maps or none.";
  info.source =
      "Keller 1997, doi:10.1145/258734.258769; Dachsbacher and Stamminger 2005, "
      "doi:10.1145/1053427.1053460";
  info.claims = claims_of;
  info.possible_claims = {{Transport::one_bounce, Part::all, std::nullopt},
                          {Transport::one_bounce, Part::indirect, std::nullopt}};
  info.supports = {Feature::point_light, Feature::spot_light, Feature::area_light,
                   Feature::environment, Feature::texture,    Feature::glossy,
                   Feature::animation};
  info.progressive_unit = "light sets";
  info.uses_seed = true;
  info.history = true;  // of imperfect_points_kept alone
  info.parameters = parameter_specs();
  info.presets = presets();
  info.create = create;
  return info;
}

}  // namespace renderers::instant_radiosity
