#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "perception/base/errors.h"
#include "perception/base/names.h"
#include "perception/base/parallel.h"
#include "perception/base/quantile.h"
#include "perception/display_model.h"
#include "perception/false_color.h"
#include "perception/image_file.h"
#include "perception/threshold_map.h"
#include "results/run_record.h"
#include "suites/command_line/exit_codes.h"
#include "suites/command_line/known_words.h"
#include "suites/command_line/option_values.h"
#include "suites/command_line/verbs.h"

namespace suites::command_line {

using nlohmann::ordered_json;
using perception::Image;

namespace {

/// One map on its way to a file, with the fixed scale of its picture.
struct NamedMap {
  std::string name;
  const Image* map = nullptr;
  perception::MapScale scale;
};

struct WrittenMap {
  std::string name;
  std::string unit;
  std::string map;
  std::string picture;
  double median = 0.0;
  double p95 = 0.0;
  double max = 0.0;
};

perception::ThresholdSettings settings_of(const ThresholdsArguments& arguments) {
  perception::ThresholdSettings settings =
      perception::threshold_profile(arguments.profile, {"--masking"});
  if (!arguments.csf.empty()) {
    settings.masking.csf = perception::find_csf(arguments.csf, {"--csf"}).name;
  }
  if (!arguments.curve.empty()) {
    require_known(arguments.curve, perception::threshold_curve_names(), "--tvi", "threshold curve");
    settings.curve = perception::threshold_curve_from_text(arguments.curve);
  }
  settings.keeps_bands = true;
  if (arguments.target_cpd) {
    if (!(*arguments.target_cpd > 0.0)) {
      throw base::InputError({"--target"}, fmt::format("{} cycles per degree; accepted: above 0",
                                                       *arguments.target_cpd));
    }
    settings.targets.push_back({*arguments.target_cpd, std::nullopt});
  }
  return settings;
}

/// Scales are the same for every image, so that two pictures can be compared.
std::vector<NamedMap> named_maps(const perception::ThresholdMap& maps) {
  const perception::MapScale light{0.01, 1000.0, true, "cd/m2"};
  const perception::MapScale threshold{0.001, 100.0, true, "cd/m2"};
  const perception::MapScale factor{1.0, 100.0, true, "times"};
  const perception::MapScale elevation{1.0, 10.0, true, "times"};  // clamped there or below
  std::vector<NamedMap> named{{"adaptation", &maps.adaptation_cd_m2, light},
                              {"tvi", &maps.tvi_cd_m2, threshold},
                              {"elevation", &maps.elevation, elevation},
                              {"threshold", &maps.threshold_cd_m2, threshold}};
  for (const perception::BandElevation& band : maps.bands) {
    std::string name = fmt::format("elevation-{:.3g}cpd", band.frequency_cpd);
    if (band.orientation_deg) name += fmt::format("-{:.0f}deg", *band.orientation_deg);
    named.push_back({name, &band.elevation, factor});
  }
  for (const perception::ArtefactElevation& artefact : maps.targets) {
    named.push_back({fmt::format("elevation-of-{:.4g}cpd", artefact.target.frequency_cpd),
                     &artefact.elevation, elevation});
  }
  return named;
}

WrittenMap write_map(const NamedMap& named, const ThresholdsArguments& arguments,
                     const perception::ViewingConditions& viewing) {
  WrittenMap written;
  written.name = named.name;
  written.unit = named.scale.unit;
  const std::filesystem::path folder(arguments.out);
  const std::string stem = std::filesystem::path(arguments.image).stem().string();
  written.map = (folder / (stem + "." + named.name + ".exr")).string();
  written.picture = (folder / (stem + "." + named.name + ".png")).string();
  perception::ImageFile file;
  file.parts.push_back({named.name, *named.map});
  file.attributes.text = {{"discern:image", arguments.image},
                          {"discern:map_unit", named.scale.unit},
                          {"discern:viewing", perception::to_json(viewing).dump()}};
  file.attributes.number = {{perception::kLuminanceScaleAttribute, viewing.luminance_scale_cd_m2},
                            {"discern:map_scale_low", named.scale.low},
                            {"discern:map_scale_high", named.scale.high}};
  perception::write_exr(written.map, file);
  perception::write_png(written.picture, perception::false_color_picture(*named.map, named.scale));

  std::vector<double> values;
  for (const float value : named.map->pixels) {
    if (std::isfinite(value)) values.push_back(static_cast<double>(value));
  }
  if (values.empty()) return written;
  written.median = base::quantile(values, 0.5);
  written.p95 = base::quantile(values, 0.95);
  written.max = *std::ranges::max_element(values);
  return written;
}

ordered_json maps_json(const std::vector<WrittenMap>& written) {
  ordered_json json = ordered_json::object();
  for (const WrittenMap& map : written) {
    json[map.name] = {{"unit", map.unit}, {"median", map.median}, {"p95", map.p95},
                      {"max", map.max},   {"map", map.map},       {"map_picture", map.picture}};
  }
  return json;
}

std::string maps_text(const std::vector<WrittenMap>& written) {
  std::vector<std::vector<std::string>> rows{{"map", "unit", "median", "p95", "max", "picture"}};
  for (const WrittenMap& map : written) {
    rows.push_back({map.name, map.unit, fmt::format("{:.4g}", map.median),
                    fmt::format("{:.4g}", map.p95), fmt::format("{:.4g}", map.max), map.picture});
  }
  return text_table(rows);
}

/// @throws base::InputError naming the parts of the file
const Image& part_of(const perception::ImageFile& file, const ThresholdsArguments& arguments) {
  if (arguments.part.empty()) return file.parts.front().image;
  std::vector<std::string> known;
  for (const perception::NamedImage& part : file.parts) {
    if (part.name == arguments.part) return part.image;
    known.push_back(part.name);
  }
  throw base::InputError({arguments.image}, base::unknown_name("part", arguments.part, known));
}

}  // namespace

int run_thresholds(const ThresholdsArguments& arguments, Console& console) {
  const base::ThreadLimit limit(arguments.threads);
  const perception::ThresholdSettings settings = settings_of(arguments);
  const perception::ImageFile file =
      perception::read_image_file(arguments.image, encoding_of(arguments.viewing));
  const Image& image = part_of(file, arguments);
  const perception::ViewingConditions viewing =
      viewing_in_force(arguments.viewing, file.attributes, arguments.image);
  const perception::ThresholdMap maps =
      perception::threshold_map(perception::to_display_light(image, viewing), viewing, settings);
  make_folder_of_option(arguments.out, "--out");
  std::vector<WrittenMap> written;
  for (const NamedMap& named : named_maps(maps)) {
    written.push_back(write_map(named, arguments, viewing));
  }
  const bool is_finite = maps.non_finite.pixels == 0;
  const std::string reason =
      is_finite ? ""
                : fmt::format("{} of {} pixels are not finite, the first at ({}, {})",
                              maps.non_finite.pixels, image.pixel_count(),
                              maps.non_finite.first_x_px, maps.non_finite.first_y_px);
  if (arguments.json) {
    print_json(console, {{"schema", results::kSchemaVersion},
                         {"status", is_finite ? "ok" : "non_finite"},
                         {"reason", is_finite ? ordered_json() : ordered_json(reason)},
                         {"image", arguments.image},
                         {"size_px", {image.width_px, image.height_px}},
                         {"viewing", perception::to_json(viewing)},
                         {"masking", arguments.profile},
                         {"csf", settings.masking.csf},
                         {"tvi", perception::to_string(settings.curve)},
                         {"tvi_scale", settings.threshold_scale},
                         {"non_finite_pixels", maps.non_finite.pixels},
                         {"negative_pixels", maps.negative_pixels},
                         {"maps", maps_json(written)}});
  } else {
    console.out << viewing_text(viewing) << "\n" << maps_text(written);
    if (!is_finite) print_note(console, reason);
    if (maps.negative_pixels > 0) {
      print_note(console, fmt::format("{} pixels have a negative luminance, counted as dark",
                                      maps.negative_pixels));
    }
  }
  return is_finite ? kAsExpected : kCellsFailed;
}

}  // namespace suites::command_line
