#include "suites/command_line/diff_scores.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "perception/base/names.h"
#include "perception/base/quantile.h"
#include "perception/false_color.h"
#include "perception/image_file.h"

namespace suites::command_line {

namespace {

/// "relmse,trim=0.001" -> "relmse-trim-0.001".
std::string file_name_part(std::string text) {
  for (char& c : text) {
    if (!base::is_path_safe(std::string("x") + c)) c = '-';
  }
  return text;
}

/// Of the finite scores; NaN if there are none.
double quantile_or_nan(const std::vector<double>& values, double q) {
  return values.empty() ? std::nan("") : base::quantile(values, q);
}

}  // namespace

metrics::Score score_image(const metrics::MetricChoice& choice, const DiffInputs& inputs,
                           const DiffImage& test, const metrics::ScoreOptions& options) {
  const metrics::ImagePair pair{inputs.reference.image, test.image, nullptr,
                                inputs.mask ? &*inputs.mask : nullptr};
  return metrics::score(choice, pair, inputs.viewing, options);
}

std::vector<std::string> map_stems(const std::vector<std::string>& tests) {
  std::vector<std::string> stems;
  for (const std::string& test : tests) {
    const std::string stem = std::filesystem::path(test).stem().string();
    const bool is_taken = std::find(stems.begin(), stems.end(), stem) != stems.end();
    stems.push_back(is_taken ? fmt::format("{}-{}", stem, stems.size() + 1) : stem);
  }
  return stems;
}

void write_map(const DiffInputs& inputs, const DiffImage& test, const MapFiles& files,
               const metrics::AnyMetricChoice& choice, MappedScore& entry) {
  if (!entry.score.map) return;
  const metrics::MetricDescription& info = description_of(choice);
  const std::string name = files.stem + "." + file_name_part(text_of(choice));
  perception::ImageFile file;
  file.parts.push_back({info.name, *entry.score.map});
  file.attributes.text = {{"discern:metric", text_of(choice)},
                          {"discern:metric_version", std::to_string(info.version)},
                          {"discern:map_unit", info.map_unit},
                          {"discern:reference", inputs.reference.path.string()},
                          {"discern:test", test.path.string()},
                          {"discern:viewing", perception::to_json(inputs.viewing).dump()}};
  file.attributes.number = {
      {perception::kLuminanceScaleAttribute, inputs.viewing.luminance_scale_cd_m2},
      {"discern:map_scale_low", info.map_scale.low},
      {"discern:map_scale_high", info.map_scale.high}};
  entry.map = (files.folder / (name + ".exr")).string();
  entry.map_picture = (files.folder / (name + ".png")).string();
  perception::write_exr(entry.map, file);
  perception::write_png(entry.map_picture,
                        perception::false_color_image(*entry.score.map, info.map_scale));
}

metrics::Score summary_of(const std::vector<DiffFrame>& frames, metrics::Better better) {
  const double sign = better == metrics::Better::lower ? 1.0 : -1.0;
  metrics::Score summary;
  std::vector<double> errors;  // the higher, the worse; finite ones
  std::size_t perfect = 0;
  double worst_frame = std::nan("");
  double worst = -std::numeric_limits<double>::infinity();
  for (const DiffFrame& frame : frames) {
    const metrics::Score& score = frame.entry.score;
    summary.non_finite_pixels += score.non_finite_pixels;
    if (std::isinf(score.value)) ++perfect;
    if (!std::isfinite(score.value)) continue;
    errors.push_back(sign * score.value);
    if (errors.back() <= worst) continue;
    worst = errors.back();
    worst_frame = frame.frame;
  }
  if (errors.size() == frames.size()) {
    const double sum = std::accumulate(errors.begin(), errors.end(), 0.0);
    summary.value = sign * sum / static_cast<double>(errors.size());
  } else {
    const bool is_perfect = perfect == frames.size();
    summary.value = is_perfect ? std::numeric_limits<double>::infinity() : std::nan("");
  }
  summary.details = {{"worst", errors.empty() ? std::nan("") : sign * worst},
                     {"worst_frame", worst_frame},
                     {"p95", sign * quantile_or_nan(errors, 0.95)}};
  return summary;
}

}  // namespace suites::command_line
