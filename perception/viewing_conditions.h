#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "perception/base/document.h"
#include "perception/base/hash.h"

namespace perception {

/// How a display turns a signal into light.
enum class DisplayTransfer { srgb, bt1886, pq, hlg, linear_hdr };

std::string to_string(DisplayTransfer transfer);  ///< "srgb", "bt1886", "pq", "hlg", "linear_hdr"

/// Where each viewing condition came from: "default", "preset", "suite", "scene", "file", "option".
struct ViewingOrigins {
  std::string pixels_per_degree = "default";
  std::string display = "default";
  std::string exposure = "default";
};

/// What stands between the picture and the viewer's eye.
struct ViewingConditions {
  /// Default of FLIP: 0.7 m from a display 0.7 m and 3840 px wide, 0.7 (3840 / 0.7) pi / 180.
  double pixels_per_degree = 67.02064327658226;
  DisplayTransfer transfer = DisplayTransfer::srgb;
  double peak_cd_m2 = 200.0;
  double black_cd_m2 = 0.2;
  double ambient_lux = 250.0;
  double screen_reflectance = 0.005;  ///< diffuse; adds ambient_lux * reflectance / pi cd/m2
  /// Photographic exposure applied to scene-linear values before display, in stops (2^ev).
  double exposure_ev = 0.0;
  /// Luminance of scene-linear 1.0, cd/m2.
  double luminance_scale_cd_m2 = 100.0;
  /// Where the luminance scale came from: "default", "file", "scene", "suite", "option".
  std::string luminance_scale_origin = "default";
  ViewingOrigins origins;
};

/// Viewing default of one-off commands: 67.0206 ppd, sRGB, 200 cd/m2 peak, 0.2 black, 250 lux, 100
/// cd/m2 for scene-linear 1.0.
ViewingConditions default_viewing_conditions();

/// Pixels per degree of visual angle at the centre of a display.
/// @param pixel_size_m, distance_m  > 0
/// ppd = 1 / (2 atan(0.5 size / distance)), in degrees (as ColorVideoVDP, display model)
double pixels_per_degree(double pixel_size_m, double distance_m);

/// A named display and distance: flip, standard_4k, standard_fhd, standard_hdr, ...
/// @throws base::InputError listing the known presets
ViewingConditions viewing_preset(const std::string& name, const base::Place& place);
std::vector<std::string> viewing_preset_names();

/// Reads the `viewing:` map of a suite.
///
///     {preset: standard_4k}                                  or
///     {ppd: 60}                                              or
///     {distance_m: 0.7, width_m: 0.7, resolution: [3840, 2160]},  each with any of
///     display: {peak_cd_m2, black_cd_m2, ambient_lux, transfer}, luminance_scale_cd_m2: cd/m2,
///     exposure: scene | stops
///
/// One of preset, ppd, distance_m is needed; the last two replace the preset's. A display value not
/// given is the preset's or the default. The luminance scale's origin becomes "suite" if given.
/// @throws base::InputError with the place, for a value out of range too
ViewingConditions read_viewing_conditions(const base::Node& node);

/// True if `exposure: scene` was read (also what its absence means): the caller then sets
/// exposure_ev to the scene's; until then it is 0.
bool takes_exposure_from_scene(const ViewingConditions& viewing);

/// {"ppd", "display": {...}, "exposure_ev", "luminance_scale_cd_m2", "origins": {...}}
nlohmann::ordered_json to_json(const ViewingConditions& viewing);
/// Over everything that changes the light at the eye; origins play no part.
base::Hash hash_of(const ViewingConditions& viewing);
/// One line for a person: "67.0 ppd, sRGB, 200 cd/m2 peak, 0.2 black, 250 lux, 1.0 = 100 cd/m2
/// (default)", and the exposure where it is not 0.
std::string describe(const ViewingConditions& viewing);

}  // namespace perception
