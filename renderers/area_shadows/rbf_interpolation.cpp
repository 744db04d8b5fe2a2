#include "renderers/area_shadows/rbf_interpolation.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

namespace renderers::area_shadows {

namespace {

/// Least square of a distance, px2, at which two places are not the same.
constexpr float kSamePlace_px2 = 1e-6F;
/// Least determinant of Phi of three bases, and least value a constant comes out as, that
/// `normalised` trusts; ours.
constexpr float kLeastDeterminant = 0.02F;
constexpr float kLeastConstant = 0.5F;

float squared_distance(const glm::vec2& a, const glm::vec2& b) {
  const glm::vec2 between = a - b;
  return glm::dot(between, between);
}

/// Directions that the sectors around a place are nearest to; the first lies along no row of
/// pixels.
std::array<glm::vec2, kMostBases> sector_directions(std::size_t count) {
  constexpr float kFirst_rad = 0.6F;
  std::array<glm::vec2, kMostBases> directions{};
  for (std::size_t i = 0; i < count; ++i) {
    const float turns = static_cast<float>(i) / static_cast<float>(count);
    const float angle_rad = kFirst_rad + 2.0F * std::numbers::pi_v<float> * turns;
    directions[i] = {std::cos(angle_rad), std::sin(angle_rad)};
  }
  return directions;
}

std::size_t sector_of(const glm::vec2& direction, std::span<const glm::vec2> sectors) {
  std::size_t best = 0;
  float most = glm::dot(direction, sectors[0]);
  for (std::size_t i = 1; i < sectors.size(); ++i) {
    const float along = glm::dot(direction, sectors[i]);
    if (along <= most) continue;
    most = along;
    best = i;
  }
  return best;
}

Bases nearest(const glm::vec2& place_px, std::span<const LightSample> samples, std::size_t count) {
  Bases bases;
  std::array<float, kMostBases> distances{};
  for (const LightSample& sample : samples) {
    const float distance = squared_distance(place_px, sample.position_px);
    if (bases.count == count && distance >= distances[count - 1]) continue;
    std::size_t at = bases.count < count ? bases.count++ : count - 1;
    for (; at > 0 && distances[at - 1] > distance; --at) {
      distances[at] = distances[at - 1];
      bases.samples[at] = bases.samples[at - 1];
    }
    distances[at] = distance;
    bases.samples[at] = &sample;
  }
  return bases;
}

Bases nearest_by_sector(const glm::vec2& place_px, std::span<const LightSample> samples,
                        std::span<const glm::vec2> sectors) {
  std::array<const LightSample*, kMostBases> found{};
  std::array<float, kMostBases> distances{};
  for (const LightSample& sample : samples) {
    const glm::vec2 direction = sample.position_px - place_px;
    const float distance = glm::dot(direction, direction);
    const std::size_t sector = sector_of(direction, sectors);
    if (found[sector] != nullptr && distance >= distances[sector]) continue;
    found[sector] = &sample;
    distances[sector] = distance;
  }
  Bases bases;
  for (const LightSample* sample : found) {
    if (sample != nullptr) bases.samples[bases.count++] = sample;
  }
  return bases;
}

/// A symmetric positive matrix and a right side, solved in place by Cholesky's method.
class Equations {
 public:
  explicit Equations(std::size_t size) : size_(size) {}
  float& at(std::size_t row, std::size_t column) { return values_[row][column]; }
  std::array<float, kMostBases>& right() { return right_; }

  /// @return the determinant; not above 0: there is no solution
  float solve() {
    float determinant = 1.0F;
    for (std::size_t j = 0; j < size_; ++j) {
      float pivot = at(j, j);
      for (std::size_t k = 0; k < j; ++k) pivot -= at(j, k) * at(j, k);
      determinant *= pivot;
      if (pivot <= 0.0F) return 0.0F;
      at(j, j) = std::sqrt(pivot);
      for (std::size_t i = j + 1; i < size_; ++i) {
        float value = at(i, j);
        for (std::size_t k = 0; k < j; ++k) value -= at(i, k) * at(j, k);
        at(i, j) = value / at(j, j);
      }
    }
    for (std::size_t i = 0; i < size_; ++i) {
      for (std::size_t k = 0; k < i; ++k) right_[i] -= at(i, k) * right_[k];
      right_[i] /= at(i, i);
    }
    for (std::size_t i = size_; i-- > 0;) {
      for (std::size_t k = i + 1; k < size_; ++k) right_[i] -= at(k, i) * right_[k];
      right_[i] /= at(i, i);
    }
    return determinant;
  }

 private:
  std::size_t size_;
  std::array<std::array<float, kMostBases>, kMostBases> values_{};
  std::array<float, kMostBases> right_{};
};

/// Eq. 3, for any number of samples.
glm::vec3 weighted_mean(const glm::vec2& place_px, const Bases& bases, float scale_px2) {
  glm::vec3 sum(0.0F);
  float weights = 0.0F;
  // Distances from the nearest: far samples must not all have weight 0.
  float least = squared_distance(place_px, bases.samples[0]->position_px);
  for (std::size_t i = 1; i < bases.count; ++i) {
    least = std::min(least, squared_distance(place_px, bases.samples[i]->position_px));
  }
  for (std::size_t i = 0; i < bases.count; ++i) {
    const float distance = squared_distance(place_px, bases.samples[i]->position_px);
    const float weight = std::exp((least - distance) / scale_px2);
    sum += weight * bases.samples[i]->irradiance;
    weights += weight;
  }
  return sum / weights;
}

using Weights = std::array<float, kMostBases>;

/// Weights of the samples at a place.
struct PlaceWeights {
  Weights phi{};    ///< phi(x)
  Weights basis{};  ///< a = Phi^-1 phi(x), by their sum unless raw
};

/// Nothing where they cannot be trusted.
std::optional<PlaceWeights> basis_weights(const glm::vec2& place_px, const Bases& bases,
                                          float scale_px2, RbfForm form) {
  Equations equations(bases.count);
  for (std::size_t i = 0; i < bases.count; ++i) {
    const glm::vec2& own = bases.samples[i]->position_px;
    equations.at(i, i) = 1.0F;
    for (std::size_t j = 0; j < i; ++j) {
      equations.at(i, j) =
          std::exp(-squared_distance(own, bases.samples[j]->position_px) / scale_px2);
    }
    equations.right()[i] = std::exp(-squared_distance(own, place_px) / scale_px2);
  }
  PlaceWeights result;
  result.phi = equations.right();
  const float determinant = equations.solve();
  if (determinant <= 0.0F) return std::nullopt;
  result.basis = equations.right();
  if (form == RbfForm::raw) return result;
  float constant = 0.0F;
  for (std::size_t i = 0; i < bases.count; ++i) constant += result.basis[i];
  const bool is_close = bases.count == 3 && determinant < kLeastDeterminant;
  if (is_close || constant < kLeastConstant) return std::nullopt;
  for (std::size_t i = 0; i < bases.count; ++i) result.basis[i] /= constant;
  return result;
}

glm::vec3 combine(const Bases& bases, const Weights& weights) {
  glm::vec3 sum(0.0F);
  for (std::size_t i = 0; i < bases.count; ++i) sum += weights[i] * bases.samples[i]->irradiance;
  return sum;
}

/// Not below the least nor above the greatest sample, per channel.
glm::vec3 bounded(const Bases& bases, const glm::vec3& value) {
  glm::vec3 least = bases.samples[0]->irradiance;
  glm::vec3 greatest = least;
  for (std::size_t i = 1; i < bases.count; ++i) {
    least = glm::min(least, bases.samples[i]->irradiance);
    greatest = glm::max(greatest, bases.samples[i]->irradiance);
  }
  return glm::clamp(value, least, greatest);
}

/// The plane nearest to the samples with the weights phi(x), taken out of them before they are
/// interpolated, and added again. Nothing for samples in a row.
std::optional<glm::vec3> planar(const glm::vec2& place_px, const Bases& bases, float width_px,
                                const PlaceWeights& weights) {
  // Rows (1, x, y) about the place, in widths: plane = (sum of w r r^T)^-1 sum of w r I, and its
  // first coefficient is the value at the place.
  constexpr float kLeastDeterminantOfPlane = 1e-4F;
  glm::mat3 normal(0.0F);
  glm::mat3 right(0.0F);  // a column per channel
  std::array<glm::vec3, kMostBases> rows{};
  for (std::size_t i = 0; i < bases.count; ++i) {
    rows[i] = {1.0F, (bases.samples[i]->position_px - place_px) / width_px};
    const float weight = weights.phi[i];
    normal += weight * glm::outerProduct(rows[i], rows[i]);
    right += weight * glm::outerProduct(rows[i], bases.samples[i]->irradiance);
  }
  const float determinant = glm::determinant(normal);
  const float scale = normal[0][0] * normal[1][1] * normal[2][2];
  if (!(determinant > kLeastDeterminantOfPlane * scale)) return std::nullopt;
  const glm::mat3 plane = glm::inverse(normal) * right;
  glm::vec3 value(plane[0][0], plane[1][0], plane[2][0]);
  for (std::size_t i = 0; i < bases.count; ++i) {
    value += weights.basis[i] * (bases.samples[i]->irradiance - rows[i] * plane);
  }
  return value;
}

}  // namespace

BaseChooser::BaseChooser(const RbfSettings& settings)
    : settings_(settings), sectors_(sector_directions(settings.bases)) {}

Bases BaseChooser::choose(const glm::vec2& place_px, std::span<const LightSample> samples) const {
  return settings_.choice == RbfChoice::nearest
             ? nearest(place_px, samples, settings_.bases)
             : nearest_by_sector(place_px, samples, std::span(sectors_).first(settings_.bases));
}

glm::vec3 interpolate(const glm::vec2& place_px, const Bases& bases, float width_px,
                      const RbfSettings& settings) {
  if (bases.count == 0) return glm::vec3(0.0F);
  const float scale_px2 = settings.spread * width_px * width_px;
  for (std::size_t i = 0; i < bases.count; ++i) {
    const LightSample& sample = *bases.samples[i];
    if (squared_distance(place_px, sample.position_px) < kSamePlace_px2) return sample.irradiance;
  }
  // Forms that keep constants have nothing to do for one.
  const bool is_constant = std::all_of(
      bases.samples.begin(), bases.samples.begin() + static_cast<std::ptrdiff_t>(bases.count),
      [&](const LightSample* sample) {
        return sample->irradiance == bases.samples[0]->irradiance;
      });
  if (is_constant && settings.form != RbfForm::raw) return bases.samples[0]->irradiance;
  if (bases.count < 3) return weighted_mean(place_px, bases, scale_px2);
  const auto weights = basis_weights(place_px, bases, scale_px2, settings.form);
  if (!weights) return weighted_mean(place_px, bases, scale_px2);
  if (settings.form == RbfForm::raw) return combine(bases, weights->basis);
  if (settings.form == RbfForm::planar) {
    const auto value = planar(place_px, bases, width_px, *weights);
    if (value) return bounded(bases, *value);
  }
  return bounded(bases, combine(bases, weights->basis));
}

}  // namespace renderers::area_shadows
