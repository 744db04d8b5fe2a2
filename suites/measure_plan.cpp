#include "suites/measure_plan.h"

#include <algorithm>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "perception/base/names.h"
#include "perception/base/units.h"

namespace suites {
namespace {

/// Largest number of seeds and repetitions: more is a slip of the pen.
constexpr std::int64_t kMostRepetitions = 100000;

int bounded(const base::Node& node, const char* what, std::int64_t low, std::int64_t high) {
  const std::int64_t value = node.integer(what);
  if (value >= low && value <= high) return static_cast<int>(value);
  throw base::InputError(node.place(),
                         fmt::format("{} is {}; accepted: {} to {}", what, value, low, high));
}

RepetitionRange read_repetitions(const base::Node& node) {
  RepetitionRange range;
  if (!node.is_map()) {
    range.min = range.max = bounded(node, "repetitions", 1, kMostRepetitions);
    return range;
  }
  base::MapReader reader(node, "repetitions");
  const base::Node* min = reader.find("min");
  const base::Node* max = reader.find("max");
  const base::Node* until = reader.find("until");
  reader.finish();
  if (min != nullptr) range.min = bounded(*min, "min", 1, kMostRepetitions);
  range.max = range.min;
  if (max != nullptr) range.max = bounded(*max, "max", range.min, kMostRepetitions);
  if (until != nullptr) {
    range.until_relative_spread = base::parse_percent(until->scalar_text("until"), until->place());
  }
  return range;
}

bool read_is_interleaved(const base::Node& node) {
  const std::string& order = node.text("order");
  const std::vector<std::string> known{"interleaved", "blocks"};
  if (std::find(known.begin(), known.end(), order) == known.end()) {
    throw base::InputError(node.place(), base::unknown_name("order", order, known));
  }
  return order == known.front();
}

/// The keys that scenes and methods may have, too.
MeasureChange read_common(base::MapReader& reader) {
  MeasureChange change;
  if (const base::Node* seeds = reader.find("seeds")) {
    change.seeds = bounded(*seeds, "seeds", 1, kMostRepetitions);
  }
  if (const base::Node* repetitions = reader.find("repetitions")) {
    change.repetitions = read_repetitions(*repetitions);
  }
  if (const base::Node* timeout = reader.find("timeout")) {
    change.timeout_s = base::parse_duration_s(timeout->scalar_text("timeout"), timeout->place());
  }
  if (const base::Node* memory = reader.find("memory")) {
    change.memory_bytes = base::parse_bytes(memory->scalar_text("memory"), memory->place());
  }
  return change;
}

}  // namespace

MeasurePlan read_measure(const base::Node& node) {
  base::MapReader reader(node, "measure");
  MeasurePlan plan = with_change({}, read_common(reader));
  if (const base::Node* warmup = reader.find("warmup")) {
    plan.warmup = bounded(*warmup, "warmup", 0, 100);
  }
  if (const base::Node* order = reader.find("order")) {
    plan.is_interleaved = read_is_interleaved(*order);
  }
  plan.has_new_view = reader.boolean("new_view", false);
  plan.has_convergence = reader.boolean("convergence", false);
  reader.finish();
  return plan;
}

MeasureChange read_measure_change(const base::Node& node) {
  base::MapReader reader(node, "measure");
  const MeasureChange change = read_common(reader);
  reader.finish();
  return change;
}

MeasurePlan with_change(MeasurePlan plan, const MeasureChange& change) {
  if (change.seeds) plan.seeds = *change.seeds;
  if (change.repetitions) {
    plan.min_repetitions = change.repetitions->min;
    plan.max_repetitions = change.repetitions->max;
    plan.until_relative_spread =
        change.repetitions->until_relative_spread.value_or(plan.until_relative_spread);
  }
  if (change.timeout_s) plan.timeout_s = *change.timeout_s;
  if (change.memory_bytes) plan.memory_bytes = *change.memory_bytes;
  return plan;
}

std::string to_yaml(const MeasureChange& change) {
  std::vector<std::string> entries;
  if (change.seeds) entries.push_back(fmt::format("seeds: {}", *change.seeds));
  if (const auto& range = change.repetitions) {
    const std::string until =
        range->until_relative_spread
            ? fmt::format(", until: {:.12g}%", 100.0 * *range->until_relative_spread)
            : std::string();
    entries.push_back(
        fmt::format("repetitions: {{min: {}, max: {}{}}}", range->min, range->max, until));
  }
  if (change.timeout_s) entries.push_back(fmt::format("timeout: {}s", *change.timeout_s));
  if (change.memory_bytes) entries.push_back(fmt::format("memory: {}B", *change.memory_bytes));
  return fmt::format("{{{}}}", fmt::join(entries, ", "));
}

}  // namespace suites
