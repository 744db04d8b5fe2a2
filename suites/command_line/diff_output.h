#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "suites/command_line/diff_scores.h"

namespace suites::command_line {

/// "ok", or "non_finite" if a pixel that counts is NaN or infinite.
std::string status_of(const DiffResult& result, bool ignores_non_finite);

/// What `discern diff --json` prints (DESIGN section 7); several tests: in "tests"; sequences: with
/// "frames".
nlohmann::ordered_json diff_json(const DiffInputs& inputs, const std::vector<DiffResult>& results,
                                 bool ignores_non_finite);

/// The same for a person: viewing conditions and their origins, one table of all tests and metrics,
/// then what else there is to say of each test.
std::string diff_text(const DiffInputs& inputs, const std::vector<DiffResult>& results);

/// A score as both print it: "0.0123", "inf", "n/a".
std::string value_text(double value);

/// Value of a score's map at the pixel of `inputs.at`; NaN if it has no map.
double map_value(const DiffScore& entry, const DiffInputs& inputs);

/// Whether the image or the sequence has non-finite pixels, how many and where the first one is:
/// "2 non-finite pixels in t.exr, the first at (4, 2)", of a sequence "..., the first in frame 3 at
/// (4, 2)".
std::string non_finite_text(const DiffImage& image);

}  // namespace suites::command_line
