#include "results/html_report/picture.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "perception/base/errors.h"
#include "perception/display_model.h"
#include "perception/image_file.h"
#include "results/html_report/html_text.h"

namespace results::html_report {

namespace fs = std::filesystem;
using perception::Image;

namespace {

std::string png_uri(const Image& image) {
  return "data:image/png;base64," + base64(perception::png_bytes(image));
}

Picture missing_picture(std::string reason) {
  Picture picture;
  picture.missing = std::move(reason);
  return picture;
}

Picture embedded(const Image& shown) {
  Picture picture;
  picture.width_px = shown.width_px;
  picture.height_px = shown.height_px;
  picture.uri = png_uri(shown);
  return picture;
}

/// Calls make(), which reads the file; says what is missing if it cannot be read.
template <class Make>
Picture picture_of(const fs::path& path, const Make& make) {
  std::error_code error;
  if (!fs::exists(path, error)) return missing_picture("not yet");
  try {
    return make();
  } catch (const base::InputError& failure) {
    return missing_picture(failure.what());
  }
}

Image part_of(const fs::path& path, const std::string& part) {
  perception::ImageFile file = perception::read_image_file(path);
  if (part.empty()) return std::move(file.parts.front().image);
  for (perception::NamedImage& candidate : file.parts) {
    if (candidate.name == part) return std::move(candidate.image);
  }
  throw base::InputError(path.string() + ": has no part \"" + part + "\"");
}

}  // namespace

Image reduced(const Image& image, int width_px) {
  const double scale = static_cast<double>(image.width_px) / width_px;
  const int height_px = std::max(1, static_cast<int>(std::lround(image.height_px / scale)));
  Image result(width_px, height_px, image.channels, image.encoding);
  const auto first_source = [](int target, int count, int source_count) {
    return static_cast<int>(static_cast<long>(target) * source_count / count);
  };
  for (int y = 0; y < height_px; ++y) {
    const int y0 = first_source(y, height_px, image.height_px);
    const int y1 = std::max(y0 + 1, first_source(y + 1, height_px, image.height_px));
    for (int x = 0; x < width_px; ++x) {
      const int x0 = first_source(x, width_px, image.width_px);
      const int x1 = std::max(x0 + 1, first_source(x + 1, width_px, image.width_px));
      for (int channel = 0; channel < image.channel_count(); ++channel) {
        double sum = 0.0;
        for (int v = y0; v < y1; ++v) {
          for (int u = x0; u < x1; ++u) sum += image.at(u, v, channel);
        }
        result.at(x, y, channel) = static_cast<float>(sum / ((y1 - y0) * (x1 - x0)));
      }
    }
  }
  return result;
}

Picture rendering_picture(const fs::path& path, const std::string& part, double exposure_ev) {
  return picture_of(path, [&] {
    const Image image = part_of(path, part);
    Picture picture = embedded(perception::to_display_encoded(image, exposure_ev));
    picture.thumbnail = picture.uri;
    if (image.width_px > kThumbnailWidthPx) {
      // Averages light, not code values, so that the small picture is as bright as the large one.
      const Image small = reduced(image, kThumbnailWidthPx);
      picture.thumbnail = png_uri(perception::to_display_encoded(small, exposure_ev));
    }
    return picture;
  });
}

Picture map_picture(const fs::path& path, const perception::MapScale& scale) {
  return picture_of(path, [&] {
    return embedded(perception::false_color_image(perception::read_image(path), scale));
  });
}

}  // namespace results::html_report
