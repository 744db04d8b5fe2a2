#pragma once

#include <memory>
#include <vector>

#include <glm/vec3.hpp>

#include "renderers/clustered_visibility/light_clusters.h"
#include "renderers/many_lights/virtual_light.h"
#include "renderers/opengl/buffer.h"
#include "renderers/opengl/context.h"
#include "renderers/scene/scene.h"
#include "tests/renderers/clustered_visibility/cluster_oracle.h"

/// Virtual lights made for tests, and their clusters on the device and by the oracle.
namespace test_clustered_visibility {

namespace cv = renderers::clustered_visibility;
using renderers::many_lights::VirtualLight;

struct LightSet {
  std::vector<VirtualLight> lights;
  renderers::scene::Box bounds;

  int count() const { return static_cast<int>(lights.size()); }
};

/// Lights on the walls of a box of 4 x 3 x 2.5 m, facing inwards.
/// @param set  a number; other lights for another one
LightSet box_lights(int count, int set = 0);
/// Lights all over the inside of a sphere of 1 m around (1, 2, 3), facing inwards.
LightSet sphere_lights(int count);
LightSet scaled(LightSet lights, float factor);
/// Takes the flux of every light i with i % period == phase; position and normal stay.
void darken(LightSet& lights, int period, int phase);

std::vector<OracleLight> oracle_lights(const LightSet& lights);
ClusterRule oracle_rule(const LightSet& lights, const cv::ClusterSettings& settings);
/// Clusters after as many assignments of the lights as `settings.iterations`, or when settled.
ClusterResult oracle_clusters(const LightSet& lights, const cv::ClusterSettings& settings);
/// The least margin of all lights in all assignments. Above `kNearTie` device and oracle must
/// agree: the device's centres are rounded to 2^-16 of the longest side, distances to 2^-22.
double least_margin(const LightSet& lights, const cv::ClusterSettings& settings);
inline constexpr double kNearTie = 1e-5;

struct Clustered {
  std::vector<cv::AreaLight> area_lights;
  std::vector<int> assignments;
  cv::ClusterSummary summary;
};
renderers::opengl::Buffer buffer_of(std::shared_ptr<renderers::opengl::Context> context,
                                    const LightSet& lights);
Clustered update(cv::LightClusters& clusters, const renderers::opengl::Buffer& buffer,
                 const LightSet& lights);
Clustered cluster_on_device(std::shared_ptr<renderers::opengl::Context> context,
                            const LightSet& lights, const cv::ClusterSettings& settings);
/// Equal to the last bit.
bool is_same(const Clustered& a, const Clustered& b);

/// Lights in each cluster.
std::vector<int> counts_of(const std::vector<int>& assignments, int clusters);

}  // namespace test_clustered_visibility
