#pragma once

#include <limits>
#include <numbers>
#include <vector>

#include <glm/vec3.hpp>

/// Clustering of virtual point lights into area lights in double precision, written from the paper
/// and for clarity, not for speed.
///
/// Dong, Grosch, Ritschel, Kautz, Seidel 2009, "Real-time Indirect Illumination with Clustered
/// Visibility", Sec. 5 and 6. What the paper leaves open (units, ties, empty clusters, iterations,
/// the axes of the rectangle, a size out of the area) is marked "derived".
namespace test_clustered_visibility {

/// A virtual point light as clustering sees it.
struct OracleLight {
  glm::dvec3 position{0.0};          ///< m
  glm::dvec3 normal{0.0, 0.0, 1.0};  ///< unit length
  bool is_valid = true;              ///< false: no light here, no cluster, moves no centre
};

/// A cluster of lights: the centre of an area light.
struct OracleCluster {
  glm::dvec3 position{0.0};          ///< m, mean of its members
  glm::dvec3 normal{0.0, 0.0, 1.0};  ///< unit length, renormalised mean of its members
  int count = 0;                     ///< members; 0: kept at its old centre, still competes
};

/// Distance of a light to a cluster, Sec. 5.1: d = w_x dx + w_a dalpha. The units of dx and dalpha
/// are derived: fractions of the scene's diagonal and of a half turn.
struct ClusterRule {
  double weight_position = 0.7;              ///< w_x
  double weight_normal = 0.3;                ///< w_a
  double position_unit_m = 1.0;              ///< diagonal of the scene's bounding box
  double angle_unit_rad = std::numbers::pi;  ///< angle that counts as 1
};

/// w_x |dx| / unit + w_a acos(n . n') / unit, without unit; the cosine is clamped to [-1, 1].
double cluster_distance(const ClusterRule& rule, const OracleLight& light,
                        const OracleCluster& cluster);

/// The cluster nearest to a light.
struct NearestCluster {
  int index = -1;         ///< the lowest one of equally near ones
  double distance = 0.0;  ///< to it, without unit
  /// Distance to the second nearest minus `distance`, >= 0; infinite if there is one cluster only.
  double margin = std::numeric_limits<double>::infinity();
};

/// @param clusters  at least one; empty ones compete too (derived)
NearestCluster nearest_cluster(const ClusterRule& rule, const OracleLight& light,
                               const std::vector<OracleCluster>& clusters);

/// Nearest cluster of every light, index -1 for invalid ones.
std::vector<NearestCluster> assign_lights(const ClusterRule& rule,
                                          const std::vector<OracleLight>& lights,
                                          const std::vector<OracleCluster>& clusters);

/// Shortest mean of normals that still has a direction; derived.
inline constexpr double kShortestMeanNormal = 0.1;

/// Second step of k-means, Sec. 5.1: centres move to the means of their members. Derived: a cluster
/// without members keeps its centre, one whose mean normal is shorter than kShortestMeanNormal
/// keeps its old normal (its position moves).
/// @param assignments  cluster of every light, -1: none
std::vector<OracleCluster> mean_step(const std::vector<OracleLight>& lights,
                                     const std::vector<int>& assignments,
                                     const std::vector<OracleCluster>& clusters);

/// Lights that the centres start from.
enum class ClusterStart {
  stride,  ///< light floor(k N / M) for cluster k, Sec. 6
  prefix,  ///< light k; derived: the first points of a Halton sequence are stratified
};

/// Start light of every cluster, in order of clusters. Where the rule's light is invalid or taken
/// by an earlier cluster: the next valid one not taken yet, after the last comes the first
/// (derived). Shorter than `cluster_count` if there are fewer valid lights.
std::vector<int> start_lights(const std::vector<OracleLight>& lights, int cluster_count,
                              ClusterStart start);

/// Clusters with the positions and normals of some lights, without members.
std::vector<OracleCluster> clusters_at(const std::vector<OracleLight>& lights,
                                       const std::vector<int>& light_indices);

struct ClusterResult {
  std::vector<int> assignments;         ///< C(i) of Sec. 4; -1 for invalid lights
  std::vector<double> margins;          ///< NearestCluster::margin of every light
  std::vector<OracleCluster> clusters;  ///< counts are those of `assignments`
  int iterations = 0;                   ///< mean steps made
  bool is_converged = false;            ///< the centres are the means of `assignments`
};

/// k-means from given centres until no assignment changes or the cap on mean steps is reached
/// (derived); in both cases a last pass assigns the lights to the final centres, Sec. 6.
/// @param start  at least one
ClusterResult cluster_lights(const ClusterRule& rule, const std::vector<OracleLight>& lights,
                             const std::vector<OracleCluster>& start, int max_iterations = 20);

/// Positions of a cluster's members, m.
std::vector<glm::dvec3> member_positions(const std::vector<OracleLight>& lights,
                                         const std::vector<int>& assignments, int cluster_index);

/// How a cluster's area follows from its members' positions s, t in the plane through its centre,
/// on the axes of shadow_maps::hemisphere_frame (derived).
enum class AreaRule {
  bounding_rectangle,  ///< (max s - min s) (max t - min t), Sec. 6
  covariance,          ///< sqrt(12 var s) sqrt(12 var t), derived: exact for a filled rectangle
};

/// The area light that stands for a cluster.
struct ClusterExtent {
  double area_m2 = 0.0;
  double size_m = 0.0;  ///< Delta of Sec. 4.2; derived: max(sqrt(area), minimum)
  /// Greatest height of a member above the plane, along the normal, m, at least 0: geometry that is
  /// nearer must be ignored (Sec. 5.1, Fig. 7).
  double height_m = 0.0;
};

/// @param members  positions, m; none: area and height 0
ClusterExtent cluster_extent(const std::vector<glm::dvec3>& members, const OracleCluster& cluster,
                             AreaRule rule, double minimum_size_m);

}  // namespace test_clustered_visibility
