#include "suites/command_line/diff_inputs.h"

#include <utility>

#include <fmt/format.h>

#include "perception/base/errors.h"
#include "suites/command_line/viewing_arguments.h"

namespace suites::command_line {

using perception::Image;

namespace {

bool is_rgb(const Image& image) {
  return image.channels == std::vector<std::string>{"R", "G", "B"};
}

/// R, G, B of a region. An image that is both is not copied.
Image rgb_of_region(Image whole, const RectanglePx& region) {
  const bool is_whole = region.width == whole.width_px && region.height == whole.height_px;
  if (is_whole) return is_rgb(whole) ? std::move(whole) : perception::rgb_of(whole);
  return perception::rgb_of(
      perception::crop(whole, region.x, region.y, region.width, region.height));
}

/// The region's R, G, B; where a non-finite pixel is said in whole-image coordinates.
DiffImage part_of(const std::filesystem::path& path, Image whole, const RectanglePx& region) {
  DiffImage part;
  part.path = path;
  try {
    part.image = rgb_of_region(std::move(whole), region);
  } catch (const base::InputError& error) {
    throw base::InputError({path.string()}, error.what());
  }
  part.non_finite = perception::count_non_finite(part.image);
  part.non_finite.first_x_px += region.x;
  part.non_finite.first_y_px += region.y;
  return part;
}

void require_size(const std::filesystem::path& path, const Image& image,
                  const std::string& reference, base::SizePx size) {
  if (image.width_px == size.width && image.height_px == size.height) return;
  throw base::InputError(
      {path.string()},
      fmt::format("is {}x{} pixels, but the reference {} is {}x{}; both must "
                  "have the same size",
                  image.width_px, image.height_px, reference, size.width, size.height));
}

/// The region of a mask as one channel of 0 and 1.
Image read_mask(const std::string& path, const DiffInputs& inputs) {
  const Image whole = perception::read_image(path);
  require_size(path, whole, inputs.reference.path.string(), inputs.size_px);
  const RectanglePx& r = inputs.region;
  const Image rgb = perception::rgb_of(perception::crop(whole, r.x, r.y, r.width, r.height));
  Image mask = perception::make_gray_image(r.width, r.height, "Y", whole.encoding);
  for (int y = 0; y < r.height; ++y) {
    for (int x = 0; x < r.width; ++x) {
      const float value = rgb.at(x, y);
      if (value != 0.0F && value != 1.0F) {
        throw base::InputError({path}, fmt::format("pixel ({}, {}) is {}; a mask holds 0 (black) "
                                                   "and 1 (white) only",
                                                   x + r.x, y + r.y, value));
      }
      mask.at(x, y) = value;
    }
  }
  return mask;
}

}  // namespace

DiffInputs read_diff_inputs(const DiffArguments& arguments) {
  DiffInputs inputs;
  inputs.encoding = encoding_of(arguments.viewing);
  perception::ImageFile file = perception::read_image_file(arguments.reference, inputs.encoding);
  Image& whole = file.parts.front().image;
  inputs.size_px = {whole.width_px, whole.height_px};
  inputs.region = {0, 0, whole.width_px, whole.height_px};
  if (!arguments.region.empty()) {
    inputs.region = parse_rectangle(arguments.region, inputs.size_px, {"--region"});
  }
  inputs.reference = part_of(arguments.reference, std::move(whole), inputs.region);
  if (!arguments.mask.empty()) inputs.mask = read_mask(arguments.mask, inputs);
  if (!arguments.at.empty()) {
    inputs.at = parse_point(arguments.at, inputs.size_px, {"--at"});
    const RectanglePx& r = inputs.region;
    if (inputs.at->x < r.x || inputs.at->y < r.y || inputs.at->x >= r.x + r.width ||
        inputs.at->y >= r.y + r.height) {
      throw base::InputError({"--at"}, fmt::format("the pixel {} is outside --region {}",
                                                   arguments.at, arguments.region));
    }
  }
  inputs.viewing = viewing_in_force(arguments.viewing, file.attributes, arguments.reference);
  return inputs;
}

DiffImage read_test_image(const std::string& path, const DiffInputs& inputs) {
  return test_image_of(path, perception::read_image_file(path, inputs.encoding), inputs);
}

DiffImage test_image_of(const std::string& path, perception::ImageFile file,
                        const DiffInputs& inputs) {
  Image& whole = file.parts.front().image;
  require_size(path, whole, inputs.reference.path.string(), inputs.size_px);
  DiffImage part = part_of(path, std::move(whole), inputs.region);
  const double in_force = inputs.viewing.luminance_scale_cd_m2;
  const auto own = positive_attribute(file.attributes, perception::kLuminanceScaleAttribute, path);
  if (own && *own != in_force) {
    part.notes.push_back(
        fmt::format("{} states {} cd/m2 for scene-linear 1.0; {} is in force for "
                    "both images",
                    path, *own, in_force));
  }
  return part;
}

}  // namespace suites::command_line
