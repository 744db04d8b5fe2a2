#include <algorithm>
#include <ostream>
#include <set>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "perception/base/errors.h"
#include "perception/base/names.h"
#include "perception/base/parallel.h"
#include "perception/false_color.h"
#include "perception/image_file.h"
#include "suites/command_line/diff_gates.h"
#include "suites/command_line/diff_inputs.h"
#include "suites/command_line/diff_output.h"
#include "suites/command_line/exit_codes.h"
#include "suites/command_line/verbs.h"

namespace suites::command_line {

namespace {

const std::vector<std::string> kDefaultMetrics{"flip", "relmse", "ssim"};

std::vector<metrics::MetricChoice> metric_choices(const std::vector<std::string>& texts) {
  std::vector<metrics::MetricChoice> choices;
  std::set<std::string> keys;
  for (const std::string& text : texts.empty() ? kDefaultMetrics : texts) {
    choices.push_back(metrics::parse_metric_choice(text, {"--metric"}));
    if (!keys.insert(choices.back().text).second) {
      throw base::InputError({"--metric"}, fmt::format("\"{}\" is given twice", text));
    }
  }
  return choices;
}

/// "relmse,trim=0.001" -> "relmse-trim-0.001".
std::string file_name_part(std::string text) {
  for (char& c : text) {
    if (!base::is_path_safe(std::string("x") + c)) c = '-';
  }
  return text;
}

/// Names of the tests' maps: the files' stems, with a number where two agree.
std::vector<std::string> map_stems(const std::vector<std::string>& tests) {
  std::vector<std::string> stems;
  for (const std::string& test : tests) {
    const std::string stem = std::filesystem::path(test).stem().string();
    const bool is_taken = std::find(stems.begin(), stems.end(), stem) != stems.end();
    stems.push_back(is_taken ? fmt::format("{}-{}", stem, stems.size() + 1) : stem);
  }
  return stems;
}

void write_maps(const DiffInputs& inputs, const std::filesystem::path& folder,
                const std::string& stem, DiffResult& result) {
  for (DiffScore& entry : result.scores) {
    if (!entry.score.map) continue;
    const metrics::MetricInfo& info = *entry.choice->info;
    const std::string name = stem + "." + file_name_part(entry.choice->text);
    perception::ImageFile file;
    file.parts.push_back({info.name, *entry.score.map});
    file.attributes.text = {{"discern:metric", entry.choice->text},
                            {"discern:metric_version", std::to_string(info.version)},
                            {"discern:map_unit", info.map_unit},
                            {"discern:reference", inputs.reference.path.string()},
                            {"discern:test", result.test.path.string()},
                            {"discern:viewing", perception::to_json(inputs.viewing).dump()}};
    file.attributes.number = {
        {perception::kLuminanceScaleAttribute, inputs.viewing.luminance_scale_cd_m2},
        {"discern:map_scale_low", info.map_scale.low},
        {"discern:map_scale_high", info.map_scale.high}};
    entry.map = (folder / (name + ".exr")).string();
    entry.map_picture = (folder / (name + ".png")).string();
    perception::write_exr(entry.map, file);
    perception::write_png(entry.map_picture,
                          perception::false_color_image(*entry.score.map, info.map_scale));
  }
}

DiffResult score_test(const DiffInputs& inputs, DiffImage test,
                      const std::vector<metrics::MetricChoice>& choices,
                      const metrics::ScoreOptions& options) {
  DiffResult result;
  result.test = std::move(test);
  const metrics::ImagePair pair{inputs.reference.image, result.test.image, nullptr,
                                inputs.mask ? &*inputs.mask : nullptr};
  for (const metrics::MetricChoice& choice : choices) {
    result.scores.push_back(
        {&choice, metrics::score(choice, pair, inputs.viewing, options), "", ""});
  }
  return result;
}

void apply_gates(const std::vector<DiffGate>& gates, DiffResult& result) {
  for (const DiffGate& gate : gates) {
    for (const DiffScore& entry : result.scores) {
      if (!concerns(gate, *entry.choice) || !is_violated(gate, entry.score)) continue;
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
  const base::ThreadLimit limit(arguments.threads);
  const std::vector<metrics::MetricChoice> choices = metric_choices(arguments.metrics);
  const std::vector<DiffGate> gates =
      parse_gates(arguments.fail_above, arguments.fail_below, choices);
  const DiffInputs inputs = read_diff_inputs(arguments);
  const bool with_maps = !arguments.map_folder.empty();
  const metrics::ScoreOptions options{arguments.ignore_non_finite,
                                      with_maps || inputs.at.has_value()};
  if (with_maps) std::filesystem::create_directories(arguments.map_folder);
  const std::vector<std::string> stems = map_stems(arguments.tests);
  std::vector<DiffResult> results;
  for (std::size_t i = 0; i < arguments.tests.size(); ++i) {
    results.push_back(
        score_test(inputs, read_test_image(arguments.tests[i], inputs), choices, options));
    apply_gates(gates, results.back());
    if (with_maps) write_maps(inputs, arguments.map_folder, stems[i], results.back());
  }
  if (arguments.json) {
    print_json(console, diff_json(inputs, results, arguments.ignore_non_finite));
  } else {
    console.out << diff_text(inputs, results);
    for (const DiffResult& result : results) {
      for (const std::string& note : result.test.notes) print_note(console, note);
    }
  }
  return code_of(results, arguments.ignore_non_finite);
}

}  // namespace suites::command_line
