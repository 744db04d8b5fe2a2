#include "renderers/ray_tracing/environment_sampler.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "renderers/ray_tracing/surface_brdf.h"

namespace renderers::ray_tracing {

namespace {

double pixel_luminance(const perception::Image& image, int x, int y) {
  const int column = (x + image.width_px) % image.width_px;
  const int row = std::clamp(y, 0, image.height_px - 1);
  const auto pixel = image.pixel(column, row);
  return static_cast<double>(luminance({pixel[0], pixel[1], pixel[2]}));
}

/// Mean of the bilinear lookup over a pixel: the tent's integral over the three pixels it touches.
double mean_luminance(const perception::Image& image, int x, int y) {
  constexpr std::array<double, 3> kTentWeights{0.125, 0.75, 0.125};
  double sum = 0.0;
  for (int j = -1; j <= 1; ++j) {
    for (int i = -1; i <= 1; ++i) {
      sum += kTentWeights[static_cast<std::size_t>(i + 1)] *
             kTentWeights[static_cast<std::size_t>(j + 1)] * pixel_luminance(image, x + i, y + j);
    }
  }
  return sum;
}

std::size_t cell_of(float position, std::size_t count) {
  const float scaled = position * static_cast<float>(count);
  return std::min(static_cast<std::size_t>(std::max(scaled, 0.0F)), count - 1);
}

}  // namespace

EnvironmentSampler::EnvironmentSampler(const scene::Environment& environment)
    : environment_(&environment) {
  const perception::Image& image = environment.image;
  std::vector<double> row_weights;
  std::vector<double> weights(static_cast<std::size_t>(image.width_px));
  for (int y = 0; y < image.height_px; ++y) {
    for (int x = 0; x < image.width_px; ++x) {
      weights[static_cast<std::size_t>(x)] = mean_luminance(image, x, y);
    }
    columns_.emplace_back(weights);
    const double polar_rad = std::numbers::pi * (y + 0.5) / image.height_px;
    row_weights.push_back(columns_.back().total() * std::sin(polar_rad));
  }
  rows_ = PiecewiseDistribution(row_weights);
  const double cell = 2.0 * std::numbers::pi * std::numbers::pi /
                      (static_cast<double>(image.width_px) * image.height_px);
  power_ = rows_.total() * cell * static_cast<double>(environment.scale);
}

float EnvironmentSampler::solid_angle_density(float cell_probability, float v) const {
  const float sine = std::sin(kPi * v);
  if (sine <= 0.0F) return 0.0F;
  const auto cells = static_cast<float>(rows_.size() * columns_.front().size());
  // d omega = 2 pi^2 sin(theta) du dv.
  return cell_probability * cells / (2.0F * kPi * kPi * sine);
}

EnvironmentSampler::Sample EnvironmentSampler::sample(const glm::vec2& u) const {
  const auto row = rows_.choose(u.y);
  const auto column = columns_[row.index].choose(u.x);
  const glm::vec2 position(
      (static_cast<float>(column.index) + column.rest) /
          static_cast<float>(columns_[row.index].size()),
      (static_cast<float>(row.index) + row.rest) / static_cast<float>(rows_.size()));
  Sample sample;
  sample.direction = scene::environment_direction(*environment_, position);
  sample.pdf = solid_angle_density(row.probability * column.probability, position.y);
  return sample;
}

float EnvironmentSampler::pdf(const glm::vec3& direction) const {
  const glm::vec2 position = scene::environment_position(*environment_, direction);
  const std::size_t row = cell_of(position.y, rows_.size());
  const std::size_t column = cell_of(position.x, columns_[row].size());
  return solid_angle_density(rows_.probability(row) * columns_[row].probability(column),
                             position.y);
}

}  // namespace renderers::ray_tracing
