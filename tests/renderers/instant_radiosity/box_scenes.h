#pragma once

#include <string>
#include <utility>
#include <vector>

#include "renderers/contract/renderer.h"
#include "renderers/scene/scene.h"

/// Small boxes with blocks in them, for pictures of one bounce.
namespace renderers::test {

/// A closed 2 m room with a block, lit by a spot light into a corner; Lambert, coloured walls.
scene::Scene spot_in_box();
/// The same room under a point light, an area light, and both with a spot light; and, open to one
/// side, under an environment.
std::vector<std::pair<std::string, scene::Scene>> boxes_by_light();
/// The room with a block and a floor that have a Phong lobe.
scene::Scene glossy_box();
/// A scene in other units: the light's power grows with the area, so that pictures stay.
scene::Scene scaled(scene::Scene scene, float scale);

/// Pixels that show the surface their neighbours show: the path tracer averages over a pixel, one
/// set of virtual lights looks through its centre. @param truth  of `path`
std::vector<bool> is_flat_pixel(const Frame& truth);

/// Mean over pixels and channels of `radiance`.
double mean_radiance(const Frame& frame);
/// sqrt(mean squared difference) / mean of the second.
double relative_rms(const Frame& test, const Frame& truth);

}  // namespace renderers::test
