#pragma once

#include <filesystem>
#include <string>

#include "perception/false_color.h"
#include "perception/image.h"

namespace results::html_report {

/// An image of a run as the page embeds it.
struct Picture {
  std::string uri;        ///< data:image/png;base64,... at full resolution; "" if there is none
  std::string thumbnail;  ///< of renderings: the same, at most kThumbnailWidthPx wide
  int width_px = 0;
  int height_px = 0;
  std::string missing;  ///< what to say in place of the picture

  bool is_empty() const { return uri.empty(); }
};

inline constexpr int kThumbnailWidthPx = 240;

/// A rendering as an SDR viewer shows it: sRGB of clamp(2^exposure_ev x linear), 8 bit.
///
/// @param part  name of the part of the EXR; "" is the first
/// A missing or unreadable file gives an empty picture that says so.
Picture rendering_picture(const std::filesystem::path& path, const std::string& part,
                          double exposure_ev);

/// An error map in the false colours of a fixed scale.
Picture map_picture(const std::filesystem::path& path, const perception::MapScale& scale);

/// Mean over the source pixels each target pixel covers, in the image's own encoding; the height
/// follows. @param width_px  1 ... the image's width
perception::Image reduced(const perception::Image& image, int width_px);

}  // namespace results::html_report
