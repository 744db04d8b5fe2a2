#include <filesystem>

#include <fmt/format.h>

#include "tests/places.h"
#include "tests/suites/command_line/program_test.h"

namespace tests {
namespace {

namespace fs = std::filesystem;

/// A repository whose "program" is a script: it runs the real one on the suite, changed as the
/// commit says.
class BisectVerb : public ProgramTest {
 protected:
  BisectVerb() {
    git({"init", "--quiet", "--initial-branch=main", path("source")});
    for (const char* setting : {"user.name=Ada", "user.email=ada@example.org"}) {
      const std::string text = setting;
      const std::size_t equals = text.find('=');
      git_in_source({"config", text.substr(0, equals), text.substr(equals + 1)});
    }
    write_text("suite.yaml",
               "schema: 1\nsuite: steps\nviewing: {ppd: 60}\n"
               "scenes: [{id: spot, file: cornell-box-spot, size: [8, 8], "
               "reference: {samples: 16}}]\n"
               "methods: [{id: b, renderer: blank, parameters: {radiance: 0.001}}]\n"
               "metrics: [relative-rmse]\n"
               "gates: [{metric: relative-rmse, against: full, worse_by: 5%}]\n");
  }

  void git(std::vector<std::string> words) const {
    words.insert(words.begin(), "git");
    const base::CommandResult result = base::run_command(words, std::chrono::seconds(30));
    ASSERT_EQ(result.exit.code, 0) << result.stderr_text;
  }
  void git_in_source(std::vector<std::string> words) const {
    words.insert(words.begin(), {"-C", path("source")});
    git(words);
  }

  /// @param radiance  of the picture from this commit on; "" for one without program
  void commit(const std::string& subject, const std::string& radiance) const {
    const std::string file = path("source/program");
    fs::remove(file);
    if (!radiance.empty()) {
      write_text("source/program",
                 fmt::format("#!/bin/sh\nchanged=\"$2.$$.yaml\"\n"
                             "sed 's/radiance: 0.001/radiance: {}/' \"$2\" >\"$changed\"\n"
                             "shift 2\nexec '{}' run \"$changed\" \"$@\"\n",
                             radiance, kProgram));
    }
    write_text("source/subject", subject + "\n");
    git_in_source({"add", "--all"});
    git_in_source({"commit", "--quiet", "--message", subject});
    git_in_source({"tag", subject});
  }

  nlohmann::ordered_json bisect(const std::string& good, const std::string& bad,
                                int exit_code) const {
    return discern_json(
        {"bisect", path("suite.yaml"), good, bad, "--source", path("source"), "--build",
         "mkdir -p build && cp program build/discern && chmod +x build/discern"},
        "bisect", exit_code);
  }
};

TEST_F(BisectVerb, FindsTheCommitThatMadeItWorse) {
  commit("first", "0.001");
  commit("words", "0.001001");
  commit("brighter", "5");
  commit("more-words", "5.001");

  const auto found = bisect("first", "more-words", 0);
  EXPECT_EQ(found["outcome"], "found");
  ASSERT_EQ(found["candidates"].size(), 1U) << found.dump(1);
  EXPECT_EQ(found["candidates"][0]["subject"], "brighter");
  EXPECT_EQ(found["gates"]["counts"]["failed"], 1);
  EXPECT_EQ(found["gates"]["entries"][0]["method"], "b");
  EXPECT_EQ(found["trials"].size(), 4U) << "first, last, and two halves";

  // A commit that does not build may be the one; so may the next.
  git_in_source({"checkout", "--quiet", "--detach", "words"});
  commit("broken-again", "");
  commit("bright-again", "5");
  const auto narrowed = bisect("words", "bright-again", 5);
  EXPECT_EQ(narrowed["outcome"], "narrowed");
  ASSERT_EQ(narrowed["candidates"].size(), 2U) << narrowed.dump(1);
  EXPECT_EQ(narrowed["candidates"][0]["subject"], "broken-again");
  EXPECT_NE(narrowed["trials"][2]["reason"].get<std::string>().find("does not build (exit code 1)"),
            std::string::npos);

  EXPECT_EQ(bisect("first", "words", 5)["outcome"], "not_worse");
  // What was run here is no night of the suite.
  EXPECT_FALSE(fs::exists(path("results/runs/steps")));
}

TEST_F(BisectVerb, RefusesWhatItCannotSearch) {
  commit("first", "0.001");
  commit("second", "0.001");
  const std::string suite = path("suite.yaml");
  const std::string source = path("source");
  expect_refused(
      {"bisect", suite, "first", "third", "--source", source},
      fmt::format("\"third\" is no commit of {}; accepted: a hash, branch or tag there", source));
  expect_refused(
      {"bisect", suite, "second", "first", "--source", source},
      "\"second\" is no earlier commit than \"first\"; accepted: a commit that the later "
      "one came from");
  expect_refused({"bisect", suite, "first", "first", "--source", source},
                 "\"first\" is no earlier commit than \"first\"; accepted: a commit that the later "
                 "one came from");
  const std::string without = write_text(
      "plain.yaml",
      "schema: 1\nsuite: plain\nviewing: {ppd: 60}\nscenes: [{id: box, file: cornell-box, size: "
      "[8, 8]}]\nmethods: [{id: b, renderer: blank}]\nmetrics: []\n");
  expect_refused({"bisect", without, "first", "second", "--source", source},
                 without + ": the suite has no gates to judge by; name one with --quantity");
}

}  // namespace
}  // namespace tests
