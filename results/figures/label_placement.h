#pragma once

#include <optional>
#include <string>
#include <vector>

#include "results/figures/figure_page.h"

namespace results::figures {

/// A mark on the page that wants its name beside it.
struct LabelledMark {
  double x_cm = 0.0, y_cm = 0.0;
  std::string text;  ///< "" for a mark that only takes room
};

/// Where a label is.
struct PlacedLabel {
  PageBox box;
  bool is_far = false;  ///< not right beside its mark
};

/// Places of the labels such that no label covers a mark, an
/// obstacle or another label or leaves the box; nothing where there is no such place.
///
/// Greedy, in the order of the marks: the first free place of right, left, above, below and the
/// corners, then the same further away.
std::vector<std::optional<PlacedLabel>> place_labels(const std::vector<LabelledMark>& marks,
                                                     const std::vector<PageBox>& obstacles,
                                                     const PageBox& box, double font_pt);

}  // namespace results::figures
