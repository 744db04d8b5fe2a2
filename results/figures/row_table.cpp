#include "results/figures/row_table.h"

#include <algorithm>

#include <fmt/format.h>

#include "perception/base/units.h"
#include "results/figures/figure_rows.h"
#include "results/html_report/picture.h"

namespace results::figures {

using perception::Image;

RowTable table_of(const FigureRun& run, const std::vector<std::size_t>& rows) {
  const RowNames names(run, rows);
  RowTable table;
  table.scenes = names.scenes();
  for (const std::size_t row : rows) add_once(table.columns, names.name_within_scene(row));
  table.rows.assign(table.scenes.size(),
                    std::vector<std::optional<std::size_t>>(table.columns.size()));
  for (const std::size_t row : rows) {
    const std::size_t scene = index_in(table.scenes, run.rows()[row].scene);
    table.rows[scene][index_in(table.columns, names.name_within_scene(row))] = row;
  }
  return table;
}

std::string value_text(const Quantity& quantity, const Estimate& value) {
  if (quantity.unit == "s") return base::format_duration(value.value);
  std::string text = base::format_significant(value.value, 3);
  const double half = std::max(value.high - value.value, value.value - value.low);
  if (half > 0.0) text += " ± " + base::format_significant(half, 2);
  return fmt::format("{} {}", quantity.text, text);
}

Image reduced_to(const Image& image, int width_px) {
  return image.width_px > width_px ? html_report::reduced(image, width_px) : image;
}

}  // namespace results::figures
