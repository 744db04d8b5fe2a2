#include "results/figures/figure_rows.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "perception/base/names.h"
#include "results/score_summary.h"

namespace results::figures {

namespace {

/// Of each wanted name, that the run has it; all rows where nothing is wanted.
template <class Names>
void keep_named(const std::vector<PlacedText>& wanted, const char* kind, const Names& names_of_row,
                const FigureRun& run, std::vector<bool>& is_in) {
  if (wanted.empty()) return;
  std::vector<bool> is_named(is_in.size(), false);
  for (const PlacedText& name : wanted) {
    bool is_known = false;
    std::vector<std::string> known;
    for (std::size_t row = 0; row < is_in.size(); ++row) {
      for (const std::string& candidate : names_of_row(run.rows()[row])) {
        add_once(known, candidate);
        if (!base::is_same_name(candidate, name.text)) continue;
        is_known = is_named[row] = true;
      }
    }
    if (!is_known) throw base::InputError(name.place, base::unknown_name(kind, name.text, known));
  }
  for (std::size_t row = 0; row < is_in.size(); ++row) is_in[row] = is_in[row] && is_named[row];
}

std::string or_none(const std::string& text) { return text.empty() ? "none" : text; }

}  // namespace

std::size_t index_in(const std::vector<std::string>& texts, const std::string& text) {
  return static_cast<std::size_t>(std::find(texts.begin(), texts.end(), text) - texts.begin());
}

std::size_t add_once(std::vector<std::string>& texts, const std::string& text) {
  const std::size_t index = index_in(texts, text);
  if (index == texts.size()) texts.push_back(text);
  return index;
}

std::vector<bool> rows_in_scope(const FigureSpec& figure, const FigureRun& run) {
  std::vector<bool> is_in(run.rows().size(), true);
  const auto scenes = [](const RowFacts& row) {
    return std::vector<std::string>{row.scene, row.base_scene};
  };
  const auto budgets = [](const RowFacts& row) { return std::vector<std::string>{row.budget}; };
  keep_named(figure.scenes, "scene", scenes, run, is_in);
  keep_named(figure.budgets, "budget", budgets, run, is_in);
  return is_in;
}

std::vector<std::size_t> rows_of(const PlacedText& selector, const FigureSpec& figure,
                                 const FigureRun& run) {
  const std::vector<bool> is_in = rows_in_scope(figure, run);
  std::vector<std::size_t> rows =
      select_rows(run.rows(), parse_row_selector(selector.text, selector.place), selector.place);
  std::erase_if(rows, [&](std::size_t row) { return !is_in[row]; });
  return rows;
}

std::vector<std::size_t> rows_of(const FigureSpec& figure, const FigureRun& run) {
  std::vector<bool> is_in = rows_in_scope(figure, run);
  if (!figure.methods.empty()) {
    std::vector<bool> is_selected(is_in.size(), false);
    for (const PlacedText& selector : figure.methods) {
      for (const std::size_t row : rows_of(selector, figure, run)) is_selected[row] = true;
    }
    is_in = is_selected;
  }
  std::vector<std::size_t> rows;
  for (std::size_t row = 0; row < is_in.size(); ++row) {
    if (is_in[row]) rows.push_back(row);
  }
  return rows;
}

std::vector<Quantity> y_quantities(const FigureSpec& figure, const FigureRun& run) {
  std::vector<Quantity> quantities;
  for (const PlacedText& y : figure.y) quantities.push_back(run.find_quantity(y.text, y.place));
  return quantities;
}

std::vector<Quantity> score_quantities(const FigureSpec& figure, const FigureRun& run) {
  std::vector<Quantity> quantities = y_quantities(figure, run);
  for (std::size_t i = 0; i < quantities.size(); ++i) {
    if (quantities[i].kind == Quantity::Kind::score) continue;
    throw base::InputError(
        figure.y[i].place,
        fmt::format("y of {} is a score, which \"{}\" is not; scores here: {}",
                    to_string(figure.kind), figure.y[i].text,
                    or_none(fmt::format("{}", fmt::join(run.summary().metrics, ", ")))));
  }
  return quantities;
}

Quantity time_quantity(const FigureSpec& figure, const FigureRun& run,
                       const std::vector<std::size_t>& rows) {
  if (figure.x.text.empty()) {
    const bool has_sequence = std::any_of(rows.begin(), rows.end(), [&](std::size_t row) {
      return run.summary().rows[row].is_sequence;
    });
    return run.find_quantity(has_sequence ? "next_frame_s" : "total_s", figure.place);
  }
  Quantity time = run.find_quantity(figure.x.text, figure.x.place);
  const bool is_time =
      (time.kind == Quantity::Kind::time || time.kind == Quantity::Kind::stage) && time.unit == "s";
  if (is_time) return time;
  throw base::InputError(figure.x.place, fmt::format("x of {} is a time, which \"{}\" is not; "
                                                     "accepted: total_s, next_frame_s, "
                                                     "new_view_s, ..., or a stage",
                                                     to_string(figure.kind), figure.x.text));
}

std::string axis_title(const Quantity& quantity) {
  return quantity.unit.empty() ? quantity.text
                               : fmt::format("{} ({})", quantity.text, quantity.unit);
}

bool is_error(const Quantity& quantity) {
  if (quantity.kind != Quantity::Kind::score) return false;
  const metrics::MetricDescription* info = metric_info_of(quantity.name);
  return info != nullptr && info->better == metrics::Better::lower && info->identical_value == 0.0;
}

RowNames::RowNames(const FigureRun& run, const std::vector<std::size_t>& rows) : run_(run) {
  for (const std::size_t row : rows) {
    const RowFacts& facts = run.rows()[row];
    add_once(scenes_, facts.scene);
    add_once(base_methods_, facts.base_method);
    add_once(budgets_, facts.budget);
    add_once(budgets_of_method_[facts.method], facts.budget);
  }
}

std::string RowNames::name_within_scene(std::size_t row) const {
  const RowFacts& facts = run_.rows()[row];
  return budgets_of_method_.at(facts.method).size() > 1 ? facts.method + ", " + facts.budget
                                                        : facts.method;
}

std::string RowNames::name(std::size_t row) const {
  const std::string name = name_within_scene(row);
  return scenes_.size() > 1 ? run_.rows()[row].scene + ", " + name : name;
}

void fail_without_data(const FigureSpec& figure, const std::string& lacking, const FigureRun& run,
                       const std::vector<std::size_t>& rows) {
  std::string reason = fmt::format("figure {}: no row has {}", figure.id, lacking);
  if (rows.empty()) {
    std::vector<std::string> names;
    for (const RowFacts& row : run.rows()) add_once(names, row.method);
    reason = fmt::format("figure {}: no row matches its methods, scenes and budgets; methods: {}",
                         figure.id, or_none(fmt::format("{}", fmt::join(names, ", "))));
    throw base::InputError(figure.place, reason);
  }
  const RowNames row_names(run, rows);
  constexpr std::size_t kMostNames = 6;
  std::vector<std::string> selected;
  for (std::size_t i = 0; i < std::min(rows.size(), kMostNames); ++i) {
    selected.push_back(row_names.name(rows[i]));
  }
  throw base::InputError(
      figure.place,
      fmt::format("{}; it looks at {} row{}: {}{}; scores of this run: {}", reason, rows.size(),
                  rows.size() == 1 ? "" : "s", fmt::join(selected, " | "),
                  rows.size() > kMostNames ? " | ..." : "",
                  or_none(fmt::format("{}", fmt::join(run.summary().metrics, ", ")))));
}

}  // namespace results::figures
