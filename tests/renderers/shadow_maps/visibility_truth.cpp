#include "tests/renderers/shadow_maps/visibility_truth.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "renderers/scene/scene_file.h"
#include "renderers/shadow_maps/hemisphere_projection.h"
#include "renderers/shadow_maps/scene_points.h"
#include "tests/places.h"
#include "tests/renderers/scene_builder.h"

namespace renderers::test {

scene::Scene catalog_scene(const std::string& name) {
  const std::filesystem::path catalog =
      std::filesystem::path(tests::kSourceFolder) / "suites/scenes";
  return scene::read_scene_file(catalog / (name + ".yaml")).at_frame(0);
}

scene::Scene empty_box() {
  SceneBuilder builder;
  const int white = builder.add_material(lambert(glm::vec3(0.5F)));
  builder.add_box(glm::vec3(-1.0F), glm::vec3(1.0F), white, true);
  return builder.scene;
}

scene::Scene scaled(scene::Scene scene, float factor) {
  for (scene::Object& object : scene.objects) {
    object.to_world = glm::scale(glm::mat4(1.0F), glm::vec3(factor)) * object.to_world;
  }
  return scene;
}

VisibilityTruth visibility_truth(const MapBench& bench, const std::vector<Origin>& origins,
                                 int points) {
  constexpr float kLeastCosine = 1e-3F;
  const float end_m = 2e-5F * bench.diagonal_m();  // of the segments, off the surfaces
  VisibilityTruth truth;
  const auto receivers = shadow_maps::scene_points(bench.scene(), 1, points);
  for (std::size_t layer = 0; layer < origins.size(); ++layer) {
    const glm::vec3 origin(origins[layer].position);
    const glm::vec3 axis(origins[layer].axis);
    for (const auto& receiver : receivers) {
      const glm::vec3 position(receiver.position);
      const glm::vec3 direction = glm::normalize(position - origin);
      const float cosine = glm::dot(direction, glm::vec3(receiver.normal));
      if (!(glm::dot(direction, axis) > kLeastCosine) || std::fabs(cosine) < kLeastCosine) continue;
      const glm::vec3 from = origin + end_m * axis;
      const glm::vec3 to = position - std::copysign(end_m, cosine) * glm::vec3(receiver.normal);
      const bool is_lit = !bench.rays().is_occluded({from, to - from, 1.0F});
      truth.lookups.push_back({glm::vec4(position, static_cast<float>(layer)), receiver.normal});
      truth.is_lit.push_back(is_lit);
      (is_lit ? truth.lit : truth.shadowed) += 1;
    }
  }
  return truth;
}

VisibilityError visibility_error(const VisibilityTruth& truth,
                                 const shadow_maps::HemisphereMaps& maps,
                                 const std::vector<Origin>& origins,
                                 const shadow_maps::LookupBias& bias) {
  const auto visibility = visibilities(maps, origins, truth.lookups, bias);
  VisibilityError error;
  for (std::size_t i = 0; i < visibility.size(); ++i) {
    const bool is_lit = visibility[i] > 0.5F;
    if (is_lit == truth.is_lit[i]) continue;
    if (truth.is_lit[i]) {
      error.false_shadow += 1.0 / truth.lit;
    } else {
      error.leak += 1.0 / truth.shadowed;
    }
  }
  return error;
}

bool is_near_silhouette(const MapBench& bench, const shadow_maps::HemisphereMaps& maps,
                        const std::vector<Origin>& origins, const Lookup& lookup) {
  constexpr int kSteps = 8;  // a texel to each side
  const Origin& origin = origins[static_cast<std::size_t>(lookup.receiver.w)];
  const glm::dvec3 axis(origin.axis);
  const glm::dmat3 to_map = glm::transpose(shadow_maps::hemisphere_frame(axis));
  const glm::dvec3 center = glm::dvec3(origin.position) + static_cast<double>(maps.near_m()) * axis;
  const glm::dvec3 local = to_map * (glm::dvec3(lookup.receiver) - center);
  const glm::dvec3 normal = to_map * glm::dvec3(lookup.normal);
  const glm::dvec2 at = shadow_maps::hemisphere_position(local);
  const double texel = 2.0 / maps.size_px();
  const double extent_m =
      shadow_maps::hemisphere_texel_angle(glm::normalize(local).z, maps.size_px()) *
      glm::length(local);
  bool some_are_blocked = false;
  bool some_are_free = false;
  for (int y = -kSteps; y <= kSteps; ++y) {
    for (int x = -kSteps; x <= kSteps; ++x) {
      glm::dvec2 position = at + texel / kSteps * glm::dvec2(x, y);
      position /= std::max(1.0, glm::length(position));
      const glm::dvec3 direction = shadow_maps::hemisphere_direction(position);
      const double plane = glm::dot(local, normal) / glm::dot(direction, normal);
      const double receiver_m =
          plane > 0.0 ? std::min(plane, glm::length(local)) : glm::length(local);
      const double met_m =
          static_cast<double>(ray_distance(bench, origin, maps.near_m(), position));
      // The bias itself may hide a blocker that is as near to the receiver.
      (met_m < receiver_m - 1e-4 * extent_m ? some_are_blocked : some_are_free) = true;
      if (met_m > receiver_m - 0.5 * extent_m) some_are_free = true;
    }
  }
  return some_are_blocked && some_are_free;
}

}  // namespace renderers::test
