#include <signal.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>
#include <thread>

#include "tests/places.h"
#include "tests/suites/command_line/program_test.h"

namespace tests {
namespace {

class Interrupt : public ProgramTest {
 protected:
  static constexpr int kMostWaits = 600;  ///< of a tenth of a second

  /// Starts the program, sends SIGINT after two seconds and once `is_at_work` says so, and waits.
  base::ExitState interrupted(
      const std::vector<std::string>& words,
      const std::function<bool()>& is_at_work = [] { return true; }) const {
    base::ChildProcess::Options options;
    options.arguments = {tests::kProgram};
    options.arguments.insert(options.arguments.end(), words.begin(), words.end());
    options.stdout_file = path("stdout.txt");
    options.stderr_file = path("stderr.txt");
    options.environment = environment();
    base::ChildProcess child(options);
    std::this_thread::sleep_for(std::chrono::seconds(2));
    for (int i = 0; i < kMostWaits && !is_at_work(); ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
    kill(child.pid(), SIGINT);
    return child.wait();
  }

  /// Whether a run has stored a repetition.
  bool has_record() const {
    // Files come and go while this looks.
    std::error_code error;
    std::filesystem::recursive_directory_iterator entry(folder(), error);
    for (; !error && entry != std::filesystem::end(entry); entry.increment(error)) {
      const bool is_records = entry->path().filename() == "cells.jsonl";
      if (is_records && entry->file_size(error) > 0 && !error) return true;
    }
    return false;
  }

  std::string text_of(const std::string& name) const {
    std::ostringstream text;
    text << std::ifstream(path(name)).rdbuf();
    return text.str();
  }

  std::size_t files_left() const {
    std::size_t count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder())) {
      if (entry.path().extension() != ".txt") ++count;
    }
    return count;
  }
};

TEST_F(Interrupt, ARenderEndsAtOnceAndLeavesNothing) {
  const base::ExitState exit =
      interrupted({"render", "--scene", "cornell-box", "--renderer", "path", "--size", "64x64",
                   "--samples", "100000000", "--out", path("a.exr")});
  EXPECT_EQ(exit.code, 130);
  EXPECT_EQ(exit.signal, 0);
  EXPECT_EQ(files_left(), 0U);
}

TEST_F(Interrupt, ARenderAnswersWithJsonWhereItIsAskedFor) {
  const base::ExitState exit =
      interrupted({"render", "--scene", "cornell-box", "--renderer", "path", "--size", "64x64",
                   "--samples", "100000000", "--out", path("a.exr"), "--json"});
  EXPECT_EQ(exit.code, 130);
  EXPECT_EQ(schema_problems("error", text_of("stdout.txt")), "") << text_of("stdout.txt");
  EXPECT_EQ(nlohmann::json::parse(text_of("stdout.txt"))["status"], "interrupted");
}

TEST_F(Interrupt, ARunKeepsWhatIsFinishedAndSaysSo) {
  const base::ExitState exit = interrupted(
      {"run", "--scene", "cornell-box", "--method", "blank", "--method", "path,samples=100000000",
       "--size", "32x32", "--reference-samples", "1", "--json"},
      [&] { return has_record(); });
  EXPECT_EQ(exit.code, 130);
  EXPECT_EQ(schema_problems("run", text_of("stdout.txt")), "") << text_of("stdout.txt");
  const auto json = nlohmann::json::parse(text_of("stdout.txt"));
  EXPECT_EQ(json["status"], "interrupted");
  EXPECT_EQ(json["interrupted"], true);
  EXPECT_EQ(json["finished_repetitions"], 1);
  EXPECT_TRUE(std::filesystem::exists(json["report"].get<std::string>()));
}

TEST_F(Interrupt, AReferenceCanBeStopped) {
  const base::ExitState exit = interrupted({"ref", "build", "--scene", "cornell-box", "--size",
                                            "32x32", "--samples", "100000000", "--json"});
  EXPECT_EQ(exit.code, 130);
  EXPECT_EQ(schema_problems("error", text_of("stdout.txt")), "") << text_of("stdout.txt");
}

}  // namespace
}  // namespace tests
