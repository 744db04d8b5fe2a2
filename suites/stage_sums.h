#pragma once

#include <span>
#include <vector>

#include "renderers/contract/stage_timer.h"

namespace suites {

/// Stage that the harness opens around a checkpoint sink, wherever the renderer calls it.
inline constexpr const char* kCheckpointStage = "checkpoint_sink";

/// Wall time of the stages named `readback`, seconds, at any depth; one inside another counts once.
double readback_s(std::span<const renderers::StageRecord> stages);

/// Sum of the top-level stages of all phases, seconds.
double top_level_s(std::span<const renderers::StageRecord> stages);

/// The stages as if no checkpoint had been stored: its time leaves the stages around it.
std::vector<renderers::StageRecord> without_checkpoints(
    std::span<const renderers::StageRecord> stages);

}  // namespace suites
