#pragma once

#include "renderers/scene/generators/generator_list.h"

#include <vector>

namespace renderers::scene {

/// A bush of an L-system (lindenmayer_plant.h) that stands in the origin.
///
/// {seed: 1, height: 0.9, steps: 5, leaf_length: [0.05, 0.1], leaf_segments: 4}: metres; steps 1 to
/// 7, every one has about three times the leaves of the one before. Parts: leaves, stems, with
/// normals and uvs.
std::vector<GeneratedPart> plant(base::MapReader& reader);

}  // namespace renderers::scene
