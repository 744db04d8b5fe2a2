#include <fstream>

#include "perception/base/atomic_file.h"
#include "tests/suites/command_line/program_test.h"

namespace tests {
namespace {

/// A small suite with claims and figures, run once.
class ClaimsVerb : public ProgramTest {
 protected:
  static std::string suite_text(const std::string& claims, const std::string& figures = "") {
    return "schema: 1\nsuite: trial\nviewing: {ppd: 60}\n"
           "scenes: [{id: spot, file: cornell-box-spot, size: [16, 16], reference: {samples: "
           "64}}]\n"
           "methods: [{id: pt, renderer: path}]\n"
           "budgets: [{samples: [1, 4, 16]}]\nmeasure: {seeds: 2}\nmetrics: [relative-rmse]\n"
           "claims:\n" +
           claims + figures;
  }

  static std::string claim(const std::string& id, const std::string& measure,
                           const std::string& expect, const std::string& more = "") {
    return "  - {id: " + id + ", item: here, says: it, measure: \"" + measure + "\", expect: \"" +
           expect + "\"" + more + "}\n";
  }

  std::string write_suite(const std::string& claims, const std::string& figures = "") const {
    return write_text("trial.yaml", suite_text(claims, figures));
  }

  static const nlohmann::ordered_json& of(const nlohmann::ordered_json& json,
                                          const std::string& id) {
    for (const auto& entry : json["claims"]) {
      if (entry["id"] == id) return entry;
    }
    throw std::runtime_error("no claim " + id);
  }
};

TEST_F(ClaimsVerb, JudgesTheNewestRunOfTheSuite) {
  const std::string suite = write_suite(
      claim("falls", "series(pt, relative-rmse, samples)", "falls") +
      claim("wrong", "value(pt[budget=16spp], relative-rmse)", "> 1e6") +
      claim("empty", "median(pt[budget=64spp], relative-rmse)", "> 0") +
      claim("stage", "share(pt, gathre)", "largest") +
      claim("old", "median(pt, total_s)", "< 1", ", comparable: \"no: hardware time\""));
  discern_json({"run", suite}, "run");
  const auto json = discern_json({"claims", suite}, "claims");
  EXPECT_EQ(of(json, "falls")["verdict"], "reproduced") << json.dump(1);
  EXPECT_EQ(of(json, "wrong")["verdict"], "not_reproduced");
  EXPECT_EQ(of(json, "empty")["verdict"], "inconclusive");
  EXPECT_EQ(of(json, "stage")["verdict"], "inconclusive");
  EXPECT_NE(of(json, "stage")["reason"].get<std::string>().find("transport"), std::string::npos)
      << of(json, "stage")["reason"];
  EXPECT_EQ(of(json, "old")["verdict"], "not_comparable");
  EXPECT_EQ(of(json, "old")["reason"], "hardware time");
  EXPECT_EQ(json["all_reproduced"], false);
  // --strict: what is not reproduced goes before what is open.
  EXPECT_EQ(discern({"claims", suite, "--strict"}).exit.code, 1);
  const auto text = discern({"claims", suite});
  EXPECT_EQ(text.exit.code, 0);
  for (const char* part : {"not reproduced", "inconclusive", "not comparable", "falls"}) {
    EXPECT_NE(text.stdout_text.find(part), std::string::npos) << part << text.stdout_text;
  }
  const auto latex = discern({"claims", suite, "--format", "latex"});
  EXPECT_NE(latex.stdout_text.find("\\toprule"), std::string::npos) << latex.stdout_text;
  EXPECT_NE(latex.stdout_text.find("paper prints"), std::string::npos);
  EXPECT_EQ(latex.stdout_text.find("\nrun "), std::string::npos);
  const auto csv = discern({"claims", suite, "--format", "csv"});
  EXPECT_EQ(csv.stdout_text.find("verdict,claim,item,value,expected,paper prints,reason"), 0U);
}

TEST_F(ClaimsVerb, ClaimsMayChangeWithoutMeasuringAgain) {
  const auto first = discern_json(
      {"run", write_suite(claim("a", "value(pt[budget=1spp], relative-rmse)", "> 0"))}, "run");
  const std::string changed =
      write_suite(claim("b", "value(pt[budget=16spp], relative-rmse)", "> 0"));
  EXPECT_EQ(discern({"claims", changed, "--strict"}).exit.code, 0);
  const auto second = discern_json({"run", changed}, "run");
  EXPECT_EQ(second["run"], first["run"]);
  EXPECT_EQ(second["new_repetitions"], 0);
  std::ifstream file(second["report"].get<std::string>());
  const std::string page((std::istreambuf_iterator<char>(file)), {});
  EXPECT_NE(page.find("value(pt[budget=16spp], relative-rmse)"), std::string::npos);
  EXPECT_EQ(page.find("value(pt[budget=1spp], relative-rmse)"), std::string::npos);
}

TEST_F(ClaimsVerb, OpenClaimsAreInconclusiveForTheExitCode) {
  const std::string suite =
      write_suite(claim("none", "median(pt[budget=64spp], relative-rmse)", "> 0"));
  discern_json({"run", suite}, "run");
  EXPECT_EQ(discern({"claims", suite, "--strict"}).exit.code, 5);
  EXPECT_EQ(discern({"claims", suite}).exit.code, 0);
}

TEST_F(ClaimsVerb, MistakesAreFoundBeforeAnythingRuns) {
  const auto error = [&](const std::string& claims) {
    const auto result = discern({"check", write_suite(claims)});
    EXPECT_EQ(result.exit.code, 2) << result.stdout_text;
    return result.stderr_text;
  };
  EXPECT_NE(error(claim("a", "value(pt relmse)", "> 0")).find("trial.yaml:10:"), std::string::npos);
  const std::string method = error(claim("a", "median(pth, relative-rmse)", "> 0"));
  EXPECT_NE(method.find("unknown method \"pth\"; did you mean \"pt\"?"), std::string::npos)
      << method;
  const std::string metric = error(claim("a", "median(pt, relative-rmes@full)", "> 0"));
  EXPECT_NE(metric.find("relative-rmes"), std::string::npos) << metric;
  EXPECT_NE(error(claim("a", "median(pt, relative-rmse)", "about 3")).find("trial.yaml:10:"),
            std::string::npos);
  const std::string profile =
      error(claim("a", "median(pt, relative-rmse)", "> 0", ", profile: half"));
  EXPECT_NE(profile.find("claim \"a\": unknown profile \"half\""), std::string::npos) << profile;
}

TEST_F(ClaimsVerb, WithoutARunItSaysHowToMakeOne) {
  const std::string suite = write_suite(claim("a", "median(pt, relative-rmse)", "> 0"));
  const auto result = discern({"claims", suite});
  EXPECT_EQ(result.exit.code, 2);
  EXPECT_NE(result.stderr_text.find("there is no run of suite \"trial\""), std::string::npos)
      << result.stderr_text;
}

TEST_F(ClaimsVerb, FiguresAreDrawnFromTheRun) {
  const std::string suite =
      write_suite(claim("a", "median(pt, relative-rmse)", "> 0"),
                  "figures:\n"
                  "  - {id: rate, kind: error-vs-parameter, x: samples, y: relative-rmse}\n"
                  "  - {id: walk, kind: series, y: next_frame_s}\n");
  discern_json({"run", suite}, "run");
  const auto one = discern_json({"figure", suite, "rate", "--out", path("out")}, "figure");
  ASSERT_EQ(one["figures"].size(), 1U);
  for (const char* name : {"rate.pdf", "rate.svg", "rate.csv", "rate.gp"}) {
    EXPECT_TRUE(std::filesystem::exists(folder() / "out" / name)) << name;
  }
  EXPECT_EQ(discern({"figure", suite, "rate", "--format", "png", "--out", path("out")}).exit.code,
            0);
  const std::string png = base::read_text_file(path("out") + "/rate.png");
  EXPECT_NE(png.find("Figure rate (error-vs-parameter)"), std::string::npos);
  expect_refused({"figure", suite, "rate", "--format", "jpg"},
                 "--format: unknown format \"jpg\"; known: pdf, svg, png");
  // One figure that cannot be made does not keep the other from it.
  const auto all = discern_json({"figure", suite}, "figure", 2);
  EXPECT_EQ(all["status"], "failed");
  EXPECT_TRUE(all["figures"][0]["error"].is_null());
  EXPECT_FALSE(all["figures"][1]["error"].is_null());
  expect_refused({"figure", suite, "rat"}, suite +
                                               ": unknown figure \"rat\"; did you mean \"rate\"? "
                                               "known: rate, walk");
}

/// A suite that says which paper it is of, and one that is of none.
TEST_F(ClaimsVerb, PapersAreSummedUpRowByRow) {
  const std::string claims = claim("xy-01", "value(pt[budget=16spp], relative-rmse)", "> 0") +
                             claim("xy-01-b", "value(pt[budget=16spp], relative-rmse)", "> 1e6") +
                             claim("xy-02-best", "value(pt[budget=1spp], relative-rmse)", "> 0");
  const std::string more =
      "paper: {source: \"Someone 2001, <Somewhere>\", claims: xy, rows: 3, unmeasured: {xy-03: "
      "no film}}\n"
      "figures:\n  - {id: rate, kind: error-vs-parameter, x: samples, y: relative-rmse}\n"
      "  - {id: walk, kind: series, y: next_frame_s}\n";
  const std::string suite = write_suite(claims, more);
  const auto before = discern_json({"papers", suite, "--out", path("out")}, "papers", 4);
  EXPECT_TRUE(before["papers"][0]["run"].is_null());
  EXPECT_EQ(before["papers"][0]["counts"]["not measured"], 3);
  EXPECT_TRUE(before["files"].empty());
  EXPECT_FALSE(std::filesystem::exists(path("out")));

  discern_json({"run", suite, "--filter", "^pt$"}, "run");
  const auto json = discern_json({"papers", suite, "--out", path("out")}, "papers");
  const auto& paper = json["papers"][0];
  ASSERT_EQ(paper["rows"].size(), 3U);
  EXPECT_EQ(paper["rows"][0]["state"], "in part");
  EXPECT_TRUE(paper["rows"][0]["corrected_state"].is_null());
  EXPECT_EQ(paper["rows"][1]["state"], "not measured");
  EXPECT_EQ(paper["rows"][1]["corrected_state"], "reproduced");
  EXPECT_EQ(json["files"], nlohmann::ordered_json({"index.html", "README.md", "trial.md"}));
  EXPECT_EQ(paper["figures"][0]["file"], "trial/rate.png");
  EXPECT_TRUE(std::filesystem::exists(folder() / "out/trial/rate.png"));
  EXPECT_FALSE(std::filesystem::exists(folder() / "out/trial/rate.gp"));
  const std::string page = base::read_text_file(path("out") + "/index.html");
  EXPECT_NE(page.find("src=\"trial/rate.png\""), std::string::npos);
  EXPECT_NE(page.find("Someone 2001, &lt;Somewhere&gt;"), std::string::npos);
  EXPECT_NE(page.find("◐ in part</b>"), std::string::npos);
  EXPECT_NE(page.find("no film"), std::string::npos);
  const std::string markdown = base::read_text_file(path("out") + "/trial.md");
  EXPECT_NE(markdown.find("| xy-03 |  |  | not measured |"), std::string::npos) << markdown;
  EXPECT_NE(markdown.find("![rate](trial/rate.png)"), std::string::npos);
  const std::string readme = base::read_text_file(path("out") + "/README.md");
  EXPECT_NE(readme.find("[trial](trial.md)"), std::string::npos);
  EXPECT_NE(readme.find("(only cells that match `^pt$`)"), std::string::npos) << readme;
  // A figure that cannot be made says where and why, and nothing of the machine's folders.
  EXPECT_NE(markdown.find("`walk`: trial.yaml:"), std::string::npos) << markdown;
  for (const std::string& text : {page, markdown, readme}) {
    EXPECT_EQ(text.find(folder().string()), std::string::npos) << text;
  }
  // Of a profile that never ran, nothing is known.
  EXPECT_EQ(discern({"papers", suite, "--profile", "half", "--out", path("none")}).exit.code, 4);
}

TEST_F(ClaimsVerb, PapersWantASuiteOfAPaper) {
  const std::string suite = write_suite(claim("a", "median(pt, relative-rmse)", "> 0"));
  expect_refused({"papers", suite, "--out", path("out")},
                 suite +
                     ": suite \"trial\" is of no paper; one that is says so: `paper: {source: "
                     "TEXT, claims: PREFIX, rows: COUNT}`");
}

}  // namespace
}  // namespace tests
