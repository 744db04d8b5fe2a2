#include "renderers/photon_map/photon_map_renderer.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include <glm/geometric.hpp>

#include "perception/base/parallel.h"
#include "renderers/contract/frame_counters.h"
#include "renderers/indirect_view/indirect_view.h"
#include "renderers/photon_map/photon_map_settings.h"
#include "renderers/ray_tracing/direction_sampling.h"
#include "renderers/ray_tracing/sample_sequence.h"

namespace renderers::photon_map {

namespace {

/// Keeps the photons at whose places irradiances are worked out apart from those of the map.
constexpr std::uint64_t kPlacesKey = 21;

/// Photons of one seed, ready to be asked.
struct PhotonMap {
  std::uint64_t seed = 0;
  std::uint64_t rays = 0;  ///< of the photons and of the irradiances' places
  std::uint64_t escaped = 0;
  PhotonTree photons;
  std::optional<PhotonTree> irradiances;

  std::int64_t memory_bytes() const {
    return photons.memory_bytes() + (irradiances ? irradiances->memory_bytes() : 0);
  }
};

class PhotonMapRenderer final : public Renderer {
 public:
  PhotonMapRenderer(const base::Parameters& parameters, const Devices& devices)
      : settings_(settings_of(parameters)), devices_(devices) {}

  void prepare(const scene::Scene& scene, StageTimer& timer) override;
  Frame render(const RenderJob& job, StageTimer& timer) override;

 private:
  bool make_map(std::uint64_t seed, StageTimer& timer);
  float mean_radius_m() const;
  void add_counters(Frame& frame) const;

  Settings settings_;
  Devices devices_;
  DensitySettings density_;
  double area_m2_ = 0.0;
  // Each refers to those before it.
  std::unique_ptr<ray_tracing::RayScene> rays_;
  std::unique_ptr<PhotonEmission> emission_;
  std::unique_ptr<PhotonMap> map_;
};

void PhotonMapRenderer::prepare(const scene::Scene& scene, StageTimer& timer) {
  const base::ThreadLimit limit(devices_.threads);
  map_.reset();
  emission_.reset();
  {
    const auto stage = timer.stage("build");
    rays_ = std::make_unique<ray_tracing::RayScene>(scene, timer);
  }
  const auto stage = timer.stage("lights");
  emission_ = std::make_unique<PhotonEmission>(*rays_);
  area_m2_ = 0.0;
  for (std::uint32_t object = 0; object < scene.objects.size(); ++object) {
    const auto count = static_cast<std::uint32_t>(scene.objects[object].mesh->triangles.size());
    for (std::uint32_t triangle = 0; triangle < count; ++triangle) {
      area_m2_ += static_cast<double>(rays_->triangle_area_m2(object, triangle));
    }
  }
  density_ = settings_.density;
  if (rays_->triangle_count() > 0) {
    density_.most_radius_m = static_cast<float>(settings_.most_radius) *
                             glm::distance(rays_->box_min(), rays_->box_max());
  }
}

/// Photons do not depend on the camera: another view keeps them.
/// @return true if photons were traced
bool PhotonMapRenderer::make_map(std::uint64_t seed, StageTimer& timer) {
  if (emission_->is_empty() || (map_ && map_->seed == seed)) return false;
  map_.reset();
  PhotonTracingSettings tracing = settings_.tracing;
  tracing.seed = seed;
  const auto stage = timer.stage("lights");
  PhotonPaths paths;
  {
    const auto inner = timer.stage("photons");
    paths = trace_photons(*rays_, *emission_, tracing);
  }
  {
    const auto inner = timer.stage("tree");
    map_ = std::make_unique<PhotonMap>(PhotonMap{
        seed, paths.rays, paths.escaped, PhotonTree(std::move(paths.photons)), std::nullopt});
  }
  if (settings_.precompute_every == 0) return true;
  const auto inner = timer.stage("irradiances");
  tracing.seed = ray_tracing::hash_combine(seed, kPlacesKey);
  tracing.photons = std::max<std::int64_t>(1, tracing.photons / settings_.precompute_every);
  PhotonPaths places = trace_photons(*rays_, *emission_, tracing);
  map_->rays += places.rays;
  map_->irradiances = irradiance_tree(map_->photons, density_, std::move(places.photons));
  return true;
}

/// Radius of a disk that holds the photons of an estimate if all surfaces were lit alike.
float PhotonMapRenderer::mean_radius_m() const {
  if (map_->photons.size() == 0) return 0.0F;
  const double photons_per_m2 = static_cast<double>(map_->photons.size()) / area_m2_;
  return static_cast<float>(
      std::sqrt(density_.nearest / (static_cast<double>(ray_tracing::kPi) * photons_per_m2)));
}

Frame PhotonMapRenderer::render(const RenderJob& job, StageTimer& timer) {
  assert(rays_ && emission_);
  const double start_s = steady_seconds();
  const base::ThreadLimit limit(devices_.threads);
  const bool is_new_map = make_map(indirect_view::seed_of(job), timer);
  std::unique_ptr<PhotonLight> light;
  if (map_) {
    PhotonLightSettings settings{density_, settings_.gather, 0.0F};
    settings.near_m = static_cast<float>(settings_.near_radii) * mean_radius_m();
    light = std::make_unique<PhotonLight>(
        *rays_, map_->photons, map_->irradiances ? &*map_->irradiances : nullptr, settings);
  }
  Frame frame =
      indirect_view::render_view({*rays_, light.get(), settings_.view, start_s}, job, timer);
  add_counters(frame);
  if (is_new_map) add_to_counter("rays", static_cast<double>(map_->rays), frame);
  return frame;
}

void PhotonMapRenderer::add_counters(Frame& frame) const {
  const auto number = [](auto value) { return static_cast<double>(value); };
  const bool has_map = map_ != nullptr;
  frame.counters.emplace_back("photons", has_map ? number(settings_.tracing.photons) : 0.0);
  frame.counters.emplace_back("photons_stored", has_map ? number(map_->photons.size()) : 0.0);
  frame.counters.emplace_back("photon_rays", has_map ? number(map_->rays) : 0.0);
  frame.counters.emplace_back("photons_escaped", has_map ? number(map_->escaped) : 0.0);
  frame.counters.emplace_back("photon_bytes", has_map ? number(map_->memory_bytes()) : 0.0);
  frame.counters.emplace_back("mean_radius_m", has_map ? number(mean_radius_m()) : 0.0);
}

std::unique_ptr<Renderer> create(const base::Parameters& parameters, const Devices& devices) {
  return std::make_unique<PhotonMapRenderer>(parameters, devices);
}

}  // namespace

RendererInfo renderer_info() {
  RendererInfo info = indirect_view::view_info();
  info.name = "photon-map";
  info.summary = "Photons from the lights in a kd-tree, and a final gather of rays into them.";
  info.source =
      "Jensen 1996, doi:10.1007/978-3-7091-7484-5_3; Christensen 1999, JGT 4(3) (irradiances "
      "beforehand)";
  info.parameters = parameter_specs();
  info.presets = presets();
  info.create = create;
  return info;
}

}  // namespace renderers::photon_map
