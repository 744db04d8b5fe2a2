#include "results/run_files.h"

#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <vector>

#include "perception/base/atomic_file.h"
#include "tests/expect_input_error.h"
#include "tests/temporary_folder.h"

namespace test_results {
namespace {

std::vector<std::string> cell_names(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  results::read_cell_names(folder, [&](const std::string& name) { names.push_back(name); });
  return names;
}

TEST(RunFiles, CellNamesAreThoseOfTheRecordsThemselves) {
  const tests::TemporaryFolder folder;
  EXPECT_TRUE(cell_names(folder.path()).empty()) << "nothing was measured yet";
  base::write_text_file(folder.path() / "cells.jsonl",
                        R"({"schema":1,"run":"r","cell":"a","rest":[1,2]})"
                        "\n"
                        R"({"inner":{"cell":"not this"},"list":[{"cell":"nor this"}],"cell":"b"})"
                        "\n\n"
                        R"({"inner":{"cell":"not this"}})"
                        "\n"
                        R"({"schema":1,"ce)");
  EXPECT_EQ(cell_names(folder.path()), (std::vector<std::string>{"a", "b"}));
}

TEST(RunFiles, LinesAreAppendedWholeWhateverEndedThem) {
  const tests::TemporaryFolder folder;
  const std::filesystem::path all = folder.path() / "all.jsonl";
  base::write_text_file(folder.path() / "one.jsonl", "1\n2");
  base::write_text_file(folder.path() / "two.jsonl", "3\n");
  for (const char* name : {"one.jsonl", "missing.jsonl", "two.jsonl"}) {
    results::append_file(folder.path() / name, all);
  }
  EXPECT_EQ(base::read_text_file(all), "1\n2\n3\n");
}

/// What cannot be read is told: a merge would lose it without a word.
TEST(RunFiles, WhatCannotBeReadIsAnError) {
  const tests::TemporaryFolder folder;
  std::filesystem::create_directory(folder.path() / "cells.jsonl");
  const std::string path = (folder.path() / "cells.jsonl").string();
  EXPECT_EQ(tests::input_error_of([&] { cell_names(folder.path()); }),
            path + ": cannot read: Is a directory");
  EXPECT_EQ(tests::input_error_of([&] {
              results::append_file(folder.path() / "cells.jsonl", folder.path() / "all.jsonl");
            }),
            path + ": cannot read: Is a directory");
}

TEST(RunFiles, ReferencesAreBesideTheRuns) {
  const tests::TemporaryFolder folder;
  const std::filesystem::path run = folder.path() / "runs/suite/run";
  std::filesystem::create_directories(run);
  EXPECT_EQ(std::filesystem::weakly_canonical(results::reference_file(run, "ab12")),
            std::filesystem::weakly_canonical(folder.path() / "references/ab12/reference.exr"));
}

}  // namespace
}  // namespace test_results
