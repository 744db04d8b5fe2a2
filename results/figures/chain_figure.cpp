#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "perception/base/units.h"
#include "results/figures/figure_colors.h"
#include "results/figures/figure_kinds.h"
#include "results/figures/figure_rows.h"
#include "results/figures/gnuplot_text.h"
#include "results/figures/quantity_axis.h"
#include "results/figures/step_differences.h"

namespace results::figures {

namespace {

constexpr double kBarWidth = 0.8;   ///< of the room of a step
constexpr double kGroupGap = 0.8;   ///< between scenes, in rooms of a step
constexpr double kLabelRoom = 0.1;  ///< above the bars, as a part of the axis

/// One bar: a step in a scene.
struct Bar {
  std::size_t scene = 0;
  std::size_t step = 0;
  std::optional<std::size_t> row;  ///< absent: the scene has no such row
  std::optional<Estimate> score;
  std::optional<Estimate> difference;  ///< to the step before
};

std::string signed_text(double value) {
  const std::string text = base::format_significant(std::abs(value), 2);
  return value == 0.0 ? "±0" : (value < 0.0 ? "−" : "+") + text;
}

bool is_clear(const Estimate& difference) {
  return difference.count > 1 && (difference.low > 0.0 || difference.high < 0.0);
}

class ChainChart {
 public:
  ChainChart(const FigureSpec& figure, const FigureRun& run)
      : figure_(figure), run_(run), styles_(run) {
    for (const PlacedText& selector : figure.methods) {
      steps_.push_back(rows_of(selector, figure, run));
      all_rows_.insert(all_rows_.end(), steps_.back().begin(), steps_.back().end());
    }
    std::sort(all_rows_.begin(), all_rows_.end());
    scenes_ = RowNames(run, all_rows_).scenes();
    drawing_.page = FigurePage(figure);
    drawing_.table.columns = {
        "quantity", "scene", "step",    "method",     "budget",         "value",
        "low",      "high",  "samples", "difference", "difference_low", "difference_high"};
    for (std::size_t step = 0; step < steps_.size(); ++step) add_legend(step);
  }

  FigureDrawing draw() {
    const std::vector<Quantity> quantities = score_quantities(figure_, run_);
    std::vector<std::pair<Quantity, std::vector<Bar>>> shown;
    for (const Quantity& y : quantities) {
      std::vector<Bar> bars = bars_of(y);
      const bool has_score =
          std::any_of(bars.begin(), bars.end(), [](const Bar& bar) { return !!bar.score; });
      if (has_score) shown.emplace_back(y, std::move(bars));
    }
    if (shown.empty()) fail_without_data(figure_, quantities.front().text, run_, all_rows_);
    add_note(drawing_.page.notes,
             "Above the bars: change from the step before; grey where its 95 % interval holds 0 or "
             "is not known.");
    const std::vector<PageBox> boxes = panel_boxes({shown.size(), 1, false, 4.2}, drawing_.page);
    for (std::size_t i = 0; i < shown.size(); ++i) {
      draw_panel(shown[i].first, shown[i].second, boxes[i], i);
    }
    return std::move(drawing_);
  }

 private:
  /// The only row of a step in a scene.
  std::optional<std::size_t> row_of(std::size_t step, const std::string& scene) const {
    std::vector<std::size_t> rows;
    std::copy_if(steps_[step].begin(), steps_[step].end(), std::back_inserter(rows),
                 [&](std::size_t row) { return run_.rows()[row].scene == scene; });
    if (rows.size() > 1) {
      std::vector<std::string> names;
      for (const std::size_t row : rows) {
        names.push_back(run_.rows()[row].method + ", " + run_.rows()[row].budget);
      }
      throw base::InputError(figure_.methods[step].place,
                             fmt::format("figure {}: a step is one row per scene; \"{}\" matches "
                                         "{} in {}: {}",
                                         figure_.id, figure_.methods[step].text, rows.size(), scene,
                                         fmt::join(names, " | ")));
    }
    return rows.empty() ? std::nullopt : std::optional(rows.front());
  }

  std::vector<Bar> bars_of(const Quantity& y) {
    std::vector<Bar> bars;
    for (std::size_t scene = 0; scene < scenes_.size(); ++scene) {
      std::optional<std::size_t> before;
      for (std::size_t step = 0; step < steps_.size(); ++step) {
        Bar bar{scene, step, row_of(step, scenes_[scene]), {}, {}};
        if (bar.row) bar.score = run_.estimate(*bar.row, y);
        if (bar.score && before) bar.difference = score_difference(run_, *bar.row, *before, y);
        before = bar.score ? bar.row : std::nullopt;
        if (bar.score) add_to_table(y, bar);
        bars.push_back(bar);
      }
    }
    return bars;
  }

  void add_to_table(const Quantity& y, const Bar& bar) {
    const RowFacts& facts = run_.rows()[*bar.row];
    const auto of_difference = [&](double Estimate::*side) {
      return bar.difference ? std::optional((*bar.difference).*side) : std::nullopt;
    };
    const bool has_interval = bar.difference && bar.difference->count > 1;
    const std::optional<double> none;
    drawing_.table.rows.push_back(
        {y.text, facts.scene, static_cast<double>(bar.step + 1), facts.method, facts.budget,
         bar.score->value, bar.score->low, bar.score->high, static_cast<double>(bar.score->count),
         of_difference(&Estimate::value), has_interval ? of_difference(&Estimate::low) : none,
         has_interval ? of_difference(&Estimate::high) : none});
  }

  /// Steps of one method have its colour, ever lighter.
  std::string color_of(std::size_t step) const {
    const auto base_of = [&](std::size_t i) {
      return steps_[i].empty() ? "" : run_.rows()[steps_[i].front()].base_method;
    };
    std::size_t siblings = 0;
    for (std::size_t i = 0; i < step; ++i) {
      siblings += static_cast<std::size_t>(base_of(i) == base_of(step));
    }
    return lightened(styles_.color(base_of(step)), siblings);
  }

  void add_legend(std::size_t step) {
    drawing_.page.legend.push_back(
        {fmt::format("{}  {}", step + 1, figure_.methods[step].text),
         fmt::format("with boxes fs solid 1 noborder lc rgb '{}'", color_of(step))});
  }

  /// Middle of a bar on the x axis.
  double place_of(const Bar& bar) const {
    const double group = static_cast<double>(steps_.size()) + kGroupGap;
    return group * static_cast<double>(bar.scene) + static_cast<double>(bar.step) + 0.5;
  }

  ChartAxis score_axis(const Quantity& y, const std::vector<Bar>& bars) const {
    std::vector<double> values;
    for (const Bar& bar : bars) {
      if (!bar.score) continue;
      values.insert(values.end(), {bar.score->low, bar.score->value, bar.score->high});
    }
    // Lengths of bars are compared from 0, unless the figure asks for something else.
    ChartAxis axis = fitted_axis(values, figure_.is_log_y.value_or(false), AxisStart::at_zero);
    axis.title = axis_title(y);
    if (axis.is_log) {
      axis.high *= std::pow(axis.high / axis.low, kLabelRoom);
    } else {
      axis.high += kLabelRoom * (axis.high - axis.low);
    }
    return axis;
  }

  ChartAxis step_axis(const std::vector<Bar>& bars) const {
    ChartAxis axis;
    axis.low = -0.3;
    axis.high = place_of(bars.back()) + 0.8;
    for (const Bar& bar : bars) {
      axis.ticks.push_back({place_of(bar), fmt::format("'{}'", bar.step + 1)});
    }
    return axis;
  }

  void draw_panel(const Quantity& y, const std::vector<Bar>& bars, const PageBox& box,
                  std::size_t number) {
    const ChartAxis x = step_axis(bars);
    const ChartAxis axis = score_axis(y, bars);
    const FigurePage& page = drawing_.page;
    std::string commands = panel_frame("", &x, &axis, box, page) + "set grid noxtics\n";
    const double step_cm = box.width / (x.high - x.low);
    for (std::size_t scene = 0; scene < scenes_.size(); ++scene) {
      const double middle =
          place_of({scene, 0, {}, {}, {}}) - 0.5 + 0.5 * static_cast<double>(steps_.size());
      const double room_cm = step_cm * (static_cast<double>(steps_.size()) + kGroupGap);
      commands += text_at(box.left + step_cm * (middle - x.low), box.bottom - 0.85,
                          gnuplot_string(shortened(scenes_[scene], room_cm, kTextPt)), page,
                          {Align::center, kTextPt});
    }
    for (const Bar& bar : bars) {
      if (bar.difference) commands += difference_label(bar, x, axis, box);
    }
    std::string plots;
    for (std::size_t step = 0; step < steps_.size(); ++step) {
      plots += bar_plots(bars, step, axis, fmt::format("steps{}_{}", number + 1, step + 1));
    }
    drawing_.commands += fmt::format("# Panel {}\n{}plot {}\n", number + 1, commands, plots);
  }

  std::string difference_label(const Bar& bar, const ChartAxis& x, const ChartAxis& y,
                               const PageBox& box) const {
    const double top = std::max(bar.score->high, bar.score->value);
    if (!y.has_place(top)) return "";
    const std::string text = signed_text(bar.difference->value);
    const double room_cm = box.width / (x.high - x.low);
    const bool is_upright = text_width_cm(text, kSmallPt) > room_cm;
    const double above_cm = is_upright ? 0.1 + 0.5 * text_width_cm(text, kSmallPt) : 0.18;
    return text_at(
        box.left + x.position(place_of(bar)) * box.width,
        box.bottom + y.position(top) * box.height + above_cm, gnuplot_string(text), drawing_.page,
        {Align::center, kSmallPt, is_clear(*bar.difference) ? kInk : kFaintInk, is_upright});
  }

  std::string bar_plots(const std::vector<Bar>& bars, std::size_t step, const ChartAxis& axis,
                        const std::string& block) {
    std::string data;
    bool has_interval = false;
    for (const Bar& bar : bars) {
      if (bar.step != step || !bar.score || !axis.has_place(bar.score->value)) continue;
      const double x = place_of(bar);
      const double base = std::clamp(0.0, axis.low, axis.high);
      const double low = axis.has_place(bar.score->low) ? bar.score->low : axis.low;
      data += fmt::format("{} {} {} {} {} {} {}\n", x, bar.score->value, x - 0.5 * kBarWidth,
                          x + 0.5 * kBarWidth, axis.is_log ? axis.low : base,
                          std::max(low, axis.low), bar.score->high);
      has_interval = has_interval || bar.score->high > bar.score->low;
    }
    if (data.empty()) return "";
    drawing_.data += fmt::format("${} << end\n{}end\n", block, data);
    std::string plots = fmt::format(
        "{}${} using 1:2:3:4:5:2 with boxxyerror fs solid 1 noborder lc rgb '{}' notitle",
        step == 0 ? "" : ", \\\n  ", block, color_of(step));
    if (has_interval) {
      plots += fmt::format(
          ", \\\n  ${} using 1:6:(0):($7-$6) with vectors heads size screen "
          "0.004,90 lw 1 lc rgb '{}' notitle",
          block, kInk);
    }
    return plots;
  }

  const FigureSpec& figure_;
  const FigureRun& run_;
  MethodStyles styles_;
  std::vector<std::vector<std::size_t>> steps_;  ///< rows, by step
  std::vector<std::size_t> all_rows_;
  std::vector<std::string> scenes_;
  FigureDrawing drawing_;
};

}  // namespace

FigureDrawing chain_figure(const FigureSpec& figure, const FigureRun& run) {
  return ChainChart(figure, run).draw();
}

}  // namespace results::figures
