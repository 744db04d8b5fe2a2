#include "tests/renderers/clustered_visibility/light_bench.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <span>
#include <utility>

#include <glm/geometric.hpp>

#include "tests/renderers/many_lights/gl_fixture.h"
#include "tests/renderers/many_lights/light_oracle.h"

namespace test_clustered_visibility {

using renderers::test::flat_light;
using renderers::test::Numbers;

namespace {

glm::dvec3 random_flux(Numbers& numbers) {
  const double red = numbers.between(0.1, 1.0);
  const double green = numbers.between(0.1, 1.0);
  return {red, green, numbers.between(0.1, 1.0)};
}

}  // namespace

LightSet box_lights(int count, int set) {
  constexpr int kNumbersPerSet = 1000;
  Numbers numbers;
  for (int i = 0; i < set * kNumbersPerSet; ++i) numbers.next();
  const glm::dvec3 sides(4.0, 3.0, 2.5);
  LightSet lights{{}, {glm::vec3(0.0F), glm::vec3(sides)}};
  for (int i = 0; i < count; ++i) {
    const auto wall = static_cast<glm::length_t>(6.0 * numbers.next());
    const glm::dvec3 share = numbers.in_box(0.5) + 0.5;
    glm::dvec3 position = share * sides;
    position[wall % 3] = wall < 3 ? 0.0 : sides[wall % 3];
    glm::dvec3 normal(0.0);
    normal[wall % 3] = wall < 3 ? 1.0 : -1.0;
    lights.lights.push_back(flat_light(position, normal, random_flux(numbers)));
  }
  return lights;
}

LightSet sphere_lights(int count) {
  Numbers numbers;
  const glm::dvec3 center(1.0, 2.0, 3.0);
  LightSet lights{{}, {glm::vec3(center - 1.0), glm::vec3(center + 1.0)}};
  for (int i = 0; i < count; ++i) {
    const glm::dvec3 direction = numbers.direction();
    lights.lights.push_back(flat_light(center + direction, -direction, random_flux(numbers)));
  }
  return lights;
}

LightSet scaled(LightSet lights, float factor) {
  for (VirtualLight& light : lights.lights) {
    light.position = glm::vec4(factor * glm::vec3(light.position), light.position.w);
  }
  lights.bounds.least *= factor;
  lights.bounds.greatest *= factor;
  return lights;
}

void darken(LightSet& lights, int period, int phase) {
  for (int i = phase; i < lights.count(); i += period) {
    VirtualLight& light = lights.lights[static_cast<std::size_t>(i)];
    light.position.w = 0.0F;
    light.flux = glm::vec4(0.0F);
  }
}

std::vector<OracleLight> oracle_lights(const LightSet& lights) {
  std::vector<OracleLight> result;
  for (const VirtualLight& light : lights.lights) {
    result.push_back(
        {glm::dvec3(light.position), glm::dvec3(light.geometric_normal), light.position.w > 0.0F});
  }
  return result;
}

ClusterRule oracle_rule(const LightSet& lights, const cv::ClusterSettings& settings) {
  ClusterRule rule;
  rule.weight_position = static_cast<double>(settings.position_weight);
  rule.weight_normal = static_cast<double>(settings.normal_weight);
  rule.position_unit_m =
      glm::length(glm::dvec3(lights.bounds.greatest) - glm::dvec3(lights.bounds.least));
  return rule;
}

ClusterResult oracle_clusters(const LightSet& lights, const cv::ClusterSettings& settings) {
  const std::vector<OracleLight> oracle = oracle_lights(lights);
  const ClusterStart rule =
      settings.start == cv::ClusterStart::stride ? ClusterStart::stride : ClusterStart::prefix;
  const auto start = clusters_at(oracle, start_lights(oracle, settings.clusters, rule));
  return cluster_lights(oracle_rule(lights, settings), oracle, start, settings.iterations - 1);
}

double least_margin(const LightSet& lights, const cv::ClusterSettings& settings) {
  double least = std::numeric_limits<double>::infinity();
  for (cv::ClusterSettings step = settings; step.iterations > 0; --step.iterations) {
    const ClusterResult result = oracle_clusters(lights, step);
    step.iterations = std::min(step.iterations, result.iterations + 1);
    for (std::size_t i = 0; i < result.margins.size(); ++i) {
      if (result.assignments[i] >= 0) least = std::min(least, result.margins[i]);
    }
  }
  return least;
}

renderers::opengl::Buffer buffer_of(std::shared_ptr<renderers::opengl::Context> context,
                                    const LightSet& lights) {
  return renderers::opengl::Buffer::of(std::move(context),
                                       std::span<const VirtualLight>(lights.lights));
}

Clustered update(cv::LightClusters& clusters, const renderers::opengl::Buffer& buffer,
                 const LightSet& lights) {
  clusters.update({&buffer, lights.count(), lights.bounds});
  return {clusters.read_area_lights(), clusters.read_assignments(), clusters.read_summary()};
}

Clustered cluster_on_device(std::shared_ptr<renderers::opengl::Context> context,
                            const LightSet& lights, const cv::ClusterSettings& settings) {
  const renderers::opengl::Buffer buffer = buffer_of(context, lights);
  cv::LightClusters clusters(std::move(context), settings);
  return update(clusters, buffer, lights);
}

bool is_same(const Clustered& a, const Clustered& b) {
  return a.assignments == b.assignments && a.area_lights.size() == b.area_lights.size() &&
         std::memcmp(a.area_lights.data(), b.area_lights.data(),
                     a.area_lights.size() * sizeof(cv::AreaLight)) == 0;
}

std::vector<int> counts_of(const std::vector<int>& assignments, int clusters) {
  std::vector<int> counts(static_cast<std::size_t>(clusters), 0);
  for (const int cluster : assignments) {
    if (cluster >= 0) ++counts[static_cast<std::size_t>(cluster)];
  }
  return counts;
}

}  // namespace test_clustered_visibility
