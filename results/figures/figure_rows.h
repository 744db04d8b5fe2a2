#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "results/figures/figure_run.h"
#include "results/figures/figure_spec.h"

namespace results::figures {

/// Whether a row is of one of the figure's scenes and budgets.
/// @throws base::InputError naming those that exist, if the run has none of one that is named
std::vector<bool> rows_in_scope(const FigureSpec& figure, const FigureRun& run);

/// Rows that one selector matches within the figure's scenes and budgets, in the run's order.
/// @throws base::InputError as `select_rows`
std::vector<std::size_t> rows_of(const PlacedText& selector, const FigureSpec& figure,
                                 const FigureRun& run);
/// Rows that any of the figure's selectors matches, in the run's order.
std::vector<std::size_t> rows_of(const FigureSpec& figure, const FigureRun& run);

/// What a figure shows along an axis: `figure.y`, found in the run.
std::vector<Quantity> y_quantities(const FigureSpec& figure, const FigureRun& run);
/// The same for kinds that show errors. @throws base::InputError if one is no score
std::vector<Quantity> score_quantities(const FigureSpec& figure, const FigureRun& run);
/// The time that rows are compared by: `figure.x` if it is given, next_frame_s of sequences, else
/// total_s. @throws base::InputError if x is no time
Quantity time_quantity(const FigureSpec& figure, const FigureRun& run,
                       const std::vector<std::size_t>& rows);

/// "relmse (share of pixels)": an axis with its unit.
std::string axis_title(const Quantity& quantity);
/// True for scores that are better the lower they are, and identical at 0.
bool is_error(const Quantity& quantity);

/// Names of rows with as much as is needed to tell them apart: the scene only where
/// the rows have several, the budget only where they have several of that method.
class RowNames {
 public:
  RowNames(const FigureRun& run, const std::vector<std::size_t>& rows);
  std::string name(std::size_t row) const;               ///< "horse, val[vals=30], 64spp"
  std::string name_within_scene(std::size_t row) const;  ///< "val[vals=30], 64spp"
  const std::vector<std::string>& scenes() const { return scenes_; }
  const std::vector<std::string>& base_methods() const { return base_methods_; }
  const std::vector<std::string>& budgets() const { return budgets_; }

 private:
  const FigureRun& run_;
  std::map<std::string, std::vector<std::string>> budgets_of_method_;
  std::vector<std::string> scenes_;        ///< in the run's order
  std::vector<std::string> base_methods_;  ///< likewise
  std::vector<std::string> budgets_;       ///< likewise
};

/// Index of a text; the end if it is not there.
std::size_t index_in(const std::vector<std::string>& texts, const std::string& text);
/// Adds a text that is not there yet; returns its index.
std::size_t add_once(std::vector<std::string>& texts, const std::string& text);

/// "figure fig10: no row has relmse; there are: ..." for a figure without anything to draw.
[[noreturn]] void fail_without_data(const FigureSpec& figure, const std::string& lacking,
                                    const FigureRun& run, const std::vector<std::size_t>& rows);

}  // namespace results::figures
