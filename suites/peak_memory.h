#pragma once

#include <cstdint>

namespace suites {

/// Lets the kernel count this process's peak memory anew, so that a repetition reports its own.
/// Where /proc refuses, the peak of the process so far is reported.
void reset_peak_memory();

/// VmHWM of /proc/self/status, bytes: the peak since the last reset.
std::int64_t peak_memory_bytes();

}  // namespace suites
