#pragma once

#include <string>
#include <vector>

#include "perception/base/document.h"

namespace suites {

/// Names of a suite document's profiles, in file order.
std::vector<std::string> profile_names(const base::Node& suite);

/// The suite's document with the values of a profile in place of its own.
///
/// A profile is {scenes: {<id>: {size, frame, frames, reference, set, matrix, zip, include,
/// exclude, measure}}, methods: {<id>: {preset, parameters, scenes, matrix, zip, include, exclude,
/// search, budgets, measure}}, budgets, measure}; maps are merged key by key, everything else is
/// replaced. What its `measure` states holds for all cells: the suite's scenes and methods lose
/// these keys of their own `measure`, unless the profile gives them some.
/// Every value keeps its place in the file.
///
/// @throws base::InputError for an unknown profile, key, scene or method
base::Node with_profile(const base::Node& suite, const std::string& profile);

}  // namespace suites
