#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "perception/image.h"
#include "results/figures/figure_run.h"

namespace results::figures {

/// Rows of a figure as scenes and columns.
struct RowTable {
  std::vector<std::string> scenes;
  std::vector<std::string> columns;  ///< methods, with budgets where there are several
  std::vector<std::vector<std::optional<std::size_t>>> rows;  ///< by scene, then column

  std::vector<std::size_t> rows_of_scene(std::size_t scene) const {
    std::vector<std::size_t> found;
    for (const auto& row : rows[scene]) {
      if (row) found.push_back(*row);
    }
    return found;
  }
};

RowTable table_of(const FigureRun& run, const std::vector<std::size_t>& rows);

/// A caption: "relmse 0.0123 ± 0.002", "83.1 ms".
std::string value_text(const Quantity& quantity, const Estimate& value);

/// The image, averaged to the width if it is wider.
perception::Image reduced_to(const perception::Image& image, int width_px);

}  // namespace results::figures
