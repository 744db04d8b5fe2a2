#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace base {

/// A line of /proc/meminfo, "MemAvailable:   123 kB", in bytes; nothing if it is not there.
std::optional<double> meminfo_bytes(const std::string& text, const std::string& key);

/// Bytes that this process can still take: of memory and swap that the machine has free, and of
/// what its control groups (version 2 or 1) and all above them leave, the least. Pages of files
/// that the kernel would give up count as free. Nothing where Linux does not tell.
/// @param root  where the files lie that Linux tells of a machine; another folder in tests
std::optional<std::int64_t> available_memory_bytes(const std::filesystem::path& root = "/");

/// Processes that the kernel has killed for lack of memory since it started (`oom_kill` of
/// /proc/vmstat); nothing where it does not tell.
std::optional<std::int64_t> out_of_memory_kills(const std::filesystem::path& root = "/");

}  // namespace base
