#include "suites/suite_scenes.h"

#include <algorithm>

#include "renderers/scene/scene_file.h"

namespace suites {
namespace {

using renderers::scene::Scene;

SceneStates load_states(const SuiteScene& entry) {
  const renderers::scene::SceneFile file =
      renderers::scene::read_scene_file(entry.file, entry.overlays());
  check_frame_range(entry.frames, file.frame_count(), file.name());
  SceneStates states;
  states.warnings = file.warnings();
  for (const int frame : entry.frames.numbers()) {
    auto state = std::make_shared<const Scene>(file.at_frame(frame));
    const auto same = std::find_if(states.frames.begin(), states.frames.end(),
                                   [&](const auto& known) { return known->hash == state->hash; });
    states.frames.push_back(same == states.frames.end() ? std::move(state) : *same);
  }
  return states;
}

}  // namespace

std::vector<SceneStates> load_scenes(const Suite& suite) {
  std::vector<SceneStates> scenes;
  for (const SuiteScene& entry : suite.scenes) scenes.push_back(load_states(entry));
  return scenes;
}

}  // namespace suites
