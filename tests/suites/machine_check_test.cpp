#include "suites/machine_check.h"

#include <algorithm>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "perception/base/atomic_file.h"

namespace suites {
namespace {

namespace fs = std::filesystem;
using State = MachineFinding::State;

/// A machine that is made of files.
class MachineCheck : public testing::Test {
 protected:
  MachineCheck()
      : root_(fs::path(testing::TempDir()) /
              (std::string("discern-machine-") +
               testing::UnitTest::GetInstance()->current_test_info()->name())) {
    fs::remove_all(root_);
  }
  ~MachineCheck() override { fs::remove_all(root_); }

  void write(const std::string& path, const std::string& text) const {
    fs::create_directories((root_ / path).parent_path());
    base::write_text_file(root_ / path, text);
  }
  MachineFinding finding(const std::string& name) const {
    for (const MachineFinding& one : check_machine({root_})) {
      if (one.name == name) return one;
    }
    ADD_FAILURE() << name;
    return {};
  }
  const fs::path root_;
};

TEST_F(MachineCheck, TellsWhatDisturbsTimesAndWhatCuresIt) {
  write("sys/devices/system/cpu/cpu0/cpufreq/scaling_governor", "powersave\n");
  write("sys/devices/system/cpu/intel_pstate/no_turbo", "0\n");
  write("sys/devices/system/clocksource/clocksource0/current_clocksource", "hpet\n");
  write("proc/loadavg", "7.50 3.00 1.00 2/300 4242\n");
  write("sys/fs/cgroup/cpu.max", "50000 100000\n");
  write("proc/meminfo",
        "MemTotal: 8000000 kB\nMemAvailable: 1000000 kB\nSwapTotal: 2000000 kB\n"
        "SwapFree: 1000000 kB\n");
  for (const char* name :
       {"governor", "turbo", "clock source", "load", "cores", "memory", "swap"}) {
    const MachineFinding one = finding(name);
    EXPECT_EQ(one.state, State::warning) << name;
    EXPECT_NE(one.cure, "") << name;
  }
  EXPECT_EQ(finding("governor").found, "powersave");
  EXPECT_NE(finding("cores").found.find("0.5 of"), std::string::npos);
}

TEST_F(MachineCheck, AGoodMachineIsGood) {
  write("sys/devices/system/cpu/cpu0/cpufreq/scaling_governor", "performance\n");
  write("sys/devices/system/cpu/cpufreq/boost", "0\n");
  write("sys/devices/system/clocksource/clocksource0/current_clocksource", "tsc\n");
  write("proc/loadavg", "0.00 0.00 0.00 1/300 4242\n");
  write("proc/stat", "cpu  100 0 100 1000 0 0 0 0 0 0\ncpu0 1 2 3\n");
  write("sys/fs/cgroup/cpu.max", "max 100000\n");
  write("proc/meminfo", "MemAvailable: 8000000 kB\nSwapTotal: 0 kB\nSwapFree: 0 kB\n");
  for (const MachineFinding& one : check_machine({root_})) {
    EXPECT_EQ(one.state, State::good) << one.name << ": " << one.found;
    EXPECT_EQ(one.cure, "");
  }
}

/// What a virtual machine hides is neither good nor bad.
TEST_F(MachineCheck, WhatCannotBeSeenIsUnknown) {
  fs::create_directories(root_);
  for (const char* name : {"governor", "turbo", "clock source", "load", "steal", "memory"}) {
    EXPECT_EQ(finding(name).state, State::unknown) << name;
  }
}

TEST_F(MachineCheck, AResultsFolderMustBeWritable) {
  EXPECT_NE(check_results_folder(root_ / "results").state, State::problem);
  write("file", "not a folder");
  const MachineFinding bad = check_results_folder(root_ / "file" / "results");
  EXPECT_EQ(bad.state, State::problem);
  EXPECT_NE(bad.cure.find("--results DIR"), std::string::npos);
}

TEST_F(MachineCheck, MeasuresHowSteadyTimesAre) {
  const MachineFinding one = check_steadiness();
  EXPECT_NE(one.found.find("spread by ±"), std::string::npos);
}

}  // namespace
}  // namespace suites
