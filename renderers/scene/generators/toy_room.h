#pragma once

#include "renderers/scene/generators/generator_list.h"

#include <vector>

namespace renderers::scene {

/// A child's room with plants grown by an L-system, after the scene "toy room" of Scheel,
/// Stamminger, Seidel 2002, "Grid Based Final Gather for Radiosity on Complex Clustered Scenes",
/// CGF 21(3), Sec. 6, whose geometry is lost: 250,000 triangles there.
///
/// {seed: 1, triangles: 250000}; met within 0.1 percent by the fineness of the leaves. x from -2.5
/// to 2.5 m, z from -2 to 2 m, y from 0 to 2.6 m. Parts: balls-a, balls-b, bear, blocks-a to
/// blocks-c, ceiling, floor, furniture, lamp, leaves, pots, rug, stems, train, walls, wheels,
/// window; lamp and window emit; all have normals and uvs.
std::vector<GeneratedPart> toy_room(base::MapReader& reader);

}  // namespace renderers::scene
