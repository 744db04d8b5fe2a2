#pragma once

#include <atomic>
#include <stdexcept>

namespace suites {

/// Thrown where work stops because of SIGINT; what was finished is kept.
struct Interrupted : std::runtime_error {
  Interrupted() : std::runtime_error("interrupted") {}
};

/// Set by the handler of SIGINT; the runner and the references stop at the next chance.
extern std::atomic<bool> interrupt_requested;

}  // namespace suites
