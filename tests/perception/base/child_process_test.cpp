#include "perception/base/child_process.h"

#include <signal.h>

#include <gtest/gtest.h>

#include "perception/base/atomic_file.h"
#include "perception/base/errors.h"
#include "tests/temporary_folder.h"

namespace base {
namespace {

using std::chrono::duration;

ChildProcess::Options shell(const std::string& script) {
  ChildProcess::Options options;
  options.arguments = {"sh", "-c", script};
  options.with_channel = true;
  return options;
}

TEST(RunCommand, CollectsOutputAndCode) {
  const CommandResult result =
      run_command({"sh", "-c", "echo out; echo err >&2; exit 3"}, duration<double>(10.0));
  EXPECT_EQ(result.exit.code, 3);
  EXPECT_FALSE(result.timed_out);
  EXPECT_EQ(result.stdout_text, "out\n");
  EXPECT_EQ(result.stderr_text, "err\n");
}

TEST(RunCommand, KillsTheWholeGroupOnTimeout) {
  const tests::TemporaryFolder folder;
  const auto mark = folder.path() / "grandchild";
  const CommandResult result = run_command(
      {"sh", "-c", "(sleep 1; touch " + mark.string() + ") & sleep 30"}, duration<double>(0.1));
  EXPECT_TRUE(result.timed_out);
  EXPECT_NE(result.exit.signal, 0);
  run_command({"sleep", "1.2"}, duration<double>(5.0));
  EXPECT_FALSE(std::filesystem::exists(mark));
}

TEST(RunCommand, PassesTheEnvironment) {
  const CommandResult result = run_command({"sh", "-c", "printf %s \"$DISCERN_X\""},
                                           duration<double>(10.0), {{"DISCERN_X", "a b"}});
  EXPECT_EQ(result.stdout_text, "a b");
  EXPECT_THROW(run_command({"no-such-program-anywhere"}, duration<double>(1.0)), DeviceError);
}

TEST(ChildProcess, TalksLineByLine) {
  ChildProcess child(shell("while read line <&3; do echo \"got $line\" >&3; done"));
  std::string line;
  ASSERT_TRUE(child.send_line("one"));
  ASSERT_TRUE(child.send_line("two"));
  ASSERT_EQ(child.receive_line(line, duration<double>(10.0)), ChildProcess::Wait::line);
  EXPECT_EQ(line, "got one");
  ASSERT_EQ(child.receive_line(line, duration<double>(10.0)), ChildProcess::Wait::line);
  EXPECT_EQ(line, "got two");
  EXPECT_EQ(child.receive_line(line, duration<double>(0.1)), ChildProcess::Wait::timeout);
  EXPECT_EQ(child.receive_line(line, duration<double>(9.0), [] { return false; }),
            ChildProcess::Wait::interrupted);
  EXPECT_GT(child.resident_bytes(), 0);
}

TEST(ChildProcess, TellsHowItEnded) {
  ChildProcess crash(shell("kill -SEGV $$"));
  std::string line;
  EXPECT_EQ(crash.receive_line(line, duration<double>(10.0)), ChildProcess::Wait::closed);
  EXPECT_EQ(crash.wait().text(), "signal 11 (Segmentation fault)");
  EXPECT_FALSE(crash.send_line("anyone?"));

  ChildProcess stubborn(shell("trap '' TERM; echo ready >&3; while :; do sleep 0.05; done"));
  ASSERT_EQ(stubborn.receive_line(line, duration<double>(10.0)), ChildProcess::Wait::line);
  EXPECT_EQ(stubborn.stop(duration<double>(0.2)).signal, SIGKILL);

  ChildProcess polite(shell("trap 'exit 5' TERM; echo ready >&3; while :; do sleep 0.05; done"));
  ASSERT_EQ(polite.receive_line(line, duration<double>(10.0)), ChildProcess::Wait::line);
  EXPECT_EQ(polite.stop(duration<double>(10.0)).text(), "exit code 5");
}

}  // namespace
}  // namespace base
