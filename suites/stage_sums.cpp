#include "suites/stage_sums.h"

#include <algorithm>
#include <string>
#include <string_view>

namespace suites {
namespace {

constexpr std::string_view kReadbackStage = "readback";

std::string_view last_name(std::string_view path) {
  const std::size_t slash = path.rfind('/');
  return slash == std::string_view::npos ? path : path.substr(slash + 1);
}

bool is_inside(const renderers::StageRecord& inner, const renderers::StageRecord& outer) {
  return inner.phase == outer.phase && inner.path.size() > outer.path.size() &&
         inner.path.starts_with(outer.path) && inner.path[outer.path.size()] == '/';
}

bool is_named(const renderers::StageRecord& stage, std::string_view name) {
  return last_name(stage.path) == name;
}

}  // namespace

double readback_s(std::span<const renderers::StageRecord> stages) {
  double sum_s = 0.0;
  for (const renderers::StageRecord& stage : stages) {
    if (!is_named(stage, kReadbackStage)) continue;
    const bool is_counted = std::any_of(stages.begin(), stages.end(), [&](const auto& other) {
      return is_named(other, kReadbackStage) && is_inside(stage, other);
    });
    if (!is_counted) sum_s += stage.wall_s;
  }
  return sum_s;
}

double top_level_s(std::span<const renderers::StageRecord> stages) {
  double sum_s = 0.0;
  for (const renderers::StageRecord& stage : stages) {
    if (stage.path.find('/') == std::string::npos) sum_s += stage.wall_s;
  }
  return sum_s;
}

std::vector<renderers::StageRecord> without_checkpoints(
    std::span<const renderers::StageRecord> stages) {
  std::vector<renderers::StageRecord> kept(stages.begin(), stages.end());
  for (const renderers::StageRecord& stage : stages) {
    if (!is_named(stage, kCheckpointStage)) continue;
    for (renderers::StageRecord& outer : kept) {
      if (!is_inside(stage, outer)) continue;
      outer.wall_s -= stage.wall_s;
      outer.cpu_s -= stage.cpu_s;
    }
  }
  std::erase_if(kept, [](const auto& stage) { return is_named(stage, kCheckpointStage); });
  return kept;
}

}  // namespace suites
