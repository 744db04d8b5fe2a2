#pragma once

#include <array>
#include <cstddef>
#include <span>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "renderers/area_shadows/fragment_light.h"

namespace renderers::area_shadows {

enum class RbfForm {
  raw,         ///< Eqs. 1 and 2 as they are: a constant comes out as 0.5 to 1.2 times itself
  normalised,  ///< divided by what a constant of 1 comes out as, never beyond the samples' values
  planar       ///< the same for what the samples differ from the plane nearest to them
};

enum class RbfChoice {
  nearest,  ///< the nearest samples, wherever they lie
  sectors   ///< the nearest one in each of as many sectors around the place
};

/// Most basis functions of a place.
inline constexpr std::size_t kMostBases = 8;

struct RbfSettings {
  RbfForm form = RbfForm::normalised;
  RbfChoice choice = RbfChoice::sectors;
  std::size_t bases = 3;
  float spread = 2.0F;  ///< C of Eq. 2b
};

/// Samples that a place is interpolated from.
struct Bases {
  std::array<const LightSample*, kMostBases> samples{};
  std::size_t count = 0;
};

/// Chooses the samples of places.
class BaseChooser {
 public:
  explicit BaseChooser(const RbfSettings& settings);
  /// @param samples  all that may be used; the order decides between equally near ones
  Bases choose(const glm::vec2& place_px, std::span<const LightSample> samples) const;

 private:
  RbfSettings settings_;
  std::array<glm::vec2, kMostBases> sectors_{};  ///< unit directions, the first `bases` of them
};

/// Irradiance at a place by Gaussian radial basis functions around samples.
///
/// Phi_ij = exp(-d_ij^2 / C), d in units of `width_px`; value sum of w_i Phi(|x - x_i|) with
/// w = Phi^-1 I. That is sum of a_i I_i with a = Phi^-1 phi(x), as Phi is symmetric; `normalised`
/// divides by sum of a_i. `planar` does so with the differences of the samples from a plane, fitted
/// by least squares with the weights phi(x), so that a ramp comes out as one. Two samples, or bases
/// too close to each other to be told apart, give the mean weighted by Phi; one gives its value,
/// none 0.
///
/// Source: Koa and Johan 2016, doi:10.1145/2949035.2949043, Eqs. 1 to 3. Differs from the paper:
/// `normalised`, `planar` (moving least squares: Lancaster and Salkauskas 1981,
/// doi:10.1090/S0025-5718-1981-0616367-1, recalled), and any number of bases.
/// @param width_px  of the fragment that the place lies in
glm::vec3 interpolate(const glm::vec2& place_px, const Bases& bases, float width_px,
                      const RbfSettings& settings);

}  // namespace renderers::area_shadows
