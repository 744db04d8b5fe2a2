#pragma once

#include <cstdint>
#include <vector>

#include "renderers/indirect_view/hemisphere_rays.h"
#include "renderers/indirect_view/indirect_light.h"
#include "renderers/photon_map/photon_tree.h"
#include "renderers/ray_tracing/light_sampler.h"

namespace renderers::photon_map {

enum class Kernel {
  none,  ///< every photon counts alike
  cone   ///< less with the distance
};

struct DensitySettings {
  int nearest = 100;  ///< photons of an estimate, >= 2
  float most_radius_m = 0.0F;
  Kernel kernel = Kernel::cone;
  Neighbours neighbours = Neighbours::same_surface;
};

/// Irradiance of the photons at a point, W/m2: the sum of w Phi over pi r^2, r the distance of the
/// outermost photon or the greatest radius.
///
/// Source: Jensen 1996, Eqs. 5 to 8 (density estimate; cone filter w = 1 - d / (k r), normalised by
/// 1 - 2 / (3 k), k = 1.1; numbers recalled). Differs from the paper: the outermost photon sets the
/// radius and is not counted itself, which takes the bias n / (n - 1) away.
/// @param found  scratch
glm::vec3 photon_irradiance(const PhotonTree& tree, const DensitySettings& settings,
                            const glm::vec3& position, const glm::vec3& normal,
                            std::vector<NearPhoton>& found);

/// Irradiances worked out beforehand, in a tree of their own; each place's `power` is its
/// irradiance, W/m2.
///
/// Source: Christensen 1999, "Faster Photon Map Global Illumination", JGT 4(3), Sec. 3. Differs
/// from the paper: the places are not the map's own photons. An estimate at a photon counts the
/// photon itself and is too bright; without it, those with the emptiest surroundings would be the
/// darkest and the nearest to most points. Places that know nothing of the photons have neither
/// bias.
/// @param places  photons traced with other random numbers, whose power is not read
PhotonTree irradiance_tree(const PhotonTree& photons, const DensitySettings& settings,
                           std::vector<Photon> places);

struct PhotonLightSettings {
  DensitySettings density;
  indirect_view::HemisphereRays gather;
  /// Hits of gather rays nearer than this are lit by a sample on the lights and one further ray
  /// instead of by photons.
  float near_m = 0.0F;
};

/// Indirect light by a final gather into a photon map.
///
/// Source: Jensen 1996, Sec. 3 (indirect light of the surface seen by rays into the global map);
/// Jensen 2001, "Realistic Image Synthesis Using Photon Mapping" (a further ray where a gather ray
/// ends nearby; recalled).
class PhotonLight final : public indirect_view::IndirectLight {
 public:
  /// @param rays, photons  must live as long as this
  /// @param irradiances    of `irradiance_tree`, or null: density estimates at every hit
  PhotonLight(const ray_tracing::RayScene& rays, const PhotonTree& photons,
              const PhotonTree* irradiances, const PhotonLightSettings& settings);

  glm::vec3 irradiance(const indirect_view::ViewedPoint& point, std::uint64_t& rays) const override;
  glm::vec3 reflected(const indirect_view::ViewedPoint& point, std::uint64_t& rays) const override;

 private:
  glm::vec3 at_photons(const indirect_view::ViewedPoint& point) const;
  glm::vec3 further(const indirect_view::ViewedPoint& point, std::uint64_t& cast) const;

  const ray_tracing::RayScene& rays_;
  const PhotonTree& photons_;
  const PhotonTree* irradiances_;
  PhotonLightSettings settings_;
  ray_tracing::LightSampler lights_;
};

}  // namespace renderers::photon_map
