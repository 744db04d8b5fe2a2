#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "perception/image.h"
#include "renderers/contract/renderer.h"
#include "renderers/ray_bundles/light_solution.h"
#include "renderers/ray_tracing/light_sampler.h"
#include "renderers/ray_tracing/ray_scene.h"
#include "renderers/texel_atlas/texel_atlas.h"

namespace renderers::ray_bundles {

/// One value per side of a texel, read between texels: bilinear among the texels of the point's
/// chart, those of small pieces counting for less; never across charts or sides.
class AtlasLookup {
 public:
  explicit AtlasLookup(const texel_atlas::TexelAtlas& atlas) : atlas_(atlas) {}

  /// Texels and weights, sum 1, for a point; none for a point without a texel.
  struct Taps {
    std::array<std::uint32_t, 4> texels{};
    std::array<float, 4> weights{};
    int count = 0;
  };
  Taps taps(const ray_tracing::SurfacePoint& point) const;

 private:
  const texel_atlas::TexelAtlas& atlas_;
};

/// What a picture shows of the atlas.
struct PictureSettings {
  int camera_rays = 16;
  bool with_direct = false;        ///< direct light that bundles carried
  bool with_emission = false;      ///< emission and environment that the camera sees
  bool with_glossy_rays = true;    ///< lobes that the camera sees, by a ray along each
  bool with_point_lights = false;  ///< by a shadow ray at each camera ray's surface
  std::uint64_t seed = 1;
};

struct AtlasPicture {
  perception::Image direct;    ///< emission, point lights and direct light, as far as asked for
  perception::Image indirect;  ///< light reflected before
  std::uint64_t rays = 0;
};

/// Looks at the scene through every pixel, rays spread over it: albedo at the point times the
/// atlas's incident light there.
AtlasPicture show_atlas(const ray_tracing::RayScene& rays, const texel_atlas::TexelAtlas& atlas,
                        const LightSolution& solution, const RenderJob& job,
                        const PictureSettings& settings);

/// Of the surfaces at the pixels' centres: `albedo`, `normal` (towards the camera), `atlas_chart`
/// (a colour per chart, grey checks for texels), `atlas_density` (texels per metre).
std::vector<perception::NamedImage> show_texels(const ray_tracing::RayScene& rays,
                                                const texel_atlas::TexelAtlas& atlas,
                                                const RenderJob& job);

}  // namespace renderers::ray_bundles
