#include "results/result_store.h"

#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "perception/base/atomic_file.h"
#include "tests/expect_input_error.h"
#include "tests/places.h"
#include "tests/results/synthetic_run.h"
#include "tests/temporary_folder.h"

namespace {

namespace fs = std::filesystem;
using results::CellRecord;
using results::RunFolder;
using test_results::full_cell_record;
using test_results::full_metric_record;
using tests::input_error_of;
using tests::TemporaryFolder;

void append_text(const fs::path& path, const std::string& text) {
  std::ofstream(path, std::ios::app | std::ios::binary) << text;
}

TEST(ResultStore, GivesBackWhatWasAppended) {
  const TemporaryFolder temporary;
  RunFolder folder = RunFolder::open_for_writing(temporary.path() / "runs/s/r");
  folder.write_run_json({{"schema", 1}, {"suite", "s"}});
  folder.write_resolved_suite("schema: 1\n");
  folder.append(full_cell_record());
  folder.append(full_metric_record());
  const results::Run run = results::load_run(folder.path());  // while it is still being written
  ASSERT_EQ(run.cells.size(), 1U);
  EXPECT_EQ(to_json(run.cells[0]), to_json(full_cell_record()));
  ASSERT_EQ(run.metrics.size(), 1U);
  EXPECT_EQ(to_json(run.metrics[0]), to_json(full_metric_record()));
  EXPECT_EQ(run.info->at("suite"), "s");
  EXPECT_EQ(run.resolved_suite, "schema: 1\n");
  EXPECT_EQ(run.unreadable_lines, 0U);
}

TEST(ResultStore, TheLastScoreOfAKeyWinsAndKeepsItsPlace) {
  const TemporaryFolder temporary;
  RunFolder folder = RunFolder::open_for_writing(temporary.path());
  auto first = full_metric_record();
  auto other = full_metric_record();
  other.against = "own";
  folder.write_run_json({{"schema", 1}});
  folder.append(first);
  folder.append(other);
  first.value = 7.0;
  folder.append(first);
  const results::Run run = results::load_run(folder.path());
  ASSERT_EQ(run.metrics.size(), 2U);
  EXPECT_EQ(run.metrics[0].value, 7.0);
  EXPECT_EQ(run.metrics[1].against, "own");
}

TEST(ResultStore, ACutLineIsSkippedAndCountedAndNeverSwallowsTheNext) {
  const TemporaryFolder temporary;
  const fs::path cells = temporary.path() / "cells.jsonl";
  {
    RunFolder folder = RunFolder::open_for_writing(temporary.path());
    folder.append(full_cell_record());
  }
  append_text(cells, R"({"schema":1,"run":"2026)");  // the process was killed here
  EXPECT_EQ(results::load_run(temporary.path()).cells.size(), 1U);
  EXPECT_EQ(results::load_run(temporary.path()).unreadable_lines, 1U);

  RunFolder folder = RunFolder::open_for_writing(temporary.path());  // resumed
  CellRecord second = full_cell_record();
  second.repetition = 3;
  folder.append(second);
  const results::Run run = results::load_run(temporary.path());
  ASSERT_EQ(run.cells.size(), 2U);
  EXPECT_EQ(run.cells[1].repetition, 3);
  EXPECT_EQ(run.unreadable_lines, 1U);
}

TEST(ResultStore, AWrongRecordIsAnErrorWithItsPlace) {
  const TemporaryFolder temporary;
  const fs::path cells = temporary.path() / "cells.jsonl";
  append_text(cells, to_json(full_cell_record()).dump() + "\n{\"schema\":1}\n");
  EXPECT_EQ(input_error_of([&] { results::load_run(temporary.path()); }),
            cells.string() + ":2: cell record: field \"run\" is missing");
}

TEST(ResultStore, BytesThatAreNoTextDoNotStopARecord) {
  const TemporaryFolder temporary;
  RunFolder folder = RunFolder::open_for_writing(temporary.path());
  CellRecord record = full_cell_record();
  record.render.reason = "log says \xff\xfe";
  folder.append(record);
  EXPECT_EQ(results::load_run(temporary.path()).cells[0].render.reason,
            "log says \xEF\xBF\xBD\xEF\xBF\xBD");
}

TEST(ResultStore, ASecondWriterIsToldWhoHoldsTheRun) {
  const TemporaryFolder temporary;
  const RunFolder first = RunFolder::open_for_writing(temporary.path());
  const std::string message =
      input_error_of([&] { RunFolder::open_for_writing(temporary.path()); });
  const std::string expected = temporary.path().string() +
                               ": the run is being written by process " + std::to_string(getpid()) +
                               " on ";
  EXPECT_EQ(message.substr(0, expected.size()), expected);
  EXPECT_NE(message.find(" since 20"), std::string::npos);
  EXPECT_NE(message.find("; wait for its end, or stop it"), std::string::npos);
}

TEST(ResultStore, TheLockGoesWithItsHolder) {
  const TemporaryFolder temporary;
  { const RunFolder first = RunFolder::open_for_writing(temporary.path()); }
  EXPECT_NO_THROW(RunFolder::open_for_writing(temporary.path()));
  // A process that dies without cleaning up leaves no lock behind.
  const pid_t child = fork();
  if (child == 0) {
    RunFolder* leaked = new RunFolder(RunFolder::open_for_writing(temporary.path()));
    _exit(leaked == nullptr ? 1 : 0);
  }
  int state = 0;
  ASSERT_EQ(waitpid(child, &state, 0), child);
  ASSERT_EQ(state, 0);
  EXPECT_NO_THROW(RunFolder::open_for_writing(temporary.path()));
}

TEST(ResultStore, TheLockMovesWithTheFolder) {
  const TemporaryFolder temporary;
  RunFolder first = RunFolder::open_for_writing(temporary.path());
  const RunFolder second = std::move(first);
  EXPECT_NE(input_error_of([&] { RunFolder::open_for_writing(temporary.path()); }), "no error");
}

TEST(ResultStore, AFullDiskIsAnErrorWithTheReason) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "needs /dev/full";
  const TemporaryFolder temporary;
  RunFolder folder = RunFolder::open_for_writing(temporary.path());
  fs::create_symlink("/dev/full", temporary.path() / "cells.jsonl");
  EXPECT_EQ(
      input_error_of([&] { folder.append(full_cell_record()); }),
      (temporary.path() / "cells.jsonl").string() + ": cannot append: No space left on device");
}

TEST(ResultStore, AFolderThatCannotBeMadeIsAnErrorWithTheReason) {
  const TemporaryFolder temporary;
  append_text(temporary.path() / "file", "x");
  const fs::path below = temporary.path() / "file" / "run";
  EXPECT_EQ(input_error_of([&] { RunFolder::open_for_writing(below); }),
            below.string() + ": cannot make the folder: Not a directory");
}

TEST(ResultStore, AFolderThatIsNoRunIsRefused) {
  const TemporaryFolder temporary;
  EXPECT_EQ(input_error_of([&] { results::load_run(temporary.path()); }),
            temporary.path().string() + ": not a run; a run folder holds run.json and cells.jsonl");
}

TEST(ResultStore, CellFoldersAreMadeOnFirstUse) {
  const TemporaryFolder temporary;
  const RunFolder folder = RunFolder::open_for_writing(temporary.path());
  EXPECT_FALSE(fs::exists(temporary.path() / "images"));
  EXPECT_EQ(folder.cell_folder("a.b"), temporary.path() / "images/a.b");
  EXPECT_TRUE(fs::is_directory(temporary.path() / "images/a.b"));
}

// ---- names of runs

void make_run(const fs::path& root, const std::string& suite, const std::string& id) {
  fs::create_directories(root / "runs" / suite / id);
  base::write_text_file(root / "runs" / suite / id / "run.json", "{}");
}

TEST(RunLookup, OptionThenVariableThenCheckout) {
  unsetenv("DISCERN_RESULTS");
  EXPECT_EQ(results::results_root(""), fs::path(tests::kSourceFolder) / "results");
  setenv("DISCERN_RESULTS", "/somewhere/else", 1);
  EXPECT_EQ(results::results_root(""), "/somewhere/else");
  EXPECT_EQ(results::results_root("here"), "here");
  unsetenv("DISCERN_RESULTS");
}

TEST(RunLookup, NewNamesStartWithTheTimeAndDiffer) {
  const TemporaryFolder temporary;
  const fs::path a = results::new_run_folder(temporary.path(), "quick");
  const fs::path b = results::new_run_folder(temporary.path(), "quick");
  EXPECT_NE(a, b);
  EXPECT_EQ(a.parent_path(), temporary.path() / "runs/quick");
  const std::string name = a.filename().string();
  ASSERT_EQ(name.size(), 16U + 1U + 6U);
  EXPECT_EQ(name[8], 'T');
  EXPECT_EQ(name[15], 'Z');
  EXPECT_EQ(name[16], '-');
  EXPECT_EQ(name.find_first_not_of("0123456789abcdef", 17), std::string::npos);
  EXPECT_FALSE(fs::exists(a));
}

/// A clock that was set back, or two runs within a second: the newest run is the one made last.
TEST(RunLookup, NewNamesComeAfterAllOthersWhateverTheClockSays) {
  const TemporaryFolder temporary;
  const fs::path& root = temporary.path();
  fs::create_directories(root / "runs/other/20991231T235959Z-ffffff");
  const fs::path first = results::new_run_folder(root, "quick");
  EXPECT_EQ(first.filename().string().substr(0, 17), "21000101T000000Z-");
  fs::create_directories(first);
  const fs::path second = results::new_run_folder(root, "quick");
  fs::create_directories(second);
  EXPECT_EQ(results::newest_run(root, "quick"), second);
  EXPECT_EQ(results::newest_run(root, ""), second);
  // A name that somebody gave a run is no time.
  fs::create_directories(root / "runs/quick/zebra");
  EXPECT_EQ(results::new_run_folder(root, "quick").filename().string().find("20"), 0U);
}

TEST(RunLookup, FindsByPathIdSuiteAndLast) {
  const TemporaryFolder temporary;
  const fs::path& root = temporary.path();
  make_run(root, "quick", "20260101T000000Z-aaaaaa");
  make_run(root, "quick", "20260301T000000Z-bbbbbb");
  make_run(root, "nightly", "20260201T000000Z-cccccc");
  EXPECT_EQ(results::newest_run(root, "").filename(), "20260301T000000Z-bbbbbb");
  EXPECT_EQ(results::newest_run(root, "nightly").filename(), "20260201T000000Z-cccccc");
  EXPECT_EQ(results::newest_run(root, "other"), "");
  EXPECT_EQ(results::find_run(root, "last").filename(), "20260301T000000Z-bbbbbb");
  EXPECT_EQ(results::find_run(root, "quick").filename(), "20260301T000000Z-bbbbbb");
  EXPECT_EQ(results::find_run(root, "20260201T000000Z-cccccc").filename(),
            "20260201T000000Z-cccccc");
  const fs::path path = root / "runs/quick/20260101T000000Z-aaaaaa";
  EXPECT_EQ(results::find_run(root, path.string()), path);
}

TEST(RunLookup, AnUnknownRunNamesWhatThereIs) {
  const TemporaryFolder temporary;
  EXPECT_EQ(input_error_of([&] { results::find_run(temporary.path(), "quick"); }),
            "no run \"quick\": " + (temporary.path() / "runs").string() +
                " holds no runs yet; make one with `discern run SUITE`");
  make_run(temporary.path(), "quick", "20260101T000000Z-aaaaaa");
  EXPECT_EQ(input_error_of([&] { results::find_run(temporary.path(), "quik"); }),
            "unknown run \"quik\"; did you mean \"quick\"? known: last, quick, "
            "20260101T000000Z-aaaaaa");
}

}  // namespace
