#pragma once

#include "renderers/scene/generators/triangle_soup.h"

#include <cstdint>
#include <map>
#include <string>

namespace renderers::scene {

/// How finely curved things are cut.
struct AtriumDetail {
  float level = 1.0F;   ///< factor on the numbers of points along curves
  int cloth_rows = 32;  ///< of every cloth
};

/// Pieces by part: arcade, balustrade, banners, columns, curtain-a, curtain-b, floor, gallery,
/// plants, roof, shell (the outside), skylight, vases, vaults, voussoirs, walls, wood.
using AtriumParts = std::map<std::string, TriangleSoup>;

/// A court of 6.6 x 21 m, 10.4 m high, with a round-arched arcade in two storeys on all sides; the
/// long axis is z, the floor y = 0, the centre the origin. Aisles run behind the arcades, vaulted
/// below, open to the roof above; the roof has a skylight. Cloth and leaves have one layer.
/// @param seed  of folds, lengths, plants
AtriumParts atrium_building(std::uint64_t seed, const AtriumDetail& detail);

}  // namespace renderers::scene
