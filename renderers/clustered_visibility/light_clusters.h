#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <glm/vec4.hpp>

#include "renderers/clustered_visibility/loop_turns.h"
#include "renderers/clustered_visibility/scatter_clusters.h"
#include "renderers/many_lights/virtual_light.h"
#include "renderers/opengl/buffer.h"
#include "renderers/opengl/context.h"
#include "renderers/scene/scene.h"

/// Virtual area lights: clusters of virtual point lights that share a fractional visibility.
/// Source: Dong, Grosch, Ritschel, Kautz and Seidel 2009, "Real-time Indirect Illumination with
/// Clustered Visibility", Vision, Modeling and Visualization (VMV) 2009.
namespace renderers::clustered_visibility {

/// Which lights the clusters start from.
enum class ClusterStart {
  stride,  ///< light k N / M of cluster k (Sec. 6)
  prefix   ///< light k: the first points of the lights' Halton sequence; ours
};

/// What the size of an area light is taken from.
enum class AreaFrom {
  rectangle,  ///< around its lights in its plane (Sec. 6)
  covariance  ///< of a rectangle with their variances: 12 variance = side^2; ours
};

/// What of the surfaces nearer to an area light's plane than its highest light its map leaves out.
enum class Clip {
  all,
  behind  ///< those seen from behind, as a bulge from within; what faces the light blocks it; ours
};

/// Who sums the lights of clusters.
enum class ClusterSums {
  integer,  ///< one work group, in integers whose order does not matter; ours
  scatter   ///< the rasteriser, by blending (Sec. 6); scatter_clusters.h
};

struct ClusterSettings {
  int clusters = 30;             ///< M, at most `kMostClusters`
  float position_weight = 0.7F;  ///< Sec. 5.1
  float normal_weight = 0.3F;    ///< Sec. 5.1
  ClusterStart start = ClusterStart::prefix;
  int iterations = 20;  ///< at most
  ClusterSums sums = ClusterSums::integer;
  AreaFrom area = AreaFrom::rectangle;
  Clip clip = Clip::behind;
  /// Starts from the clusters of the last call instead, once there are any; those that had no light
  /// to start from then take lights that had no flux.
  bool is_warm = false;
  int most_turns = kMostTurns;  ///< of loops in one dispatch; never changes what comes out
};

/// Most clusters: their centres and sums lie in 32 KiB of shared memory.
inline constexpr int kMostClusters = 512;
/// Most lights: sums of as many fixed-point numbers of 14 bits or more fit 31 bits.
inline constexpr int kMostLights = 1 << 16;

/// A virtual area light, std430 (`AreaLight` of shaders/area_light.glsl). Position and axis lead,
/// so that shadow maps can read them (stride `kAreaLightStride`).
struct AreaLight {
  glm::vec4 position{0.0F};  ///< xyz: mean of the lights, m; w: 1, or 0 without lights
  /// xyz: mean of their geometric normals, unit length; w: m, greatest height of its lights above
  /// its plane, the clip height of its map, negative with `Clip::behind`
  glm::vec4 axis{0.0F};
  /// x: size D, m, the root of the area; y: depth in the shadow map's units per metre;
  /// z: area, m2; w: number of lights
  glm::vec4 shape{0.0F};
  glm::vec4 flux{0.0F};  ///< rgb: sum over the lights, W; w: index of the first light in `sorted`
};
inline constexpr int kAreaLightStride = static_cast<int>(sizeof(AreaLight) / sizeof(glm::vec4));

/// The clustering's own account, read back for records and tests.
struct ClusterSummary {
  std::int32_t iterations = 0;  ///< assignments of all lights, the last included
  std::int32_t has_converged = 0;
  std::int32_t filled = 0;  ///< clusters with lights
};

/// Lights and the scene they lie in.
struct ClusterInput {
  const opengl::Buffer* lights = nullptr;  ///< VirtualLight
  int count = 0;                           ///< N, at most `kMostLights`
  scene::Box bounds;                       ///< of the scene; its diagonal is the unit of length
  int clusters = 0;  ///< to make, at most the settings'; 0: as many. The others are empty
  int only = -1;     ///< cluster whose lights alone `sort_runs` keeps lit; -1: all
};

/// k-means clustering of virtual lights by position and normal, on the device.
///
/// Distance of a light to a centre (Sec. 5.1; the units are ours, the paper names none):
///   d = w_x |x - x_c| / diagonal + w_a acos(n . n_c) / pi,
/// lowest index on ties, geometric normals. A centre is the mean of its lights' positions and the
/// normalised mean of their normals (the old one if that is shorter than 0.1). Clusters without
/// lights keep their centre and stay in the competition. Lights without flux belong to none.
class LightClusters {
 public:
  /// @throws UnsupportedError as ScatterClusters
  LightClusters(std::shared_ptr<opengl::Context> context, const ClusterSettings& settings);

  /// Clusters the lights and makes the area lights.
  void update(const ClusterInput& input);
  /// Forgets the clusters that a warm start would begin with.
  void restart() { has_clusters_ = false; }

  /// Makes copies of the lights in which every run of an n x n interleaved gather
  /// (gather_settings.h) is sorted by cluster, w of the flux being the cluster's index (-1 where
  /// there is no light).
  void sort_runs(const ClusterInput& input, int interleave);

  int clusters() const { return settings_.clusters; }
  int used_clusters() const { return used_; }  ///< of the last update
  /// M AreaLight.
  const opengl::Buffer& area_lights() const { return area_lights_; }
  /// N int: cluster of each light, -1 for those without flux.
  const opengl::Buffer& assignments() const { return assignments_; }
  /// VirtualLight, sorted in runs by `sort_runs`.
  const opengl::Buffer& sorted() const { return sorted_; }

  ClusterSummary read_summary() const;                 ///< waits for the device
  std::vector<AreaLight> read_area_lights() const;     ///< waits for the device
  std::vector<std::int32_t> read_assignments() const;  ///< waits for the device
  std::int64_t memory_bytes() const;

 private:
  void reserve(int lights);
  void cluster(const ClusterInput& input);
  /// Integer sums: iterations in as many dispatches as a thread's loops allow.
  void iterate(const ClusterInput& input, int group);
  void set_rule(const ClusterInput& input, opengl::Program& program) const;
  void describe(const ClusterInput& input);

  std::shared_ptr<opengl::Context> context_;
  ClusterSettings settings_;
  bool has_clusters_ = false;
  int used_ = 0;      ///< clusters of the last update
  int assigned_ = 0;  ///< lights that `assignments_` is about
  opengl::Buffer assignments_;
  opengl::Buffer centers_;  ///< M Center
  opengl::Buffer summary_;
  opengl::Buffer members_;  ///< N int: lights sorted by cluster
  opengl::Buffer area_lights_;
  opengl::Buffer sorted_;
  std::optional<ScatterClusters> scatter_;
};

}  // namespace renderers::clustered_visibility
