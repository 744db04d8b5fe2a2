#include "results/figures/figure_run.h"

#include <fmt/format.h>

namespace results::figures {

std::optional<Estimate> FigureRun::estimate(std::size_t row, const Quantity& quantity) const {
  const SummaryRow& summary_row = summary().rows[row];
  const bool is_total = quantity.kind == Quantity::Kind::time && quantity.name == "total_s" &&
                        (quantity.is_first_frame || !summary_row.is_sequence);
  if (is_total) return summary_row.total_s;  // the tables' own
  const std::string key =
      fmt::format("{} {} {} {} {}\n{}", row, static_cast<int>(quantity.kind),
                  quantity.is_first_frame, quantity.against, quantity.detail, quantity.name);
  {
    const std::lock_guard lock(mutex_);
    const auto known = estimates_.find(key);
    if (known != estimates_.end()) return known->second;
  }
  const std::optional<Estimate> estimate = values_.estimate(row, quantity);
  const std::lock_guard lock(mutex_);
  return estimates_.emplace(key, estimate).first->second;
}

}  // namespace results::figures
