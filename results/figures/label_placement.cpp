#include "results/figures/label_placement.h"

#include <algorithm>
#include <array>

#include "results/figures/gnuplot_text.h"

namespace results::figures {

namespace {

constexpr double kMark_cm = 0.09;  ///< half the side of a mark

bool overlap(const PageBox& a, const PageBox& b) {
  return a.left < b.right() && b.left < a.right() && a.bottom < b.top() && b.bottom < a.top();
}

bool is_inside(const PageBox& inner, const PageBox& outer) {
  return inner.left >= outer.left && inner.right() <= outer.right() &&
         inner.bottom >= outer.bottom && inner.top() <= outer.top();
}

/// Boxes of a size around a mark, from the one that reads best.
std::vector<PlacedLabel> candidates(const LabelledMark& mark, double width, double height) {
  // Steps from the mark to the label's middle, in halves of its size and gaps.
  constexpr std::array<std::pair<int, int>, 8> kSides{
      {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {1, -1}, {-1, 1}, {-1, -1}}};
  constexpr std::array<double, 4> kGaps_cm{0.12, 0.4, 0.8, 1.3};
  std::vector<PlacedLabel> labels;
  for (const double gap : kGaps_cm) {
    for (const auto& [right, up] : kSides) {
      const double x = mark.x_cm + right * (gap + 0.5 * width);
      const double y = mark.y_cm + up * (gap + 0.5 * height);
      labels.push_back(
          {{x - 0.5 * width, y - 0.5 * height, width, height}, gap > kGaps_cm.front()});
    }
  }
  return labels;
}

}  // namespace

std::vector<std::optional<PlacedLabel>> place_labels(const std::vector<LabelledMark>& marks,
                                                     const std::vector<PageBox>& obstacles,
                                                     const PageBox& box, double font_pt) {
  std::vector<PageBox> taken = obstacles;
  for (const LabelledMark& mark : marks) {
    taken.push_back({mark.x_cm - kMark_cm, mark.y_cm - kMark_cm, 2.0 * kMark_cm, 2.0 * kMark_cm});
  }
  const double height = 1.1 * font_pt * 2.54 / 72.0;
  std::vector<std::optional<PlacedLabel>> places;
  for (const LabelledMark& mark : marks) {
    places.emplace_back();
    if (mark.text.empty()) continue;
    const double width = text_width_cm(mark.text, font_pt) + 0.05;
    for (const PlacedLabel& candidate : candidates(mark, width, height)) {
      const bool is_free = is_inside(candidate.box, box) &&
                           std::none_of(taken.begin(), taken.end(), [&](const PageBox& other) {
                             return overlap(candidate.box, other);
                           });
      if (!is_free) continue;
      places.back() = candidate;
      taken.push_back(candidate.box);
      break;
    }
  }
  return places;
}

}  // namespace results::figures
