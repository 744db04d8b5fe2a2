#pragma once

#include <memory>
#include <string>
#include <vector>

#include "renderers/scene/scene.h"
#include "suites/suite_file.h"

namespace suites {

/// The states of a suite's scene, one per frame in order. Frames that look alike share one.
struct SceneStates {
  std::vector<std::shared_ptr<const renderers::scene::Scene>> frames;  ///< never empty
  std::vector<std::string> warnings;  ///< what reading the scene passed over or repaired
  const renderers::scene::Scene& first() const { return *frames.front(); }
};

/// Reads the scene files of a suite, one entry per scene in order.
/// @throws base::InputError as read_scene_file, and for a sequence that the scene is too short for
std::vector<SceneStates> load_scenes(const Suite& suite);

}  // namespace suites
