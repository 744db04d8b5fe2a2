#include <malloc.h>

#include <algorithm>
#include <filesystem>
#include <future>
#include <ostream>
#include <set>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "perception/base/errors.h"
#include "perception/base/parallel.h"
#include "suites/command_line/diff_gates.h"
#include "suites/command_line/diff_inputs.h"
#include "suites/command_line/diff_output.h"
#include "suites/command_line/diff_sequence.h"
#include "suites/command_line/exit_codes.h"
#include "suites/command_line/frame_pattern.h"
#include "suites/command_line/option_values.h"
#include "suites/command_line/verbs.h"
#include "suites/command_line/viewing_arguments.h"

namespace suites::command_line {

namespace {

using metrics::AnyMetricChoice;

std::vector<std::string> metric_texts(const DiffArguments& arguments) {
  if (!arguments.metrics.empty()) return arguments.metrics;
  std::vector<std::string> defaults{"flip", "relmse", "ssim"};
  const bool is_sequence =
      !arguments.frames.empty() && parse_frames(arguments.frames, {"--frames"}).size() > 1;
  if (is_sequence) defaults.emplace_back("flicker");
  return defaults;
}

std::vector<AnyMetricChoice> metric_choices(const DiffArguments& arguments) {
  std::vector<AnyMetricChoice> choices;
  std::set<std::string> keys;
  for (const std::string& text : metric_texts(arguments)) {
    choices.push_back(metrics::parse_any_metric_choice(text, {"--metric"}));
    if (!keys.insert(text_of(choices.back())).second) {
      throw base::InputError({"--metric"}, fmt::format("\"{}\" is given twice", text));
    }
    const bool is_of_image = std::holds_alternative<metrics::MetricChoice>(choices.back());
    if (is_of_image || !arguments.frames.empty()) continue;
    throw base::InputError(
        {"--metric"},
        fmt::format("\"{}\" scores sequences; accepted: with --frames FIRST..LAST and file names "
                    "that hold %04d or ####, or an image metric",
                    text));
  }
  return choices;
}

/// A pattern where a file is expected: the option was forgotten.
void refuse_patterns(const DiffArguments& arguments) {
  std::vector<std::string> names{arguments.reference};
  names.insert(names.end(), arguments.tests.begin(), arguments.tests.end());
  for (const std::string& name : names) {
    if (!has_frame_number(name) || std::filesystem::exists(name)) continue;
    throw base::InputError(
        {name}, "no such file; if it names the files of a sequence, add --frames FIRST..LAST");
  }
}

/// Freed memory stays with the process: every score takes and gives back buffers as large as the
/// images, and a page that is new costs more than filling it. Only here: where memory is measured,
/// what others left would count.
void keep_freed_memory() {
  constexpr int kTop_bytes = 1 << 30;
  mallopt(M_MMAP_THRESHOLD, kTop_bytes);
  mallopt(M_TRIM_THRESHOLD, kTop_bytes);
}

/// A file that is being read, on a thread of its own if there may be two.
std::future<perception::ImageFile> begin_reading(const DiffArguments& arguments) {
  const bool may_be_two = base::core_count() > 1 && arguments.threads != 1;
  return std::async(may_be_two ? std::launch::async : std::launch::deferred,
                    [path = arguments.tests.front(), encoding = encoding_of(arguments.viewing)] {
                      return perception::read_image_file(path, encoding);
                    });
}

/// What is compared and what came out.
DiffOutcome diff_images(const DiffArguments& arguments,
                        const std::vector<AnyMetricChoice>& choices) {
  refuse_patterns(arguments);
  auto first_file = begin_reading(arguments);
  DiffOutcome diff{read_diff_inputs(arguments), {}};
  const bool with_maps = !arguments.map_folder.empty();
  const metrics::ScoreOptions options{arguments.ignore_non_finite,
                                      with_maps || diff.inputs.at.has_value()};
  const std::vector<std::string> stems = map_stems(arguments.tests);
  for (std::size_t i = 0; i < arguments.tests.size(); ++i) {
    DiffResult result;
    const std::string& name = arguments.tests[i];
    result.test = i == 0 ? test_image_of(name, first_file.get(), diff.inputs)
                         : read_test_image(name, diff.inputs);
    for (const AnyMetricChoice& choice : choices) {
      const auto& of_image = std::get<metrics::MetricChoice>(choice);
      MappedScore entry{score_image(of_image, diff.inputs, result.test, options), "", ""};
      if (with_maps) {
        write_map(diff.inputs, result.test, {arguments.map_folder, stems[i]}, choice, entry);
      }
      result.scores.push_back({&choice, of_image.parameters, std::move(entry), {}});
    }
    diff.results.push_back(std::move(result));
  }
  return diff;
}

void apply_gates(const std::vector<DiffGate>& gates, DiffResult& result) {
  for (const DiffGate& gate : gates) {
    for (const DiffScore& score : result.scores) {
      if (!concerns(gate, *score.choice) || !is_violated(gate, score.entry.score)) continue;
      result.violated_gates.push_back(gate.text);
    }
  }
}

int code_of(const std::vector<DiffResult>& results, bool ignores_non_finite) {
  int code = kAsExpected;
  for (const DiffResult& result : results) {
    const bool is_ok = status_of(result, ignores_non_finite) == "ok";
    code = most_important({code, is_ok ? kAsExpected : kCellsFailed,
                           result.violated_gates.empty() ? kAsExpected : kGateFailed});
  }
  return code;
}

}  // namespace

int run_diff(const DiffArguments& arguments, Console& console) {
  keep_freed_memory();
  const base::ThreadLimit limit(arguments.threads);
  const std::vector<AnyMetricChoice> choices = metric_choices(arguments);
  const std::vector<DiffGate> gates =
      parse_gates(arguments.fail_above, arguments.fail_below, choices);
  if (!arguments.map_folder.empty()) {
    make_folder_of_option(arguments.map_folder, "--map-dir");
  }
  DiffOutcome diff = arguments.frames.empty() ? diff_images(arguments, choices)
                                              : diff_sequences(arguments, choices);
  for (DiffResult& result : diff.results) apply_gates(gates, result);
  if (arguments.json) {
    print_json(console, diff_json(diff.inputs, diff.results, arguments.ignore_non_finite));
  } else {
    console.out << diff_text(diff.inputs, diff.results);
    for (const DiffResult& result : diff.results) {
      for (const std::string& note : result.test.notes) print_note(console, note);
    }
  }
  return code_of(diff.results, arguments.ignore_non_finite);
}

}  // namespace suites::command_line
