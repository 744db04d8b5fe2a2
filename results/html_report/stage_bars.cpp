#include "results/html_report/stage_bars.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "perception/base/units.h"
#include "results/html_report/html_text.h"

namespace results::html_report {

namespace {

/// The stage vocabulary of every renderer; the style sheet gives each a colour.
constexpr std::array<std::string_view, 12> kVocabulary{
    "scene_update", "build",  "lights", "cluster",  "shadow",  "visibility",
    "transport",    "gather", "filter", "upsample", "masking", "readback"};

constexpr const char* kUnattributed = "unattributed";
constexpr std::string_view kReadback = "readback";

bool is_top_level(const renderers::StageRecord& stage) {
  return stage.path.find('/') == std::string::npos;
}

/// Whether the path, or the path of a stage around it, ends in `readback`.
bool has_readback(std::string_view path) {
  while (!path.empty()) {
    const std::size_t slash = path.rfind('/');
    if (path.substr(slash == std::string_view::npos ? 0 : slash + 1) == kReadback) return true;
    path = path.substr(0, slash == std::string_view::npos ? 0 : slash);
  }
  return false;
}

/// A readback that is in no other: its time is to be taken out once.
bool is_outermost_readback(const renderers::StageRecord& stage) {
  const std::size_t slash = stage.path.rfind('/');
  if (slash == std::string::npos) return stage.path == kReadback;
  return has_readback(stage.path) && !has_readback(stage.path.substr(0, slash));
}

bool is_inside(const renderers::StageRecord& inner, const renderers::StageRecord& outer) {
  return inner.phase == outer.phase && inner.path.starts_with(outer.path + "/");
}

void take_out(const renderers::StageRecord& inner, renderers::StageRecord& outer) {
  outer.wall_s -= inner.wall_s;
  outer.cpu_s -= inner.cpu_s;
  const bool has_gpu_times = inner.gpu_s >= 0.0 && outer.gpu_s >= 0.0;  // below 0: not measured
  if (has_gpu_times) outer.gpu_s -= inner.gpu_s;
}

void add_phase(const std::vector<renderers::StageRecord>& stages, renderers::Phase phase,
               std::vector<StageSpan>& spans) {
  for (const renderers::StageRecord& stage : stages) {
    if (stage.phase != phase || !is_top_level(stage) || is_readback(stage)) continue;
    if (!(stage.wall_s > 0.0)) continue;
    spans.push_back({stage.path, renderers::to_string(phase), stage.wall_s});
  }
}

std::string span_title(const StageSpan& span, double total_s) {
  const std::string phase = span.phase.empty() ? "" : span.phase + ": ";
  return fmt::format("{}{} {} ({} %)", phase, span.name, base::format_duration(span.wall_s),
                     base::format_significant(100.0 * span.wall_s / total_s, 2));
}

bool is_before_render(const StageSpan& span) {
  return span.phase == "prepare" || span.phase == "update";
}

std::string css_classes(const StageSpan& span) {
  return stage_class(span.name) + (is_before_render(span) ? " prepare" : "");
}

}  // namespace

bool is_readback(const renderers::StageRecord& stage) { return has_readback(stage.path); }

std::vector<renderers::StageRecord> stages_of_total(const RenderRecord& record) {
  std::vector<renderers::StageRecord> stages = record.stages;
  for (const renderers::StageRecord& readback : record.stages) {
    if (!is_outermost_readback(readback)) continue;
    for (renderers::StageRecord& outer : stages) {
      if (is_inside(readback, outer)) take_out(readback, outer);
    }
  }
  return stages;
}

std::vector<StageSpan> stage_spans(const RenderRecord& record) {
  const std::vector<renderers::StageRecord> stages = stages_of_total(record);
  std::vector<StageSpan> spans;
  add_phase(stages, renderers::Phase::prepare, spans);
  add_phase(stages, renderers::Phase::update, spans);
  add_phase(stages, renderers::Phase::render, spans);
  if (record.unattributed_s > 0.0) spans.push_back({kUnattributed, "", record.unattributed_s});
  return spans;
}

std::string stage_class(std::string_view name) {
  if (name == kUnattributed) return "stage-unattributed";
  const bool is_known =
      std::find(kVocabulary.begin(), kVocabulary.end(), name) != kVocabulary.end();
  return is_known ? fmt::format("stage-{}", name) : "stage-other";
}

std::string stage_bar(const RenderRecord& record, double full_scale_s) {
  std::string pieces;
  std::string label;
  for (const StageSpan& span : stage_spans(record)) {
    const std::string title = escape(span_title(span, timed_s(record)));
    label += (label.empty() ? "" : ", ") + title;
    pieces += fmt::format("<i class=\"{}\" style=\"width:{:.3f}%\" title=\"{}\"></i>",
                          css_classes(span), 100.0 * span.wall_s / full_scale_s, title);
  }
  return fmt::format("<div class=\"bar\" role=\"img\" aria-label=\"{}\">{}</div>", label, pieces);
}

std::string stage_legend(const std::vector<const RenderRecord*>& records) {
  std::vector<std::string> names;
  bool has_prepare = false;
  bool has_update = false;
  for (const RenderRecord* record : records) {
    for (const StageSpan& span : stage_spans(*record)) {
      has_prepare = has_prepare || span.phase == "prepare";
      has_update = has_update || span.phase == "update";
      if (span.name == kUnattributed) continue;
      if (std::find(names.begin(), names.end(), span.name) == names.end()) {
        names.push_back(span.name);
      }
    }
  }
  names.emplace_back(kUnattributed);
  std::string items;
  for (const std::string& name : names) {
    items +=
        fmt::format("<span><i class=\"swatch {}\"></i>{}</span>", stage_class(name), escape(name));
  }
  if (has_prepare || has_update) {
    items += fmt::format(
        "<span><i class=\"swatch stage-other prepare\"></i>hatched: {}; plain: render</span>",
        has_update ? "update" : "prepare");
  }
  return "<div class=\"legend\">" + items + "</div>\n";
}

std::vector<double> axis_ticks(double high) {
  constexpr double kWantedTicks = 5.0;
  const double raw_step = high / kWantedTicks;
  const double decade = std::pow(10.0, std::floor(std::log10(raw_step)));
  const double factor = raw_step / decade;
  const double step = decade * (factor <= 1.0   ? 1.0
                                : factor <= 2.0 ? 2.0
                                : factor <= 5.0 ? 5.0
                                                : 10.0);
  constexpr double kSlack = 1e-9;  // a tick at the very end may lie beyond it by rounding
  std::vector<double> ticks;
  for (int i = 0; i * step <= high * (1.0 + kSlack); ++i) ticks.push_back(i * step);
  return ticks;
}

}  // namespace results::html_report
