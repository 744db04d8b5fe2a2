#include <algorithm>
#include <ostream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "perception/base/child_process.h"
#include "perception/base/errors.h"
#include "results/gates/gate_check.h"
#include "results/result_store.h"
#include "results/run_record.h"
#include "suites/bisection.h"
#include "suites/command_line/exit_codes.h"
#include "suites/command_line/gate_verdicts.h"
#include "suites/command_line/suite_selection.h"
#include "suites/command_line/verbs.h"
#include "suites/revision_builds.h"

namespace suites::command_line {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using results::gates::Gate;
using results::gates::GateReport;
using results::gates::Outcome;

constexpr std::chrono::duration<double> kRunTimeout{24.0 * 3600.0};
constexpr double kWorseBy = 0.05;

/// What became of one revision.
struct Tried {
  std::size_t index = 0;
  Trial trial = Trial::unknown;
  std::string reason;
  std::optional<results::Run> run;
  GateReport gates;
};

std::string to_string(Trial trial) {
  switch (trial) {
    case Trial::good:
      return "good";
    case Trial::bad:
      return "bad";
    case Trial::unknown:
      break;
  }
  return "unknown";
}

Gate gate_of(const BisectArguments& arguments) {
  Gate gate;
  gate.quantity = arguments.quantity;
  gate.is_score = arguments.quantity.find('@') != std::string::npos;
  gate.worse_by = arguments.worse_by.value_or(kWorseBy);
  gate.text = fmt::format("{} worse by {:g} %", gate.quantity, 100.0 * *gate.worse_by);
  return gate;
}

/// The last line of what a program said.
std::string last_line(const std::string& text) {
  const std::size_t end = text.find_last_not_of('\n');
  if (end == std::string::npos) return "it said nothing";
  const std::size_t begin = text.rfind('\n', end);
  return text.substr(begin == std::string::npos ? 0 : begin + 1, end - begin);
}

/// Runs the suite at revisions and sets each run against that of the first one.
class Trials {
 public:
  Trials(const BisectArguments& arguments, std::vector<Revision> revisions, const fs::path& source,
         const fs::path& root, Console& console)
      : arguments_(arguments),
        revisions_(std::move(revisions)),
        suite_file_(fs::absolute(find_suite(arguments.suite)).string()),
        root_(root / "bisect"),
        builds_(source, root_, arguments.build),
        console_(console) {
    // References are named by content: the same ones serve every revision.
    fs::create_directories(root / "references");
    std::error_code error;
    if (!fs::exists(root_ / "references", error)) {
      fs::create_directory_symlink(fs::absolute(root / "references"), root_ / "references");
    }
  }

  const std::vector<Revision>& revisions() const { return revisions_; }
  const std::vector<Tried>& tried() const { return tried_; }

  /// @throws base::InputError if the first revision, which all are set against, has no run
  void measure_first() {
    Tried first{0, Trial::good, "all others are set against it", measured(0), {}};
    if (!arguments_.quantity.empty()) {
      results::RunValues(*first.run).check_quantity(arguments_.quantity, {});
    }
    tried_.push_back(std::move(first));
  }

  const Tried& measure(std::size_t index) {
    Tried tried{index, Trial::unknown, "", {}, {}};
    try {
      tried.run = measured(index);
      judge(tried);
    } catch (const base::InputError& error) {
      tried.reason = error.what();
    }
    tried_.push_back(std::move(tried));
    return tried_.back();
  }

 private:
  results::Run measured(std::size_t index) {
    const Revision& revision = revisions_[index];
    print_note(console_,
               fmt::format("trying {} \"{}\"", revision.commit.substr(0, 10), revision.subject));
    const fs::path program = builds_.build(revision);
    std::vector<std::string> command{program.string(), "run",     suite_file_, "--results",
                                     root_.string(),   "--force", "--json"};
    if (!arguments_.profile.empty()) {
      command.insert(command.end(), {"--profile", arguments_.profile});
    }
    if (!arguments_.filter.empty()) command.insert(command.end(), {"--filter", arguments_.filter});
    const base::CommandResult result = base::run_command(command, kRunTimeout);
    const Json json = Json::parse(result.stdout_text, nullptr, false);
    const std::string run = json.is_object() ? json.value("run", "") : "";
    if (run.empty()) {
      throw base::InputError(
          fmt::format("the run ended with {}: {}", result.exit.text(),
                      last_line(json.is_object() ? json.value("reason", "") : result.stderr_text)));
    }
    return results::load_run(run);
  }

  void judge(Tried& tried) const {
    const results::Run& first = *tried_.front().run;
    tried.gates = arguments_.quantity.empty()
                      ? gates_against(first, *tried.run)
                      : gates_against(first, *tried.run, {gate_of(arguments_)});
    switch (tried.gates.overall()) {
      case Outcome::failed:
        tried.trial = Trial::bad;
        tried.reason = "worse";
        return;
      case Outcome::passed:
        tried.trial = Trial::good;
        tried.reason = "not worse";
        return;
      case Outcome::inconclusive:
        tried.reason = "within noise: more repetitions or seeds would tell";
        return;
      case Outcome::not_measured:
        tried.reason = "what is asked was not measured";
        return;
    }
  }

  const BisectArguments& arguments_;
  std::vector<Revision> revisions_;
  std::string suite_file_;
  fs::path root_;
  RevisionBuilds builds_;
  Console& console_;
  std::vector<Tried> tried_;
};

Json to_json(const Revision& revision) {
  return {{"commit", revision.commit}, {"subject", revision.subject}};
}

/// What the search came to; `found` is empty where the last revision is not worse.
struct Findings {
  std::optional<Bisection> found;
  const Trials& trials;

  std::string outcome() const {
    if (!found) return "not_worse";
    return found->is_exact() ? "found" : "narrowed";
  }
  /// What may be the first bad revision, in order.
  std::vector<Revision> candidates() const {
    std::vector<Revision> list;
    if (!found) return list;
    for (std::size_t i : found->unknown_between) list.push_back(trials.revisions()[i]);
    list.push_back(trials.revisions()[found->first_bad]);
    return list;
  }
  /// Of the first revision that was seen to be bad.
  const GateReport* gates() const {
    if (!found) return nullptr;
    const auto bad = std::ranges::find_if(
        trials.tried(), [&](const Tried& tried) { return tried.index == found->first_bad; });
    return &bad->gates;
  }
};

Json to_json(const Findings& findings, const BisectArguments& arguments) {
  Json trials = Json::array();
  for (const Tried& tried : findings.trials.tried()) {
    Json entry = to_json(findings.trials.revisions()[tried.index]);
    entry["verdict"] = to_string(tried.trial);
    entry["reason"] = tried.reason;
    entry["run"] = tried.run ? Json(tried.run->folder.string()) : Json();
    trials.push_back(std::move(entry));
  }
  Json candidates = Json::array();
  for (const Revision& revision : findings.candidates()) candidates.push_back(to_json(revision));
  const GateReport* gates = findings.gates();
  return {{"schema", results::kSchemaVersion},
          {"status", "ok"},
          {"suite", arguments.suite},
          {"outcome", findings.outcome()},
          {"candidates", std::move(candidates)},
          {"trials", std::move(trials)},
          {"gates", gates == nullptr ? Json() : results::gates::to_json(*gates)}};
}

void print_text(const Findings& findings, Console& console) {
  results::Table table{{{"verdict"}, {"commit"}, {"subject"}, {"reason"}}, {}, {}};
  std::vector<const Tried*> by_age;
  for (const Tried& tried : findings.trials.tried()) by_age.push_back(&tried);
  std::ranges::sort(by_age, {}, &Tried::index);
  for (const Tried* tried : by_age) {
    const Revision& revision = findings.trials.revisions()[tried->index];
    table.rows.push_back({{{to_string(tried->trial)},
                           {revision.commit.substr(0, 10)},
                           {revision.subject},
                           {tried->reason}}});
  }
  console.out << results::to_text(table) << '\n';
  if (const GateReport* gates = findings.gates()) {
    console.out << results::to_text(gate_table(*gates, false)) << '\n';
  }
  const std::vector<Revision> candidates = findings.candidates();
  if (candidates.empty()) {
    console.out << "the later revision is not worse than the earlier one\n";
    return;
  }
  console.out << (candidates.size() == 1 ? "worse from here on:\n"
                                         : "worse from one of these on:\n");
  for (const Revision& revision : candidates) {
    console.out << "  " << revision.commit << ' ' << revision.subject << '\n';
  }
}

}  // namespace

int run_bisect(const BisectArguments& arguments, Console& console) {
  SuiteSelection selection;
  selection.suite = arguments.suite;
  selection.profile = arguments.profile;
  const Suite suite = select_suite(selection);
  if (suite.gates.empty() && arguments.quantity.empty()) {
    throw base::InputError({suite.file.string()},
                           "the suite has no gates to judge by; name one with --quantity");
  }
  const fs::path source = arguments.source.empty() ? source_folder() : fs::path(arguments.source);
  Trials trials(arguments, revisions_between(source, arguments.good, arguments.bad), source,
                results::results_root(arguments.results), console);
  trials.measure_first();
  Findings findings{{}, trials};
  const std::size_t last = trials.revisions().size() - 1;
  if (trials.measure(last).trial == Trial::bad) {
    findings.found = bisect(last + 1, [&](std::size_t i) { return trials.measure(i).trial; });
  }
  if (arguments.json) {
    print_json(console, to_json(findings, arguments));
  } else {
    print_text(findings, console);
  }
  return findings.outcome() == "found" ? kAsExpected : kInconclusive;
}

}  // namespace suites::command_line
