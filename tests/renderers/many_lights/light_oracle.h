#pragma once

#include <vector>

#include <glm/vec3.hpp>

#include "renderers/many_lights/gather_settings.h"
#include "renderers/many_lights/geometry_aware_blur.h"
#include "renderers/many_lights/surface_image.h"
#include "renderers/many_lights/virtual_light.h"
#include "renderers/scene/scene.h"

/// The formulas of many_lights in double precision, written from the papers and the headers, and
/// the mistakes that the tests must notice.
namespace renderers::test {

/// Known mistakes; a check that an unbroken oracle passes must fail for these.
enum class Mistake { none, swapped_normal, missing_pi, distance_to_the_fourth, strided_runs };

struct OracleLight {
  glm::dvec3 position{0.0};
  glm::dvec3 geometric_normal{0.0};
  glm::dvec3 shading_normal{0.0};
  glm::dvec3 flux{0.0};
  bool is_valid = true;
};
OracleLight oracle_light(const many_lights::VirtualLight& light);

struct OracleReceiver {
  glm::dvec3 position{0.0};
  glm::dvec3 geometric_normal{0.0};
  glm::dvec3 shading_normal{0.0};
};
OracleReceiver oracle_receiver(const many_lights::SurfaceImage& surfaces, std::size_t pixel);

/// A light or a receiver with one normal.
many_lights::VirtualLight flat_light(const glm::dvec3& position, const glm::dvec3& normal,
                                     const glm::dvec3& flux);

/// @param geometry_clamp  0: none
glm::dvec3 oracle_irradiance(const OracleLight& light, const OracleReceiver& receiver,
                             double geometry_clamp, Mistake mistake = Mistake::none);

/// Lights that a pixel reads.
std::vector<std::size_t> oracle_run(int x_px, int y_px, int interleave, int light_count,
                                    Mistake mistake = Mistake::none);

/// Irradiance, and radiance that the lobes reflect, of every pixel.
struct OraclePicture {
  std::vector<glm::dvec3> irradiance;
  std::vector<glm::dvec3> glossy;
};
OraclePicture oracle_gather(const many_lights::SurfaceImage& surfaces,
                            const std::vector<many_lights::VirtualLight>& lights,
                            const std::vector<scene::Material>& materials,
                            const many_lights::GatherSettings& settings);

std::vector<glm::dvec3> oracle_blur(const many_lights::SurfaceImage& surfaces,
                                    const std::vector<glm::dvec3>& values,
                                    const many_lights::BlurSettings& settings);

}  // namespace renderers::test
