// Figures of synthetic runs: the numbers that are drawn against closed forms, and whether gnuplot
// makes pictures of them that hold what they should.
#include "results/figures/figures.h"

#include <cstdlib>
#include <regex>

#include <gtest/gtest.h>
#include <chrono>

#include "perception/base/atomic_file.h"
#include "perception/base/child_process.h"
#include "results/figures/gnuplot_process.h"
#include "tests/expect_input_error.h"
#include "tests/results/figures/synthetic_suite.h"
#include "tests/temporary_folder.h"

namespace {

namespace fs = std::filesystem;
using results::RunValues;
using results::figures::FigureOutcome;
using results::figures::FigureSpec;
using test_figures::figures_of;
using test_figures::SyntheticSuite;

constexpr const char* kEveryKind = R"(
- {id: parameter, kind: error-vs-parameter, x: vals, y: [relmse, visible-difference],
   methods: [val, "val-hard[vals=2..30]"], title: "Error over the number of VALs"}
- {id: time, kind: error-vs-time, y: [relmse, ssim], scenes: [horse]}
- {id: chain, kind: error-chain, y: [relmse, flip], title: "What each step adds",
   methods: ["val[vals=100]", "val[vals=5]", "val-hard[vals=5]", light-propagation, novis]}
- {id: pareto, kind: pareto, y: relmse}
- {id: stages, kind: stage-stack, methods: [val, pt, novis]}
- {id: images, kind: image-grid, y: [relmse, flip], title: "Indirect light",
   methods: ["val[vals=30]", "pt[budget=4spp]", novis],
   crops: [{x: 0.2, y: 0.55, width: 0.2, height: 0.2}, {x: 0.62, y: 0.6, width: 0.2, height: 0.2}]}
- {id: maps, kind: false-colour, metric: flip, methods: ["val[vals=30]", "pt[budget=4spp]", novis]}
)";
constexpr const char* kSeries =
    "- {id: series, kind: series, y: [next_frame_s, relmse, links], title: Forty frames}";

bool has_gnuplot() {
  try {
    results::figures::gnuplot_program();
    return true;
  } catch (const base::InputError&) {
    return false;
  }
}

/// Makes figures in a folder of their own; DISCERN_KEEP_FIGURES=DIR keeps them.
class FigureFiles : public testing::Test {
 protected:
  void SetUp() override {
    if (!has_gnuplot()) GTEST_SKIP() << "gnuplot is not installed";
  }

  std::vector<FigureOutcome> write(const std::string& yaml, const results::Run& run) {
    const char* kept = std::getenv("DISCERN_KEEP_FIGURES");
    out_ = kept == nullptr ? folder_.path() / "figures" : fs::path(kept);
    return results::figures::write_figures(figures_of(yaml), RunValues(run), out_);
  }

  std::string text_of(const std::string& name) const { return base::read_text_file(out_ / name); }

  /// What the SVG says; a label may be cut into spans.
  std::string svg_words(const std::string& id) const {
    std::string words;
    bool is_tag = false;
    for (const char c : text_of(id + ".svg")) {
      is_tag = is_tag || c == '<';
      if (!is_tag) words += c;
      is_tag = is_tag && c != '>';
    }
    return words;
  }
  bool svg_shows(const std::string& id, const std::string& text) const {
    return svg_words(id).find(text) != std::string::npos;
  }

  void expect_sound(const std::string& id) const {
    EXPECT_GT(fs::file_size(out_ / (id + ".pdf")), 2000U) << id;
    EXPECT_EQ(text_of(id + ".pdf").substr(0, 5), "%PDF-") << id;
    EXPECT_NE(text_of(id + ".pdf").find("/Subject (suite quick, run 20261122T001209Z-0a1b2c"),
              std::string::npos);
    const std::string svg = text_of(id + ".svg");
    EXPECT_NE(svg.find("<metadata>"), std::string::npos);
    EXPECT_EQ(svg.substr(svg.find_last_not_of('\n') - 5, 6), "</svg>") << id;
    EXPECT_NE(text_of(id + ".csv").find('\n'), std::string::npos);
  }

  tests::TemporaryFolder folder_;
  fs::path out_;
};

TEST_F(FigureFiles, EveryKindMakesPicturesThatSayWhatTheyShow) {
  const results::Run run = test_figures::realistic_run(folder_.path());
  for (const FigureOutcome& outcome : write(kEveryKind, run)) {
    EXPECT_EQ(outcome.error, "");
    EXPECT_EQ(outcome.files.size(), 4U);
    expect_sound(outcome.id);
  }
  EXPECT_TRUE(svg_shows("parameter", "Error over the number of VALs"));
  EXPECT_TRUE(svg_shows("parameter", "visible-difference"));
  EXPECT_TRUE(svg_shows("time", "light_propagation"));
  EXPECT_TRUE(svg_shows("chain", "3  val-hard[vals=5]"));
  EXPECT_TRUE(svg_shows("pareto", "Pareto front"));
  EXPECT_TRUE(svg_shows("stages", "unattributed"));
  EXPECT_TRUE(svg_shows("images", "reference"));
  EXPECT_NE(text_of("images.svg").find("data:image/png"), std::string::npos);
  EXPECT_TRUE(svg_shows("maps", "room[light=2]"));
}

/// Where a score does not fit below its picture, its name and its value have a line each.
TEST_F(FigureFiles, NarrowPicturesKeepTheirNumbers) {
  const results::Run run = test_figures::realistic_run(folder_.path());
  for (const FigureOutcome& outcome : write(R"(
- {id: narrow, kind: image-grid, y: [visible-difference], size_cm: [13],
   methods: ["val[vals=30]", "pt[budget=4spp]", novis]}
- {id: low, kind: image-grid, y: [visible-difference], size_cm: [20, 14],
   methods: ["val[vals=30]", "pt[budget=4spp]", novis]}
- {id: wide, kind: image-grid, y: [visible-difference], size_cm: [30],
   methods: ["val[vals=30]", "pt[budget=4spp]", novis]}
)",
                                            run)) {
    EXPECT_EQ(outcome.error, "");
  }
  for (const char* id : {"narrow", "low"}) {
    EXPECT_TRUE(svg_shows(id, "visible-difference")) << id;
    const std::regex cut("(visible-[a-z]*|[0-9]|vals=[0-9]*)\\.\\.\\.");
    EXPECT_FALSE(std::regex_search(svg_words(id), cut)) << id;
  }
  EXPECT_TRUE(svg_shows("narrow", "[vals=30]"));
  EXPECT_TRUE(svg_shows("wide", "visible-difference 0"));
  EXPECT_FALSE(svg_shows("narrow", "visible-difference 0"));
}

TEST_F(FigureFiles, ASeriesHasALinePerMethod) {
  const auto outcomes = write(kSeries, test_figures::realistic_sequence());
  ASSERT_EQ(outcomes.front().error, "");
  expect_sound("series");
  EXPECT_TRUE(svg_shows("series", "next_frame_s (s)"));
  EXPECT_TRUE(svg_shows("series", "val"));
}

/// Everything that gnuplot, a shell, XML or a CSV reader could take for something else.
constexpr const char* kHostile = "a_b^{2}\\ 'q' \"d\" `touch owned` @x & ~y <i> % #$[0";

TEST_F(FigureFiles, HostileNamesAreShownAsTheyAre) {
  SyntheticSuite suite;
  suite.add_scene(kHostile);
  suite.add_method(kHostile);
  suite.add_method("plain");
  suite.set_metrics({"relmse"});
  for (const char* method : {kHostile, "plain"}) {
    for (const std::uint64_t seed : {1U, 2U}) {
      SyntheticSuite::Cell cell{kHostile, method, "fixed", seed};
      cell.scores = {{"relmse", 0.1 * static_cast<double>(seed)}};
      suite.add(cell);
    }
  }
  const auto outcomes = write(
      "- {id: hostile-time, kind: error-vs-time, y: relmse, title: \"it's {a_b}^2 \\\\ `id`\"}\n"
      "- {id: hostile-stages, kind: stage-stack, title: \"}{\"}\n"
      "- {id: hostile-pareto, kind: pareto, y: relmse}\n",
      suite.run());
  // gnuplot writes & and < as XML wants them; names in stage-stack are shortened.
  const std::string begin = "a_b^{2}\\ 'q' \"d\" `touch owned` ";
  const std::string whole = begin + "@x &amp; ~y &lt;i> % #$[0";
  for (const FigureOutcome& outcome : outcomes) {
    ASSERT_EQ(outcome.error, "");
    EXPECT_TRUE(svg_shows(outcome.id, outcome.id == "hostile-stages" ? begin + "..." : whole));
  }
  EXPECT_TRUE(svg_shows("hostile-time", "it's {a_b}^2 \\ `id`"));
  EXPECT_TRUE(svg_shows("hostile-stages", "}{"));
  EXPECT_FALSE(fs::exists("owned"));
  EXPECT_FALSE(fs::exists(out_ / "owned"));
}

TEST_F(FigureFiles, TheScriptMakesThePicturesAgainByHand) {
  write(kSeries, test_figures::realistic_sequence());
  fs::remove(out_ / "series.svg");
  fs::remove(out_ / "series.pdf");
  const auto result = base::run_command(
      {"sh", "-c", "cd \"$0\" && gnuplot -e \"formats='svg'\" series.gp", out_.string()},
      std::chrono::seconds(30));
  EXPECT_EQ(result.exit.code, 0) << result.stderr_text;
  EXPECT_TRUE(fs::exists(out_ / "series.svg"));
  EXPECT_FALSE(fs::exists(out_ / "series.pdf"));
}

TEST_F(FigureFiles, AFigureWithoutDataLeavesTheOthersAlone) {
  const auto outcomes = write(
      "- {id: none, kind: false-colour, metric: relmse}\n"
      "- {id: series, kind: series, y: relmse}\n",
      test_figures::realistic_sequence());
  EXPECT_EQ(outcomes[0].error,
            "suite.yaml:1:3: figure none: no row has a map of relmse against own; it looks at 2 "
            "rows: val | pt; scores of this run: relmse");
  EXPECT_EQ(outcomes[1].error, "");
  EXPECT_FALSE(fs::exists(out_ / "none.gp"));
  EXPECT_TRUE(fs::exists(out_ / "series.pdf"));
}

TEST_F(FigureFiles, AProgramThatFailsIsQuoted) {
  const fs::path program = folder_.path() / "gnuplot";
  base::write_text_file(program, "#!/bin/sh\necho 'no font at all' >&2\nexit 3\n");
  fs::permissions(program, fs::perms::owner_all);
  setenv("DISCERN_GNUPLOT", program.c_str(), 1);
  const auto outcomes = write(kSeries, test_figures::realistic_sequence());
  unsetenv("DISCERN_GNUPLOT");
  EXPECT_EQ(outcomes[0].error,
            (out_ / "series.gp").string() + ": gnuplot failed (exit code 3): no font at all\n");
}

TEST(GnuplotProgram, AMissingOneIsNamedWithItsPackage) {
  setenv("DISCERN_GNUPLOT", "/nowhere/gnuplot", 1);
  const std::string error = tests::input_error_of([] { results::figures::gnuplot_program(); });
  unsetenv("DISCERN_GNUPLOT");
  EXPECT_EQ(error,
            "$DISCERN_GNUPLOT is \"/nowhere/gnuplot\", which is no program; figures need gnuplot: "
            "apt-get install gnuplot-nox");
}

}  // namespace
