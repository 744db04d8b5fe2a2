#pragma once

#include "suites/command_line/verb_arguments.h"
#include "suites/suite_file.h"

namespace suites::command_line {

/// A suite named `ad-hoc` from scenes, methods and budgets; viewing conditions as `diff`'s default,
/// metrics relmse, flip and ssim unless named.
/// @throws base::InputError for unknown names, or if scenes or methods are missing
Suite make_ad_hoc_suite(const SuiteSelection& selection);

/// The scene file of an option: a path, or a name of the catalogue.
/// @throws base::InputError with the nearest known name
std::filesystem::path find_scene_option(const std::string& path_or_name);

}  // namespace suites::command_line
