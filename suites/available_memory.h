#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "suites/machine_check.h"

namespace suites {

/// A line of /proc/meminfo, "MemAvailable:   123 kB", in bytes; nothing if it is not there.
std::optional<double> meminfo_bytes(const std::string& text, const std::string& key);

/// Bytes that this process can still take: of memory and swap that the machine has free, and of
/// what its control groups (version 2 or 1) and all above them leave, the least. Pages of files
/// that the kernel would give up count as free. Nothing where Linux does not tell.
std::optional<std::int64_t> available_memory_bytes(const MachineFiles& files = {});

/// Processes that the kernel has killed for lack of memory since it started (`oom_kill` of
/// /proc/vmstat); nothing where it does not tell.
std::optional<std::int64_t> out_of_memory_kills(const MachineFiles& files = {});

}  // namespace suites
