#include "metrics/metric_list.h"

#include <algorithm>

#include <fmt/format.h>

#include "metrics/color_difference.h"
#include "metrics/cvvdp.h"
#include "metrics/flip.h"
#include "metrics/multi_scale_similarity.h"
#include "metrics/pixel_error.h"
#include "metrics/pu_metrics.h"
#include "metrics/structural_similarity.h"
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

}  // namespace

std::span<const MetricInfo> metric_list() {
  static const MetricInfo kMetrics[] = {
      cvvdp_info(),  delta_e_2000_info(), flip_info(),       mae_info(),     ms_ssim_info(),
      mse_info(),    psnr_info(),         pu_ms_ssim_info(), pu_psnr_info(), pu_ssim_info(),
      relmse_info(), smape_info(),        ssim_info(),
  };
  return kMetrics;
}

const MetricInfo& find_metric(std::string_view name, const base::Place& place) {
  std::vector<std::string> known;
  for (const MetricInfo& info : metric_list()) {
    if (base::is_same_name(info.name, name)) return info;
    known.push_back(info.name);
  }
  throw base::InputError(place, base::unknown_name("metric", name, known));
}

MetricChoice parse_metric_choice(std::string_view text, const base::Place& place) {
  const std::vector<std::string_view> pieces = split_at_commas(text);
  MetricChoice choice;
  choice.text = std::string(text);
  choice.info = &find_metric(pieces.front(), place);
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

}  // namespace metrics
