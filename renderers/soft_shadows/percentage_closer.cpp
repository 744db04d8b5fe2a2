#include "renderers/soft_shadows/percentage_closer.h"

#include <algorithm>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "perception/base/errors.h"

namespace renderers::soft_shadows {

namespace {

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

float MappedLight::visible_share(const glm::vec3& position, const glm::vec3& normal,
                                 const PcssSettings& settings) const {
  const glm::vec3 own(glm::dot(normal, flat.tangent), glm::dot(normal, flat.bitangent),
                      glm::dot(normal, flat.normal));
  return soft_shadows::visible_share(map, flat.width_m, flat.to_light(position), own, settings);
}

std::vector<MappedLight> map_lights(const ray_tracing::RayScene& rays,
                                    std::span<const ray_tracing::LightPointSet> lights,
                                    int map_px) {
  const double bytes =
      static_cast<double>(lights.size()) * map_px * map_px * static_cast<double>(sizeof(float));
  if (bytes > kMostMapBytes) {
    throw base::InputError(fmt::format(
        "pcss: maps of {} lights with map_px {} take {:.1f} GiB; accepted: at most {:.0f} GiB, "
        "lower "
        "map_px",
        lights.size(), map_px, bytes / kGibibyte, kMostMapBytes / kGibibyte));
  }
  std::vector<MappedLight> mapped;
  for (const ray_tracing::LightPointSet& points : lights) {
    const FlatLight flat = flat_light(points);
    mapped.push_back({&points, flat, LightDepthMap(rays, flat, map_px)});
  }
  return mapped;
}

}  // namespace renderers::soft_shadows
