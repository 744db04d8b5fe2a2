#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "results/run_record.h"

namespace results::html_report {

/// One piece of a stage bar.
struct StageSpan {
  std::string name;   ///< top-level stage, or "unattributed"
  std::string phase;  ///< "prepare", "update", "render", "" for what no stage covers
  double wall_s = 0.0;
};

/// Whether a stage is `readback` or lies within one, at any depth: it is no part of total_s.
bool is_readback(const renderers::StageRecord& stage);

/// The record's stages, the time of every `readback` taken out of the stages around it, as it is
/// out of total_s; the readbacks themselves stay as they are.
std::vector<renderers::StageRecord> stages_of_total(const RenderRecord& record);

/// The pieces of total_s, of a following frame those of next_frame_s: prepare's or update's stages,
/// render's stages, the unattributed rest. `readback` is left out, as it is in total_s; so are
/// stages of no length, and a new view.
std::vector<StageSpan> stage_spans(const RenderRecord& record);

/// A horizontal stacked bar. @param full_scale_s  time at its right end, > 0
std::string stage_bar(const RenderRecord& record, double full_scale_s);

/// Names and colours of the stages that occur in the records, and what the hatch means.
std::string stage_legend(const std::vector<const RenderRecord*>& records);

/// CSS class of a stage's colour: every name of the stage vocabulary has one of its own.
std::string stage_class(std::string_view name);

/// Multiples of 1, 2 or 5 x 10^k from 0 to `high`, about five of them. @param high  > 0
std::vector<double> axis_ticks(double high);

}  // namespace results::html_report
