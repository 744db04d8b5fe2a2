#pragma once

#include <vector>

#include "suites/parameter_grid.h"
#include "suites/suite_file.h"

namespace suites {

/// The scenes that the `matrix`, `zip`, `include` and `exclude` of a suite's scene make of it; the
/// scene itself if there are none.
///
/// An axis of `matrix` or `zip` is {label: what to lay over the scene, ...}, or of single values
/// {path: lights.key.position.1, values: [1, 2]}, which lays {lights: {key: {position: {1: 1}}}}
/// over it. `include` and `exclude` name the labels and values of axes. Points are in the order of
/// parameter_grid.
///
/// @param entry  with its `id` alone: each result adds the values of its point, "id[view=front]"
/// @throws base::InputError with the place in the suite's file; what the scene itself makes of an
///   overlay shows when it is loaded
std::vector<SuiteScene> swept_scenes(const SuiteScene& entry, const GridKeys& keys);

}  // namespace suites
