#include "renderers/element_hierarchy/shown_light.h"

#include <memory>

#include <glm/common.hpp>

#include "renderers/ray_tracing/direction_sampling.h"
#include "renderers/ray_tracing/surface_brdf.h"

namespace renderers::element_hierarchy {

ShownLight::ShownLight(const Solution& solution, Shading shading)
    : ShownLight(solution, shading == Shading::flat
                               ? nullptr
                               : std::make_unique<PatchVertices>(*solution.tree).get()) {}

ShownLight::ShownLight(const Solution& solution, const PatchVertices& vertices)
    : ShownLight(solution, &vertices) {}

ShownLight::ShownLight(const Solution& solution, const PatchVertices* vertices)
    : solution_(solution) {
  const ElementTree& tree = *solution.tree;
  const std::size_t count = tree.elements().size();
  std::vector<glm::vec3> direct(count);
  std::vector<glm::vec3> indirect(count);
  for (std::size_t i = 0; i < count; ++i) {
    direct[i] = solution.emitted_irradiance[i] + tree.elements()[i].environment_w_m2;
    // The last iteration may have left a rounding error below zero.
    indirect[i] =
        glm::max(glm::vec3(0.0F), solution.field->irradiance()[i] - solution.emitted_irradiance[i]);
  }
  corners_.resize(count);
  if (vertices == nullptr) {
    for (std::size_t i = 0; i < count; ++i) corners_[i].fill({direct[i], indirect[i]});
    return;
  }
  const std::vector<glm::vec3> direct_at = vertices->means(tree, direct);
  const std::vector<glm::vec3> indirect_at = vertices->means(tree, indirect);
  for (std::uint32_t i = 0; i < count; ++i) {
    if (!tree.at(i).is_patch) continue;
    for (std::size_t c = 0; c < 3; ++c) {
      corners_[i][c] = {direct_at[vertices->of(i)[c]], indirect_at[vertices->of(i)[c]]};
    }
  }
}

ShownLight::Irradiance ShownLight::at(const ray_tracing::SurfacePoint& point,
                                      const glm::vec3& towards) const {
  const ElementTree::Place place = solution_.tree->place_at(point, towards);
  Irradiance sum;
  if (place.leaf == kNoElement) return sum;
  for (int c = 0; c < 3; ++c) {
    const Irradiance& corner = corners_[place.leaf][static_cast<std::size_t>(c)];
    sum.direct += place.weights[c] * corner.direct;
    sum.indirect += place.weights[c] * corner.indirect;
  }
  return sum;
}

glm::vec3 ShownLight::reflected(const ray_tracing::SurfacePoint& point,
                                const glm::vec3& towards) const {
  const std::uint32_t leaf = solution_.tree->leaf_at(point, towards);
  if (leaf == kNoElement) return glm::vec3(0.0F);
  const Irradiance light = at(point, towards);
  const glm::vec3 incident =
      light.direct + light.indirect + solution_.tree->at(leaf).point_light_w_m2;
  return ray_tracing::diffuse_albedo(solution_.tree->rays().scene(), point) * incident /
         ray_tracing::kPi;
}

}  // namespace renderers::element_hierarchy
