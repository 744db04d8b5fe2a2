#include "renderers/clustered_visibility/clustered_visibility_renderer.h"

#include <algorithm>
#include <cassert>
#include <memory>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

#include "perception/base/parallel.h"
#include "renderers/clustered_visibility/clipped_surfaces.h"
#include "renderers/clustered_visibility/cluster_images.h"
#include "renderers/clustered_visibility/cluster_statistics.h"
#include "renderers/clustered_visibility/clustered_picture.h"
#include "renderers/clustered_visibility/clustered_visibility_settings.h"
#include "renderers/many_lights/direct_part.h"
#include "renderers/ray_tracing/ray_scene.h"
#include "renderers/ray_tracing/sample_sequence.h"

namespace renderers::clustered_visibility {

namespace {

using perception::Image;

/// The colours of an rgba32f texture's texels.
Image image_of(const std::vector<float>& rgba, const RenderJob& job) {
  Image image =
      perception::make_rgb_image(job.width_px, job.height_px, perception::Encoding::scene_linear);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = rgba[i / 3 * 4 + i % 3];
  return image;
}

Image image_of(const std::vector<glm::vec4>& values, const RenderJob& job) {
  Image image =
      perception::make_rgb_image(job.width_px, job.height_px, perception::Encoding::scene_linear);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    image.pixels[i] = values[i / 3][static_cast<glm::length_t>(i % 3)];
  }
  return image;
}

/// A set of virtual lights.
struct SetTotals {
  double lights = 0.0;  ///< that have flux
  double flux_w = 0.0;  ///< luminance of their sum
};

SetTotals totals_of(const std::vector<many_lights::VirtualLight>& lights) {
  SetTotals totals;
  for (const auto& light : lights) {
    totals.lights += light.position.w > 0.0F ? 1.0 : 0.0;
    totals.flux_w += many_lights::luminance(glm::dvec3(light.flux));
  }
  return totals;
}

class ClusteredVisibilityRenderer final : public Renderer {
 public:
  ClusteredVisibilityRenderer(const base::Parameters& parameters, const Devices& devices)
      : settings_(settings_of(parameters)), devices_(devices) {}

  void prepare(const scene::Scene& scene, StageTimer& timer) override {
    // A cold start knows no earlier clusters.
    if (picture_) picture_->restart();
    before_.reset();
    load(scene, "build", timer);
  }
  void update(const scene::Scene& scene, StageTimer& timer) override {
    load(scene, "scene_update", timer);
  }
  Frame render(const RenderJob& job, StageTimer& timer) override;

 private:
  void load(const scene::Scene& scene, const char* stage_name, StageTimer& timer);
  Image direct_light(const RenderJob& job, StageTimer& timer);
  ClusterState read_state() const;
  void add_images(const RenderJob& job, const ClusterState& state, Frame& frame);
  void add_shown_lights(const RenderJob& job, const ClusterState& state, Frame& frame);
  void add_counters(const ClusterState& state, Frame& frame) const;
  void add_bounces(const ClusterState& state, Frame& frame) const;
  void add_growth(Frame& frame) const;
  void add_notes(const ClusterState& state, Frame& frame) const;

  Settings settings_;
  Devices devices_;
  std::shared_ptr<opengl::Context> context_;
  std::optional<ClusteredPicture> picture_;
  const scene::Scene* scene_ = nullptr;
  double clamp_ = 0.0;
  std::unique_ptr<ray_tracing::RayScene> rays_;
  std::uint64_t direct_rays_ = 0;
  std::optional<ClusterState> before_;  ///< of the frame before, for counters alone
  bool is_new_state_ = false;           ///< the scene's state has not been pictured yet
};

void ClusteredVisibilityRenderer::load(const scene::Scene& scene, const char* stage_name,
                                       StageTimer& timer) {
  const base::ThreadLimit limit(devices_.threads);
  if (!context_) context_ = opengl::Context::of(devices_);
  scene_ = &scene;
  {
    const auto stage = timer.stage(stage_name);
    if (!picture_) picture_.emplace(context_, settings_);
    clamp_ = many_lights::geometry_clamp_of(settings_, scene);
    picture_->load(scene, timer);
    if (settings_.needs_rays()) rays_ = std::make_unique<ray_tracing::RayScene>(scene, timer);
  }
  picture_->make_lights(clamp_, rays_.get(), timer);
  is_new_state_ = true;
}

Frame ClusteredVisibilityRenderer::render(const RenderJob& job, StageTimer& timer) {
  assert(picture_);
  const base::ThreadLimit limit(devices_.threads);
  picture_->draw(job, clamp_, rays_.get(), timer);
  Image direct;
  if (settings_.part == Part::all) direct = direct_light(job, timer);
  Frame frame;
  Image indirect;
  {
    const auto stage = timer.stage("readback");
    indirect = image_of(picture_->read_radiance(), job);
  }
  frame.radiance = indirect;
  if (!direct.is_empty()) {
    const auto stage = timer.stage("transport");
    for (std::size_t i = 0; i < direct.pixels.size(); ++i) {
      frame.radiance.pixels[i] += direct.pixels[i];
    }
  }
  const auto stage = timer.stage("readback");
  if (!direct.is_empty()) frame.aovs.push_back({"direct", std::move(direct)});
  frame.aovs.push_back({"indirect", std::move(indirect)});
  ClusterState state = read_state();
  add_images(job, state, frame);
  add_counters(state, frame);
  add_notes(state, frame);
  if (is_new_state_) before_ = std::move(state);
  is_new_state_ = false;
  frame.device = context_->facts().renderer;
  frame.gl_platform = opengl::to_string(context_->platform());
  return frame;
}

Image ClusteredVisibilityRenderer::direct_light(const RenderJob& job, StageTimer& timer) {
  const auto stage = timer.stage("transport");
  const auto inner = timer.stage("direct");
  Image direct;
  const std::uint64_t seed =
      ray_tracing::hash_combine(job.seed, static_cast<std::uint64_t>(job.frame_index));
  direct_rays_ = many_lights::add_direct_light(*rays_, job, settings_, {.seed = seed}, direct);
  return direct;
}

ClusterState ClusteredVisibilityRenderer::read_state() const {
  ClusterState state;
  state.lights = picture_->generator().lights().read<many_lights::VirtualLight>(
      static_cast<std::size_t>(settings_.virtual_lights));
  const LightClusters& clusters = picture_->lights().clusters();
  state.assignments = clusters.read_assignments();
  state.area_lights = clusters.read_area_lights();
  state.summary = clusters.read_summary();
  return state;
}

void ClusteredVisibilityRenderer::add_images(const RenderJob& job, const ClusterState& state,
                                             Frame& frame) {
  const many_lights::SurfaceImage& surfaces = picture_->surfaces();
  frame.aovs.push_back({"irradiance", image_of(picture_->read_irradiance(), job)});
  frame.aovs.push_back({"albedo", image_of(surfaces.albedo, job)});
  frame.aovs.push_back({"normal", image_of(surfaces.shading_normal, job)});
  if (settings_.shows_lights) {
    const float diagonal_m = picture_->scene().bounds().diagonal_m();
    const opengl::View view = opengl::camera_view(job.camera, job.width_px, job.height_px);
    frame.aovs.push_back(
        {"clusters", cluster_image(state, settings_.clusters, surfaces, diagonal_m)});
    frame.aovs.push_back({"vpls", light_image(state, view, surfaces, diagonal_m)});
    frame.aovs.push_back({"light_count", light_count_image(state, settings_.interleave, surfaces)});
  }
  if (settings_.shown_vals > 0 && settings_.has_maps()) add_shown_lights(job, state, frame);
}

void ClusteredVisibilityRenderer::add_shown_lights(const RenderJob& job, const ClusterState& state,
                                                   Frame& frame) {
  std::vector<int> order(state.area_lights.size());
  std::iota(order.begin(), order.end(), 0);
  const auto power = [&](int cluster) {
    return many_lights::luminance(
        glm::dvec3(state.area_lights[static_cast<std::size_t>(cluster)].flux));
  };
  std::ranges::stable_sort(order, [&](int a, int b) { return power(a) > power(b); });
  const auto count = std::min(order.size(), static_cast<std::size_t>(settings_.shown_vals));
  const opengl::Texture shown(context_, {.format = opengl::TextureFormat::rgba32f,
                                         .width_px = job.width_px,
                                         .height_px = job.height_px});
  for (std::size_t i = 0; i < count; ++i) {
    show_visibility(picture_->geometry(), order[i], settings_.area, picture_->lights().shadows(),
                    shown);
    frame.aovs.push_back({"val_" + std::to_string(i), image_of(shown.read(), job)});
  }
}

void ClusteredVisibilityRenderer::add_counters(const ClusterState& state, Frame& frame) const {
  const int clusters = picture_->lights().clusters().used_clusters();
  const double side_px = settings_.shadow_map_px;
  const OracleRays& oracle = picture_->oracle_rays();
  frame.counters = cluster_counters(state, settings_.interleave);
  const auto maps = settings_.has_maps() ? double{1.0} * clusters * settings_.bounces : 0.0;
  const auto valid = std::ranges::count_if(state.assignments, [](auto c) { return c >= 0; });
  const std::pair<const char*, double> numbers[]{
      {"vpls", settings_.virtual_lights},
      {"valid_vpls", static_cast<double>(valid)},
      {"emitters", static_cast<double>(picture_->generator().emitters().size())},
      {"shadow_maps", maps},
      {"shadow_texels", maps * side_px * side_px},
      {"shadow_triangles", maps * picture_->lights().filler().triangle_count(picture_->scene())},
      {"shadow_draws",
       static_cast<double>(picture_->lights().filler().draw_count(static_cast<int>(maps)))},
      {"layer_bytes",
       static_cast<double>(picture_->lights().layer_bytes() + picture_->bounces().layer_bytes())},
      {"distance_bytes", static_cast<double>(picture_->lights().distance_bytes())},
      {"device_bytes", static_cast<double>(picture_->memory_bytes())},
      {"rays", static_cast<double>(oracle.traced + direct_rays_)},
      {"visibility_rays", static_cast<double>(oracle.traced)},
      {"occluded_rays", static_cast<double>(oracle.occluded)},
      {"triangles", static_cast<double>(picture_->scene().triangle_count())}};
  for (const auto& [name, value] : numbers) frame.counters.emplace_back(name, value);
  if (settings_.has_maps()) {
    const ClippedSurfaces clipped =
        clipped_surfaces(*scene_, state.area_lights, picture_->lights().shadows().maps.near_m());
    frame.counters.emplace_back("clipped_triangles", static_cast<double>(clipped.triangles));
    frame.counters.emplace_back("clipped_share", clipped.hemisphere_share);
  }
  if (settings_.growth.is_on) add_growth(frame);
  if (settings_.bounces > 1) add_bounces(state, frame);
  if (!is_new_state_ || !before_) return;
  for (auto& change :
       change_counters(*before_, state, double{picture_->scene().bounds().diagonal_m()})) {
    frame.counters.push_back(std::move(change));
  }
}

void ClusteredVisibilityRenderer::add_bounces(const ClusterState& state, Frame& frame) const {
  std::vector<SetTotals> sets{totals_of(state.lights)};
  const LightBounces& bounces = picture_->bounces();
  for (std::size_t i = 0; i < bounces.count(); ++i) {
    sets.push_back(totals_of(bounces.set(i).lights->read<many_lights::VirtualLight>(
        static_cast<std::size_t>(settings_.virtual_lights))));
  }
  std::vector<double> flux_w;
  std::vector<double> lights;
  for (const SetTotals& set : sets) {
    flux_w.push_back(set.flux_w);
    lights.push_back(set.lights);
  }
  frame.counters.emplace_back("bounce_flux_w", std::move(flux_w));
  frame.counters.emplace_back("bounce_vpls", std::move(lights));
}

void ClusteredVisibilityRenderer::add_growth(Frame& frame) const {
  std::vector<double> clusters;
  std::vector<double> shares;
  for (const GrowthStep& step : picture_->growth().steps()) {
    clusters.push_back(step.clusters);
    shares.push_back(step.visible_share);
  }
  frame.counters.emplace_back("growth_vals", std::move(clusters));
  frame.counters.emplace_back("growth_visible_share", std::move(shares));
}

void ClusteredVisibilityRenderer::add_notes(const ClusterState& state, Frame& frame) const {
  const int asked = picture_->lights().clusters().used_clusters();
  if (std::ranges::all_of(state.assignments, [](auto c) { return c < 0; })) {
    frame.notes.push_back("no light reaches a surface: no indirect light");
  } else if (state.summary.filled < asked) {
    frame.notes.push_back(std::to_string(asked - state.summary.filled) + " of " +
                          std::to_string(asked) + " area lights have no light");
  }
  if (is_in_one_plane(state, double{picture_->scene().bounds().diagonal_m()})) {
    frame.notes.push_back("all virtual lights lie in one plane");
  }
  if (settings_.clips_more && settings_.has_maps()) {
    frame.notes.push_back(
        "maps of depth=vertex leave out all surfaces below their clip heights, not only backs");
  }
  const int left_out = picture_->generator().emitters_left_out();
  if (left_out > 0) {
    frame.notes.push_back(std::to_string(left_out) +
                          " sources of light got no virtual light: there are more than vpls");
  }
}

std::unique_ptr<Renderer> create(const base::Parameters& parameters, const Devices& devices) {
  return std::make_unique<ClusteredVisibilityRenderer>(parameters, devices);
}

}  // namespace

RendererInfo renderer_info() {
  RendererInfo info;
  info.name = "clustered-visibility";
  info.summary =
      "Diffuse bounces of light from virtual point lights that see the scene through few area "
      "lights.";
  info.source =
      "Dong et al. 2009, \"Real-time Indirect Illumination with Clustered Visibility\", VMV";
  info.claims = claims_of;
  info.possible_claims = {{Transport::one_bounce, Part::all, std::nullopt},
                          {Transport::one_bounce, Part::indirect, std::nullopt},
                          {Transport::diffuse, Part::all, std::nullopt},
                          {Transport::diffuse, Part::indirect, std::nullopt}};
  info.supports = {Feature::point_light, Feature::spot_light, Feature::area_light,
                   Feature::environment, Feature::texture,    Feature::glossy,
                   Feature::animation};
  info.uses_seed = true;
  info.history = true;
  info.parameters = parameter_specs();
  info.presets = presets();
  info.create = create;
  return info;
}

}  // namespace renderers::clustered_visibility
