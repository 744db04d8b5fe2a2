#pragma once

#include <string>
#include <utility>
#include <vector>

#include "perception/base/document.h"

namespace suites {

/// One point of a sweep: parameter names (snake_case) with the values as they stand in the file.
using GridPoint = std::vector<std::pair<std::string, base::Node>>;

/// The keys of a method that span a grid of parameter values; null where the file lacks them.
struct GridKeys {
  const base::Node* matrix = nullptr;   ///< {name: [values]}: every combination
  const base::Node* zip = nullptr;      ///< {name: [values]}: lists of one length, in lockstep
  const base::Node* include = nullptr;  ///< [{name: value}]
  const base::Node* exclude = nullptr;  ///< [{name: value}]
};

/// The keys with `include` and `exclude` looked for inside `matrix`, too.
/// @throws base::InputError if one of them stands beside `matrix` and inside it
GridKeys with_points_inside(GridKeys keys);

/// The points of a grid, the last matrix axis varying fastest, zip fastest of all.
///
/// `exclude` removes the combinations that hold all values of one of its maps. Then each map of
/// `include` is added to every combination whose matrix and zip values it does not contradict; a
/// map that fits none becomes a point of its own. `include` and `exclude` may stand beside `matrix`
/// or inside it.
///
/// @return one empty point if there are no keys
/// @throws base::InputError with the place: empty lists, lists of unequal length in `zip`, an
///   exclusion that removes nothing, a grid without points
std::vector<GridPoint> parameter_grid(const GridKeys& keys);

}  // namespace suites
