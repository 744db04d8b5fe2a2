#include "renderers/irradiance_cache/irradiance_records.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace renderers::irradiance_cache {

namespace {

/// A record further in front of a point than this share of their distance does not light it: it
/// may see what the point does not (Ward 1988, Sec. on the test of depth). Ours.
constexpr float kInFront = 0.05F;
/// Least error, so that a point on a record does not divide by zero.
constexpr float kLeastError = 1e-4F;

}  // namespace

IrradianceRecords::Cube IrradianceRecords::Cube::child(int octant) const {
  const float quarter_m = 0.5F * half_m;
  const auto sign = [&](int bit) { return (octant & bit) != 0 ? quarter_m : -quarter_m; };
  return {middle + glm::vec3(sign(1), sign(2), sign(4)), quarter_m};
}

IrradianceRecords::IrradianceRecords(const RecordSettings& settings, const glm::vec3& least,
                                     const glm::vec3& greatest)
    : settings_(settings), nodes_(1) {
  const glm::vec3 size = greatest - least;
  root_ = {0.5F * (least + greatest), 0.51F * std::max(size.x, std::max(size.y, size.z))};
}

std::int64_t IrradianceRecords::memory_bytes() const {
  std::size_t bytes = records_.size() * sizeof(IrradianceRecord) + nodes_.size() * sizeof(Node);
  for (const Node& node : nodes_) bytes += node.records.size() * sizeof(std::uint32_t);
  return static_cast<std::int64_t>(bytes);
}

template <typename Visit>
void IrradianceRecords::visit_near(const glm::vec3& position, const Visit& visit) const {
  Cube cube = root_;
  std::uint32_t node = 0;
  for (;;) {
    for (const std::uint32_t record : nodes_[node].records) visit(record);
    int octant = 0;
    for (int axis = 0; axis < 3; ++axis) {
      if (position[axis] >= cube.middle[axis]) octant |= 1 << axis;
    }
    node = nodes_[node].children[static_cast<std::size_t>(octant)];
    if (node == 0) return;
    cube = cube.child(octant);
  }
}

float IrradianceRecords::error(const IrradianceRecord& record, const glm::vec3& position,
                               const glm::vec3& normal) const {
  const glm::vec3 from_record = position - record.position;
  const float distance_m = glm::length(from_record);
  const float height_m = 0.5F * glm::dot(from_record, normal + record.normal);
  if (height_m < -kInFront * distance_m) return std::numeric_limits<float>::infinity();
  const float turn = std::fmax(0.0F, 1.0F - glm::dot(normal, record.normal));
  return std::fmax(kLeastError, distance_m / record.radius_m + std::sqrt(turn));
}

void IrradianceRecords::clamp_radii(IrradianceRecord& record) {
  std::vector<std::uint32_t> near;
  visit_near(record.position, [&](std::uint32_t index) { near.push_back(index); });
  for (const std::uint32_t index : near) {
    const float distance_m = glm::distance(records_[index].position, record.position);
    record.radius_m = std::min(record.radius_m, records_[index].radius_m + distance_m);
  }
  for (const std::uint32_t index : near) {
    const float distance_m = glm::distance(records_[index].position, record.position);
    records_[index].radius_m = std::min(records_[index].radius_m, record.radius_m + distance_m);
  }
}

void IrradianceRecords::insert(IrradianceRecord record) {
  if (settings_.neighbour_clamp) clamp_radii(record);
  const auto index = static_cast<std::uint32_t>(records_.size());
  const float reach_m = kMostStretch * settings_.accuracy * record.radius_m;
  records_.push_back(record);
  insert_below(0, root_, index, reach_m);
}

void IrradianceRecords::insert_below(std::uint32_t node, const Cube& cube, std::uint32_t record,
                                     float reach_m) {
  // In cubes of the record's own size it lies in eight at most.
  if (0.5F * cube.half_m < reach_m) {
    nodes_[node].records.push_back(record);
    return;
  }
  const glm::vec3 center = records_[record].position;
  for (int octant = 0; octant < 8; ++octant) {
    const Cube child = cube.child(octant);
    const glm::vec3 away = glm::abs(center - child.middle) - glm::vec3(child.half_m + reach_m);
    if (away.x > 0.0F || away.y > 0.0F || away.z > 0.0F) continue;
    std::uint32_t below = nodes_[node].children[static_cast<std::size_t>(octant)];
    if (below == 0) {
      below = static_cast<std::uint32_t>(nodes_.size());
      nodes_[node].children[static_cast<std::size_t>(octant)] = below;
      nodes_.emplace_back();
    }
    insert_below(below, child, record, reach_m);
  }
}

std::optional<glm::vec3> IrradianceRecords::irradiance(const glm::vec3& position,
                                                       const glm::vec3& normal,
                                                       float stretch) const {
  const float greatest_error = settings_.accuracy * stretch;
  glm::vec3 sum(0.0F);
  float weights = 0.0F;
  visit_near(position, [&](std::uint32_t index) {
    const IrradianceRecord& record = records_[index];
    const float e = error(record, position, normal);
    if (e >= greatest_error) return;
    float weight = 1.0F / e;
    if (settings_.weights == Weights::continuous) weight -= 1.0F / greatest_error;
    glm::vec3 value = record.irradiance;
    if (settings_.gradients) {
      const glm::vec3 turn = glm::cross(record.normal, normal);
      for (int c = 0; c < 3; ++c) {
        const auto channel = static_cast<std::size_t>(c);
        value[c] += glm::dot(turn, record.rotation[channel]) +
                    glm::dot(position - record.position, record.translation[channel]);
      }
    }
    sum += weight * glm::max(value, glm::vec3(0.0F));
    weights += weight;
  });
  if (weights <= 0.0F) return std::nullopt;
  return sum / weights;
}

}  // namespace renderers::irradiance_cache
