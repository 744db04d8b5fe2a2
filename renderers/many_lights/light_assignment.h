#pragma once

#include <span>
#include <vector>

namespace renderers::many_lights {

/// Which emitter a virtual light belongs to.
struct LightSlot {
  int emitter = 0;
  int index = 0;  ///< rank among the emitter's lights
};

/// Deals virtual lights to emitters: as many as their share of the weights, rounded by largest
/// remainders, at least one for each emitter of positive weight (for the heaviest ones if there are
/// more of them than lights). An emitter's lights are spread evenly over the order by error
/// diffusion, so that a contiguous run of r lights holds r N_e / N of emitter e, up to one or two.
///
/// @param weights  finite, >= 0
/// @return `light_count` slots; none if no weight is positive
std::vector<LightSlot> assign_lights(std::span<const double> weights, int light_count);

/// The numbers of lights that `assign_lights` deals, one per weight.
std::vector<int> light_counts(std::span<const double> weights, int light_count);

}  // namespace renderers::many_lights
