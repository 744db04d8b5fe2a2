#include "suites/peak_memory.h"

#include <fstream>
#include <string>

#include "perception/base/child_process.h"

namespace suites {

void reset_peak_memory() { std::ofstream("/proc/self/clear_refs") << "5"; }

std::int64_t peak_memory_bytes() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with("VmHWM:")) return std::int64_t{1024} * std::stoll(line.substr(6));
  }
  return base::peak_resident_bytes();
}

}  // namespace suites
