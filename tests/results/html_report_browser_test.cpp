// The report in a real browser: it must run without a single console message, and what its script
// adds must be there. Skipped where Chromium is not installed.
#include <cstdlib>

#include <chrono>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "perception/base/atomic_file.h"
#include "perception/base/child_process.h"
#include "results/html_report/html_report.h"
#include "tests/headless_browser.h"
#include "tests/results/synthetic_run.h"
#include "tests/temporary_folder.h"

namespace {

namespace fs = std::filesystem;
using tests::browse;
using tests::console_lines;
using tests::TemporaryFolder;

class InTheBrowser : public testing::Test {
 protected:
  void SetUp() override {
    if (!tests::has_browser()) GTEST_SKIP() << "chromium is not installed";
    const fs::path run = test_results::write_synthetic_run(folder_.path(), 320, 240);
    page_ = results::html_report::write_report(results::load_run(run)).index;
    const char* kept = std::getenv("DISCERN_KEEP_REPORT");
    if (kept != nullptr) fs::copy_file(page_, kept, fs::copy_options::overwrite_existing);
  }

  /// The page after its script and another one have run.
  std::string dom_after(const std::string& script) {
    const fs::path changed = folder_.path() / "changed.html";
    std::string text = base::read_text_file(page_);
    text.insert(text.rfind("</body>"), "<script>" + script + "</script>");
    base::write_text_file(changed, text);
    const auto result = browse(changed, folder_.path() / "profile", {"--dump-dom"});
    EXPECT_EQ(result.exit.code, 0) << result.stderr_text;
    EXPECT_EQ(console_lines(result.stderr_text), "");
    return result.stdout_text;
  }

  TemporaryFolder folder_;
  fs::path page_;
};

TEST_F(InTheBrowser, ScriptAddsSortingAndTheViewerWithoutAnyMessage) {
  const std::string dom = dom_after("");
  for (const char* wanted :
       {"id=\"overview\"", "id=\"scene-1\"", "id=\"scene-2\"", "id=\"failures\"",
        "id=\"provenance\"", "class=\"sorts\"", "<dialog class=\"viewer\">", "picture zooms"}) {
    EXPECT_NE(dom.find(wanted), std::string::npos) << wanted;
  }
}

TEST_F(InTheBrowser, AConsoleErrorWouldBeSeen) {
  const auto result = [&] {
    const fs::path broken = folder_.path() / "broken.html";
    base::write_text_file(broken, "<script>no_such_function()</script>");
    return browse(broken, folder_.path() / "profile", {"--dump-dom"});
  }();
  EXPECT_NE(console_lines(result.stderr_text).find("no_such_function"), std::string::npos);
}

TEST_F(InTheBrowser, AClickSortsNumbersAsNumbers) {
  const std::string dom = dom_after(
      "document.querySelectorAll('#numbers thead th')[4].click();"
      "document.title = [...document.querySelectorAll('#numbers tbody tr')]"
      ".map(r => r.cells[1].textContent).join(' ');");
  EXPECT_NE(dom.find("<title>direct-only direct-only pt8 pt8 broken broken later later<"),
            std::string::npos)
      << dom.substr(0, 400);
}

/// Rows of a sweep that nobody reads from top to bottom: still sorted, and still without a message.
TEST_F(InTheBrowser, TenThousandRowsAreSorted) {
  constexpr std::size_t kRows = 10'000;
  results::Run run;
  nlohmann::ordered_json info{{"schema", 1}, {"suite", "sweep"}, {"state", "complete"}};
  run.info = std::make_shared<const nlohmann::ordered_json>(std::move(info));
  run.folder = folder_.path() / "runs/sweep/many";
  for (std::size_t i = 0; i < kRows; ++i) {
    // Times in another order than names: 7 has no common divisor with the number of rows.
    const auto time_s = 1e-3 * static_cast<double>(7 * i % kRows + 1);
    run.cells.push_back(test_results::timed_cell("box", fmt::format("pt[n={}]", i), 1, time_s));
  }
  fs::create_directories(run.folder);
  page_ = results::html_report::write_report(run).index;
  const std::string dom = dom_after(
      "document.querySelectorAll('#numbers thead th')[4].click();"
      "const rows = [...document.querySelectorAll('#numbers tbody tr')];"
      "document.title = [rows.length, rows[0].cells[1].textContent, rows[1].cells[1].textContent,"
      "rows[rows.length - 1].cells[1].textContent].join(' ');");
  // 7 i = 1 (mod 10,000) of i = 7143, and 7 i = 9999 of i = 2857.
  EXPECT_NE(dom.find("<title>10000 pt[n=0] pt[n=7143] pt[n=2857]</title>"), std::string::npos)
      << dom.substr(0, 600);
}

TEST_F(InTheBrowser, AScreenshotIsMade) {
  const char* kept = std::getenv("DISCERN_SCREENSHOT");
  const fs::path picture = kept == nullptr ? folder_.path() / "page.png" : fs::path(kept);
  const auto result =
      browse(page_, folder_.path() / "profile", {"--screenshot=" + picture.string()});
  EXPECT_EQ(console_lines(result.stderr_text), "");
  ASSERT_TRUE(fs::exists(picture)) << result.stderr_text;
  EXPECT_GT(fs::file_size(picture), 20000U);  // a blank page of this size is far smaller
}

}  // namespace
