#include "results/html_report/trend_page.h"

#include <algorithm>
#include <map>
#include <set>

#include <fmt/format.h>

#include "results/html_report/chip.h"
#include "results/html_report/html_table.h"
#include "results/html_report/html_text.h"
#include "results/html_report/page_frame.h"
#include "results/html_report/run_facts.h"
#include "results/html_report/trend_line.h"

namespace results::html_report {

namespace {

using history::Point;
using history::Series;
using history::Step;
using history::Trend;

/// Every run that a point is of, in the order of their names, which is that of time.
std::vector<Point> runs_of(const std::vector<QuantityTrends>& quantities) {
  std::map<std::string, Point> runs;
  for (const QuantityTrends& quantity : quantities) {
    for (const Trend& trend : quantity.trends) {
      for (const Point& point : trend.series.points) runs.emplace(point.run, point);
    }
  }
  std::vector<Point> sorted;
  for (auto& [name, point] : runs) sorted.push_back(std::move(point));
  std::ranges::sort(sorted, {}, &Point::run);
  return sorted;
}

struct FoundStep {
  const QuantityTrends* quantity;
  const Trend* trend;
  const Step* step;
};

/// The newest first; of one run the greatest change.
std::vector<FoundStep> steps_of(const std::vector<QuantityTrends>& quantities,
                                const RunPlaces& places) {
  std::vector<FoundStep> found;
  for (const QuantityTrends& quantity : quantities) {
    for (const Trend& trend : quantity.trends) {
      for (const Step& step : trend.steps) found.push_back({&quantity, &trend, &step});
    }
  }
  const auto size_of = [](const Step& step) {
    const double low = std::min(step.before, step.after);
    return low > 0.0 ? std::max(step.before, step.after) / low : 1.0;
  };
  std::ranges::stable_sort(found, [&](const FoundStep& a, const FoundStep& b) {
    const auto key = [&](const FoundStep& one) {
      return std::pair(places.at(one.trend->series.points[one.step->at].run), size_of(*one.step));
    };
    return key(a) > key(b);
  });
  return found;
}

std::string change_chip(const Series& series, const Step& step) {
  const bool is_worse = is_for_the_worse(series, step);
  return chip(is_worse ? kBadLook : kGoodLook, fmt::format("{} {}", is_worse ? "worse" : "better",
                                                           trend_change(step.before, step.after)));
}

std::string commit_of(const Point& point) {
  constexpr std::size_t kShort = 12;
  if (point.commit.empty()) return "";
  return fmt::format("<code>{}</code>{}", escape(point.commit.substr(0, kShort)),
                     point.is_dirty ? " with local changes" : "");
}

std::string header(const TrendSource& source, const std::vector<Point>& runs,
                   const std::vector<QuantityTrends>& quantities) {
  std::string html = fmt::format(
      "<header><h1>{}</h1>\n<p class=\"lead\">Its numbers over all runs, and where they "
      "changed their level.</p>\n<dl class=\"facts\">",
      escape(source.suite));
  html += fact("machine", source.machine) + fact("profile", source.profile);
  html += fact("runs", std::to_string(runs.size()));
  if (!runs.empty()) html += fact("first", runs.front().utc) + fact("last", runs.back().utc);
  html += "</dl>\n</header>\n<nav><a href=\"#steps\">Steps</a>";
  for (const QuantityTrends& quantity : quantities) {
    html += fmt::format("<a href=\"#{0}\">{0}</a>", escape(quantity.quantity));
  }
  return html + "</nav>\n";
}

std::string steps_section(const std::vector<FoundStep>& steps) {
  std::string html = "<section id=\"steps\"><h2>Steps</h2>\n";
  if (steps.empty()) {
    html += "<p>No quantity of any row changed its level.</p>\n";
  } else {
    std::string rows;
    for (const FoundStep& one : steps) {
      const Series& series = one.trend->series;
      const Point& point = series.points[one.step->at];
      rows += word_row({change_chip(series, *one.step), escape(one.quantity->quantity),
                        escape(series.scene), escape(series.method), escape(series.budget),
                        escape(point.utc), escape(point.run), commit_of(point)});
    }
    html += word_table(
        {"change", "quantity", "scene", "method", "budget", "since", "run", "commit"}, rows);
  }
  return html +
         "<p class=\"note\">A level is at least two runs: whether the newest run changed is what "
         "<code>discern compare</code> tests.</p>\n</section>\n";
}

/// Of the runs that the series holds; a device has a column where there are several.
std::string row_of(const Trend& trend, const RunPlaces& places, bool has_devices) {
  const Series& series = trend.series;
  const Estimate& first = series.points.front().value;
  const Estimate& last = series.points.back().value;
  std::string html = fmt::format("<tr><td>{}</td><td>{}</td><td>{}</td>", escape(series.scene),
                                 escape(series.method), escape(series.budget));
  if (has_devices) html += "<td>" + escape(series.device) + "</td>";
  html += fmt::format("<td>{}</td>", trend_line(trend, places));
  for (const Estimate& value : {first, last}) {
    html += fmt::format("<td class=\"n\"{}>{}</td>", sort_attribute(value.value),
                        escape(trend_value(series.unit, value)));
  }
  const double change = first.value > 0.0 ? last.value / first.value - 1.0 : last.value;
  html += fmt::format("<td class=\"n\"{}>{}</td>", sort_attribute(change),
                      escape(trend_change(first.value, last.value)));
  const std::string step = trend.steps.empty()
                               ? "<span class=\"none\">none</span>"
                               : change_chip(series, trend.steps.back()) + "<small>since " +
                                     escape(series.points[trend.steps.back().at].run) + "</small>";
  return html + "<td>" + step + "</td></tr>\n";
}

std::string quantity_section(const QuantityTrends& quantity, const RunPlaces& places) {
  std::set<std::string> devices;
  for (const Trend& trend : quantity.trends) devices.insert(trend.series.device);
  const bool has_devices = devices.size() > 1;
  const Direction better =
      quantity.trends.empty() ? Direction::none : quantity.trends.front().series.better;
  std::string html = fmt::format(
      "<section id=\"{0}\"><h2>{0}{1}</h2>\n<div class=\"scroll\"><table class=\"sortable "
      "numbers\"><thead><tr><th>scene</th><th>method</th><th>budget</th>{2}<th>runs</th>"
      "<th class=\"n\">first</th><th class=\"n\">last</th><th class=\"n\">change</th>"
      "<th>last step</th></tr></thead><tbody>\n",
      escape(quantity.quantity), arrow_of(better), has_devices ? "<th>device</th>" : "");
  for (const Trend& trend : quantity.trends) {
    if (!trend.series.points.empty()) html += row_of(trend, places, has_devices);
  }
  return html + "</tbody></table></div>\n</section>\n";
}

}  // namespace

std::string trend_page(const TrendSource& source, const std::vector<QuantityTrends>& quantities) {
  const std::vector<Point> runs = runs_of(quantities);
  RunPlaces places;
  for (const Point& run : runs) places.emplace(run.run, places.size());
  std::string body = header(source, runs, quantities) + "<main>\n";
  body += steps_section(steps_of(quantities, places));
  for (const QuantityTrends& quantity : quantities) body += quantity_section(quantity, places);
  return page_frame(source.suite + " over time", body + "</main>\n");
}

}  // namespace results::html_report
