#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "suites/command_line/rectangle.h"
#include "suites/measurement.h"

namespace suites::command_line {

struct RenderOutputOptions {
  std::filesystem::path path;
  bool is_png = false;  ///< else EXR
  std::string aov;      ///< this image only; "" for the radiance and, in EXR, all AOVs
  std::optional<RectanglePx> crop;
  double exposure_ev = 0.0;  ///< PNG only
};

/// Writes the image, atomically. A PNG is display-encoded: clamp(2^ev x linear), sRGB.
/// @throws base::InputError for an AOV that the renderer does not have, listing those it has
void write_render_output(const Measurement& measurement, double luminance_scale_cd_m2,
                         const RenderOutputOptions& options);

/// The record of DESIGN section 7, with "crop_px" and "aov".
nlohmann::ordered_json render_json(const results::RenderRecord& record,
                                   const RenderOutputOptions& options);

/// The record for a person: what was rendered, times, stages, where the image is.
std::string render_text(const results::RenderRecord& record);

}  // namespace suites::command_line
