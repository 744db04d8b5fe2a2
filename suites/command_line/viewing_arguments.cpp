#include "suites/command_line/viewing_arguments.h"

#include <cmath>

#include <fmt/format.h>

#include "perception/base/errors.h"

namespace suites::command_line {

namespace {

/// A number given by an option. @throws base::InputError if it is not above 0
double positive_option(double value, const char* option) {
  if (value > 0.0) return value;
  throw base::InputError({option}, fmt::format("{}; accepted: a number above 0", value));
}

/// Option, else discern:luminance_scale_cd_m2, else whiteLuminance, else the default.
void set_luminance_scale(const ViewingArguments& arguments,
                         const perception::Attributes& attributes, const std::string& file,
                         perception::ViewingConditions& viewing) {
  if (arguments.luminance_scale_cd_m2) {
    viewing.luminance_scale_cd_m2 =
        positive_option(*arguments.luminance_scale_cd_m2, "--luminance-scale");
    viewing.luminance_scale_origin = "option";
    return;
  }
  for (const char* name : {perception::kLuminanceScaleAttribute, "whiteLuminance"}) {
    const auto value = positive_attribute(attributes, name, file);
    if (!value) continue;
    viewing.luminance_scale_cd_m2 = *value;
    viewing.luminance_scale_origin = fmt::format("file ({})", name);
    return;
  }
}

}  // namespace

std::optional<perception::Encoding> encoding_of(const ViewingArguments& arguments) {
  if (arguments.encoding.empty()) return std::nullopt;
  return perception::encoding_from_text(arguments.encoding);
}

std::optional<double> positive_attribute(const perception::Attributes& attributes,
                                         const std::string& name, const std::string& path) {
  const auto number = attributes.number.find(name);
  if (number == attributes.number.end()) return std::nullopt;
  if (!(number->second > 0.0) || !std::isfinite(number->second)) {
    throw base::InputError({path}, fmt::format("attribute {} is {}; accepted: a number above 0",
                                               name, number->second));
  }
  return number->second;
}

perception::ViewingConditions viewing_in_force(const ViewingArguments& arguments,
                                               const perception::Attributes& attributes,
                                               const std::string& file) {
  perception::ViewingConditions viewing =
      arguments.display.empty() ? perception::default_viewing_conditions()
                                : perception::viewing_preset(arguments.display, {"--display"});
  if (arguments.pixels_per_degree) {
    viewing.pixels_per_degree = positive_option(*arguments.pixels_per_degree, "--ppd");
    viewing.origins.pixels_per_degree = "option";
  }
  if (arguments.exposure_ev) {
    viewing.exposure_ev = *arguments.exposure_ev;
    viewing.origins.exposure = "option";
  }
  set_luminance_scale(arguments, attributes, file, viewing);
  return viewing;
}

std::string viewing_text(const perception::ViewingConditions& viewing) {
  return fmt::format(
      "viewing: {}\n         from: ppd {}; display {}; exposure {}; luminance scale {}\n",
      perception::describe(viewing), viewing.origins.pixels_per_degree, viewing.origins.display,
      viewing.origins.exposure, viewing.luminance_scale_origin);
}

}  // namespace suites::command_line
