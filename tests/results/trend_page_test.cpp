// The page of a suite over all its runs: steps, lines, and what it escapes.
#include "results/html_report/trend_page.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "results/html_report/trend_line.h"

namespace {

using results::Direction;
using results::history::Series;
using results::history::trend_of;
using results::html_report::QuantityTrends;
using results::html_report::RunPlaces;

Series series_of(const std::string& method, const std::vector<double>& values,
                 const std::string& unit = "s", Direction better = Direction::lower) {
  Series series{"box", method, "fixed", "cpu", unit, better, {}};
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::string run = fmt::format("2026110{}T000000Z-abcdef", i + 1);
    series.points.push_back({run,
                             fmt::format("2026-11-0{}T00:00:00Z", i + 1),
                             fmt::format("c0ffee{}", i),
                             false,
                             {values[i], 0.99 * values[i], 1.01 * values[i], 8}});
  }
  return series;
}

const std::vector<double> kRises{1.0, 1.01, 1.0, 1.2, 1.21, 1.2};
const std::vector<double> kCalm{1.0, 1.01, 1.0, 0.99, 1.0, 1.01};

std::size_t count(const std::string& text, const std::string& wanted) {
  std::size_t found = 0;
  for (std::size_t at = text.find(wanted); at != std::string::npos;
       at = text.find(wanted, at + 1)) {
    ++found;
  }
  return found;
}

std::string page_of(const std::vector<QuantityTrends>& quantities) {
  return results::html_report::trend_page({"night<ly>", "half", "desk"}, quantities);
}

TEST(TrendPage, ListsStepsOfAllQuantitiesForBetterAndWorse) {
  const std::string page = page_of(
      {{"total_s",
        {trend_of(series_of("slow", kRises), 0.05), trend_of(series_of("calm", kCalm), 0.05)}},
       {"cvvdp@full", {trend_of(series_of("fine", kRises, "JOD", Direction::higher), 0.05)}}});
  EXPECT_NE(page.find("<b class=\"verdict not-reproduced\">✗ worse +20.0 %</b></td><td>total_s</td>"
                      "<td>box</td><td>slow</td>"),
            std::string::npos);
  EXPECT_NE(
      page.find("<b class=\"verdict reproduced\">✓ better +20.0 %</b></td><td>cvvdp@full</td>"),
      std::string::npos);
  EXPECT_NE(page.find("<td>20261104T000000Z-abcdef</td><td><code>c0ffee3</code></td>"),
            std::string::npos);
  EXPECT_EQ(count(page, "<section id="), 3U);
  EXPECT_EQ(count(page, "<svg class=\"trend-line\""), 3U);
  EXPECT_NE(page.find("<h1>night&lt;ly&gt;</h1>"), std::string::npos);
  EXPECT_EQ(page.find("night<ly>"), std::string::npos);
  EXPECT_NE(page.find("<dt>runs</dt><dd>6</dd>"), std::string::npos);
}

TEST(TrendPage, SaysThatNothingChanged) {
  const std::string page = page_of({{"total_s", {trend_of(series_of("calm", kCalm), 0.05)}}});
  EXPECT_NE(page.find("No quantity of any row changed its level."), std::string::npos);
  EXPECT_EQ(count(page, "class=\"step"), 0U);
}

/// The height of a point, in the units of the picture.
double y_of_last_point(const std::string& svg) {
  const std::size_t at = svg.rfind("cy=\"") + 4;
  return std::stod(svg.substr(at));
}

TEST(TrendLine, PlacesRunsAlikeInAllLinesAndKeepsNoiseSmall) {
  const RunPlaces places{
      {"20261101T000000Z-abcdef", 0}, {"20261102T000000Z-abcdef", 1}, {"other", 2}};
  const std::string svg =
      results::html_report::trend_line(trend_of(series_of("a", {1.0, 1.01}), 0.05), places);
  // The second of three runs is in the middle of 320, although the series ends there.
  EXPECT_NE(svg.find("cx=\"160.0\""), std::string::npos) << svg;
  // A hundredth on a scale of a tenth to both sides of the median: near the middle of 48.
  EXPECT_NEAR(y_of_last_point(svg), 24.0, 2.0);
  EXPECT_NE(svg.find("<title>20261102T000000Z-abcdef\n2026-11-02T00:00:00Z c0ffee1\n1.01 s"),
            std::string::npos)
      << svg;
}

TEST(TrendLine, OfZerosAndOfNothing) {
  const RunPlaces places{{"20261101T000000Z-abcdef", 0}};
  EXPECT_EQ(results::html_report::trend_line(trend_of(series_of("a", {}), 0.05), places), "");
  const std::string svg =
      results::html_report::trend_line(trend_of(series_of("a", {0.0}), 0.05), places);
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_EQ(svg.find("inf"), std::string::npos);
}

}  // namespace
