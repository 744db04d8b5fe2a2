#include "renderers/area_shadows/pcss_shadows.h"

#include <algorithm>
#include <atomic>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "perception/base/errors.h"
#include "perception/base/parallel.h"
#include "renderers/area_shadows/screen_shadows_renderer.h"
#include "renderers/area_shadows/shadow_tracer.h"

namespace renderers::area_shadows {

namespace {

constexpr std::size_t kPixelGrain = 64;
constexpr double kGibibyte = 1024.0 * 1024.0 * 1024.0;
/// Of the maps of all lights together; ours.
constexpr double kMostMapBytes = 4.0 * kGibibyte;

/// Samples about a receiver, as the light's centre sees them.
class Receiver {
 public:
  Receiver(const LightDepthMap& map, const glm::vec3& place, const glm::vec3& normal,
           const PcssSettings& settings)
      : map_(map), place_(place), normal_(normal), settings_(settings) {}

  struct Blockers {
    int samples = 0;
    int count = 0;
    float height_sum_m = 0.0F;
  };
  /// What is nearer to the light at the middles of side x side cells of a square.
  Blockers blockers(float width_m, int side) const {
    Blockers found;
    found.samples = side * side;
    for (int y = 0; y < side; ++y) {
      for (int x = 0; x < side; ++x) {
        const glm::vec2 cell(static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F);
        const glm::vec2 step = width_m * (cell / static_cast<float>(side) - 0.5F);
        const glm::vec3 sample = place_ + glm::vec3(step, 0.0F);
        const glm::vec3 surface = map_.surface_towards(sample);
        if (!hides(surface)) continue;
        ++found.count;
        found.height_sum_m += surface.z;
      }
    }
    return found;
  }

 private:
  /// Whether something that the light's centre sees can stand between light and receiver.
  bool hides(const glm::vec3& surface) const {
    const float margin_m = settings_.bias * place_.z;
    if (surface.z >= place_.z - margin_m) return false;
    if (!settings_.has_receiver_plane) return true;
    return glm::dot(normal_, surface - place_) > margin_m;
  }

  const LightDepthMap& map_;
  glm::vec3 place_;
  glm::vec3 normal_;
  const PcssSettings& settings_;
};

/// One light with its map.
struct MappedLight {
  const ray_tracing::LightPointSet& points;
  FlatLight flat;
  LightDepthMap map;
};

/// @throws base::InputError if the maps would take more than kMostMapBytes
std::vector<MappedLight> map_lights(const ShadowJob& job, const PcssSettings& settings) {
  const double bytes = static_cast<double>(job.lights.size()) * settings.map_px * settings.map_px *
                       static_cast<double>(sizeof(float));
  if (bytes > kMostMapBytes) {
    throw base::InputError(fmt::format(
        "pcss: maps of {} lights with map_px {} take {:.1f} GiB; accepted: at most {:.0f} GiB, "
        "lower "
        "map_px",
        job.lights.size(), settings.map_px, bytes / kGibibyte, kMostMapBytes / kGibibyte));
  }
  std::vector<MappedLight> lights;
  for (const auto& points : job.lights) {
    const FlatLight flat = flat_light(points);
    lights.push_back({points, flat, LightDepthMap(job.rays, flat, settings.map_px)});
  }
  return lights;
}

glm::vec3 irradiance_at(const std::vector<MappedLight>& lights,
                        const ray_tracing::Receiver& receiver, const PcssSettings& settings) {
  glm::vec3 sum(0.0F);
  for (const MappedLight& light : lights) {
    const glm::vec3 open = open_irradiance({&light.points, 1}, receiver);
    if (open == glm::vec3(0.0F)) continue;
    const FlatLight& flat = light.flat;
    const glm::vec3& world = receiver.geometric_normal;
    const glm::vec3 normal(glm::dot(world, flat.tangent), glm::dot(world, flat.bitangent),
                           glm::dot(world, flat.normal));
    sum += open * visible_share(light.map, flat.width_m, flat.to_light(receiver.position), normal,
                                settings);
  }
  return sum;
}

ShadowResult solve(const ShadowJob& job, const PcssSettings& settings, StageTimer& timer) {
  ShadowResult result;
  std::vector<MappedLight> lights;
  double bytes = 0.0;
  {
    auto stage = timer.stage("shadow");
    auto inner = timer.stage("maps");
    lights = map_lights(job, settings);
    for (const MappedLight& light : lights) {
      result.rays += static_cast<double>(light.map.ray_count());
      bytes += static_cast<double>(light.map.memory_bytes());
    }
    inner.add_bytes(static_cast<std::int64_t>(bytes));
  }
  const auto stage = timer.stage("gather");
  const auto inner = timer.stage("irradiance");
  result.irradiance.resize(job.surfaces.pixels.size());
  std::atomic<std::uint64_t> fragments = 0;
  base::parallel_for(
      result.irradiance.size(), kPixelGrain, [&](std::size_t begin, std::size_t end) {
        std::uint64_t own_fragments = 0;
        for (std::size_t pixel = begin; pixel < end; ++pixel) {
          const PixelSurface& surface = job.surfaces.pixels[pixel];
          if (!surface.is_surface()) continue;
          ++own_fragments;
          result.irradiance[pixel] = irradiance_at(lights, surface.receiver, settings);
        }
        fragments.fetch_add(own_fragments, std::memory_order_relaxed);
      });
  result.counters = {{"fragments", static_cast<double>(fragments)},
                     {"map_rays", result.rays},
                     {"map_bytes", bytes}};
  return result;
}

std::vector<base::ParameterSpec> parameter_specs() {
  return {
      base::integer_parameter("map_px", 1024, {16.0, 8192.0}, "texels",
                              "Along a side of each light's shadow map; ours."),
      base::integer_parameter("search_side", 6, {1.0, 64.0}, "samples",
                              "Blockers are searched for at the square of it; ours."),
      base::integer_parameter("filter_side", 8, {1.0, 64.0}, "samples",
                              "The filter takes the square of it; ours: as many samples as the "
                              "other techniques have points."),
      base::real_parameter("near_share", 0.2, {0.01, 1.0}, "",
                           "Nearest blocker that is looked for, by the receiver's height below the "
                           "light; the paper's is the map's near plane; ours."),
      base::real_parameter(
          "bias", 0.003, {0.0, 1.0}, "",
          "A blocker is nearer, and off the tangent plane, by that share of the height; ours."),
      base::boolean_parameter("receiver_plane", true,
                              "What lies behind the receiver's tangent plane hides nothing; ours."),
      base::integer_parameter("light_points", 64, {4.0, 256.0}, "points",
                              "Of each light, for its unoccluded irradiance and its width; a power "
                              "of two; as the others.")};
}

std::unique_ptr<Renderer> create(const base::Parameters& parameters, const Devices& devices) {
  const auto integer = [&](const char* name) { return static_cast<int>(parameters.integer(name)); };
  const auto real = [&](const char* name) { return static_cast<float>(parameters.real(name)); };
  check_power_of_two("pcss", "light_points", parameters.integer("light_points"));
  const PcssSettings settings{integer("map_px"),      integer("search_side"),
                              integer("filter_side"), real("near_share"),
                              real("bias"),           parameters.boolean("receiver_plane")};
  return make_screen_shadows_renderer(
      {integer("light_points"), ray_tracing::kGroupPoints},
      [settings](const ShadowJob& job, StageTimer& timer) { return solve(job, settings, timer); },
      devices);
}

}  // namespace

float visible_share(const LightDepthMap& map, float light_width_m, const glm::vec3& place,
                    const glm::vec3& normal, const PcssSettings& settings) {
  if (place.z <= 0.0F) return 1.0F;
  const Receiver receiver(map, place, normal, settings);
  // Blockers between the nearest height looked for and the receiver hide a part of the light.
  const float search_m = light_width_m * (1.0F - settings.near_share) / settings.near_share;
  const Receiver::Blockers search = receiver.blockers(search_m, settings.search_side);
  if (search.count == 0) return 1.0F;
  const float blocker_m = std::max(search.height_sum_m / static_cast<float>(search.count),
                                   settings.near_share * place.z);
  const float penumbra_m = light_width_m * std::max(place.z - blocker_m, 0.0F) / blocker_m;
  const Receiver::Blockers filter = receiver.blockers(penumbra_m, settings.filter_side);
  return 1.0F - static_cast<float>(filter.count) / static_cast<float>(filter.samples);
}

RendererInfo pcss_shadows_info() {
  RendererInfo info = screen_shadows_info();
  std::erase(info.supports, Feature::environment);
  info.name = "pcss";
  info.summary =
      "Direct light of area lights by percentage-closer soft shadows in a shadow map from each "
      "light's centre.";
  info.source = "Fernando 2005, doi:10.1145/1187112.1187153";
  info.parameters = parameter_specs();
  info.presets = {{"paper", {{"receiver_plane", base::ParameterValue(false)}}}, {"best", {}}};
  info.create = create;
  return info;
}

}  // namespace renderers::area_shadows
