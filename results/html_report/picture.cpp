#include "results/html_report/picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "perception/base/errors.h"
#include "perception/base/parallel.h"
#include "perception/display_model.h"
#include "perception/image_file.h"
#include "results/html_report/html_text.h"

namespace results::html_report {

namespace fs = std::filesystem;
using perception::Image;

namespace {

constexpr int kJpegQuality = 85;
constexpr std::size_t kSmallPixels = 160 * 160;  ///< so small a picture is kept without loss
constexpr std::array<float, 3> kNonFinite{0.0F, 1.0F, 1.0F};  ///< cyan, as in error maps

/// What one picture becomes before it is known whether the page is split.
struct Made {
  EncodedPicture preview;
  EncodedPicture thumbnail;  ///< no bytes: the preview
};

Image part_of(const fs::path& path, const std::string& part) {
  perception::ImageFile file = perception::read_image_file(path);
  if (part.empty()) return std::move(file.parts.front().image);
  for (perception::NamedImage& candidate : file.parts) {
    if (candidate.name == part) return std::move(candidate.image);
  }
  throw base::InputError(path.string() + ": has no part \"" + part + "\"");
}

/// Pixels that are not finite in cyan: clipped to 8 bit they would be black.
void mark_non_finite(Image& shown) {
  for (std::size_t i = 0; i < shown.pixels.size(); i += 3) {
    const auto* pixel = &shown.pixels[i];
    if (std::isfinite(pixel[0]) && std::isfinite(pixel[1]) && std::isfinite(pixel[2])) continue;
    std::copy(kNonFinite.begin(), kNonFinite.end(), &shown.pixels[i]);
  }
}

/// Averages light, not code values, so that a small picture is as bright as the large one.
EncodedPicture shown_rendering(const Image& image, int width_px, double exposure_ev) {
  const Image small = image.width_px > width_px ? reduced(image, width_px) : image;
  Image shown = perception::to_display_encoded(small, exposure_ev);
  mark_non_finite(shown);
  return encoded(shown);
}

EncodedPicture shown_map(const Image& map, int width_px, const perception::MapScale& scale) {
  const Image small = map.width_px > width_px ? reduced(map, width_px) : map;
  return encoded(perception::false_color_image(small, scale));
}

/// Preview and thumbnail of an image that was read.
Made shown(const Image& image, const PictureSource& source) {
  Made made;
  if (source.scale) {
    made.preview = shown_map(image, kPreviewWidthPx, *source.scale);
    return made;
  }
  const Image colors = perception::rgb_of(image);
  made.preview = shown_rendering(colors, kPreviewWidthPx, source.exposure_ev);
  if (image.width_px > kThumbnailWidthPx) {
    made.thumbnail = shown_rendering(colors, kThumbnailWidthPx, source.exposure_ev);
  }
  return made;
}

/// Calls make(), which reads the file; says what is missing if it cannot be read.
template <class Make>
void try_to_make(Picture& picture, const Make& make) {
  std::error_code error;
  if (!fs::exists(picture.source.path, error)) {
    picture.missing = "not yet";
    return;
  }
  try {
    make();
  } catch (const base::InputError& failure) {
    picture.width_px = 0;
    picture.missing = failure.what();
  }
}

std::string data_uri(const EncodedPicture& picture) {
  return fmt::format("data:image/{};base64,{}", picture.format, base64(picture.bytes));
}

void make_picture(Picture& picture, Made& made, std::size_t id, FloatStore& store) {
  if (picture.source.path.empty()) return;
  try_to_make(picture, [&] {
    const Image image = part_of(picture.source.path, picture.source.part);
    if (picture.source.has_preview) made = shown(image, picture.source);
    const FloatPayload payload = float_payload(image);
    picture.floats = {id, payload.channels, payload.exponent, payload.non_finite};
    picture.width_px = image.width_px;
    picture.height_px = image.height_px;
    store.put(id, base64(payload.deflated));
  });
}

std::string published(const EncodedPicture& picture, const std::string& name,
                      const FloatStore& store) {
  return store.is_split() ? store.put_file(name + "." + picture.format, picture.bytes)
                          : data_uri(picture);
}

void publish(Picture& picture, const Made& made, std::size_t id, const FloatStore& store) {
  if (picture.is_empty() || made.preview.bytes.empty()) return;
  picture.uri = published(made.preview, fmt::format("p{}", id), store);
  const bool is_small = made.thumbnail.bytes.empty();
  picture.thumbnail =
      is_small ? picture.uri : published(made.thumbnail, fmt::format("t{}", id), store);
}

}  // namespace

void fill_pictures(const std::vector<Picture*>& pictures, FloatStore& store) {
  std::vector<Made> made(pictures.size());
  base::parallel_for(pictures.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) make_picture(*pictures[i], made[i], i, store);
  });
  store.finish();
  for (std::size_t i = 0; i < pictures.size(); ++i) publish(*pictures[i], made[i], i, store);
}

EncodedPicture encoded(const Image& picture) {
  if (picture.pixel_count() <= kSmallPixels) return {"png", perception::png_bytes(picture)};
  return {"jpeg", perception::jpeg_bytes(picture, kJpegQuality)};
}

Picture rendering_picture(const fs::path& path, const std::string& part, double exposure_ev) {
  Picture picture;
  picture.source = {path, part, exposure_ev, std::nullopt, true};
  try_to_make(picture, [&] {
    const Image image = part_of(path, part);
    const Made made = shown(image, picture.source);
    picture.width_px = image.width_px;
    picture.height_px = image.height_px;
    picture.uri = data_uri(made.preview);
    picture.thumbnail = made.thumbnail.bytes.empty() ? picture.uri : data_uri(made.thumbnail);
  });
  return picture;
}

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

}  // namespace results::html_report
