#include "renderers/scene/emission_profile.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace renderers::scene {

float emission_factor(std::span<const float> profile, float cosine) {
  if (profile.empty()) return 1.0F;
  assert(profile.size() >= 2);
  constexpr float kRightAngle_rad = 0.5F * std::numbers::pi_v<float>;
  const auto steps = static_cast<float>(profile.size() - 1);
  const float place = std::acos(std::clamp(cosine, 0.0F, 1.0F)) / kRightAngle_rad * steps;
  const auto low = std::min(static_cast<std::size_t>(place), profile.size() - 2);
  const float share = std::min(1.0F, place - static_cast<float>(low));
  return profile[low] + share * (profile[low + 1] - profile[low]);
}

/// The integral of f(t) sin 2t over 0 ... pi / 2, piece by piece: of f = a + b t the antiderivative
/// is -f(t) cos(2 t) / 2 + b sin(2 t) / 4.
double flux_factor(std::span<const float> profile) {
  if (profile.empty()) return 1.0;
  const double step_rad = 0.5 * std::numbers::pi / static_cast<double>(profile.size() - 1);
  double flux = 0.0;
  for (std::size_t i = 0; i + 1 < profile.size(); ++i) {
    const auto value = static_cast<double>(profile[i]);
    const auto next = static_cast<double>(profile[i + 1]);
    const double at_rad = static_cast<double>(i) * step_rad;
    const double end_rad = at_rad + step_rad;
    const double slope = (next - value) / step_rad;
    flux += 0.5 * (value * std::cos(2.0 * at_rad) - next * std::cos(2.0 * end_rad)) +
            0.25 * slope * (std::sin(2.0 * end_rad) - std::sin(2.0 * at_rad));
  }
  return flux;
}

}  // namespace renderers::scene
