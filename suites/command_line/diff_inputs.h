#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "perception/image.h"
#include "perception/image_file.h"
#include "perception/viewing_conditions.h"
#include "suites/command_line/rectangle.h"
#include "suites/command_line/verb_arguments.h"

namespace suites::command_line {

/// An image to compare: R, G, B of the part in question, and where its non-finite pixels are.
struct DiffImage {
  std::filesystem::path path;                 ///< of a sequence the pattern of its files
  perception::Image image;                    ///< of a sequence empty
  perception::NonFinite non_finite;           ///< first position in the whole image
  std::optional<int> first_non_finite_frame;  ///< of a sequence, if it has such pixels
  std::vector<std::string> notes;             ///< what a reader of the scores should know
};

/// What the images of one `diff` have in common.
struct DiffInputs {
  DiffImage reference;
  base::SizePx size_px;  ///< of the whole reference
  RectanglePx region;    ///< the whole image unless --region
  std::optional<perception::Image> mask;
  std::optional<PointPx> at;
  perception::ViewingConditions viewing;  ///< with the origin of each value
  std::optional<perception::Encoding> encoding;
  std::vector<int> frames;  ///< of a sequence; empty for single images
};

/// Reads reference, mask, region, viewing conditions.
/// @throws base::InputError
DiffInputs read_diff_inputs(const DiffArguments& arguments);

/// Reads a test image. @throws base::InputError if its size is not the reference's
DiffImage read_test_image(const std::string& path, const DiffInputs& inputs);
/// The same of a file that was read. @param path  for messages
DiffImage test_image_of(const std::string& path, perception::ImageFile file,
                        const DiffInputs& inputs);

}  // namespace suites::command_line
