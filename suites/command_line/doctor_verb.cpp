#include <algorithm>
#include <ostream>

#include <nlohmann/json.hpp>

#include "perception/base/child_process.h"
#include "results/result_store.h"
#include "results/run_record.h"
#include "results/tables.h"
#include "suites/command_line/device_probe.h"
#include "suites/command_line/exit_codes.h"
#include "suites/command_line/verbs.h"
#include "suites/machine_check.h"

namespace suites::command_line {

namespace {

using State = MachineFinding::State;

/// Every graphics platform is tried out in a process of its own; one that works is enough.
MachineFinding check_devices() {
  std::string found;
  std::string reasons;
  for (const std::string& platform : known_devices()) {
    if (platform == "auto") continue;
    const nlohmann::ordered_json device =
        probed_device(platform, base::this_program(), kProbeTimeLimit);
    if (!device.at("reason").is_null()) {
      reasons +=
          (reasons.empty() ? "" : "; ") + platform + ": " + device.at("reason").get<std::string>();
      continue;
    }
    found +=
        (found.empty() ? "" : "; ") + platform + ": " + device.at("renderer").get<std::string>();
  }
  if (!found.empty()) return {"OpenGL", State::good, found, ""};
  return {"OpenGL", State::warning, "none (" + reasons + ")",
          "install libgl1-mesa-dri and libosmesa6; without it OpenGL renderers are unsupported"};
}

std::vector<MachineFinding> all_findings(const DoctorArguments& arguments) {
  std::vector<MachineFinding> findings = check_machine({});
  findings.push_back(check_steadiness());
  findings.push_back(check_devices());
  findings.push_back(check_results_folder(results::results_root(arguments.results)));
  return findings;
}

results::Table table_of(const std::vector<MachineFinding>& findings) {
  results::Table table;
  for (const char* title : {"what", "state", "found", "cure"}) {
    table.columns.push_back({title, "", results::Direction::none, false});
  }
  for (const MachineFinding& one : findings) {
    std::vector<results::TableCell>& row = table.rows.emplace_back();
    for (const std::string& text : {one.name, to_string(one.state), one.found, one.cure}) {
      row.push_back({text, std::nullopt, false, ""});
    }
  }
  return table;
}

bool has(const std::vector<MachineFinding>& findings, State state) {
  return std::ranges::any_of(findings,
                             [state](const MachineFinding& one) { return one.state == state; });
}

}  // namespace

int run_doctor(const DoctorArguments& arguments, Console& console) {
  const std::vector<MachineFinding> findings = all_findings(arguments);
  if (arguments.json) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const MachineFinding& one : findings) {
      list.push_back({{"name", one.name},
                      {"state", to_string(one.state)},
                      {"found", one.found},
                      {"cure", one.cure}});
    }
    print_json(console, {{"schema", results::kSchemaVersion},
                         {"status", has(findings, State::problem) ? "failed" : "ok"},
                         {"findings", std::move(list)}});
  } else {
    console.out << results::to_text(table_of(findings));
  }
  const bool is_noisy = arguments.strict && has(findings, State::warning);
  return most_important({has(findings, State::problem) ? kNothingMeasured : kAsExpected,
                         is_noisy ? kInconclusive : kAsExpected});
}

}  // namespace suites::command_line
