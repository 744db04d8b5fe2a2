#pragma once

#include <string>

#include "results/gates/gate_check.h"
#include "results/run_values.h"

namespace results::gates {

/// A run as JUnit XML, as Jenkins and GitLab read it: a test case per row, an `error` where it
/// failed, `skipped` where it is unsupported or not there yet, its scores as properties; and one
/// per gate and row, a `failure` where the gate failed, `skipped` where it could not be judged.
/// Characters that XML 1.0 does not allow become U+FFFD.
/// Source: the schema of Jenkins' xUnit plugin (recalled; there is no standard).
std::string junit_xml(const RunValues& run, const GateReport& gates);

}  // namespace results::gates
