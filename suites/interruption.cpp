#include "suites/interruption.h"

namespace suites {

std::atomic<bool> interrupt_requested{false};

}  // namespace suites
