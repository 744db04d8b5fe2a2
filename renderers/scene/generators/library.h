#pragma once

#include "renderers/scene/generators/generator_list.h"

#include <vector>

namespace renderers::scene {

/// A reading room full of books under 80 large area lights, after the scene "library" of Scheel,
/// Stamminger, Seidel 2002, "Grid Based Final Gather for Radiosity on Complex Clustered Scenes",
/// CGF 21(3), Sec. 6, whose geometry is lost: 500,000 triangles there.
///
/// {seed: 1, triangles: 500000}; the number of triangles is met within 0.1 percent by the roundness
/// of the books' spines. x from -5 to 5 m, z from 0 to 16 m, y from 0 to 3.2 m. Parts: books-a to
/// books-f, cases, ceiling, floor, lamp-1 to lamp-80, pages, tables, walls; all have normals and
/// uvs.
std::vector<GeneratedPart> library(base::MapReader& reader);

}  // namespace renderers::scene
