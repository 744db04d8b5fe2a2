#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "renderers/ray_bundles/light_solution.h"
#include "renderers/ray_tracing/light_sampler.h"
#include "renderers/ray_tracing/ray_scene.h"
#include "renderers/texel_atlas/texel_atlas.h"

namespace renderers::ray_bundles {

/// The second atlas of the paper: what glossy lobes send along the next bundle.
///
/// While a bundle along w brings light to a side, its lobe is evaluated towards the sense of the
/// next bundle's direction that leaves the side, and what comes of it,
///
///   G = 2 pi f(d, o) |n . w| L,
///
/// is its glossy radiance in the next bundle (d and o: from the side to where light comes from, and
/// to where it goes). G is one sample of one direction: written anew each time, never averaged, 0
/// where the bundle missed the texel. So lobes follow each other along paths of any length.
/// Light of point and spot lights, which no bundle meets, is added with known visibility.
///
/// Source: Hermes et al. 2010, Sec. 5.4 and Eq. 4, whose constant 2 pi is ours, as in Eq. 3: one
/// such factor for each bounce. Its mean is right if successive directions are independent; raw
/// Halton points are not.
class GlossyTransfer {
 public:
  /// @param rays, atlas  must live as long as this
  GlossyTransfer(const ray_tracing::RayScene& rays, const texel_atlas::TexelAtlas& atlas,
                 bool has_back_sides);

  /// True if no surface has a lobe.
  bool is_empty() const { return lobes_.empty(); }
  std::uint64_t shadow_rays() const { return shadow_rays_; }

  /// Before the samples of a bundle along `direction`, unit length as is `next`.
  void begin_direction(const glm::vec3& direction, const glm::vec3& next);
  /// From any thread; each texel once per direction. @param sample  sums weighted by |n . w|
  void receive(std::uint32_t texel, const TexelSample& sample);
  /// What was received is what lobes send from here on.
  void end_direction();
  /// Adds it to what sides send. @param sent  per side
  void add_to(std::vector<glm::vec3>& sent) const;
  /// Of a side, along the direction at hand.
  glm::vec3 radiance(std::uint32_t side) const;

 private:
  /// Light of a point or spot light at a side.
  struct KnownLight {
    std::uint32_t side = 0;      ///< texel_atlas::Side
    glm::vec3 direction{0.0F};   ///< to the light
    glm::vec3 irradiance{0.0F};  ///< W/m2, on the shading normal's plane
  };
  /// A texel with a lobe.
  struct Lobe {
    std::uint32_t texel = 0;
    glm::vec3 geometric_normal{0.0F};
    glm::vec3 shading_normal{0.0F};
    scene::GlossyLobe shape;
    std::vector<KnownLight> known;
  };
  void find_known_light(const ray_tracing::RayScene& rays, const ray_tracing::LightSampler& lights,
                        const ray_tracing::SurfacePoint& point);
  glm::vec3 lobe_value(const Lobe& lobe, std::uint32_t side, const glm::vec3& to_light) const;

  static constexpr std::uint32_t kNoLobe = 0xffffffffU;
  bool has_back_sides_;
  std::vector<Lobe> lobes_;
  std::vector<std::uint32_t> lobe_of_;  ///< per texel
  std::vector<glm::vec3> sent_;         ///< per lobe and side
  std::vector<glm::vec3> next_sent_;
  glm::vec3 direction_{0.0F, 0.0F, 1.0F};
  glm::vec3 next_{0.0F, 0.0F, 1.0F};
  std::uint64_t shadow_rays_ = 0;
};

}  // namespace renderers::ray_bundles
