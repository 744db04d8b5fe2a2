#include "perception/base/available_memory.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <sstream>

namespace base {

namespace fs = std::filesystem;

namespace {

/// What differs between the versions of control groups: cgroups(7).
struct GroupFiles {
  const char* controllers;  ///< second field of the group's line in /proc/self/cgroup
  const char* mount;
  const char* limit;
  const char* usage;
  /// Keys of memory.stat: what the kernel gives up before it kills.
  std::array<const char*, 3> reclaimable;
};
constexpr GroupFiles kVersion2{"",
                               "sys/fs/cgroup",
                               "memory.max",
                               "memory.current",
                               {"inactive_file", "active_file", "slab_reclaimable"}};
// Version 1 has no count of what slabs could give up.
constexpr GroupFiles kVersion1{"memory",
                               "sys/fs/cgroup/memory",
                               "memory.limit_in_bytes",
                               "memory.usage_in_bytes",
                               {"total_inactive_file", "total_active_file", "slab_reclaimable"}};

/// A file of /proc or /sys; nothing if it is not there.
std::optional<std::string> text_of(const fs::path& path) {
  std::ifstream file(path);
  if (!file) return std::nullopt;
  return std::string{std::istreambuf_iterator<char>(file), {}};
}

/// The number of a file that holds one; nothing for "max".
std::optional<double> number_of(const fs::path& path) {
  const auto text = text_of(path);
  if (!text) return std::nullopt;
  char* end = nullptr;
  const double number = std::strtod(text->c_str(), &end);
  return end == text->c_str() ? std::nullopt : std::optional(number);
}

/// The value of "key value" in a file of such lines.
std::optional<double> value_of(const fs::path& path, const std::string& key) {
  std::istringstream lines(text_of(path).value_or(""));
  std::string name;
  double value = 0.0;
  while (lines >> name >> value) {
    if (name == key) return value;
  }
  return std::nullopt;
}

/// Where the process is in the tree of groups, "/user.slice"; nothing without such a tree.
std::optional<std::string> group_of(const fs::path& root, const GroupFiles& version) {
  std::istringstream lines(text_of(root / "proc/self/cgroup").value_or(""));
  for (std::string line; std::getline(lines, line);) {
    const std::size_t first = line.find(':');
    const std::size_t second = line.find(':', first + 1);
    if (second == std::string::npos) continue;
    if (line.substr(first + 1, second - first - 1) == version.controllers) {
      return line.substr(second + 1);
    }
  }
  return std::nullopt;
}

/// Swap that a group leaves of what is free; groups of version 1 are taken to have none.
double swap_left(const fs::path& folder, double free_bytes) {
  const auto used = number_of(folder / "memory.swap.current");
  if (!used) return 0.0;
  const auto limit = number_of(folder / "memory.swap.max");
  return limit ? std::clamp(*limit - *used, 0.0, free_bytes) : free_bytes;
}

/// Lowers `bytes` to what the process's group and those above it leave.
/// @param swap_bytes  free on the machine
void limit_by_groups(const fs::path& root, const GroupFiles& version, double swap_bytes,
                     std::optional<double>& bytes) {
  const auto group = group_of(root, version);
  if (!group) return;
  // Inside a container the group may be named as it is outside: its own folder is the mount then.
  for (fs::path name = fs::path(*group).relative_path();; name = name.parent_path()) {
    const fs::path folder = root / version.mount / name;
    const auto limit = number_of(folder / version.limit);
    const auto usage = number_of(folder / version.usage);
    if (limit && usage) {
      double left = *limit - *usage;
      for (const char* key : version.reclaimable) {
        left += value_of(folder / "memory.stat", key).value_or(0.0);
      }
      left = std::clamp(left, 0.0, *limit) + swap_left(folder, swap_bytes);
      bytes = std::min(bytes.value_or(left), left);
    }
    if (name.empty()) return;
  }
}

}  // namespace

std::optional<double> meminfo_bytes(const std::string& text, const std::string& key) {
  const std::size_t found = text.find(key + ":");
  if (found == std::string::npos) return std::nullopt;
  return 1024.0 * std::strtod(text.c_str() + found + key.size() + 1, nullptr);
}

std::optional<std::int64_t> available_memory_bytes(const fs::path& root) {
  const std::string meminfo = text_of(root / "proc/meminfo").value_or("");
  std::optional<double> bytes = meminfo_bytes(meminfo, "MemAvailable");
  const double swap_bytes = meminfo_bytes(meminfo, "SwapFree").value_or(0.0);
  if (bytes) *bytes += swap_bytes;
  limit_by_groups(root, kVersion2, swap_bytes, bytes);
  limit_by_groups(root, kVersion1, swap_bytes, bytes);
  if (!bytes) return std::nullopt;
  return static_cast<std::int64_t>(*bytes);
}

std::optional<std::int64_t> out_of_memory_kills(const fs::path& root) {
  const auto kills = value_of(root / "proc/vmstat", "oom_kill");
  if (!kills) return std::nullopt;
  return static_cast<std::int64_t>(*kills);
}

}  // namespace base
