#pragma once

#include <string>

#include "results/gates/gate_check.h"

namespace results::html_report {

/// Every gate and row with its outcome, the numbers and the reason; "" for a run without gates.
std::string gates_section(const gates::GateReport& report);

/// An outcome with its sign and colour. @param text  what it says, not yet escaped
std::string outcome_chip(gates::Outcome outcome, const std::string& text);

}  // namespace results::html_report
