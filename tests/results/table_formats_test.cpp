#include "results/table_formats.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace test_results {
namespace {

using results::Direction;
using results::Estimate;
using results::Table;
using results::TableCell;

TableCell number(double low, double value, double high, std::size_t count = 5) {
  return {std::to_string(value).substr(0, 4), value, false, "", std::nullopt,
          Estimate{value, low, high, count}};
}

TableCell words(const std::string& text) { return {text, std::nullopt, false, ""}; }

Table table_of(const std::vector<std::vector<TableCell>>& rows) {
  Table table;
  table.columns = {{"scene", "", Direction::none, false},
                   {"method", "", Direction::none, false},
                   {"total", "median", Direction::lower, true}};
  table.rows = rows;
  table.notes = {"a note | of it"};
  return table;
}

/// The best is only called so where noise cannot have made it.
TEST(TableFormats, MarksTheBestBeyondTheNoise) {
  Table table = table_of({{words("box"), words("a"), number(0.9, 1.0, 1.1)},
                          {words("box"), words("b"), number(1.9, 2.0, 2.1)},
                          {words("hall"), words("a"), number(0.9, 1.0, 1.3)},
                          {words("hall"), words("b"), number(1.2, 1.4, 1.6)},
                          {words("room"), words("a"), number(1.0, 1.0, 1.0, 1)},
                          {words("room"), words("b"), number(1.9, 2.0, 2.1)},
                          {words("lone"), words("a"), number(0.9, 1.0, 1.1)}});
  results::mark_best(table);
  std::vector<bool> best;
  for (const auto& row : table.rows) best.push_back(row[2].is_best);
  EXPECT_EQ(best, (std::vector<bool>{true, false, false, false, false, false, false}));

  Table higher = table_of({{words("box"), words("a"), number(0.9, 1.0, 1.1)},
                           {words("box"), words("b"), number(1.9, 2.0, 2.1)}});
  higher.columns[2].better = Direction::higher;
  results::mark_best(higher);
  EXPECT_TRUE(higher.rows[1][2].is_best);
}

TEST(TableFormats, Markdown) {
  Table table = table_of({{words("a|b"), words("x_y*"), number(0.9, 1.0, 1.1)}});
  table.rows[0][2].is_best = true;
  EXPECT_EQ(results::to_markdown(table),
            "| scene | method | total ↓ \\[median] |\n| --- | --- | ---: |\n"
            "| a\\|b | x\\_y\\* | **1.00** |\n\na note \\| of it\n");
}

TEST(TableFormats, CsvHasAllDigitsAndIntervals) {
  const Table table = table_of({{words("a,b"), words("x"), number(0.9, 1.0 / 3.0, 1.1)},
                                {words("c"), words("y"), number(2.0, 2.0, 2.0, 1)},
                                {words("d"), words("z"), words("-")}});
  EXPECT_EQ(results::to_csv(table),
            "scene,method,total [median],total low,total high\n"
            "\"a,b\",x,0.3333333333333333,0.9,1.1\nc,y,2,,\nd,z,,,\n");
}

TEST(TableFormats, LatexIsBooktabs) {
  Table table = table_of({{words("a_b & 5%"), words("x±1 ∞ ~2"), number(0.9, 1.0, 1.1)}});
  table.rows[0][2].is_best = true;
  const std::string latex = results::to_latex(table);
  EXPECT_NE(latex.find("\\begin{tabular}{llr}\n\\toprule\n"), std::string::npos) << latex;
  EXPECT_NE(latex.find("a\\_b \\& 5\\% & x$\\pm$1 $\\infty$ $\\sim$2 & \\textbf{1.00} \\\\\n"),
            std::string::npos)
      << latex;
  EXPECT_NE(latex.find("\\bottomrule\n\\end{tabular}\n% a note | of it\n"), std::string::npos);
}

}  // namespace
}  // namespace test_results
