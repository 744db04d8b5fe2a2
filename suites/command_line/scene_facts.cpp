#include "suites/command_line/scene_facts.h"

#include <algorithm>

namespace suites::command_line {

std::size_t light_count(const renderers::scene::Scene& scene) {
  const auto emissive =
      std::count_if(scene.objects.begin(), scene.objects.end(), [&scene](const auto& object) {
        return scene.materials.at(static_cast<std::size_t>(object.material)).is_emissive();
      });
  return scene.lights.size() + static_cast<std::size_t>(emissive) +
         (scene.environment != nullptr ? 1U : 0U);
}

std::vector<std::string> feature_names(const renderers::scene::Scene& scene) {
  std::vector<std::string> names;
  for (const auto feature : renderers::scene::features_of(scene)) {
    names.push_back(renderers::scene::to_string(feature));
  }
  return names;
}

}  // namespace suites::command_line
