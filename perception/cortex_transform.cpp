// Daly 1993, "The Visible Differences Predictor: An Algorithm for the Assessment of Image
//   Fidelity", in Watson (ed.), Digital Images and Human Vision, MIT Press: the cortex transform
//   after Watson 1987, "The Cortex Transform".
// Mesa, dom, baseband and fan were checked against a public implementation of the predictor
// (jterrace/hdrvdp). Equation numbers are not at hand.

#include "perception/cortex_transform.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

namespace perception {
namespace {

constexpr double kFanWidth_deg = 180.0 / CortexTransform::kOrientations;

/// Half-amplitude frequency of mesa k: 1, 1/2, 1/4, ... cycles per pixel.
double mesa_corner(int k) { return std::exp2(-k); }

/// tw = (2/3) rho.
double transition_width(int k) { return 2.0 / 3.0 * mesa_corner(k); }

/// (1 + cos(pi t)) / 2, t cut to [0, 1], to 1e-7: the sine's series, so that loops have no calls.
inline float half_cosine(float t) {
  constexpr auto kPi = std::numbers::pi_v<float>;
  const float y = kPi * (std::clamp(t, 0.0F, 1.0F) - 0.5F);
  const float y2 = y * y;
  const float tail = 1.0F / 362880.0F - y2 * (1.0F / 39916800.0F - y2 * (1.0F / 6227020800.0F));
  const float sine =
      y * (1.0F - y2 * (1.0F / 6.0F - y2 * (1.0F / 120.0F - y2 * (1.0F / 5040.0F - y2 * tail))));
  return 0.5F - 0.5F * sine;
}

/// Mesa k over frequency, as CortexTransform::mesa.
struct Mesa {
  explicit Mesa(int k)
      : corner(static_cast<float>(mesa_corner(k))),
        per_width(static_cast<float>(1.0 / transition_width(k))) {}
  float operator()(float rho) const { return half_cosine((rho - corner) * per_width + 0.5F); }
  float corner;
  float per_width;
};

/// Where the baseband ends.
double base_end() {
  return mesa_corner(CortexTransform::kLevels) + 0.5 * transition_width(CortexTransform::kLevels);
}

float base_gain(float rho) { return static_cast<float>(CortexTransform::base(double{rho})); }

/// A fan over direction: (1 + cos(6 (theta - theta_c))) / 2 within 30 degrees. With theta_c = 30 o
/// - 90 the cosine is cos(6 theta) or its negative, a polynomial of cos(theta)^2.
struct Fan {
  explicit Fan(int orientation)
      : cos_centre(static_cast<float>(
            std::cos(CortexTransform::centre_deg(orientation) * std::numbers::pi / 180.0))),
        sin_centre(static_cast<float>(
            std::sin(CortexTransform::centre_deg(orientation) * std::numbers::pi / 180.0))),
        sign(orientation % 2 == 1 ? 1.0F : -1.0F) {}

  /// @param rho2  fx^2 + fy^2, > 0
  float operator()(float fx, float fy, float rho2) const {
    constexpr float kCos2OfWidth = 0.75F;  // of 30 degrees
    const float along = fx * cos_centre + fy * sin_centre;
    const float c2 = fx * fx / rho2;
    const float cos6 = ((32.0F * c2 - 48.0F) * c2 + 18.0F) * c2 - 1.0F;
    const float inside = 0.5F + 0.5F * sign * cos6;
    return along * along > kCos2OfWidth * rho2 ? inside : 0.0F;
  }

  float cos_centre, sin_centre, sign;
};

/// Fills the gains of a column with gain(fy, rho2), where rho is below an end.
template <class Gain>
bool fill_below(double end, float fx, std::span<const float> fy, std::span<float> gains,
                const Gain& gain) {
  if (double{fx} >= end) return false;
  const auto end2 = static_cast<float>(end * end);
  const float* y = fy.data();
  float* __restrict out = gains.data();
  const std::size_t count = fy.size();
  for (std::size_t i = 0; i < count; ++i) {
    const float rho2 = fx * fx + y[i] * y[i];
    const float value = gain(y[i], rho2);
    out[i] = rho2 < end2 ? value : 0.0F;
  }
  return true;
}

}  // namespace

double orientation_difference_deg(double a_deg, double b_deg) {
  return std::abs(std::remainder(a_deg - b_deg, 180.0));
}

double CortexTransform::centre_cycles_px(int level) {
  assert(level >= 1 && level <= kLevels);
  // Between the transitions of mesa k - 1 and mesa k lies the single frequency (4/3) rho_k.
  return std::min(0.5, 4.0 / 3.0 * mesa_corner(level));
}

double CortexTransform::centre_deg(int orientation) {
  assert(orientation >= 0 && orientation < kOrientations);
  return orientation * kFanWidth_deg - 90.0;
}

/// 1 inside, 0 outside, half a cosine over the transition.
double CortexTransform::mesa(int k, double cycles_px) {
  assert(k >= 0 && k <= kLevels);
  const double t = (cycles_px - mesa_corner(k)) / transition_width(k) + 0.5;
  if (t <= 0.0) return 1.0;
  if (t >= 1.0) return 0.0;
  return 0.5 * (1.0 + std::cos(std::numbers::pi * t));
}

/// exp(-rho^2 / (2 sigma^2)), sigma = (rho_5 + tw_5 / 2) / 3.
double CortexTransform::base(double cycles_px) {
  if (cycles_px >= base_end()) return 0.0;
  const double ratio = 3.0 * cycles_px / base_end();
  return std::exp(-0.5 * ratio * ratio);
}

double CortexTransform::dom(int level, double cycles_px) {
  assert(level >= 1 && level <= kLevels);
  const double inner = level == kLevels ? base(cycles_px) : mesa(level, cycles_px);
  return mesa(level - 1, cycles_px) - inner;
}

/// (1 + cos(pi |theta - theta_c| / tw)) / 2 within tw = 180 / 6 degrees.
double CortexTransform::fan(int orientation, double angle_deg) {
  const double distance = orientation_difference_deg(angle_deg, centre_deg(orientation));
  if (distance >= kFanWidth_deg) return 0.0;
  return 0.5 * (1.0 + std::cos(std::numbers::pi * distance / kFanWidth_deg));
}

FrequencyResponse CortexTransform::channel_response(int level, int orientation) {
  assert(level >= 1 && level <= kLevels);
  const double end = mesa_corner(level - 1) + 0.5 * transition_width(level - 1);
  // A fan holds no fx above that of its edge nearest to the axis.
  const double nearest_deg =
      std::max(orientation_difference_deg(0.0, centre_deg(orientation)) - kFanWidth_deg, 0.0);
  const double last_fx = end * std::cos(nearest_deg * std::numbers::pi / 180.0);
  return [=, outer = Mesa(level - 1), inner = Mesa(level), fan = Fan(orientation)](
             float fx, std::span<const float> fy, std::span<float> gains) {
    if (double{fx} > last_fx) return false;
    constexpr float kAboveZero = 1e-30F;  // at frequency 0 the dom is 0, whatever the fan
    if (level < kLevels) {
      return fill_below(end, fx, fy, gains, [&](float y, float rho2) {
        const float rho = std::sqrt(rho2);
        return (outer(rho) - inner(rho)) * fan(fx, y, std::max(rho2, kAboveZero));
      });
    }
    return fill_below(end, fx, fy, gains, [&](float y, float rho2) {
      const float rho = std::sqrt(rho2);
      return (outer(rho) - base_gain(rho)) * fan(fx, y, std::max(rho2, kAboveZero));
    });
  };
}

FrequencyResponse CortexTransform::base_response() {
  return [end = base_end()](float fx, std::span<const float> fy, std::span<float> gains) {
    return fill_below(end, fx, fy, gains,
                      [](float, float rho2) { return base_gain(std::sqrt(rho2)); });
  };
}

FrequencyResponse CortexTransform::mesa_response(int k) {
  const double end = mesa_corner(k) + 0.5 * transition_width(k);
  return [end, mesa = Mesa(k)](float fx, std::span<const float> fy, std::span<float> gains) {
    return fill_below(end, fx, fy, gains, [&](float, float rho2) { return mesa(std::sqrt(rho2)); });
  };
}

CortexTransform::CortexTransform(const Image& image)
    : width_px_(image.width_px),
      height_px_(image.height_px),
      filter_(width_px_, height_px_),
      spectrum_(filter_.spectrum_of(image)) {}

Image CortexTransform::filtered(const FrequencyResponse& response) const {
  Image image = make_gray_image(width_px_, height_px_, "Y", Encoding::luminance_cd_m2);
  filter_.filter(spectrum_, response, image);
  return image;
}

Image CortexTransform::channel(int level, int orientation) const {
  return filtered(channel_response(level, orientation));
}

Image CortexTransform::baseband() const { return filtered(base_response()); }

}  // namespace perception
