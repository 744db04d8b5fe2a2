#pragma once

#include "renderers/scene/generators/generator_list.h"

#include <vector>

namespace renderers::scene {

/// A two-storey arcade around a court, with vaults, balustrades, cloth and plants: what is hard
/// about the Sponza atrium of Dabrovic and Meinl, in geometry of our own.
///
/// {seed: 1, triangles: 98000}; the number of triangles is met within 2 percent. The parts are
/// those of `atrium_building`; all have normals and uvs.
std::vector<GeneratedPart> atrium(base::MapReader& reader);

}  // namespace renderers::scene
