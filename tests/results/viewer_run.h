#pragma once

#include <filesystem>

namespace test_results {

/// A run whose every pixel is known, for tests of the report's viewer; 16x12 pixels.
///
/// Scene "box": the reference is 0.25 everywhere; method "ramp" is 0.25 + x/64; method "<b>flat" is
/// 0.5 with a NaN in the green of pixel (3, 2); "ramp" has a relmse map of 0.01 everywhere.
/// Scene "moving": method "ramp" in frames 5, 6, 7, which are 0.125, 0.25, 0.5; relmse maps of
/// frames 5 and 6, 0.0125 and 0.025. Scene "sizes": method "ramp" of 16x12, method "<b>flat" of
/// 8x6.
/// @return the run folder
std::filesystem::path write_viewer_run(const std::filesystem::path& root);

}  // namespace test_results
