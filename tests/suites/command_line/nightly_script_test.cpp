#include <chrono>
#include <filesystem>
#include <vector>

#include <gtest/gtest.h>

#include "perception/base/atomic_file.h"
#include "perception/base/child_process.h"
#include "tests/places.h"
#include "tests/suites/command_line/program_test.h"

namespace tests {
namespace {

/// The script of the recipes, with a program that only writes down what it was asked.
class NightlyScript : public ProgramTest {
 protected:
  /// @return the exit code of the night
  int night(const std::string& night_code, const std::string& paper_code,
            const std::string& profile = "smoke") const {
    const std::string fake = write_text("discern", "#!/bin/sh\necho \"$@\" >> '" + path("log") +
                                                       "'\n[ \"$1\" = run ] || exit 0\n"
                                                       "[ \"$2\" = nightly ] && exit " +
                                                       night_code + "\nexit " + paper_code + "\n");
    std::filesystem::permissions(fake, std::filesystem::perms::owner_all);
    std::filesystem::remove(path("log"));
    const std::string script = std::string(kSourceFolder) + "/suites/nightly";
    std::vector<std::string> words{script};
    if (!profile.empty()) words.push_back(profile);
    return base::run_command(words, std::chrono::seconds(30), {{"DISCERN", fake}}).exit.code;
  }
  std::string log() const { return base::read_text_file(path("log")); }
};

TEST_F(NightlyScript, RunsTheNightAndTheClaimsOfEveryPaper) {
  EXPECT_EQ(night("0", "0"), 0);
  const std::string asked = log();
  EXPECT_EQ(asked.find("doctor\nrun nightly --force --profile smoke\nrun "), 0U) << asked;
  const std::filesystem::path papers =
      std::filesystem::path(kSourceFolder) / "suites/catalog/papers";
  for (const auto& file : std::filesystem::directory_iterator(papers)) {
    if (file.path().extension() != ".yaml") continue;
    EXPECT_NE(asked.find("run " + file.path().string() + " --profile smoke --force\n"),
              std::string::npos)
        << asked;
  }
  EXPECT_TRUE(asked.ends_with("history nightly --profile smoke\n")) << asked;
}

/// Profiles of the sweep have other budgets than a second.
TEST_F(NightlyScript, RunsTheRowOfASecondOfTheSmallSweep) {
  const std::string row = "run sweeps/common-box --filter [.]1s[.] --force\n";
  EXPECT_EQ(night("0", "0", ""), 0);
  EXPECT_NE(log().find(row), std::string::npos) << log();
  EXPECT_TRUE(log().ends_with(row + "history nightly\n")) << log();
  EXPECT_EQ(night("0", "0"), 0);
  EXPECT_EQ(log().find(row), std::string::npos) << log();
}

/// The codes of exit_codes.h: of several the most important one, and a stop is a stop.
TEST_F(NightlyScript, EndsWithTheCodeThatCounts) {
  EXPECT_EQ(night("1", "0"), 1);
  EXPECT_EQ(night("1", "3"), 3);
  EXPECT_EQ(night("3", "1"), 3);
  EXPECT_EQ(night("4", "3"), 4);
  EXPECT_EQ(night("5", "1"), 1);
  EXPECT_EQ(night("139", "0"), 4);
  EXPECT_EQ(night("130", "0"), 130);
  EXPECT_EQ(log(), "doctor\nrun nightly --force --profile smoke\n");
}

}  // namespace
}  // namespace tests
