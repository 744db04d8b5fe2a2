#pragma once

#include <cstddef>
#include <span>

namespace renderers::scene {

/// Most values of a profile.
inline constexpr std::size_t kMostProfileValues = 1801;

/// Radiance of an emitter by the angle from its front normal, over `Material::emission`: a polar
/// curve as luminaires are measured by (rotationally symmetric). Values stand at equal steps from 0
/// to 90 degrees, linear in the angle between; without values it is 1 at all angles.
/// Source: the photometric files of luminaires (ANSI/IES LM-63, from memory), which tabulate
/// intensity so; here it is radiance, without the cosine of the emitter's area.
/// @param profile  empty, or at least two values  @param cosine  of the angle from the normal
float emission_factor(std::span<const float> profile, float cosine);

/// Flux of an emitter over that of one that shines alike at all angles: the integral over the
/// hemisphere of factor times cosine, over pi; exact.
double flux_factor(std::span<const float> profile);

}  // namespace renderers::scene
