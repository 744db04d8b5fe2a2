#include "metrics/metric_list.h"

#include <algorithm>

#include <fmt/format.h>

#include "metrics/color_difference.h"
#include "metrics/contrast_kept.h"
#include "metrics/cvvdp.h"
#include "metrics/daly_vdp.h"
#include "metrics/edge_excess.h"
#include "metrics/flicker.h"
#include "metrics/flip.h"
#include "metrics/holes.h"
#include "metrics/leak.h"
#include "metrics/multi_scale_similarity.h"
#include "metrics/penumbra_width.h"
#include "metrics/pixel_error.h"
#include "metrics/pu_metrics.h"
#include "metrics/structural_similarity.h"
#include "metrics/threshold_ratio.h"
#include "metrics/visible_difference.h"
#include "metrics/yee.h"
#include "perception/base/errors.h"
#include "perception/base/names.h"

namespace metrics {
namespace {

std::vector<std::string_view> split_at_commas(std::string_view text) {
  std::vector<std::string_view> pieces;
  for (std::size_t begin = 0;;) {
    const std::size_t comma = text.find(',', begin);
    pieces.push_back(text.substr(begin, comma - begin));
    if (comma == std::string_view::npos) return pieces;
    begin = comma + 1;
  }
}

/// `name=value` with the place of the metric it belongs to.
base::ParameterSetting read_setting(std::string_view text, std::string_view metric,
                                    const base::Place& place) {
  const std::string where = place.file.empty() ? "" : base::to_string(place) + ": ";
  base::ParameterSetting setting =
      base::parse_setting(text, fmt::format("{}metric \"{}\"", where, metric));
  setting.value = base::Node::from_text(setting.value.scalar_text(setting.name), place);
  return setting;
}

void refuse_repeats(const std::vector<base::ParameterSetting>& settings, std::string_view metric,
                    const base::Place& place) {
  for (std::size_t i = 1; i < settings.size(); ++i) {
    const auto end = settings.begin() + static_cast<std::ptrdiff_t>(i);
    const bool is_repeat = std::any_of(settings.begin(), end, [&](const auto& earlier) {
      return base::is_same_name(earlier.name, settings[i].name);
    });
    if (is_repeat) {
      throw base::InputError(place, fmt::format("metric \"{}\" is given parameter \"{}\" twice",
                                                metric, settings[i].name));
    }
  }
}

/// The entry of a table by name. @param kind  for the message
template <typename Info>
const Info& find_entry(std::span<const Info> table, const char* kind, std::string_view name,
                       const base::Place& place) {
  std::vector<std::string> known;
  for (const Info& info : table) {
    if (base::is_same_name(info.name, name)) return info;
    known.push_back(info.name);
  }
  throw base::InputError(place, base::unknown_name(kind, name, known));
}

/// Of both tables, sorted.
std::vector<std::string> all_names() {
  std::vector<std::string> names;
  for (const MetricInfo& info : metric_list()) names.push_back(info.name);
  for (const SequenceMetricInfo& info : sequence_metric_list()) names.push_back(info.name);
  std::sort(names.begin(), names.end());
  return names;
}

/// Reads `name,parameter=value,...`. @param find  (name) -> entry of a table
template <typename Choice, typename Find>
Choice parse_choice(std::string_view text, const base::Place& place, const Find& find) {
  const std::vector<std::string_view> pieces = split_at_commas(text);
  Choice choice;
  choice.text = std::string(text);
  choice.info = &find(pieces.front());
  std::vector<base::ParameterSetting> settings;
  for (std::size_t i = 1; i < pieces.size(); ++i) {
    settings.push_back(read_setting(pieces[i], choice.info->name, place));
  }
  refuse_repeats(settings, choice.info->name, place);
  choice.parameters = base::resolve_parameters(choice.info->parameters, nullptr, settings,
                                               fmt::format("metric \"{}\"", choice.info->name));
  choice.info->create(choice.parameters);  // refuses texts that the declaration cannot check
  return choice;
}

}  // namespace

std::span<const MetricInfo> metric_list() {
  static const MetricInfo kMetrics[] = {
      contrast_kept_info(),
      cvvdp_info(),
      daly_vdp_info(),
      delta_e_2000_info(),
      edge_excess_info(),
      flip_info(),
      holes_info(),
      leak_info(),
      mae_info(),
      ms_ssim_info(),
      mse_info(),
      penumbra_width_info(),
      psnr_info(),
      pu_ms_ssim_info(),
      pu_psnr_info(),
      pu_ssim_info(),
      relative_rmse_info(),
      relmse_info(),
      smape_info(),
      ssim_info(),
      threshold_ratio_info(),
      visible_difference_info(),
      yee_info(),
  };
  return kMetrics;
}

const MetricInfo& find_metric(std::string_view name, const base::Place& place) {
  return find_entry(metric_list(), "metric", name, place);
}

MetricChoice parse_metric_choice(std::string_view text, const base::Place& place) {
  return parse_choice<MetricChoice>(
      text, place, [&](std::string_view name) -> auto& { return find_metric(name, place); });
}

std::span<const SequenceMetricInfo> sequence_metric_list() {
  static const SequenceMetricInfo kMetrics[] = {flicker_info()};
  return kMetrics;
}

const SequenceMetricInfo& find_sequence_metric(std::string_view name, const base::Place& place) {
  return find_entry(sequence_metric_list(), "sequence metric", name, place);
}

SequenceMetricChoice parse_sequence_metric_choice(std::string_view text, const base::Place& place) {
  return parse_choice<SequenceMetricChoice>(
      text,
      place, [&](std::string_view name) -> auto& { return find_sequence_metric(name, place); });
}

AnyMetricChoice parse_any_metric_choice(std::string_view text, const base::Place& place) {
  const std::string_view name = split_at_commas(text).front();
  const MetricDescription* description = find_description(name);
  if (description == nullptr) {
    throw base::InputError(place, base::unknown_name("metric", name, all_names()));
  }
  if (description->scope == MetricScope::image) return parse_metric_choice(text, place);
  return parse_sequence_metric_choice(text, place);
}

const std::string& text_of(const AnyMetricChoice& choice) {
  return std::visit([](const auto& one) -> const std::string& { return one.text; }, choice);
}

const base::Parameters& parameters_of(const AnyMetricChoice& choice) {
  return std::visit([](const auto& one) -> const base::Parameters& { return one.parameters; },
                    choice);
}

const MetricDescription& description_of(const AnyMetricChoice& choice) {
  return std::visit([](const auto& one) -> const MetricDescription& { return *one.info; }, choice);
}

const MetricDescription* find_description(std::string_view name) {
  for (const MetricInfo& info : metric_list()) {
    if (base::is_same_name(info.name, name)) return &info;
  }
  for (const SequenceMetricInfo& info : sequence_metric_list()) {
    if (base::is_same_name(info.name, name)) return &info;
  }
  return nullptr;
}

}  // namespace metrics
