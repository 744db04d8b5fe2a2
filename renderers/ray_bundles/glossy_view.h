#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "perception/image.h"
#include "renderers/contract/renderer.h"
#include "renderers/ray_bundles/light_solution.h"
#include "renderers/ray_bundles/radiance_exchange.h"
#include "renderers/ray_tracing/glossy_lobe.h"
#include "renderers/ray_tracing/ray_scene.h"
#include "renderers/texel_atlas/texel_atlas.h"

namespace renderers::ray_bundles {

/// What bundles bring to the lobes that the camera sees.
struct GlossyViewSettings {
  bool with_emission = false;  ///< of surfaces and environment
  bool with_diffuse = false;  ///< what Lambert lobes send; without it, rays along the lobe see that
};

/// The paper's final gather to the eye (Hermes et al. 2010, Sec. 5.3): lobes that pixels see take
/// the light of every bundle,
///
///   (1 / N) sum_i 2 pi f(d_i, view) |n . w_i| L(x_i, -d_i),
///
/// weighted where directions are not uniform,
/// not in the atlas but at the pixels' points, where neighbours on the bundle's lines are found as
/// texels find theirs.
class GlossyView {
 public:
  /// @param rays, atlas, job  must live as long as this
  GlossyView(const ray_tracing::RayScene& rays, const texel_atlas::TexelAtlas& atlas,
             const RenderJob& job, const GlossyViewSettings& settings);

  /// New points in the pixels, one each. @param pass  which
  void look(std::uint64_t seed, std::uint32_t pass);
  /// A bundle, with what is sent along it.
  void add(const Bundle& bundle, const LightSolution& solution);

  /// Adds the means over the bundles to pictures of the same size.
  void add_to(perception::Image& direct, perception::Image& indirect) const;
  std::uint64_t camera_rays() const { return camera_rays_; }

 private:
  /// A point with a lobe.
  struct Point {
    std::size_t pixel = 0;
    std::uint32_t texel = 0;
    ExchangeTexel surface;  ///< normals towards the camera
    bool sees_front = true;
    ray_tracing::SeenLobe glossy;  ///< from the camera
  };
  struct Sum {
    glm::vec3 direct{0.0F};
    glm::vec3 indirect{0.0F};
    /// Of the bundles that the pixel had no place in, weights by 2 |n . w|, which is 1 in the mean:
    /// most of them lie nearly along the surface, and would have brought nothing.
    float missed = 0.0F;
    float met = 0.0F;
  };
  void add_point(const Point& point, const Bundle& bundle, const LightSolution& solution);

  const ray_tracing::RayScene& rays_;
  const texel_atlas::TexelAtlas& atlas_;
  const RenderJob& job_;
  GlossyViewSettings settings_;
  std::vector<Point> points_;
  std::vector<Sum> sums_;  ///< per pixel
  double weights_ = 0.0;   ///< of the bundles
  std::uint64_t camera_rays_ = 0;
};

}  // namespace renderers::ray_bundles
