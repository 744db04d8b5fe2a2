// How often gates and comparisons blame a night in which nothing changed.
//
//   benchmark_false_alarms RUN [NIGHTS]      RUN: a run folder; NIGHTS: 200 unless given
//
// Each night draws the times of every row anew, with replacement, from the repetitions of the
// stored run, both for the night before and for the one after: whatever is called a change then is
// a false alarm. Scores stay as they are: the same seeds give the same pictures.

#include <cstdio>
#include <cstdlib>
#include <random>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "perception/base/document.h"
#include "perception/base/errors.h"
#include "results/comparison/comparison.h"
#include "results/gates/gate_check.h"
#include "results/result_store.h"
#include "results/run_summary.h"

namespace {

using results::comparison::Verdict;

results::Run drawn_night(const results::Run& run, const results::RunSummary& summary,
                         std::mt19937& random) {
  results::Run night = run;
  for (const results::SummaryRow& row : summary.rows) {
    if (row.records.empty()) continue;
    std::uniform_int_distribution<std::size_t> any(0, row.records.size() - 1);
    for (const std::size_t i : row.records) {
      const results::CellRecord& drawn = run.cells[row.records[any(random)]];
      results::CellRecord& record = night.cells[i];
      if (drawn.render.frame != record.render.frame) continue;
      record.canary_s = drawn.canary_s;
      record.render.total_s = drawn.render.total_s;
      record.render.prepare_s = drawn.render.prepare_s;
      record.render.render_s = drawn.render.render_s;
      record.render.stages = drawn.render.stages;
    }
  }
  return night;
}

std::vector<results::gates::Gate> gates_of(const results::Run& run) {
  const auto gates = run.info->find("gates");
  if (gates == run.info->end()) return {};
  return results::gates::read_gates(
      base::parse_document(gates->dump(), (run.folder / "run.json").string()));
}

void count_alarms(const results::Run& run, int nights) {
  const results::RunSummary summary = results::summarize(run);
  const std::vector<results::gates::Gate> gates = gates_of(run);
  std::mt19937 random(1);
  int gate_nights = 0;
  int worse_nights = 0;
  std::size_t gate_entries = 0;
  std::size_t changes = 0;
  std::size_t worse_or_better = 0;
  for (int i = 0; i < nights; ++i) {
    const results::Run before = drawn_night(run, summary, random);
    const results::Run after = drawn_night(run, summary, random);
    const results::RunValues earlier(before);
    const results::RunValues later(after);
    const auto report = check_gates(gates, &earlier, later, "");
    gate_entries += report.entries.size();
    if (report.count(results::gates::Outcome::failed) > 0) ++gate_nights;
    const auto comparison = results::comparison::compare(earlier, later, {});
    const std::size_t worse = comparison.count(Verdict::worse);
    changes += comparison.changes.size();
    worse_or_better += worse + comparison.count(Verdict::better);
    if (worse > 0) ++worse_nights;
  }
  const auto share = [nights](int count) { return 100.0 * count / nights; };
  fmt::print("{} nights of {} rows\n", nights, summary.rows.size());
  fmt::print("gates: {} entries a night; a gate failed in {:.1f} % of the nights\n",
             gate_entries / static_cast<std::size_t>(nights), share(gate_nights));
  fmt::print(
      "compare: {} quantities a night; \"worse\" in {:.1f} % of the nights, a change in "
      "{:.3f} % of the quantities\n",
      changes / static_cast<std::size_t>(nights), share(worse_nights),
      100.0 * static_cast<double>(worse_or_better) / static_cast<double>(changes));
}

}  // namespace

int main(int count, char** words) {
  if (count < 2) {
    fmt::print(stderr, "benchmark_false_alarms RUN [NIGHTS]\n");
    return 2;
  }
  try {
    count_alarms(results::load_run(words[1]), count > 2 ? std::atoi(words[2]) : 200);
  } catch (const base::InputError& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 2;
  }
  return 0;
}
