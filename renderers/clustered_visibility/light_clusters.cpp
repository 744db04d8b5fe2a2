#include "renderers/clustered_visibility/light_clusters.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <string>
#include <utility>

#include <glm/common.hpp>
#include <glm/vec3.hpp>

#include "renderers/clustered_visibility/convolution_maps.h"
#include "renderers/clustered_visibility/shader_files.h"
#include "renderers/opengl/program.h"

namespace renderers::clustered_visibility {

namespace {

constexpr int kLargestGroup = 1024;
constexpr int kSmallestGroup = 64;
constexpr int kLocalSize = 32;  ///< of area_lights and sort_runs
constexpr int kFixedBits = 16;  ///< of positions and normals, with up to 2^14 lights
constexpr int kSumBits = 30;
constexpr int kTurnsOfSums = 2;  ///< per cluster, of the loops over sums of cluster_lights: at most
/// Least size of an area light, in diagonals of the scene.
constexpr float kLeastSize = 1e-6F;

constexpr std::uint32_t kLights = 3;
constexpr std::uint32_t kAssignments = 4;
constexpr std::uint32_t kCenters = 5;

/// `Center` of cluster_rule.glsl.
struct Center {
  glm::vec4 position{0.0F};
  glm::vec4 normal{0.0F};
};

opengl::ProgramSource source_of(const std::string& pass, opengl::Defines defines = {}) {
  return {shader_files(),
          {"renderers/clustered_visibility/shaders/" + pass + ".comp.glsl"},
          std::move(defines)};
}

float fixed_scale(int lights) {
  const int light_bits = std::bit_width(static_cast<unsigned>(std::max(lights - 1, 0)));
  return static_cast<float>(1 << std::min(kFixedBits, kSumBits - light_bits));
}

float longest_side(const scene::Box& bounds) {
  const glm::vec3 sides = bounds.greatest - bounds.least;
  const float longest = std::max({sides.x, sides.y, sides.z});
  return longest > 0.0F ? longest : 1.0F;
}

float diagonal_of(const scene::Box& bounds) {
  const float diagonal = bounds.diagonal_m();
  return diagonal > 0.0F ? diagonal : 1.0F;
}

}  // namespace

LightClusters::LightClusters(std::shared_ptr<opengl::Context> context,
                             const ClusterSettings& settings)
    : context_(std::move(context)), settings_(settings) {
  assert(settings.clusters >= 1 && settings.clusters <= kMostClusters);
  const auto clusters = static_cast<std::size_t>(settings.clusters);
  centers_ = opengl::Buffer(context_, clusters * sizeof(Center));
  area_lights_ = opengl::Buffer(context_, clusters * sizeof(AreaLight));
  summary_ = opengl::Buffer::of<ClusterSummary>(context_, std::array{ClusterSummary{}});
  if (settings.sums == ClusterSums::scatter) scatter_.emplace(context_, settings.clusters);
}

void LightClusters::reserve(int lights) {
  assert(lights >= 1 && lights <= kMostLights);
  const auto count = static_cast<std::size_t>(lights);
  assignments_.reserve(context_, count * sizeof(std::int32_t));
  members_.reserve(context_, count * sizeof(std::int32_t));
  if (assigned_ != lights) has_clusters_ = false;
  assigned_ = lights;
}

void LightClusters::update(const ClusterInput& input) {
  assert(input.clusters >= 0 && input.clusters <= settings_.clusters);
  used_ = input.clusters > 0 ? input.clusters : settings_.clusters;
  reserve(input.count);
  cluster(input);
  describe(input);
  has_clusters_ = true;
}

void LightClusters::cluster(const ClusterInput& input) {
  const int most = static_cast<int>(
      std::min<std::int64_t>(kLargestGroup, context_->limits().work_group_invocations));
  const int group = std::clamp(static_cast<int>(std::bit_ceil(static_cast<unsigned>(input.count))),
                               kSmallestGroup, most);
  opengl::Defines defines{{"LOCAL_SIZE", std::to_string(group)},
                          {"MOST_LIGHTS", std::to_string(kMostLights)}};
  if (settings_.start == ClusterStart::prefix) defines.emplace_back("START_PREFIX", "1");
  opengl::Program& start = context_->program(source_of("cluster_start", std::move(defines)));
  start.storage(kLights, *input.lights);
  start.storage(kAssignments, assignments_);
  start.storage(kCenters, centers_);
  start.set("light_count", input.count);
  start.set("cluster_count", used_);
  start.set("is_warm", settings_.is_warm && has_clusters_ ? 1 : 0);
  start.dispatch(1);

  if (scatter_) {
    scatter_->run({*input.lights, assignments_, centers_, summary_, input.count,
                   settings_.iterations, input.bounds.least,
                   [&](opengl::Program& program) { set_rule(input, program); }});
    return;
  }
  iterate(input, group);
}

void LightClusters::iterate(const ClusterInput& input, int group) {
  opengl::Program& program = context_->program(source_of(
      "cluster_lights",
      {{"LOCAL_SIZE", std::to_string(group)}, {"CLUSTERS", std::to_string(settings_.clusters)}}));
  program.storage(kLights, *input.lights);
  program.storage(kAssignments, assignments_);
  program.storage(kCenters, centers_);
  program.storage(6, summary_);
  program.set("light_count", input.count);
  set_rule(input, program);
  program.set("bounds_min", input.bounds.least);
  program.set("bounds_size", longest_side(input.bounds));
  program.set("fixed_scale", fixed_scale(input.count));
  // A thread looks at all clusters for each of its lights, and once at its share of the sums.
  const int lights_of_thread = (input.count + group - 1) / group;
  const int turns = (lights_of_thread + kTurnsOfSums) * (used_ + 1);
  const int at_once = std::max(1, settings_.most_turns / turns);
  for (int done = 0; done < settings_.iterations; done += at_once) {
    program.set("earlier_iterations", done);
    program.set("most_iterations", std::min(at_once, settings_.iterations - done));
    program.dispatch(1);
  }
}

void LightClusters::set_rule(const ClusterInput& input, opengl::Program& program) const {
  program.set("cluster_count", used_);
  program.set("position_weight", settings_.position_weight / diagonal_of(input.bounds));
  program.set("normal_weight", settings_.normal_weight);
}

void LightClusters::describe(const ClusterInput& input) {
  opengl::Program& sort = context_->program(source_of("sort_runs"));
  sort.storage(kAssignments, assignments_);
  sort.storage(5, members_);
  sort.set("light_count", input.count);
  sort.set("cluster_count", used_);
  sort.set("run_count", 1);
  sort.dispatch(opengl::groups_for(used_ + 1, kLocalSize));

  opengl::Defines defines;
  if (settings_.area == AreaFrom::covariance) defines.emplace_back("FROM_COVARIANCE", "1");
  if (settings_.clip == Clip::behind) defines.emplace_back("CLIP_BEHIND", "1");
  opengl::Program& area = context_->program(source_of("area_lights", std::move(defines)));
  area.storage(kLights, *input.lights);
  area.storage(4, members_);
  area.storage(kCenters, centers_);
  area.storage(6, area_lights_);
  area.set("cluster_count", used_);
  area.set("area_light_count", settings_.clusters);
  area.set("bounds_min", input.bounds.least);
  area.set("bounds_max", input.bounds.greatest);
  area.set("least_size", kLeastSize * diagonal_of(input.bounds));
  area.set("far_depth", kFarDepth);
  area.dispatch(opengl::groups_for(settings_.clusters, kLocalSize));
}

void LightClusters::sort_runs(const ClusterInput& input, int interleave) {
  assert(input.count == assigned_ && interleave >= 1);
  sorted_.reserve(context_,
                  static_cast<std::size_t>(input.count) * sizeof(many_lights::VirtualLight));
  opengl::Program& sort = context_->program(source_of("sort_runs", {{"COPIES", "1"}}));
  sort.storage(kLights, *input.lights);
  sort.storage(kAssignments, assignments_);
  sort.storage(5, sorted_);
  sort.set("light_count", input.count);
  sort.set("cluster_count", used_);
  sort.set("run_count", interleave * interleave);
  sort.set("only_cluster", input.only);
  sort.dispatch(opengl::groups_for(used_ + 1, kLocalSize),
                static_cast<std::uint32_t>(interleave * interleave));
}

ClusterSummary LightClusters::read_summary() const {
  return summary_.read<ClusterSummary>(1).front();
}

std::vector<AreaLight> LightClusters::read_area_lights() const {
  return area_lights_.read<AreaLight>(static_cast<std::size_t>(settings_.clusters));
}

std::vector<std::int32_t> LightClusters::read_assignments() const {
  return assignments_.read<std::int32_t>(static_cast<std::size_t>(assigned_));
}

std::int64_t LightClusters::memory_bytes() const {
  std::size_t bytes = 0;
  for (const opengl::Buffer* buffer :
       {&assignments_, &centers_, &summary_, &members_, &area_lights_, &sorted_}) {
    bytes += buffer->size_bytes();
  }
  return static_cast<std::int64_t>(bytes) + (scatter_ ? scatter_->memory_bytes() : 0);
}

}  // namespace renderers::clustered_visibility
