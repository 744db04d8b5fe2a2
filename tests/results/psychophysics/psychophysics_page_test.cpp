#include "results/html_report/psychophysics_page.h"

#include <algorithm>
#include <fstream>

#include <gtest/gtest.h>

#include "tests/results/psychophysics/synthetic_experiment.h"
#include "tests/temporary_folder.h"

namespace {

std::size_t count_of(const std::string& text, const std::string& piece) {
  std::size_t count = 0;
  for (std::size_t at = text.find(piece); at != std::string::npos; at = text.find(piece, at + 1)) {
    ++count;
  }
  return count;
}

TEST(PsychophysicsPage, ShowsTablesChartAndEveryStimulus) {
  const auto run = tests::synthetic_experiment("/nowhere/edges/run");
  const std::string page = results::html_report::psychophysics_page(run);
  EXPECT_NE(page.find("<h2>edges</h2>"), std::string::npos);
  EXPECT_NE(page.find("Edges &lt;sharp&gt; &amp; soft."), std::string::npos);
  EXPECT_EQ(page.find("<sharp>"), std::string::npos);
  EXPECT_NE(page.find(">12 of 12<"), std::string::npos);
  EXPECT_NE(page.find("pedestal contrast (%)"), std::string::npos);
  EXPECT_NE(page.find("yes 0.60"), std::string::npos);
  EXPECT_NE(page.find("not a question for: silent"), std::string::npos);
  // Observed and two models, four points each; the axis is logarithmic.
  EXPECT_EQ(count_of(page, "<circle"), 12U);
  EXPECT_NE(page.find(">100</text>"), std::string::npos);
  // A residual of 6 dB is of the third step, of 0 dB of the first.
  EXPECT_NE(page.find("<td class=\"n rank-2\" data-sort=\"-34\">-34.0<small>+6.0</small></td>"),
            std::string::npos);
  EXPECT_NE(page.find("<td class=\"n rank-0\" data-sort=\"-40\">-40.0<small>+0.0</small></td>"),
            std::string::npos);
  EXPECT_NE(page.find("calibrated"), std::string::npos);
  EXPECT_EQ(page, results::html_report::psychophysics_page(run));
}

TEST(PsychophysicsPage, PicturesAreInsideIt) {
  const tests::TemporaryFolder folder;
  auto run = tests::synthetic_experiment(folder.path());
  std::ofstream(folder.path() / "p1.png") << "not looked at here";
  run.experiments[0].stimuli[0].picture = "p1.png";
  run.experiments[0].stimuli[1].picture = "gone.png";
  const std::string page = results::html_report::psychophysics_page(run);
  EXPECT_EQ(count_of(page, "data:image/png;base64,"), 1U);
  EXPECT_EQ(page.find("http://"), std::string::npos);
}

TEST(PsychophysicsPage, CanBeWrittenBeforeAnyAnswer) {
  auto run = tests::synthetic_experiment("/nowhere/edges/run");
  run.predictions.clear();
  const std::string page = results::html_report::psychophysics_page(run);
  EXPECT_NE(page.find("4 not yet"), std::string::npos);
}

}  // namespace
