#include <algorithm>

#include <fmt/format.h>

#include "perception/base/units.h"
#include "results/figures/figure_colors.h"
#include "results/figures/figure_kinds.h"
#include "results/figures/figure_rows.h"
#include "results/figures/gnuplot_text.h"
#include "results/figures/line_chart.h"
#include "results/figures/quantity_axis.h"
#include "results/html_report/stage_bars.h"

namespace results::figures {

namespace {

constexpr double kSlot_cm = 0.55;      ///< height of a bar with its gap
constexpr double kBar = 0.72;          ///< of the slot
constexpr double kBelow_cm = 1.2;      ///< ticks and title of the time axis
constexpr double kMostNames_cm = 6.5;  ///< width of the names
constexpr double kTotal_cm = 1.6;      ///< room of the total behind a bar

/// A line of the figure: a scene's name, or a bar.
struct Slot {
  std::string name;
  std::optional<std::size_t> row;
  const RenderRecord* record = nullptr;
};

class StageChart {
 public:
  StageChart(const FigureSpec& figure, const FigureRun& run)
      : figure_(figure), run_(run), rows_(rows_of(figure, run)), names_(run, rows_) {
    drawing_.page = FigurePage(figure);
    drawing_.table.columns = {"scene", "method", "budget", "phase", "stage", "wall_s", "total_s"};
  }

  FigureDrawing draw() {
    collect_slots();
    if (most_s_ <= 0.0) fail_without_data(figure_, "times of stages", run_, rows_);
    unit_s_ = most_s_ < 1.0 ? 1e-3 : 1.0;
    for (const std::string& stage : stages_) add_legend(stage);
    if (has_preparation_) {
      add_note(drawing_.page.notes,
               "The dark line in a bar: what stands left of it is done once per "
               "scene (prepare), of a sequence per frame (update).");
    }
    FigurePage& page = drawing_.page;
    if (!figure_.has_height) {
      page.height_cm = std::min(100.0, page.height_around_content() + kBelow_cm + 0.2 +
                                           kSlot_cm * static_cast<double>(slots_.size()));
    }
    page.require_room(kBelow_cm + 0.2 + 0.2 * static_cast<double>(slots_.size()));
    draw_bars();
    return std::move(drawing_);
  }

 private:
  const RenderRecord* record_of(std::size_t row) const {
    const SummaryRow& summary = run_.summary().rows[row];
    const auto typical = summary.is_sequence ? summary.next_frames.typical : summary.typical;
    return typical ? &run_.run().cells[*typical].render : nullptr;
  }

  void collect_slots() {
    for (const std::string& scene : names_.scenes()) {
      if (names_.scenes().size() > 1) slots_.push_back({scene, std::nullopt, nullptr});
      for (const std::size_t row : rows_) {
        if (run_.rows()[row].scene != scene) continue;
        const RenderRecord* record = record_of(row);
        if (record == nullptr) {
          add_note(drawing_.page.notes, fmt::format("{}: no time.", names_.name(row)));
          continue;
        }
        slots_.push_back({names_.name_within_scene(row), row, record});
        most_s_ = std::max(most_s_, timed_s(*record));
        for (const html_report::StageSpan& span : html_report::stage_spans(*record)) {
          if (span.name != kUnattributed) add_once(stages_, span.name);
          has_unattributed_ = has_unattributed_ || span.name == kUnattributed;
          add_to_table(row, span, timed_s(*record));
        }
      }
    }
    if (has_unattributed_) stages_.emplace_back(kUnattributed);
  }

  void add_to_table(std::size_t row, const html_report::StageSpan& span, double total_s) {
    const RowFacts& facts = run_.rows()[row];
    const bool is_preparation = span.phase == "prepare" || span.phase == "update";
    has_preparation_ = has_preparation_ || is_preparation;
    drawing_.table.rows.push_back(
        {facts.scene, facts.method, facts.budget, span.phase, span.name, span.wall_s, total_s});
  }

  static std::string fill_of(const std::string& stage) {
    const bool is_white = stage == kUnattributed;
    return fmt::format("fs solid 1 border lc rgb '{}' lc rgb '{}'",
                       is_white ? kFaintInk : "#ffffff", stage_color(stage));
  }

  void add_legend(const std::string& stage) {
    drawing_.page.legend.push_back({stage, "with boxes " + fill_of(stage)});
  }

  /// Height of a slot's middle on the y axis, which counts slots from below.
  double middle_of(std::size_t slot) const {
    return static_cast<double>(slots_.size() - slot) - 0.5;
  }

  PageBox bar_area() const {
    const PageBox content = drawing_.page.content();
    double names_cm = 1.0;
    for (const Slot& slot : slots_) {
      names_cm = std::max(names_cm, text_width_cm(slot.name, kTextPt) + 0.25);
    }
    names_cm = std::min(names_cm, std::min(kMostNames_cm, 0.5 * content.width));
    return {content.left + names_cm, content.bottom + kBelow_cm, content.width - names_cm - 0.2,
            content.height - kBelow_cm - 0.2};
  }

  void draw_bars() {
    const FigurePage& page = drawing_.page;
    const PageBox box = bar_area();
    ChartAxis time = fitted_axis({0.0, most_s_ / unit_s_}, false, AxisStart::at_zero);
    time.high = most_s_ / unit_s_ * box.width / std::max(box.width - kTotal_cm, 0.3 * box.width);
    std::erase_if(time.ticks, [&](const AxisTick& tick) { return tick.value > time.high; });
    time.title = unit_s_ < 1.0 ? "time (ms)" : "time (s)";
    std::string commands = panel_frame("", &time, nullptr, box, page);
    commands += fmt::format("set border 1\nunset ytics\nset grid noytics\nset yrange [0:{}]\n",
                            slots_.size());
    for (std::size_t slot = 0; slot < slots_.size(); ++slot) {
      commands += slot_commands(slot, time, box);
    }
    std::string plots;
    for (std::size_t stage = 0; stage < stages_.size(); ++stage) {
      drawing_.data += data_block(stage);
      plots += fmt::format("{}$stage{} using 1:2:3:4:5:6 with boxxyerror {} lw 0.6 notitle",
                           plots.empty() ? "" : ", \\\n  ", stage + 1, fill_of(stages_[stage]));
    }
    drawing_.commands += "# Bars\n" + commands + "plot " + plots + "\n";
  }

  std::string slot_commands(std::size_t slot, const ChartAxis& time, const PageBox& box) const {
    const FigurePage& page = drawing_.page;
    const Slot& shown = slots_[slot];
    const double per_slot_cm = box.height / static_cast<double>(slots_.size());
    const double y_cm = box.bottom + per_slot_cm * middle_of(slot);
    const double room_cm = box.left - page.content().left - 0.15;
    if (shown.record == nullptr) {
      return text_at(page.content().left, y_cm, gnuplot_bold_string(shown.name), page);
    }
    const double end_cm =
        box.left + box.width * time.position(timed_s(*shown.record) / unit_s_) + 0.12;
    std::string commands =
        text_at(box.left - 0.15, y_cm, gnuplot_string(shortened(shown.name, room_cm, kTextPt)),
                page, {Align::right, kTextPt}) +
        text_at(end_cm, y_cm, gnuplot_string(base::format_duration(timed_s(*shown.record))), page,
                {Align::left, kSmallPt, kSoftInk});
    double prepared_s = 0.0;
    for (const html_report::StageSpan& span : html_report::stage_spans(*shown.record)) {
      if (span.phase == "prepare" || span.phase == "update") prepared_s += span.wall_s;
    }
    // In a bar that is hardly wider than the line, it would hide what it is about.
    const bool is_wide = end_cm - box.left > 0.6;
    if (prepared_s <= 0.0 || !is_wide) return commands;
    return commands + fmt::format(
                          "set arrow from {0},{1} to {0},{2} nohead front lc rgb '{3}' lw "
                          "1.8\n",
                          prepared_s / unit_s_, middle_of(slot) - 0.5 * kBar,
                          middle_of(slot) + 0.5 * kBar, kInk);
  }

  /// The pieces of one stage in all bars.
  std::string data_block(std::size_t stage) const {
    std::string block = fmt::format("$stage{} << end\n", stage + 1);
    for (std::size_t slot = 0; slot < slots_.size(); ++slot) {
      if (slots_[slot].record == nullptr) continue;
      double begin_s = 0.0;
      for (const html_report::StageSpan& span : html_report::stage_spans(*slots_[slot].record)) {
        const double end_s = begin_s + span.wall_s;
        const double y = middle_of(slot);
        if (span.name == stages_[stage]) {
          block += fmt::format("{} {} {} {} {} {}\n", begin_s / unit_s_, y, begin_s / unit_s_,
                               end_s / unit_s_, y - 0.5 * kBar, y + 0.5 * kBar);
        }
        begin_s = end_s;
      }
    }
    return block + "end\n";
  }

  static constexpr const char* kUnattributed = "unattributed";

  const FigureSpec& figure_;
  const FigureRun& run_;
  std::vector<std::size_t> rows_;
  RowNames names_;
  std::vector<Slot> slots_;
  std::vector<std::string> stages_;  ///< in the order of their first bar, unattributed last
  double most_s_ = 0.0;
  double unit_s_ = 1.0;  ///< of the axis
  bool has_unattributed_ = false;
  bool has_preparation_ = false;
  FigureDrawing drawing_;
};

}  // namespace

FigureDrawing stage_figure(const FigureSpec& figure, const FigureRun& run) {
  return StageChart(figure, run).draw();
}

}  // namespace results::figures
