#include "renderers/ray_bundles/direction_importance.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "perception/base/parallel.h"
#include "renderers/ray_bundles/direction_set.h"
#include "renderers/ray_tracing/direction_sampling.h"
#include "renderers/ray_tracing/environment_sampler.h"
#include "renderers/ray_tracing/sample_sequence.h"
#include "renderers/ray_tracing/surface_brdf.h"

namespace renderers::ray_bundles {

namespace {

constexpr std::uint32_t kWalks = 1U << 16;
constexpr double kSphere_sr = 4.0 * std::numbers::pi;

using Cells = std::vector<double>;

/// What a walk found: its cell and what it counts there.
struct Arrival {
  std::size_t cell = 0;
  double weight = 0.0;
};

/// (c L)^2 of what sides send; a sample of side and direction stands for power / kWalks.
void add_surfaces(const ray_tracing::RayScene& rays, const texel_atlas::TexelAtlas& atlas,
                  const CarriedLight& light, Cells& cells) {
  std::vector<double> powers;
  powers.reserve(light.radiance.size());
  for (std::size_t side = 0; side < light.radiance.size(); ++side) {
    const auto area_m2 = static_cast<double>(atlas.texels()[side / 2].area_m2);
    powers.push_back(area_m2 * static_cast<double>(ray_tracing::luminance(light.radiance[side])));
  }
  const ray_tracing::PiecewiseDistribution sides(powers);
  if (sides.total() <= 0.0) return;
  const auto walk = [&](std::uint32_t index) {
    ray_tracing::SampleSequence numbers(ray_tracing::SequenceKind::sobol, light.seed, index);
    const glm::vec4 u = numbers.next();
    const std::size_t side = sides.choose(u.x).index;
    const ray_tracing::SurfacePoint& from = atlas.texels()[side / 2].point;
    const float sign = side % 2 == 0 ? 1.0F : -1.0F;
    const ray_tracing::Frame3 frame = ray_tracing::frame_around(sign * from.geometric_normal);
    const glm::vec3 direction =
        glm::normalize(frame.to_world(ray_tracing::cosine_hemisphere({u.y, u.z})));
    ray_tracing::Hit hit;
    if (!rays.intersect(ray_from(from, direction), hit)) return Arrival{};
    const double cosine = std::fabs(static_cast<double>(glm::dot(hit.geometric_normal, direction)));
    const auto radiance = static_cast<double>(ray_tracing::luminance(light.radiance[side]));
    return Arrival{DirectionImportance::cell_of(direction), cosine * radiance};
  };
  constexpr std::size_t kGrain = 1024;
  std::vector<Arrival> arrivals(kWalks);
  base::parallel_for(kWalks, kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) arrivals[i] = walk(static_cast<std::uint32_t>(i));
  });
  const double power = std::numbers::pi * sides.total() / kWalks;
  for (const Arrival& arrival : arrivals) cells[arrival.cell] += power * arrival.weight;
}

/// (c L)^2 of the environment.
void add_environment(const ray_tracing::RayScene& rays, std::uint64_t seed, Cells& cells) {
  if (!rays.scene().environment) return;
  const scene::Environment& environment = *rays.scene().environment;
  const ray_tracing::EnvironmentSampler sampler(environment);
  if (sampler.power() <= 0.0) return;
  const glm::vec3 size = rays.box_max() - rays.box_min();
  const glm::vec3 faces_m2(size.y * size.z, size.z * size.x, size.x * size.y);
  constexpr double kMeanCosine = 0.5;
  for (std::uint32_t i = 0; i < kWalks; ++i) {
    ray_tracing::SampleSequence numbers(ray_tracing::SequenceKind::sobol, seed, i);
    const glm::vec4 u = numbers.next();
    const auto drawn = sampler.sample({u.x, u.y});
    if (drawn.pdf <= 0.0F) continue;
    const auto area_m2 = static_cast<double>(glm::dot(faces_m2, glm::abs(drawn.direction)));
    const auto radiance = static_cast<double>(
        ray_tracing::luminance(scene::sample_environment(environment, drawn.direction)));
    cells[DirectionImportance::cell_of(drawn.direction)] +=
        sampler.power() / kWalks * area_m2 * kMeanCosine * radiance;
  }
}

/// Row and column of the reverse direction's cell.
std::size_t reverse_of(std::size_t cell) {
  constexpr std::size_t kColumns = DirectionImportance::kColumns;
  const std::size_t row = DirectionImportance::kRows - 1 - cell / kColumns;
  return row * kColumns + (cell % kColumns + kColumns / 2) % kColumns;
}

}  // namespace

std::size_t DirectionImportance::cell_of(const glm::vec3& direction) {
  // The inverse of `direction_on_sphere`.
  const double turn =
      std::atan2(static_cast<double>(direction.y), static_cast<double>(direction.x)) /
      (2.0 * std::numbers::pi);
  const double row = 0.5 * (1.0 - static_cast<double>(direction.z)) * kRows;
  const double column = (turn < 0.0 ? turn + 1.0 : turn) * kColumns;
  const auto bounded = [](double value, std::size_t count) {
    return static_cast<std::size_t>(std::clamp(value, 0.0, static_cast<double>(count) - 0.5));
  };
  return bounded(row, kRows) * kColumns + bounded(column, kColumns);
}

DirectionImportance::DirectionImportance(std::span<const double> weights) {
  assert(weights.size() == kCells);
  std::array<double, kRows> sums{};
  for (std::size_t row = 0; row < kRows; ++row) {
    std::array<double, kColumns> both{};
    for (std::size_t column = 0; column < kColumns; ++column) {
      const std::size_t cell = row * kColumns + column;
      both[column] = weights[cell] + weights[reverse_of(cell)];
      sums[row] += both[column];
    }
    columns_.emplace_back(both);
  }
  rows_ = ray_tracing::PiecewiseDistribution(sums);
}

double DirectionImportance::density(const glm::vec3& direction) const {
  const std::size_t cell = cell_of(direction);
  const std::size_t row = cell / kColumns;
  if (columns_[row].total() <= 0.0) return 0.0;
  const double probability = static_cast<double>(rows_.probability(row)) *
                             static_cast<double>(columns_[row].probability(cell % kColumns));
  return probability * kCells / kSphere_sr;
}

glm::vec3 DirectionImportance::sample(const glm::dvec2& u) const {
  // Below 1 in single precision, too.
  const auto number = [](double value) {
    constexpr float kBelowOne = 0x1.fffffep-1F;
    return std::min(static_cast<float>(value), kBelowOne);
  };
  const auto row = rows_.choose(number(u.x));
  const auto column = columns_[row.index].choose(number(u.y));
  const auto place = [](const ray_tracing::PiecewiseDistribution::Choice& choice,
                        std::size_t count) {
    return (static_cast<double>(choice.index) + static_cast<double>(choice.rest)) /
           static_cast<double>(count);
  };
  return direction_on_sphere({place(row, kRows), place(column, kColumns)});
}

DirectionImportance measure_importance(const ray_tracing::RayScene& rays,
                                       const texel_atlas::TexelAtlas& atlas,
                                       const CarriedLight& light) {
  assert(light.radiance.size() == 2 * atlas.texels().size());
  Cells cells(DirectionImportance::kCells, 0.0);
  add_surfaces(rays, atlas, light, cells);
  if (light.has_environment) {
    add_environment(rays, ray_tracing::hash_combine(light.seed, 1), cells);
  }
  Cells roots(cells.size());
  for (std::size_t i = 0; i < cells.size(); ++i) {
    roots[i] = std::sqrt(cells[i] + cells[reverse_of(i)]);
  }
  return DirectionImportance(roots);
}

}  // namespace renderers::ray_bundles
