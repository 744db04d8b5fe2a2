#include "perception/viewing_conditions.h"

#include <array>
#include <cassert>
#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "perception/base/errors.h"
#include "perception/base/names.h"

namespace perception {
namespace {

constexpr double kMetresPerInch = 0.0254;

/// A display by its diagonal and its distance, as ColorVideoVDP lists them (display_models.json).
struct DisplayPreset {
  const char* name;
  int width_px;
  int height_px;
  double diagonal_in;
  double distance_m;
  double peak_cd_m2;
  double black_cd_m2;
  double ambient_lux;
  DisplayTransfer transfer;
};

// Black of the SDR displays: contrast 1000:1; of the HDR displays: 1,000,000:1. `standard_hdr` is
// ours, another name for `standard_hdr_pq`.
constexpr std::array<DisplayPreset, 11> kPresets{{
    {"standard_4k", 3840, 2160, 30.0, 0.7472, 200.0, 0.2, 250.0, DisplayTransfer::srgb},
    {"standard_fhd", 1920, 1080, 24.0, 0.6, 200.0, 0.2, 250.0, DisplayTransfer::srgb},
    {"standard_phone", 2400, 1080, 6.0, 0.4, 500.0, 0.05, 250.0, DisplayTransfer::srgb},
    {"standard_hdr", 3840, 2160, 30.0, 0.7472, 1500.0, 0.0015, 10.0, DisplayTransfer::pq},
    {"standard_hdr_pq", 3840, 2160, 30.0, 0.7472, 1500.0, 0.0015, 10.0, DisplayTransfer::pq},
    {"standard_hdr_hlg", 3840, 2160, 30.0, 0.7472, 1500.0, 0.0015, 10.0, DisplayTransfer::hlg},
    {"standard_hdr_linear", 3840, 2160, 30.0, 0.7472, 1500.0, 0.0015, 10.0,
     DisplayTransfer::linear_hdr},
    {"standard_hdr_linear_dark", 3840, 2160, 30.0, 0.7472, 1500.0, 0.0015, 0.0,
     DisplayTransfer::linear_hdr},
    {"standard_hdr_linear_zoom", 3840, 2160, 30.0, 0.25, 10000.0, 0.01, 10.0,
     DisplayTransfer::linear_hdr},
    {"sdr_4k_30", 3840, 2160, 30.0, 0.6, 100.0, 0.1, 250.0, DisplayTransfer::srgb},
    {"sdr_fhd_24", 1920, 1080, 24.0, 0.6, 100.0, 0.1, 250.0, DisplayTransfer::srgb},
}};
constexpr const char* kFlipPreset = "flip";  ///< the defaults, by name

constexpr std::array<DisplayTransfer, 5> kTransfers{DisplayTransfer::srgb, DisplayTransfer::bt1886,
                                                    DisplayTransfer::pq, DisplayTransfer::hlg,
                                                    DisplayTransfer::linear_hdr};

DisplayTransfer transfer_from_node(const base::Node& node) {
  const std::string text = node.scalar_text("transfer");
  std::vector<std::string> known;
  for (const DisplayTransfer transfer : kTransfers) {
    known.push_back(to_string(transfer));
    if (base::is_same_name(known.back(), text)) return transfer;
  }
  throw base::InputError(node.place(), base::unknown_name("display transfer", text, known));
}

/// What a value may be; a bound is accepted itself unless it is open.
struct Range {
  double low;
  double high;
  bool is_low_open = false;
};

constexpr Range kPixelsPerDegree{1.0, 1000.0};
constexpr Range kLength_m{0.0, 1000.0, true};
constexpr Range kPeak_cd_m2{0.0, 1e5, true};
constexpr Range kBlack_cd_m2{0.0, 1e5};
constexpr Range kAmbient_lux{0.0, 2e5};  // full sunlight is about 1e5 lux
constexpr Range kScale_cd_m2{0.0, 1e9, true};
constexpr Range kExposure_ev{-64.0, 64.0};
constexpr Range kResolution_px{1.0, 65536.0};

double checked(double value, const std::string& what, const Range& range,
               const base::Place& place) {
  const bool is_low = range.is_low_open ? value <= range.low : value < range.low;
  if (is_low || value > range.high) {
    throw base::InputError(
        place, fmt::format("{} is {}; accepted: {} {} to {}", what, value,
                           range.is_low_open ? "above" : "from", range.low, range.high));
  }
  return value;
}

double number_in(const base::Node& node, const std::string& what, const Range& range) {
  return checked(node.number(what), what, range, node.place());
}

/// Reads a number of the map into `value` if it is there; says whether it was.
bool read_if_given(base::MapReader& reader, const std::string& key, const Range& range,
                   double& value) {
  const base::Node* node = reader.find(key);
  if (node != nullptr) value = number_in(*node, key, range);
  return node != nullptr;
}

void read_display(const base::Node& node, ViewingConditions& viewing) {
  base::MapReader reader(node, "display");
  const base::Node* black = reader.find("black_cd_m2");
  read_if_given(reader, "peak_cd_m2", kPeak_cd_m2, viewing.peak_cd_m2);
  read_if_given(reader, "black_cd_m2", kBlack_cd_m2, viewing.black_cd_m2);
  read_if_given(reader, "ambient_lux", kAmbient_lux, viewing.ambient_lux);
  if (const base::Node* transfer = reader.find("transfer")) {
    viewing.transfer = transfer_from_node(*transfer);
  }
  reader.finish();
  if (viewing.black_cd_m2 >= viewing.peak_cd_m2) {
    throw base::InputError((black != nullptr ? *black : node).place(),
                           fmt::format("black_cd_m2 is {}; accepted: below peak_cd_m2, {}",
                                       viewing.black_cd_m2, viewing.peak_cd_m2));
  }
  viewing.origins.display = "suite";
}

/// distance_m, width_m and resolution give pixels per degree.
double pixels_per_degree_from(base::MapReader& reader, const base::Node& distance) {
  const double distance_m = number_in(distance, "distance_m", kLength_m);
  const double width_m = number_in(reader.require("width_m"), "width_m", kLength_m);
  const base::Node& resolution = reader.require("resolution");
  const double width_px =
      checked(base::number_list(resolution, "resolution", 2).front(),
              "the first number of resolution", kResolution_px, resolution.place());
  return checked(pixels_per_degree(width_m / width_px, distance_m), "pixels per degree",
                 kPixelsPerDegree, distance.place());
}

/// Reads preset, ppd, or distance and size.
ViewingConditions read_geometry(base::MapReader& reader) {
  const base::Node* preset = reader.find("preset");
  const base::Node* ppd = reader.find("ppd");
  const base::Node* distance = reader.find("distance_m");
  ViewingConditions viewing = default_viewing_conditions();
  if (preset != nullptr) {
    viewing = viewing_preset(preset->scalar_text("preset"), preset->place());
  }
  if (ppd != nullptr && distance != nullptr) {
    throw base::InputError(distance->place(),
                           "viewing has both ppd and distance_m; accepted: one of them");
  }
  if (preset == nullptr && ppd == nullptr && distance == nullptr) {
    throw base::InputError(reader.node().place(),
                           "viewing says nothing about distance; accepted: preset, ppd, or "
                           "distance_m with width_m and resolution");
  }
  if (ppd != nullptr) viewing.pixels_per_degree = number_in(*ppd, "ppd", kPixelsPerDegree);
  if (distance != nullptr) viewing.pixels_per_degree = pixels_per_degree_from(reader, *distance);
  if (ppd != nullptr || distance != nullptr) viewing.origins.pixels_per_degree = "suite";
  return viewing;
}

/// `exposure: scene` is what its absence means, too.
void read_exposure(const base::Node* node, ViewingConditions& viewing) {
  viewing.origins.exposure = "scene";
  if (node == nullptr) return;
  if (node->is_number()) {
    viewing.exposure_ev = number_in(*node, "exposure", kExposure_ev);
    viewing.origins.exposure = "suite";
  } else if (!node->is_scalar() || node->scalar_text("exposure") != "scene") {
    throw base::InputError(node->place(),
                           fmt::format("exposure is {}; accepted: scene, or stops from -64 to 64",
                                       node->is_scalar() ? node->scalar_text("exposure")
                                                         : base::Node::kind_name(node->kind())));
  }
}

/// Names as a person writes them.
std::string title(DisplayTransfer transfer) {
  switch (transfer) {
    case DisplayTransfer::srgb:
      return "sRGB";
    case DisplayTransfer::bt1886:
      return "BT.1886";
    case DisplayTransfer::pq:
      return "PQ";
    case DisplayTransfer::hlg:
      return "HLG";
    case DisplayTransfer::linear_hdr:
      return "linear HDR";
  }
  assert(false);
  return "";
}

}  // namespace

std::string to_string(DisplayTransfer transfer) {
  switch (transfer) {
    case DisplayTransfer::srgb:
      return "srgb";
    case DisplayTransfer::bt1886:
      return "bt1886";
    case DisplayTransfer::pq:
      return "pq";
    case DisplayTransfer::hlg:
      return "hlg";
    case DisplayTransfer::linear_hdr:
      return "linear_hdr";
  }
  assert(false);
  return "";
}

ViewingConditions default_viewing_conditions() { return {}; }

double pixels_per_degree(double pixel_size_m, double distance_m) {
  assert(pixel_size_m > 0.0 && distance_m > 0.0);
  const double angle_rad = 2.0 * std::atan(0.5 * pixel_size_m / distance_m);
  return std::numbers::pi / 180.0 / angle_rad;
}

ViewingConditions viewing_preset(const std::string& name, const base::Place& place) {
  ViewingConditions viewing;
  viewing.origins.pixels_per_degree = "preset";
  viewing.origins.display = "preset";
  if (base::is_same_name(name, kFlipPreset)) return viewing;
  for (const DisplayPreset& preset : kPresets) {
    if (!base::is_same_name(name, preset.name)) continue;
    const double diagonal_px = std::hypot(preset.width_px, preset.height_px);
    viewing.pixels_per_degree =
        pixels_per_degree(preset.diagonal_in * kMetresPerInch / diagonal_px, preset.distance_m);
    viewing.transfer = preset.transfer;
    viewing.peak_cd_m2 = preset.peak_cd_m2;
    viewing.black_cd_m2 = preset.black_cd_m2;
    viewing.ambient_lux = preset.ambient_lux;
    return viewing;
  }
  throw base::InputError(place, base::unknown_name("viewing preset", name, viewing_preset_names()));
}

std::vector<std::string> viewing_preset_names() {
  std::vector<std::string> names{kFlipPreset};
  for (const DisplayPreset& preset : kPresets) names.emplace_back(preset.name);
  return names;
}

ViewingConditions read_viewing_conditions(const base::Node& node) {
  base::MapReader reader(node, "viewing");
  ViewingConditions viewing = read_geometry(reader);
  // Asked for in any case, so that a misspelt key is answered with the full list.
  reader.find("width_m");
  reader.find("resolution");
  if (const base::Node* display = reader.find("display")) read_display(*display, viewing);
  read_exposure(reader.find("exposure"), viewing);
  if (read_if_given(reader, "luminance_scale_cd_m2", kScale_cd_m2, viewing.luminance_scale_cd_m2)) {
    viewing.luminance_scale_origin = "suite";
  }
  reader.finish();
  return viewing;
}

bool takes_exposure_from_scene(const ViewingConditions& viewing) {
  return viewing.origins.exposure == "scene";
}

nlohmann::ordered_json to_json(const ViewingConditions& viewing) {
  nlohmann::ordered_json json;
  json["ppd"] = viewing.pixels_per_degree;
  nlohmann::ordered_json& display = json["display"];
  display["transfer"] = to_string(viewing.transfer);
  display["peak_cd_m2"] = viewing.peak_cd_m2;
  display["black_cd_m2"] = viewing.black_cd_m2;
  display["ambient_lux"] = viewing.ambient_lux;
  display["screen_reflectance"] = viewing.screen_reflectance;
  json["exposure_ev"] = viewing.exposure_ev;
  json["luminance_scale_cd_m2"] = viewing.luminance_scale_cd_m2;
  nlohmann::ordered_json& origins = json["origins"];
  origins["ppd"] = viewing.origins.pixels_per_degree;
  origins["display"] = viewing.origins.display;
  origins["exposure_ev"] = viewing.origins.exposure;
  origins["luminance_scale_cd_m2"] = viewing.luminance_scale_origin;
  return json;
}

base::Hash hash_of(const ViewingConditions& viewing) {
  base::Hasher hasher;
  hasher.add(viewing.pixels_per_degree);
  hasher.add(std::string_view(to_string(viewing.transfer)));
  hasher.add(viewing.peak_cd_m2);
  hasher.add(viewing.black_cd_m2);
  hasher.add(viewing.ambient_lux);
  hasher.add(viewing.screen_reflectance);
  hasher.add(viewing.exposure_ev);
  hasher.add(viewing.luminance_scale_cd_m2);
  return hasher.finish();
}

std::string describe(const ViewingConditions& viewing) {
  std::string text = fmt::format(
      "{:.1f} ppd, {}, {:g} cd/m2 peak, {:g} black, {:g} lux, 1.0 = {:g} cd/m2 ({})",
      viewing.pixels_per_degree, title(viewing.transfer), viewing.peak_cd_m2, viewing.black_cd_m2,
      viewing.ambient_lux, viewing.luminance_scale_cd_m2, viewing.luminance_scale_origin);
  if (viewing.exposure_ev != 0.0) text += fmt::format(", exposure {:+g} EV", viewing.exposure_ev);
  return text;
}

}  // namespace perception
