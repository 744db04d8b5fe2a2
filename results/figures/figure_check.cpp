#include <algorithm>
#include <string_view>

#include <fmt/format.h>

#include "results/figures/figure_rows.h"
#include "results/figures/figures.h"

namespace results::figures {

namespace {

bool has_prefix(std::string_view text, std::string_view prefix) {
  return text.substr(0, prefix.size()) == prefix;
}

/// Stages and counters have no names before there are records.
bool may_come_later(const PlacedText& name, const FigureRun& planned) {
  if (has_prefix(name.text, "score.") || has_prefix(name.text, "parameter.")) return false;
  return planned.run().cells.empty();
}

/// @return whether it is known
bool check_quantity(const PlacedText& name, const FigureRun& planned) {
  try {
    planned.find_quantity(name.text, name.place);
    return true;
  } catch (const base::InputError&) {
    if (!may_come_later(name, planned)) throw;
    return false;
  }
}

bool shows_scores(FigureKind kind) {
  return kind == FigureKind::error_vs_time || kind == FigureKind::error_chain ||
         kind == FigureKind::pareto;
}

bool takes_a_time(FigureKind kind) {
  return kind == FigureKind::error_vs_time || kind == FigureKind::pareto;
}

void check_figure(const FigureSpec& figure, const FigureRun& planned) {
  const std::vector<std::size_t> rows = rows_of(figure, planned);
  if (shows_scores(figure.kind)) {
    score_quantities(figure, planned);
  } else {
    for (const PlacedText& y : figure.y) check_quantity(y, planned);
  }
  if (!figure.x.text.empty() && check_quantity(figure.x, planned) && takes_a_time(figure.kind)) {
    time_quantity(figure, planned, rows);
  }
  if (figure.kind != FigureKind::false_colour) return;
  const Quantity score = planned.find_quantity(figure.metric.text, figure.metric.place);
  if (score.kind == Quantity::Kind::score && score.detail.empty()) return;
  throw base::InputError(figure.metric.place, base::unknown_name("metric", figure.metric.text,
                                                                 planned.summary().metrics));
}

}  // namespace

void check_figures(const std::vector<FigureSpec>& figures, const RunValues& planned) {
  for (const FigureSpec& figure : figures) check_figure(figure, planned);
}

}  // namespace results::figures
