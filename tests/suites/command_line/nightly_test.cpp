#include <filesystem>

#include <fmt/format.h>

#include "perception/base/atomic_file.h"
#include "results/run_environment.h"
#include "tests/suites/command_line/program_test.h"

namespace tests {
namespace {

/// Nights of a suite whose one renderer is told how long to take.
class Nightly : public ProgramTest {
 protected:
  std::string suite_taking(double seconds, int depth = 4) const {
    return write_text(
        "night.yaml",
        fmt::format("schema: 1\nsuite: night\nviewing: {{ppd: 60}}\n"
                    "scenes: [{{id: spot, file: cornell-box-spot, size: [8, 8], "
                    "reference: {{samples: 512}}}}]\n"
                    "methods: [{{id: b, renderer: blank, parameters: {{sleep_s: {}}}}},\n"
                    "          {{id: pt, renderer: path, parameters: {{max_depth: {}}}, "
                    "budgets: [{{samples: 64}}], measure: {{seeds: 4}}}}]\n"
                    "measure: {{repetitions: {{min: 6, max: 6}}}}\nmetrics: [relative-rmse]\n"
                    "gates: [{{stage: total, slower_by: 30%, methods: [b]}},\n"
                    "        {{metric: relative-rmse, against: full, worse_by: 5%, "
                    "methods: [pt]}}]\n",
                    seconds, depth));
  }
  std::string text_of(const std::string& file) const { return base::read_text_file(file); }
  std::string baseline_file() const {
    const auto file = std::filesystem::path(path("results")) / "baselines/night" /
                      (results::machine_name() + ".json");
    return file.string();
  }
};

/// A night with a slower renderer and one that lost quality: both are caught and named. Slower by
/// more than the machine itself can get under other work, which the canary would answer for.
TEST_F(Nightly, CatchesASlowdownAndALossOfQuality) {
  const std::string suite = suite_taking(0.02);
  const auto first = discern_json({"run", suite, "--force"}, "run");
  EXPECT_EQ(first["gates"]["outcome"], "not_measured");
  EXPECT_NE(first["gates"]["notes"][0].get<std::string>().find("discern accept"),
            std::string::npos);
  // Nothing measured is no success where that was asked for.
  EXPECT_EQ(discern({"run", suite, "--strict"}).exit.code, 5);

  const std::string run = first["run"].get<std::string>();
  expect_refused({"compare", "baseline", "last"},
                 fmt::format("there is no baseline {}; make one with `discern accept {} --reason "
                             "TEXT`",
                             baseline_file(), std::filesystem::path(run).filename().string()));
  const auto accepted =
      discern_json({"accept", "last", "--reason", "first night", "--author", "Ada"}, "accept");
  EXPECT_EQ(accepted["rows"].size(), 2U);
  EXPECT_EQ(accepted["baseline"], baseline_file());

  const auto calm = discern_json({"run", suite, "--force"}, "run");
  EXPECT_EQ(calm["gates"]["counts"]["failed"], 0) << calm.dump(1);

  const auto bad = discern_json(
      {"run", suite_taking(0.4, 1), "--force", "--junit", path("night.xml")}, "run", 1);
  EXPECT_EQ(bad["gates"]["outcome"], "failed");
  EXPECT_EQ(bad["gates"]["counts"]["failed"], 2) << bad["gates"].dump(1);
  const std::string xml = text_of(path("night.xml"));
  EXPECT_EQ(xml, text_of(bad["run"].get<std::string>() + "/junit.xml"));
  EXPECT_NE(xml.find("failures=\"2\""), std::string::npos) << xml;

  // The same again, of the stored run, by its gates alone.
  const auto again = discern_json({"compare", "baseline", "last", "--gates"}, "compare", 1);
  EXPECT_EQ(again["gates"]["counts"]["failed"], 2);
  const auto table = discern({"compare", "baseline", "last", "--gates", "--only-changed"});
  EXPECT_NE(table.stdout_text.find("total slower by 30%"), std::string::npos);

  // Accepted, it is what later nights are compared with.
  EXPECT_EQ(discern({"accept", "last", "--reason", "it does more now"}).exit.code, 0);
  EXPECT_EQ(discern_json({"compare", "baseline", "last", "--gates"}, "compare")["gates"]["outcome"],
            "passed");
}

TEST_F(Nightly, HistoryTableCheapestReadWhatNightsLeft) {
  for (const double seconds : {0.001, 0.001, 0.02, 0.02}) {
    discern_json({"run", suite_taking(seconds), "--force", "--repetitions", "2", "--seeds", "1"},
                 "run");
  }
  const auto history = discern_json({"history", "night", "--filter", "^b$"}, "history");
  ASSERT_EQ(history["series"].size(), 1U) << history.dump(1);
  EXPECT_EQ(history["series"][0]["points"].size(), 4U);
  ASSERT_EQ(history["series"][0]["steps"].size(), 1U) << history.dump(1);
  EXPECT_EQ(history["series"][0]["steps"][0]["run"], history["series"][0]["points"][2]["run"]);
  EXPECT_NE(discern({"history", "night"}).stdout_text.find("last step"), std::string::npos);
  // A page has every quantity, unless one is asked for.
  const auto all = discern_json({"history", "night", "--html", path("trends.html")}, "history");
  EXPECT_EQ(all["page"], path("trends.html"));
  const std::string page = text_of(path("trends.html"));
  for (const char* part : {"<section id=\"total_s\">", "<section id=\"relative-rmse@full\">",
                           "<section id=\"steps\">", "worse +"}) {
    EXPECT_NE(page.find(part), std::string::npos) << part;
  }
  EXPECT_EQ(
      discern({"history", "night", "--quantity", "total_s", "--html", path("one.html")}).exit.code,
      0);
  EXPECT_EQ(text_of(path("one.html")).find("<section id=\"relative-rmse@full\">"),
            std::string::npos);
  expect_refused({"history", "nigth"},
                 "history: unknown suite \"nigth\"; "
                 "known: night");

  const auto csv = discern({"table", "last", "--format", "csv"});
  EXPECT_EQ(csv.exit.code, 0);
  EXPECT_EQ(csv.stdout_text.find("scene,method,budget,reps,"), 0U) << csv.stdout_text;
  EXPECT_NE(discern({"table", "last", "--format", "latex"}).stdout_text.find("\\toprule"),
            std::string::npos);
  EXPECT_EQ(discern({"table", "last", "--filter", "nothing"}).exit.code, 4);

  const auto cheapest =
      discern_json({"cheapest", "last", "--metric", "relative-rmse", "--below", "1"}, "cheapest");
  EXPECT_EQ(cheapest["scenes"][0]["cheapest"]["method"], "pt") << cheapest.dump(1);
  EXPECT_TRUE(discern_json({"cheapest", "last", "--metric", "relative-rmse", "--below", "0.1%"},
                           "cheapest")["scenes"][0]["cheapest"]
                  .is_null());
}

TEST_F(Nightly, PartsOfOneSuiteBecomeOneRun) {
  const std::string suite = suite_taking(0.001);
  const auto run_part = [&](const std::string& filter) {
    return discern_json({"run", suite, "--force", "--filter", filter, "--repetitions", "1"},
                        "run")["run"]
        .get<std::string>();
  };
  const std::string b = run_part("^b$");
  const std::string pt = run_part("^pt$");
  const auto merged = discern_json({"merge", b, pt}, "merge");
  EXPECT_EQ(merged["repetitions"], 1 + 4);
  const auto table = discern({"table", merged["run"].get<std::string>(), "--format", "csv"});
  EXPECT_NE(table.stdout_text.find("spot,b,"), std::string::npos) << table.stdout_text;
  EXPECT_NE(table.stdout_text.find("spot,pt,"), std::string::npos);
  EXPECT_EQ(table.stdout_text.find("not yet"), std::string::npos) << table.stdout_text;
  // Its parts are whole still, and may not be taken in twice.
  const auto twice = discern({"merge", merged["run"].get<std::string>(), pt});
  EXPECT_EQ(twice.exit.code, 2);
  EXPECT_NE(twice.stderr_text.find("accepted: parts that share none"), std::string::npos)
      << twice.stderr_text;
}

TEST_F(Nightly, DoctorLooksAtTheMachine) {
  const auto json = discern_json({"doctor"}, "doctor");
  EXPECT_GE(json["findings"].size(), 9U);
  for (const auto& one : json["findings"]) {
    EXPECT_EQ(one["cure"].get<std::string>().empty(),
              one["state"] == "good" || one["state"] == "unknown")
        << one.dump();
  }
  const std::string file = write_text("file", "not a folder");
  EXPECT_EQ(discern({"doctor", "--results", file + "/results"}).exit.code, 4);
}

}  // namespace
}  // namespace tests
