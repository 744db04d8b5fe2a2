#include "perception/base/available_memory.h"

#include <gtest/gtest.h>

#include "perception/base/atomic_file.h"
#include "tests/temporary_folder.h"

namespace base {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kMiB = std::int64_t{1} << 20;

/// A machine that is made of files: 1000 MiB available, 100 MiB of swap.
class AvailableMemory : public testing::Test {
 protected:
  AvailableMemory() {
    write("proc/meminfo",
          "MemTotal: 4096000 kB\nMemFree: 1 kB\nMemAvailable: 1024000 kB\nSwapTotal: 204800 kB\n"
          "SwapFree: 102400 kB\n");
  }
  void write(const std::string& path, const std::string& text) const {
    fs::create_directories((folder_.path() / path).parent_path());
    write_text_file(folder_.path() / path, text);
  }
  std::optional<std::int64_t> bytes() const { return available_memory_bytes(folder_.path()); }

  tests::TemporaryFolder folder_;
};

TEST_F(AvailableMemory, WithoutGroupsIsWhatTheMachineHas) { EXPECT_EQ(bytes(), 1100 * kMiB); }

TEST_F(AvailableMemory, IsLeastOfTheGroupAndThoseAboveIt) {
  write("proc/self/cgroup", "0::/jobs/night\n");
  const std::string group = "sys/fs/cgroup/jobs/night/";
  write(group + "memory.max", "max\n");
  write(group + "memory.current", "314572800\n");
  EXPECT_EQ(bytes(), 1100 * kMiB);
  write("sys/fs/cgroup/jobs/memory.max", "524288000\n");      // 500 MiB
  write("sys/fs/cgroup/jobs/memory.current", "419430400\n");  // 400 MiB
  EXPECT_EQ(bytes(), 100 * kMiB);
  // Pages of files and what slabs can do without are given up before anything is killed.
  write("sys/fs/cgroup/jobs/memory.stat",
        "anon 5\ninactive_file 52428800\nactive_file 31457280\nslab_reclaimable 10485760\n");
  EXPECT_EQ(bytes(), 190 * kMiB);
  // The machine has 100 MiB of swap; a group may have less of it.
  write("sys/fs/cgroup/jobs/memory.swap.current", "0\n");
  write("sys/fs/cgroup/jobs/memory.swap.max", "max\n");
  EXPECT_EQ(bytes(), 290 * kMiB);
  write("sys/fs/cgroup/jobs/memory.swap.max", "20971520\n");
  EXPECT_EQ(bytes(), 210 * kMiB);
  write(group + "memory.max", "314572800\n");
  EXPECT_EQ(bytes(), 0);
}

TEST_F(AvailableMemory, KnowsTheFirstVersionOfGroupsToo) {
  write("proc/self/cgroup", "5:cpuset:/x\n4:memory:/jobs\n0::/\n");
  write("sys/fs/cgroup/memory/memory.limit_in_bytes", "9223372036854771712\n");
  write("sys/fs/cgroup/memory/memory.usage_in_bytes", "419430400\n");
  EXPECT_EQ(bytes(), 1100 * kMiB);
  write("sys/fs/cgroup/memory/jobs/memory.limit_in_bytes", "524288000\n");
  write("sys/fs/cgroup/memory/jobs/memory.usage_in_bytes", "419430400\n");
  write("sys/fs/cgroup/memory/jobs/memory.stat", "inactive_file 1\ntotal_inactive_file 10485760\n");
  EXPECT_EQ(bytes(), 110 * kMiB);
}

TEST_F(AvailableMemory, IsNotKnownWithoutFiles) {
  const tests::TemporaryFolder empty;
  EXPECT_FALSE(available_memory_bytes(empty.path()).has_value());
  EXPECT_FALSE(out_of_memory_kills(empty.path()).has_value());
}

TEST_F(AvailableMemory, OfThisMachineIsMoreThanThisTestHas) {
  const auto here = available_memory_bytes();
  ASSERT_TRUE(here.has_value());
  EXPECT_GT(*here, 8 * kMiB);
}

TEST_F(AvailableMemory, KillsAreCounted) {
  write("proc/vmstat", "nr_free_pages 99\noom_kill 3\n");
  EXPECT_EQ(out_of_memory_kills(folder_.path()), 3);
}

}  // namespace
}  // namespace base
