// The whole way, on real scenes: the quick suite is run, its report opened in a real browser.
//
// With DISCERN_PICTURES=FOLDER the picture of the report that the README shows is written there.
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "perception/base/child_process.h"
#include "tests/headless_browser.h"
#include "tests/places.h"
#include "tests/temporary_folder.h"

namespace tests {
namespace {

constexpr std::chrono::minutes kLongest{10};

base::CommandResult run_quick(const std::filesystem::path& results) {
  return base::run_command({tests::kProgram, "run", "quick", "--json", "--results", results},
                           kLongest);
}

TEST(QuickSuite, MakesAReportThatABrowserShowsAndResumesAtOnce) {
  const TemporaryFolder folder;
  const base::CommandResult first = run_quick(folder.path());
  ASSERT_EQ(first.exit.code, 0) << first.stderr_text;
  const auto outcome = nlohmann::json::parse(first.stdout_text);
  EXPECT_GE(outcome["cells"], 9);  // 3 scenes x 3 methods
  EXPECT_EQ(outcome["failed"], 0);
  EXPECT_EQ(outcome["skipped"], 0);

  const base::CommandResult second = run_quick(folder.path());
  ASSERT_EQ(second.exit.code, 0) << second.stderr_text;
  const auto resumed = nlohmann::json::parse(second.stdout_text);
  EXPECT_EQ(resumed["run"], outcome["run"]);

  if (!has_browser()) GTEST_SKIP() << "chromium is not installed";
  const char* kept = std::getenv("DISCERN_PICTURES");
  const auto picture =
      (kept != nullptr ? std::filesystem::path(kept) : folder.path()) / "report.png";
  const base::CommandResult shown =
      browse(outcome["report"].get<std::string>(), folder.path() / "profile",
             {"--screenshot=" + picture.string(), "--force-device-scale-factor=0.5",
              "--window-size=1400,1290"});
  EXPECT_EQ(console_lines(shown.stderr_text), "");
  ASSERT_TRUE(std::filesystem::exists(picture)) << shown.stderr_text;
  EXPECT_GT(std::filesystem::file_size(picture), 20000U);
}

}  // namespace
}  // namespace tests
