#pragma once

#include <filesystem>
#include <string>

#include "suites/suite_file.h"
#include "suites/suite_runner.h"

namespace tests {

/// A room with one point light: what `path` renders in milliseconds.
inline const std::string kSceneText = R"(schema: 1
scene: two-walls
luminance_scale_cd_m2: 50
camera: {position: [0, 1, -3], look_at: [0, 1, 1], up: [0, 1, 0], vertical_fov_deg: 40}
materials: {white: {albedo: [0.5, 0.5, 0.5]}}
objects:
  - {name: room, box: {min: [-2, 0, -4], max: [2, 2, 2], facing: in}, material: white}
lights: [{name: key, type: point, position: [0, 1.5, 0], intensity: [3, 3, 3]}]
)";

/// Everything of a suite before its methods; one scene "walls" of 16x16 pixels.
inline const std::string kSuiteHead = R"(schema: 1
suite: trial
viewing: {ppd: 60, display: {peak_cd_m2: 200, black_cd_m2: 0.2, ambient_lux: 250}, exposure: scene}
scenes: [{id: walls, file: walls.yaml, size: [16, 16], reference: {renderer: path, samples: 16}}]
)";

/// A box that stands until frame 2, moves until frame 5 and stands again, in such a room: frames 0
/// to 5 have four states.
inline const std::string kMovingText = R"(schema: 1
scene: moving-block
luminance_scale_cd_m2: 50
camera: {position: [0, 1, -3], look_at: [0, 1, 1], up: [0, 1, 0], vertical_fov_deg: 40}
materials: {white: {albedo: [0.5, 0.5, 0.5]}}
objects:
  - {name: room, box: {min: [-2, 0, -4], max: [2, 2, 2], facing: in}, material: white}
  - {name: block, box: {min: [-0.3, 0, 0], max: [0.3, 0.6, 0.6]}, material: white,
     animation: {keys: [{frame: 2, translate: [-0.8, 0, 0]}, {frame: 5, translate: [0.8, 0, 0]}]}}
lights: [{name: key, type: point, position: [0, 1.5, 0], intensity: [3, 3, 3]}]
)";

/// As kSuiteHead, its one scene "moving" being frames 0 to 3 of the block.
inline const std::string kSequenceHead = R"(schema: 1
suite: trial
viewing: {ppd: 60, display: {peak_cd_m2: 200, black_cd_m2: 0.2, ambient_lux: 250}, exposure: scene}
scenes: [{id: moving, file: moving.yaml, size: [16, 16], frames: [0, 3],
          reference: {renderer: path, samples: 16}}]
)";

/// Writes walls.yaml and moving.yaml into the folder.
void write_scene(const std::filesystem::path& folder);

/// Reads a suite whose file would stand in the folder; writes the scenes first.
suites::Suite suite_from(const std::filesystem::path& folder, const std::string& text,
                         const std::string& profile = "");

/// Options with results in the folder and the tests' own worker.
suites::RunOptions run_options(const std::filesystem::path& folder);

/// Runs a suite without a display.
suites::RunOutcome run(const suites::Suite& suite, const suites::RunOptions& options);

}  // namespace tests
