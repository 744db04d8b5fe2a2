#include "perception/aces_config.h"

#include <vector>

#include <fmt/format.h>

namespace perception {
namespace {

/// A view of ours: an ACES output transform shown on a display.
struct View {
  const char* name;
  const char* style;  ///< the end of OpenColorIO's "ACES-OUTPUT - ..." name
};

/// A display: its name, OpenColorIO's "DISPLAY - ..." transform, and the views that suit it.
struct Display {
  const char* name;
  const char* style;
  std::vector<View> views;
};

std::vector<Display> all_displays() {
  return {
      {"sRGB",
       "sRGB",
       {{"ACES SDR", "SDR-VIDEO_1.0"},
        {"ACES SDR Rec.709 limited", "SDR-VIDEO-REC709lim_1.1"},
        {"ACES SDR D60 simulation", "SDR-VIDEO-D60sim-D65_1.0"}}},
      {"PQ",
       "REC.2100-PQ",
       {{"ACES HDR 1000", "HDR-VIDEO-1000nit-15nit-REC2020lim_1.1"},
        {"ACES HDR 2000", "HDR-VIDEO-2000nit-15nit-REC2020lim_1.1"},
        {"ACES HDR 4000", "HDR-VIDEO-4000nit-15nit-REC2020lim_1.1"},
        {"ACES HDR 1000 P3 limited", "HDR-VIDEO-1000nit-15nit-P3lim_1.1"},
        {"ACES HDR 2000 P3 limited", "HDR-VIDEO-2000nit-15nit-P3lim_1.1"},
        {"ACES HDR 4000 P3 limited", "HDR-VIDEO-4000nit-15nit-P3lim_1.1"},
        {"ACES HDR cinema 108", "HDR-CINEMA-108nit-7.2nit-P3lim_1.1"}}},
      {"P3-D65",
       "G2.6-P3-D65",
       {{"ACES SDR P3 limited", "SDR-VIDEO-P3lim_1.1"},
        {"ACES cinema", "SDR-CINEMA_1.0"},
        {"ACES cinema Rec.709 limited", "SDR-CINEMA-REC709lim_1.1"},
        {"ACES cinema D60 simulation", "SDR-CINEMA-D60sim-D65_1.1"}}},
      {"DCI-P3",
       "G2.6-P3-DCI-BFD",
       {{"ACES cinema D60 simulation DCI", "SDR-CINEMA-D60sim-DCI_1.0"},
        {"ACES cinema D65 simulation DCI", "SDR-CINEMA-D65sim-DCI_1.1"}}},
  };
}

std::string display_lines(const Display& display) {
  std::string lines = fmt::format("  {}:\n", display.name);
  for (const View& view : display.views) {
    lines += fmt::format(
        "    - !<View> {{name: {0}, view_transform: {0}, display_colorspace: {1} - Display}}\n",
        view.name, display.name);
  }
  return lines + "    - !<View> {name: Raw, colorspace: Raw}\n";
}

std::string view_transform_lines(const View& view) {
  return fmt::format(
      "  - !<ViewTransform>\n"
      "    name: {}\n"
      "    from_scene_reference: !<BuiltinTransform> "
      "{{style: ACES-OUTPUT - ACES2065-1_to_CIE-XYZ-D65 - {}}}\n",
      view.name, view.style);
}

std::string display_color_space_lines(const Display& display) {
  return fmt::format(
      "  - !<ColorSpace>\n"
      "    name: {} - Display\n"
      "    bitdepth: 32f\n"
      "    from_display_reference: !<BuiltinTransform> "
      "{{style: DISPLAY - CIE-XYZ-D65_to_{}}}\n",
      display.name, display.style);
}

constexpr const char* kHead = R"(ocio_profile_version: 2
environment: {}
search_path: ""
strictparsing: true
luma: [0.2126, 0.7152, 0.0722]
roles:
  default: Raw
  scene_linear: Linear Rec.709
  aces_interchange: ACES2065-1
  cie_xyz_d65_interchange: CIE-XYZ-D65
file_rules:
  - !<Rule> {name: Default, colorspace: default}
)";

/// With a place for the matrix.
constexpr const char* kColorSpaces = R"(colorspaces:
  - !<ColorSpace>
    name: ACES2065-1
    encoding: scene-linear
    bitdepth: 32f
  - !<ColorSpace>
    name: Linear Rec.709
    aliases: [lin_rec709]
    encoding: scene-linear
    bitdepth: 32f
    to_scene_reference: !<MatrixTransform> {{matrix: [{}]}}
  - !<ColorSpace>
    name: Raw
    isdata: true
    bitdepth: 32f
)";

}  // namespace

std::string aces_config() {
  const std::vector<Display> displays = all_displays();
  std::string active;
  std::string shown = "displays:\n";
  std::string transforms = "view_transforms:\n";
  std::string spaces =
      "display_colorspaces:\n"
      "  - !<ColorSpace>\n"
      "    name: CIE-XYZ-D65\n"
      "    bitdepth: 32f\n";
  for (const Display& display : displays) {
    active += (active.empty() ? "" : ", ") + std::string(display.name);
    shown += display_lines(display);
    spaces += display_color_space_lines(display);
    for (const View& view : display.views) transforms += view_transform_lines(view);
  }
  return fmt::format("{}{}active_displays: [{}]\nactive_views: []\n{}{}{}", kHead, shown, active,
                     transforms, spaces,
                     fmt::format(kColorSpaces, fmt::join(kAcesFromRec709, ", ")));
}

}  // namespace perception
