#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "perception/image.h"

namespace perception {

/// OpenColorIO transforms from scene-linear Rec.709 to displays.
///
/// The configuration is $OCIO if set, else an embedded one with the 16 ACES output transforms that
/// OpenColorIO 2.1 holds: displays "sRGB" (views "ACES SDR", ..., "Raw"), "PQ" (views "ACES HDR
/// 1000", ..., in the primaries of BT.2020), "P3-D65", "DCI-P3".
class ColorManagement {
 public:
  /// @throws base::InputError if $OCIO names a file that cannot be read or parsed, or that has no
  ///         ACES2065-1 (role aces_interchange, or a colour space of that name)
  ColorManagement();
  ~ColorManagement();
  ColorManagement(const ColorManagement&) = delete;
  ColorManagement& operator=(const ColorManagement&) = delete;

  std::vector<std::string> displays() const;
  /// @throws base::InputError naming the known displays
  std::vector<std::string> views(const std::string& display) const;
  std::string default_display() const;
  std::string default_view(const std::string& display) const;
  std::string origin() const;  ///< "embedded" or the path of the configuration

  /// Scene-linear Rec.709 through display and view; result R, G, B, encoding display.
  ///
  /// A view of raw data ("Raw") leaves the values as they are.
  /// @throws base::InputError naming the known displays or views, or for another encoding
  Image view(const Image& scene_linear, const std::string& display, const std::string& view) const;

  /// From a named colour space of the configuration to scene-linear Rec.709, R, G, B.
  /// @param image  its own encoding plays no part: the colour space says what the numbers mean
  /// @throws base::InputError naming the known colour spaces
  Image to_scene_linear_rec709(const Image& image, const std::string& color_space) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace perception
