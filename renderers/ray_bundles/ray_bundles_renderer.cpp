#include "renderers/ray_bundles/ray_bundles_renderer.h"

#include <algorithm>
#include <cassert>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "perception/base/errors.h"
#include "perception/base/parallel.h"
#include "renderers/contract/sample_schedule.h"
#include "renderers/ray_bundles/atlas_lights.h"
#include "renderers/ray_bundles/atlas_picture.h"
#include "renderers/ray_bundles/bundle_transport.h"
#include "renderers/ray_bundles/device_needs.h"
#include "renderers/ray_bundles/ray_bundles_settings.h"
#include "renderers/ray_tracing/direct_light_pass.h"
#include "renderers/ray_tracing/glossy_lobe.h"
#include "renderers/ray_tracing/sample_sequence.h"

namespace renderers::ray_bundles {

namespace {

using perception::Image;

/// Parts of one image on its way.
struct Picture {
  explicit Picture(const RenderJob& of_job)
      : job(of_job),
        seed(ray_tracing::hash_combine(job.seed, static_cast<std::uint64_t>(job.frame_index))),
        solution_seed(ray_tracing::hash_combine(job.seed, 0)) {}
  const RenderJob& job;
  std::uint64_t seed;           ///< of what is drawn for the pixels
  std::uint64_t solution_seed;  ///< the same in all frames, so that the next may keep the solution
  Image direct;                 ///< sum over the passes, not by the atlas; empty: none
  std::unique_ptr<GlossyView> glossy;  ///< null: no bundles for lobes
  std::int64_t passes = 0;
  std::uint64_t direct_rays = 0;
};

class RayBundlesRenderer final : public Renderer {
 public:
  RayBundlesRenderer(const base::Parameters& parameters, const Devices& devices)
      : settings_(settings_of(parameters)), devices_(devices) {}

  void prepare(const scene::Scene& scene, StageTimer& timer) override;
  void update(const scene::Scene& scene, StageTimer& timer) override;
  Frame render(const RenderJob& job, StageTimer& timer) override;

 private:
  void check_lobes(const scene::Scene& scene) const;
  void check_emission(const scene::Scene& scene) const;
  std::shared_ptr<opengl::Context> drawing_device() const;
  void leave_small_device();
  std::unique_ptr<GlossyView> glossy_view(const RenderJob& job) const;
  void begin_transport(std::uint64_t seed, std::int64_t planned, StageTimer& timer);
  void add_directions(Picture& picture, std::int64_t end, StageTimer& timer);
  void add_passes(Picture& picture, StageTimer& timer) const;
  void add_pixel_direct(Picture& picture, StageTimer& timer) const;
  void fetch(StageTimer& timer) const;
  AtlasPicture show(const Picture& picture, StageTimer& timer) const;
  void add_details(const Picture& picture, const AtlasPicture& shown, Frame& frame) const;
  /// True if the direct light of the pixels is not the atlas'.
  bool has_pixel_direct() const {
    return settings_.part == Part::all && settings_.direct != DirectMode::bundles;
  }

  Settings settings_;
  Devices devices_;
  std::shared_ptr<opengl::Context> device_;  ///< null: the CPU
  std::string device_note_;                  ///< why it is not a device that there is
  // Each refers to those before it.
  std::unique_ptr<ray_tracing::RayScene> rays_;
  std::unique_ptr<texel_atlas::TexelAtlas> atlas_;
  std::unique_ptr<SoftDirectLight> soft_;  ///< null: not of this
  std::unique_ptr<BundleTransport> transport_;
  std::uint64_t shadow_rays_ = 0;  ///< to light the atlas
  base::Hash world_hash_;          ///< of the scene at hand
};

/// @throws InputError for a lobe too sharp for bundles
void RayBundlesRenderer::check_lobes(const scene::Scene& scene) const {
  if (!has_glossy_bundles(settings_)) return;
  for (const scene::Material& material : scene.materials) {
    const auto exponent = static_cast<double>(ray_tracing::equivalent_exponent(material.lobe));
    if (!material.is_glossy() || exponent <= settings_.most_exponent) continue;
    throw base::InputError(fmt::format(
        "ray-bundles: material \"{}\" has a lobe {} exponent {}; accepted: at most {} "
        "(most_exponent): sharper lobes fall between directions; or glossy last_surface with "
        "final_glossy ray",
        material.name,
        material.lobe.shape == scene::LobeShape::ggx
            ? fmt::format("of alpha {}, as sharp as", material.lobe.alpha)
            : std::string("of"),
        exponent, settings_.most_exponent));
  }
}

/// @throws InputError for emission that soft shadows take for the same in all directions
void RayBundlesRenderer::check_emission(const scene::Scene& scene) const {
  if (settings_.direct != DirectMode::pcss) return;
  for (const scene::Object& object : scene.objects) {
    const auto& material = scene.materials[static_cast<std::size_t>(object.material)];
    if (material.emission_profile.empty()) continue;
    throw base::InputError(
        fmt::format("ray-bundles: material \"{}\" has an emission_profile, which direct pcss does "
                    "not know; accepted: direct next_event or bundles",
                    material.name));
  }
}

/// What finds the bundles' crossings; null: the CPU.
/// @throws UnsupportedError if OpenGL is asked for and there is none
std::shared_ptr<opengl::Context> RayBundlesRenderer::drawing_device() const {
  if (settings_.backend == Backend::opengl) return opengl::Context::of(devices_);
  if (settings_.backend == Backend::cpu) return nullptr;
  return opengl::Context::hardware_of(devices_);
}

/// The CPU instead of a device that nobody asked for by name, if that is too small.
void RayBundlesRenderer::leave_small_device() {
  if (!device_ || settings_.backend != Backend::automatic ||
      settings_.transport.exchange == ExchangePlace::device) {
    return;
  }
  const DeviceNeeds needs =
      list_needs(settings_.transport.lists == ListKind::trace,
                 GpuBundleLists::scene_block_bytes(rays_->triangle_count(), *atlas_));
  const std::string lack = lacking(needs, device_->limits(), device_->facts().renderer);
  if (lack.empty()) return;
  device_note_ = "backend auto: the CPU finds the crossings, since " + lack;
  device_.reset();
}

void RayBundlesRenderer::prepare(const scene::Scene& scene, StageTimer& timer) {
  check_lobes(scene);
  check_emission(scene);
  world_hash_ = {};
  const base::ThreadLimit limit(devices_.threads);
  const auto stage = timer.stage("build");
  transport_.reset();
  device_note_.clear();
  {
    const auto inner = timer.stage("device");
    device_ = drawing_device();
    if (!device_ && settings_.transport.exchange == ExchangePlace::device) {
      throw UnsupportedError(
          "ray-bundles: exchange device, but backend auto finds no hardware and draws on the CPU; "
          "accepted: backend opengl, or exchange auto or cpu");
    }
  }
  soft_.reset();
  atlas_.reset();
  const bool has_traced_lists =
      settings_.backend != Backend::opengl && settings_.transport.lists == ListKind::trace;
  rays_ = std::make_unique<ray_tracing::RayScene>(
      scene, timer,
      has_traced_lists ? ray_tracing::RayQueries::all_hits : ray_tracing::RayQueries::first_hits);
  {
    const auto inner = timer.stage("atlas");
    atlas_ = std::make_unique<texel_atlas::TexelAtlas>(*rays_, settings_.atlas, timer);
  }
  leave_small_device();
  if (settings_.direct == DirectMode::pcss) {
    auto inner = timer.stage("maps");
    soft_ = std::make_unique<SoftDirectLight>(*rays_, settings_.soft);
    inner.add_bytes(soft_->memory_bytes());
  }
  world_hash_ = scene.world_hash;
}

/// Where nothing but the camera has moved, the solution stays.
void RayBundlesRenderer::update(const scene::Scene& scene, StageTimer& timer) {
  const bool is_same_world = world_hash_ != base::Hash() && scene.world_hash == world_hash_;
  if (!is_same_world) {
    prepare(scene, timer);
    return;
  }
  const auto stage = timer.stage("scene_update");
  rays_->follow(scene);
}

/// What bundles are to light of the lobes in this picture.
std::unique_ptr<GlossyView> RayBundlesRenderer::glossy_view(const RenderJob& job) const {
  if (!has_glossy_bundles(settings_)) return nullptr;
  GlossyViewSettings view;
  view.with_diffuse = settings_.final_glossy == FinalGlossy::bundles;
  view.with_emission =
      view.with_diffuse && settings_.part == Part::all && settings_.direct == DirectMode::bundles;
  return std::make_unique<GlossyView>(*rays_, *atlas_, job, view);
}

/// Starts anew, or keeps a finished solution of the same plan: it does not depend on the camera,
/// but where bundles light what the camera sees.
void RayBundlesRenderer::begin_transport(std::uint64_t seed, std::int64_t planned,
                                         StageTimer& timer) {
  if (!has_glossy_bundles(settings_) && transport_ && planned > 0 &&
      transport_->settings().seed == seed && transport_->settings().planned == planned &&
      transport_->directions() == planned) {
    return;
  }
  const auto stage = timer.stage("lights");
  TransportSettings transport = settings_.transport;
  transport.device = device_;
  transport.seed = seed;
  transport.planned = planned;
  const std::int64_t count = planned > 0 ? planned : settings_.samples;
  // With bundles for direct light, that is the first share.
  const std::int64_t shares = settings_.bounces + (settings_.direct == DirectMode::bundles ? 1 : 0);
  transport.solution.bounce_directions = std::max<std::int64_t>(1, count / shares);
  transport_ = std::make_unique<BundleTransport>(*rays_, *atlas_, transport, timer);
  AtlasLightSettings lights;
  lights.with_areas = settings_.direct == DirectMode::next_event;
  lights.light_samples = settings_.light_samples;
  lights.soft = soft_.get();
  lights.has_back_sides = transport.solution.has_back_sides;
  lights.seed = ray_tracing::hash_combine(seed, 1);
  AtlasLight light = light_atlas(*rays_, *atlas_, lights);
  shadow_rays_ = light.shadow_rays;
  transport_->set_known_direct(std::move(light.incident));
  transport_->aim(timer);
}

Frame RayBundlesRenderer::render(const RenderJob& job, StageTimer& timer) {
  assert(rays_ && atlas_);
  const double start_s = steady_seconds();
  const base::ThreadLimit limit(devices_.threads);
  Picture picture(job);
  picture.glossy = glossy_view(job);
  const bool is_timed = job.time_budget_s && !job.samples;
  const std::int64_t planned = is_timed ? 0 : job.samples.value_or(settings_.samples);
  begin_transport(picture.solution_seed, planned, timer);

  const SampleSchedule schedule(job, settings_.samples);
  double not_counted_s = 0.0;
  while (const auto range =
             schedule.next(transport_->directions(), steady_seconds() - start_s - not_counted_s)) {
    add_directions(picture, range->end, timer);
    add_passes(picture, timer);
    if (!job.checkpoint || !SampleSchedule::is_checkpoint(range->end)) continue;
    // The picture's own, whoever looks at it before; else only the checkpoint wants it.
    const bool is_last = planned > 0 && range->end >= planned;
    if (is_last) fetch(timer);
    const double pause_s = steady_seconds();
    Image image;
    {
      const auto stage = timer.stage("readback");
      const AtlasPicture shown = show(picture, timer);
      image = shown.direct;
      for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        image.pixels[i] += shown.indirect.pixels[i];
      }
    }
    job.checkpoint(image, range->end);
    not_counted_s += steady_seconds() - pause_s;
  }

  Frame frame;
  add_passes(picture, timer);  // a finished solution, another view
  const AtlasPicture shown = show(picture, timer);
  const auto stage = timer.stage("readback");
  frame.radiance = shown.direct;
  for (std::size_t i = 0; i < frame.radiance.pixels.size(); ++i) {
    frame.radiance.pixels[i] += shown.indirect.pixels[i];
  }
  add_details(picture, shown, frame);
  return frame;
}

void RayBundlesRenderer::add_directions(Picture& picture, std::int64_t end, StageTimer& timer) {
  while (transport_->directions() < end) {
    const std::int64_t direction = transport_->directions();
    if (picture.glossy && direction % settings_.pass_directions == 0) {
      const auto stage = timer.stage("gather");
      picture.glossy->look(ray_tracing::hash_combine(picture.seed, 4),
                           static_cast<std::uint32_t>(direction / settings_.pass_directions));
    }
    transport_->add_direction(timer, picture.glossy.get());
  }
}

/// As many passes through the pixels as belong to the directions done: both converge together.
void RayBundlesRenderer::add_passes(Picture& picture, StageTimer& timer) const {
  const std::int64_t directions = transport_->directions();
  const std::int64_t passes =
      (directions + settings_.pass_directions - 1) / settings_.pass_directions;
  while (picture.passes < passes) {
    if (has_pixel_direct()) add_pixel_direct(picture, timer);
    ++picture.passes;
  }
}

void RayBundlesRenderer::add_pixel_direct(Picture& picture, StageTimer& timer) const {
  const auto stage = timer.stage("transport");
  const auto inner = timer.stage("direct");
  const ray_tracing::DirectLightJob job{
      picture.job.width_px, picture.job.height_px, picture.job.camera,
      ray_tracing::hash_combine(picture.seed, 2), static_cast<std::uint32_t>(picture.passes)};
  ray_tracing::DirectLight light;
  if (soft_) {
    light = render_soft_direct(*rays_, *soft_, job, settings_.camera_rays);
  } else {
    ray_tracing::DirectLightSettings direct;
    direct.pixel_rays = ray_tracing::PixelRays::spread;
    direct.camera_rays = settings_.camera_rays;
    light = ray_tracing::DirectLightPass(*rays_, direct).render(job);
  }
  picture.direct_rays += light.counts.rays();
  if (picture.direct.is_empty()) {
    picture.direct = std::move(light.radiance);
    return;
  }
  for (std::size_t i = 0; i < picture.direct.pixels.size(); ++i) {
    picture.direct.pixels[i] += light.radiance.pixels[i];
  }
}

void RayBundlesRenderer::fetch(StageTimer& timer) const {
  const auto stage = timer.stage("gather");
  transport_->fetch(timer);
}

AtlasPicture RayBundlesRenderer::show(const Picture& picture, StageTimer& timer) const {
  fetch(timer);
  const auto stage = timer.stage("gather");
  const bool from_atlas = settings_.part == Part::all && !has_pixel_direct();
  PictureSettings settings;
  settings.camera_rays = static_cast<int>(picture.passes) * settings_.camera_rays;
  settings.with_direct = from_atlas;
  settings.with_emission = from_atlas;
  settings.with_point_lights = from_atlas;
  settings.with_glossy_rays = settings_.final_glossy == FinalGlossy::ray;
  settings.seed = ray_tracing::hash_combine(picture.seed, 3);
  AtlasPicture shown = show_atlas(*rays_, *atlas_, transport_->solution(), picture.job, settings);
  if (has_pixel_direct()) {
    const float weight = 1.0F / static_cast<float>(picture.passes);
    shown.direct = picture.direct;
    for (float& value : shown.direct.pixels) value *= weight;
  }
  if (picture.glossy) picture.glossy->add_to(shown.direct, shown.indirect);
  if (settings_.paths == LightPaths::direct) std::ranges::fill(shown.indirect.pixels, 0.0F);
  return shown;
}

void RayBundlesRenderer::add_details(const Picture& picture, const AtlasPicture& shown,
                                     Frame& frame) const {
  const TransportCounts& counts = transport_->counts();
  const GlossyTransfer* chain = transport_->glossy();
  const std::uint64_t glossy_rays = (picture.glossy ? picture.glossy->camera_rays() : 0) +
                                    (chain != nullptr ? chain->shadow_rays() : 0);
  const std::uint64_t map_rays = soft_ ? soft_->map_rays() : 0;
  const auto number = [](auto value) { return static_cast<double>(value); };
  const std::int64_t directions = transport_->directions();
  frame.samples = directions;
  if (device_) {
    frame.device = device_->facts().renderer;
    frame.gl_platform = opengl::to_string(device_->platform());
  }
  if (settings_.part == Part::all) frame.aovs.push_back({"direct", shown.direct});
  frame.aovs.push_back({"indirect", shown.indirect});
  for (perception::NamedImage& image : show_texels(*rays_, *atlas_, picture.job)) {
    frame.aovs.push_back(std::move(image));
  }
  for (const std::string& note : {device_note_, transport_->note()}) {
    if (!note.empty()) frame.notes.push_back(note);
  }
  if (counts.dropped > 0) {
    frame.notes.push_back(
        fmt::format("{} of {} crossings found no slot of the k-buffer: light leaks; more slots, or "
                    "slot_passes: until_complete",
                    counts.dropped, counts.dropped + counts.nodes));
  }
  if (settings_.paths == LightPaths::all &&
      settings_.transport.solution.direct_only >= directions) {
    frame.notes.push_back("no indirect light: all directions are direct_only ones");
  }
  frame.counters = {{"directions", number(directions)},
                    {"rays", number(counts.lines + picture.direct_rays + shown.rays + shadow_rays_ +
                                    glossy_rays + map_rays)},
                    {"lines", number(counts.lines)},
                    {"fragments", number(counts.nodes)},
                    {"passes", number(counts.passes)},
                    {"overflow", number(counts.dropped)},
                    {"texels", number(atlas_->texels().size())},
                    {"charts", number(atlas_->charts().size())},
                    {"split_charts", number(atlas_->split_charts())},
                    {"texels_per_m", atlas_->layout().texels_per_m},
                    {"receivers", number(counts.exchange.receivers)},
                    {"pairs", number(counts.exchange.pairs)},
                    {"lit_pairs", number(counts.exchange.lit_pairs)},
                    {"unmatched_texels", number(counts.exchange.unmatched)},
                    {"atlas_shadow_rays", number(shadow_rays_)},
                    {"atlas_bytes", number(atlas_->memory_bytes() + transport_->memory_bytes())},
                    {"samples", number(directions)}};
  const std::vector<double> by_reflections = transport_->light_by_reflections();
  for (std::size_t k = 0; k < by_reflections.size(); ++k) {
    frame.counters.push_back({fmt::format("reflected_{}", k), by_reflections[k]});
  }
}

std::unique_ptr<Renderer> create(const base::Parameters& parameters, const Devices& devices) {
  return std::make_unique<RayBundlesRenderer>(parameters, devices);
}

}  // namespace

RendererInfo renderer_info() {
  RendererInfo info;
  info.name = "ray-bundles";
  info.summary =
      "Diffuse interreflections in a texture atlas by bundles of parallel lines through the scene.";
  info.source = "Hermes, Henrich, Grosch, Mueller 2010, doi:10.2312/PE/VMV/VMV10/065-072";
  info.claims = [](const base::Parameters& parameters, const scene::Scene&) {
    return claims_of(parameters);
  };
  info.possible_claims = {{Transport::direct, Part::all, std::nullopt},
                          {Transport::diffuse, Part::all, std::nullopt},
                          {Transport::diffuse, Part::indirect, std::nullopt},
                          {Transport::full, Part::all, std::nullopt},
                          {Transport::full, Part::indirect, std::nullopt}};
  info.supports = {Feature::point_light,      Feature::spot_light,  Feature::area_light,
                   Feature::emission_profile, Feature::environment, Feature::texture,
                   Feature::glossy,           Feature::animation};
  // A sequence keeps its directions, and its solution where the camera alone moves.
  info.version = 2;
  info.progressive_unit = "directions";
  info.uses_seed = true;
  info.parameters = parameter_specs();
  info.presets = presets();
  info.create = create;
  return info;
}

}  // namespace renderers::ray_bundles
