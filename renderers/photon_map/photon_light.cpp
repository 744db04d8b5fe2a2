#include "renderers/photon_map/photon_light.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <glm/geometric.hpp>

#include "perception/base/parallel.h"
#include "renderers/indirect_view/sampled_light.h"
#include "renderers/ray_tracing/direction_sampling.h"
#include "renderers/ray_tracing/sample_sequence.h"

namespace renderers::photon_map {

namespace {

using indirect_view::ViewedPoint;
using ray_tracing::kPi;

/// k of the cone filter.
constexpr float kCone = 1.1F;
constexpr std::size_t kPhotonGrain = 256;

}  // namespace

glm::vec3 photon_irradiance(const PhotonTree& tree, const DensitySettings& settings,
                            const glm::vec3& position, const glm::vec3& normal,
                            std::vector<NearPhoton>& found) {
  tree.nearest({position, normal, settings.nearest, settings.most_radius_m, settings.neighbours},
               found);
  if (found.empty()) return glm::vec3(0.0F);
  float radius2_m2 = settings.most_radius_m * settings.most_radius_m;
  const bool is_full = found.size() == static_cast<std::size_t>(settings.nearest);
  if (is_full) {
    const auto outermost = std::ranges::max_element(
        found, {}, [](const NearPhoton& photon) { return photon.distance2_m2; });
    radius2_m2 = outermost->distance2_m2;
    found.erase(outermost);
  }
  if (radius2_m2 <= 0.0F) return glm::vec3(0.0F);
  const float radius_m = std::sqrt(radius2_m2);
  glm::vec3 sum(0.0F);
  for (const NearPhoton& photon : found) {
    const float weight = settings.kernel == Kernel::cone
                             ? 1.0F - std::sqrt(photon.distance2_m2) / (kCone * radius_m)
                             : 1.0F;
    sum += weight * tree.at(photon.index).power;
  }
  const float norm = settings.kernel == Kernel::cone ? 1.0F - 2.0F / (3.0F * kCone) : 1.0F;
  return sum / (norm * kPi * radius2_m2);
}

PhotonTree irradiance_tree(const PhotonTree& photons, const DensitySettings& settings,
                           std::vector<Photon> places) {
  base::parallel_for(places.size(), kPhotonGrain, [&](std::size_t begin, std::size_t end) {
    std::vector<NearPhoton> found;
    for (std::size_t i = begin; i < end; ++i) {
      places[i].power =
          photon_irradiance(photons, settings, places[i].position, places[i].normal, found);
    }
  });
  return PhotonTree(std::move(places));
}

PhotonLight::PhotonLight(const ray_tracing::RayScene& rays, const PhotonTree& photons,
                         const PhotonTree* irradiances, const PhotonLightSettings& settings)
    : rays_(rays),
      photons_(photons),
      irradiances_(irradiances),
      settings_(settings),
      lights_(rays) {}

glm::vec3 PhotonLight::at_photons(const ViewedPoint& point) const {
  static thread_local std::vector<NearPhoton> found;
  const DensitySettings& density = settings_.density;
  const glm::vec3& position = point.surface.position;
  if (irradiances_ == nullptr) {
    return photon_irradiance(photons_, density, position, point.geometric_normal, found);
  }
  irradiances_->nearest(
      {position, point.geometric_normal, 1, density.most_radius_m, density.neighbours}, found);
  return found.empty() ? glm::vec3(0.0F) : irradiances_->at(found.front().index).power;
}

glm::vec3 PhotonLight::reflected(const ViewedPoint& point, std::uint64_t&) const {
  return reflectance_of(rays_, point) * at_photons(point);
}

glm::vec3 PhotonLight::irradiance(const ViewedPoint& point, std::uint64_t& rays) const {
  return gather_irradiance(
      rays_, point, settings_.gather,
      [&](const ViewedPoint& seen, float distance_m) {
        return distance_m < settings_.near_m ? further(seen, rays) : reflected(seen, rays);
      },
      rays);
}

/// Radiance by a sample on the lights and one cosine-distributed ray to surfaces with photons.
glm::vec3 PhotonLight::further(const ViewedPoint& point, std::uint64_t& cast) const {
  const glm::vec3 reflectance = reflectance_of(rays_, point);
  if (reflectance == glm::vec3(0.0F)) return glm::vec3(0.0F);
  ray_tracing::SampleSequence numbers(ray_tracing::SequenceKind::random, point.seed, point.index);
  const glm::vec4 u = numbers.next();
  glm::vec3 irradiance = sampled_light(rays_, lights_, point, glm::vec3(u), cast);
  const indirect_view::HemisphereRays one{1, indirect_view::HemisphereSequence::random};
  irradiance += gather_irradiance(
      rays_, point, one, [&](const ViewedPoint& seen, float) { return reflected(seen, cast); },
      cast);
  return reflectance * irradiance;
}

}  // namespace renderers::photon_map
