#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "perception/false_color.h"
#include "perception/image.h"
#include "results/html_report/float_payload.h"
#include "results/html_report/float_store.h"

namespace results::html_report {

/// Where a picture's pixels are, and how they are shown.
struct PictureSource {
  std::filesystem::path path;
  std::string part;                           ///< of the EXR; "" is the first
  double exposure_ev = 0.0;                   ///< of renderings
  std::optional<perception::MapScale> scale;  ///< an error map's; absent for renderings
  bool has_preview = true;                    ///< else only floats: the frames of a sequence
};

/// The floats of an image on the page: where its data are, and what the viewer needs to read them.
struct FloatReference {
  std::size_t id = 0;
  int channels = 0;
  int exponent = 0;
  std::size_t non_finite = 0;
};

/// An encoded 8-bit picture.
struct EncodedPicture {
  std::string format;  ///< "png" or "jpeg"
  std::string bytes;
};

/// An image of a run as the page embeds it.
struct Picture {
  PictureSource source;
  std::string uri;        ///< of the preview, at most kPreviewWidthPx wide; "" if there is none
  std::string thumbnail;  ///< of renderings: the same, at most kThumbnailWidthPx wide
  int width_px = 0;       ///< of the image itself
  int height_px = 0;
  std::string missing;  ///< what to say in place of the picture
  std::optional<FloatReference> floats;

  bool is_empty() const { return width_px == 0; }
};

inline constexpr int kPreviewWidthPx = 400;
inline constexpr int kThumbnailWidthPx = 240;

/// Reads the images of all pictures, in parallel, and fills them: previews, and floats into the
/// store, which is finished then. A missing or unreadable file gives an empty picture that says so;
/// so does a picture without a path, which keeps its `missing`.
void fill_pictures(const std::vector<Picture*>& pictures, FloatStore& store);

/// One rendering as an SDR viewer shows it, sRGB of clamp(2^exposure_ev x linear), 8 bit, without
/// its floats. Pixels that are not finite, or whose average would not be, are cyan.
Picture rendering_picture(const std::filesystem::path& path, const std::string& part,
                          double exposure_ev);

/// A PNG up to 160x160 pixels, else a JPEG: floats are beside it for whoever needs more.
/// @param shown  encoding display, R G B
EncodedPicture encoded(const perception::Image& shown);

/// Mean over the source pixels each target pixel covers, in the image's own encoding; the height
/// follows. @param width_px  1 ... the image's width
perception::Image reduced(const perception::Image& image, int width_px);

}  // namespace results::html_report
