#pragma once

#include <cstdint>
#include <vector>

namespace suites {

/// What a fixed piece of work took, and what came out of it.
struct CanaryResult {
  double wall_s = 0.0;
  std::uint64_t checksum = 0;  ///< the same on every machine, with any number of threads
};

/// The same work before every repetition: half arithmetic in registers, half reads scattered over a
/// table of 8 MiB, on all cores; about 10 ms. Its time tells a machine that is slower than it was
/// (other work, a lower clock) from a renderer that is.
class Canary {
 public:
  Canary();  ///< fills the table and runs once, so that no run pays for pages and threads
  CanaryResult run() const;

 private:
  std::vector<std::uint32_t> table_;
};

}  // namespace suites
