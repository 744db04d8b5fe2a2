#pragma once

#include "renderers/many_lights/light_emitters.h"

/// Emitters that stand for light without a position: points of area lights, directions of the
/// environment. A flux of zero means that the scene has none.
namespace renderers::many_lights {

Emitter area_emitter(const scene::Scene& scene, const EmitterSettings& settings);
Emitter environment_emitter(const scene::Scene& scene, const EmitterSettings& settings);

}  // namespace renderers::many_lights
