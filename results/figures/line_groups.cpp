#include "results/figures/line_groups.h"

#include <algorithm>

#include <fmt/format.h>

#include "perception/base/names.h"
#include "results/figures/figure_colors.h"
#include "results/figures/figure_rows.h"

namespace results::figures {

namespace {

/// "val[vals=30,vpls=1024]" without vals: "val[vpls=1024]".
std::string without_sweep(const std::string& id, const std::string& name) {
  const std::size_t open = id.find('[');
  if (open == std::string::npos || id.back() != ']') return id;
  std::string rest;
  std::size_t begin = open + 1;
  while (begin < id.size()) {
    const std::size_t end = std::min(id.find(',', begin), id.size() - 1);
    const std::string item = id.substr(begin, end - begin);
    if (!base::is_same_name(item.substr(0, item.find('=')), name)) {
      rest += (rest.empty() ? "" : ",") + item;
    }
    begin = end + 1;
  }
  return id.substr(0, open) + (rest.empty() ? "" : "[" + rest + "]");
}

LineGroup group_of(const RowFacts& row, const Quantity& x, bool has_budgets) {
  LineGroup group{row.base_method, row.method, row.scene, {}};
  if (x.kind == Quantity::Kind::parameter) {
    group.method = without_sweep(row.method, x.name);
    group.scene = without_sweep(row.scene, x.name);
  } else if (x.kind == Quantity::Kind::counter) {
    group.method = row.base_method;
  } else {
    return group;
  }
  if (has_budgets) group.method += ", " + row.budget;
  return group;
}

}  // namespace

std::vector<LineGroup> line_groups(const std::vector<std::size_t>& rows, const FigureRun& run,
                                   const Quantity& x) {
  const bool has_budgets = RowNames(run, rows).budgets().size() > 1;
  std::vector<LineGroup> groups;
  for (const std::size_t row : rows) {
    LineGroup group = group_of(run.rows()[row], x, has_budgets);
    const auto known = std::find_if(groups.begin(), groups.end(), [&](const LineGroup& other) {
      return other.method == group.method && other.scene == group.scene;
    });
    if (known == groups.end()) {
      group.rows.push_back(row);
      groups.push_back(std::move(group));
    } else {
      known->rows.push_back(row);
    }
  }
  return groups;
}

std::vector<LineGroup> single_row_groups(const std::vector<std::size_t>& rows,
                                         const FigureRun& run) {
  const RowNames names(run, rows);
  std::vector<LineGroup> groups;
  for (const std::size_t row : rows) {
    const RowFacts& facts = run.rows()[row];
    groups.push_back({facts.base_method, names.name_within_scene(row), facts.scene, {row}});
  }
  return groups;
}

LineStyles::LineStyles(const std::vector<LineGroup>& groups, const FigureRun& run) {
  const MethodStyles styles(run);
  for (const LineGroup& group : groups) {
    add_once(scenes_, group.scene);
    std::size_t siblings = 0;
    bool is_known = false;
    for (const Method& method : methods_) {
      siblings += static_cast<std::size_t>(method.base == group.base_method);
      is_known = is_known || method.name == group.method;
    }
    if (is_known) continue;
    methods_.push_back({group.base_method, group.method, styles.color(group.base_method),
                        siblings + styles.round(group.base_method)});
  }
}

ChartLine LineStyles::line_of(const LineGroup& group, LineLook look) const {
  const auto method = std::find_if(methods_.begin(), methods_.end(),
                                   [&](const Method& one) { return one.name == group.method; });
  ChartLine line;
  line.look = look;
  line.color = method->color;
  line.mark = method->mark;
  line.dash = index_in(scenes_, group.scene);
  // Without marks, the dash is all that tells lines of one colour apart.
  if (look == LineLook::band) line.dash += method->mark;
  return line;
}

bool LineStyles::has_many_methods() const {
  constexpr std::size_t kMostEntries = 16;
  return methods_.size() > kMostEntries;
}

std::vector<LegendEntry> LineStyles::legend(LineLook look) const {
  std::vector<LegendEntry> entries;
  std::vector<std::string> bases;
  for (const Method& method : methods_) {
    const std::size_t known = bases.size();
    const bool is_new = add_once(bases, method.base) == known;
    if (has_many_methods() && !is_new) continue;
    const std::string style = look == LineLook::band
                                  ? fmt::format("with lines lc rgb '{}' dt {} lw 1.6", method.color,
                                                dash_type(method.mark))
                                  : fmt::format("with linespoints lc rgb '{}' pt {} ps 0.55 lw 1.6",
                                                method.color, point_type(method.mark));
    entries.push_back({has_many_methods() ? method.base : method.name, style});
  }
  if (scenes_.size() < 2) return entries;
  for (std::size_t i = 0; i < scenes_.size(); ++i) {
    entries.push_back(
        {scenes_[i], fmt::format("with lines lc rgb '{}' dt {} lw 1.6", kSoftInk, dash_type(i))});
  }
  return entries;
}

}  // namespace results::figures
