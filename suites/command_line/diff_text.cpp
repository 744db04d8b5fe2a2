#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "suites/command_line/console.h"
#include "suites/command_line/diff_output.h"
#include "suites/command_line/viewing_arguments.h"

namespace suites::command_line {

namespace {

using Rows = std::vector<std::vector<std::string>>;

const char* better_text(const metrics::MetricDescription& info) {
  return info.better == metrics::Better::lower ? "lower" : "higher";
}

const char* arrow_of(const metrics::MetricDescription& info) {
  return info.better == metrics::Better::lower ? "↓" : "↑";
}

std::string detail_text(const metrics::Score& score, const char* name) {
  for (const metrics::NamedValue& detail : score.details) {
    if (detail.name == name) return value_text(detail.value);
  }
  return "";
}

/// One test: a row per metric.
std::string table_of_one(const DiffInputs& inputs, const DiffResult& result) {
  Rows rows{{"metric", "value", "unit", "better"}};
  if (inputs.at) rows.front().push_back(fmt::format("map at {},{}", inputs.at->x, inputs.at->y));
  for (const DiffScore& score : result.scores) {
    const metrics::MetricDescription& info = description_of(*score.choice);
    rows.push_back({text_of(*score.choice), value_text(score.entry.score.value), info.unit,
                    better_text(info)});
    if (inputs.at) rows.back().push_back(value_text(map_value(score, inputs)));
  }
  return text_table(rows);
}

/// Several tests side by side: a row per test, a column per metric.
std::string table_of_several(const std::vector<DiffResult>& results) {
  Rows rows{{"test"}, {""}};
  for (const DiffScore& score : results.front().scores) {
    const metrics::MetricDescription& info = description_of(*score.choice);
    rows[0].push_back(fmt::format("{} {}", text_of(*score.choice), arrow_of(info)));
    rows[1].push_back(info.unit);
  }
  const auto is_empty = [](const std::string& text) { return text.empty(); };
  if (std::all_of(rows[1].begin(), rows[1].end(), is_empty)) rows.pop_back();
  for (const DiffResult& result : results) {
    rows.push_back({result.test.path.string()});
    for (const DiffScore& score : result.scores) {
      rows.back().push_back(value_text(score.entry.score.value));
    }
  }
  return text_table(rows) + "↓ lower is better, ↑ higher is better\n";
}

/// Sequences: a row per metric and test, those of a metric below each other.
std::string table_of_sequences(const std::vector<DiffResult>& results) {
  Rows rows{{"metric", "mean", "worst", "frame", "p95", "unit", "better", "test"}};
  for (std::size_t i = 0; i < results.front().scores.size(); ++i) {
    for (const DiffResult& result : results) {
      const DiffScore& score = result.scores[i];
      const metrics::Score& summary = score.entry.score;
      const metrics::MetricDescription& info = description_of(*score.choice);
      rows.push_back({text_of(*score.choice), value_text(summary.value),
                      detail_text(summary, "worst"), detail_text(summary, "worst_frame"),
                      detail_text(summary, "p95"), info.unit, better_text(info),
                      result.test.path.string()});
    }
  }
  std::string text = text_table(rows);
  text += "mean over the frames; p95: 95 % of them are at least as good\n";
  for (const DiffScore& score : results.front().scores) {
    const base::Parameters& given = parameters_of(*score.choice);
    if (given.to_text() == score.parameters.to_text()) continue;
    std::vector<std::string> found;
    for (const auto& [name, value] : score.parameters.entries()) {
      const base::Parameters one({{name, value}});
      const auto same =
          std::find(given.entries().begin(), given.entries().end(), std::pair(name, value));
      if (same == given.entries().end()) found.push_back(one.to_text());
    }
    text += fmt::format("{}: {} for all frames, found from the references\n",
                        text_of(*score.choice), fmt::join(found, ", "));
  }
  return text;
}

/// What else the metrics say, a line each: "flip: weighted_median 0.31, ...".
std::string details_text(const DiffResult& result) {
  std::string text;
  for (const DiffScore& score : result.scores) {
    std::string details;
    for (const metrics::NamedValue& detail : score.entry.score.details) {
      details += fmt::format("{} {} {}", details.empty() ? ":" : ",", detail.name,
                             value_text(detail.value));
    }
    if (!details.empty()) text += text_of(*score.choice) + details + "\n";
  }
  return text;
}

std::string channels_text(std::span<const float> channels) {
  nlohmann::json values = nlohmann::json::array();
  for (const float value : channels) values.push_back(value);
  return values.dump();
}

/// The values at the pixel of --at.
std::string pixel_text(const DiffInputs& inputs, const DiffResult& result, bool with_maps) {
  const int x = inputs.at->x - inputs.region.x;
  const int y = inputs.at->y - inputs.region.y;
  std::string text = fmt::format("pixel {},{}: reference {}, test {}\n", inputs.at->x, inputs.at->y,
                                 channels_text(inputs.reference.image.pixel(x, y)),
                                 channels_text(result.test.image.pixel(x, y)));
  if (!with_maps) return text;
  std::vector<std::string> values;
  for (const DiffScore& score : result.scores) {
    values.push_back(text_of(*score.choice) + " " + value_text(map_value(score, inputs)));
  }
  return text +
         fmt::format("maps at {},{}: {}\n", inputs.at->x, inputs.at->y, fmt::join(values, ", "));
}

/// What there is to say of one test besides its values.
std::string remarks_text(const DiffInputs& inputs, const DiffResult& result, bool is_alone) {
  std::string text;
  if (inputs.frames.empty()) text += details_text(result);
  if (inputs.at) text += pixel_text(inputs, result, !is_alone);
  for (const std::string& gate : result.violated_gates) text += "limit violated: " + gate + "\n";
  for (const DiffImage* image : {&inputs.reference, &result.test}) {
    if (image->non_finite.pixels > 0) text += non_finite_text(*image) + "\n";
  }
  if (is_alone || text.empty()) return text;
  return "\n" + result.test.path.string() + "\n" + text;
}

std::string heading(const DiffInputs& inputs, const std::vector<DiffResult>& results) {
  std::string text = results.size() == 1 ? results.front().test.path.string()
                                         : fmt::format("{} tests", results.size());
  text += " against " + inputs.reference.path.string();
  if (inputs.frames.empty()) return text + "\n";
  return text + fmt::format(", frames {} to {} ({})\n", inputs.frames.front(), inputs.frames.back(),
                            inputs.frames.size());
}

}  // namespace

std::string diff_text(const DiffInputs& inputs, const std::vector<DiffResult>& results) {
  const bool is_alone = results.size() == 1;
  std::string text = viewing_text(inputs.viewing) + "\n" + heading(inputs, results);
  if (!inputs.frames.empty()) {
    text += table_of_sequences(results);
  } else {
    text += is_alone ? table_of_one(inputs, results.front()) : table_of_several(results);
  }
  for (const DiffResult& result : results) text += remarks_text(inputs, result, is_alone);
  return text;
}

}  // namespace suites::command_line
