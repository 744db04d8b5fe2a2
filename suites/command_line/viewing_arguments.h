#pragma once

#include <optional>
#include <string>

#include "perception/image_file.h"
#include "perception/viewing_conditions.h"

namespace suites::command_line {

/// How images are looked at, as options of a verb.
struct ViewingArguments {
  std::optional<double> pixels_per_degree;
  std::string display;  ///< viewing preset
  std::optional<double> exposure_ev;
  std::optional<double> luminance_scale_cd_m2;
  std::string encoding;  ///< "": the file's
};

/// The encoding asked for, if one is. @throws base::InputError listing the known ones
std::optional<perception::Encoding> encoding_of(const ViewingArguments& arguments);

/// A number of a file's attributes, if it has it. @throws base::InputError if it is not above 0
std::optional<double> positive_attribute(const perception::Attributes& attributes,
                                         const std::string& name, const std::string& path);

/// The conditions in force, each value with its origin: option, else preset, else default; the
/// luminance of 1.0: option, else the file's discern:luminance_scale_cd_m2, else its
/// whiteLuminance, else the default.
/// @param file  whose attributes count
/// @throws base::InputError for an unknown preset, and for numbers that must be above 0
perception::ViewingConditions viewing_in_force(const ViewingArguments& arguments,
                                               const perception::Attributes& attributes,
                                               const std::string& file);

/// The conditions and their origins in two lines.
std::string viewing_text(const perception::ViewingConditions& viewing);

}  // namespace suites::command_line
