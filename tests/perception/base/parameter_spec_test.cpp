#include "perception/base/parameter_spec.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/expect_input_error.h"

namespace base {
namespace {

using tests::input_error_of;

std::vector<ParameterSpec> specs() {
  return {{"samples",
           ParameterType::integer,
           std::int64_t{64},
           1.0,
           1048576.0,
           {},
           "samples per pixel",
           "Paths through each pixel."},
          {"clamp", ParameterType::real, 0.0, 0.0, {}, {}, "1/m2", "Bound of the geometry term."},
          {"shadows", ParameterType::boolean, true, {}, {}, {}, "", "Trace shadow rays."},
          {"part",
           ParameterType::choice,
           std::string("all"),
           {},
           {},
           {"all", "indirect"},
           "",
           "Which light."}};
}

Parameters resolve(const std::vector<std::string>& settings, const Preset* preset = nullptr) {
  std::vector<ParameterSetting> parsed;
  for (const std::string& text : settings) parsed.push_back(parse_setting(text, "--set"));
  const auto all = specs();
  return resolve_parameters(all, preset, parsed, "renderer \"path\"");
}

TEST(Parameters, DefaultThenPresetThenSetting) {
  const Preset best{"best", {{"samples", std::int64_t{256}}, {"shadows", false}}};
  const Parameters parameters = resolve({"samples=16", "part=Indirect"}, &best);
  EXPECT_EQ(parameters.integer("samples"), 16);
  EXPECT_FALSE(parameters.boolean("shadows"));
  EXPECT_EQ(parameters.text("part"), "indirect");
  EXPECT_EQ(parameters.to_text(), "samples=16,clamp=0.0,shadows=false,part=indirect");
}

TEST(Parameters, RefusesWithWhatIsAccepted) {
  EXPECT_EQ(input_error_of([] { resolve({"samples=0"}); }),
            "--set: parameter \"samples\" of renderer \"path\" cannot be \"0\"; accepted: a whole "
            "number from 1 to 1048576 (samples per pixel)");
  EXPECT_EQ(input_error_of([] { resolve({"samples=1.5"}); }),
            "--set: parameter \"samples\" of renderer \"path\" cannot be \"1.5\"; accepted: a "
            "whole number from 1 to 1048576 (samples per pixel)");
  EXPECT_EQ(input_error_of([] { resolve({"clamp=-1"}); }),
            "--set: parameter \"clamp\" of renderer \"path\" cannot be \"-1\"; accepted: a number "
            "of at least 0 (1/m2)");
  EXPECT_EQ(input_error_of([] { resolve({"part=direct"}); }),
            "--set: parameter \"part\" of renderer \"path\" cannot be \"direct\"; accepted: one of "
            "all, indirect");
  EXPECT_EQ(input_error_of([] { resolve({"sampels=4"}); }),
            "--set: unknown parameter \"sampels\"; did you mean \"samples\"? known: samples, "
            "clamp, shadows, part of renderer \"path\"");
  EXPECT_EQ(input_error_of([] {
              resolve({"samples=4", "samples=5"});
            }),
            "--set: parameter \"samples\" of renderer \"path\" is given twice; accepted: once");
  EXPECT_EQ(input_error_of([] { resolve({"samples"}); }),
            "--set: \"samples\" is not a setting; accepted: name=value");
}

TEST(Parameters, JsonOfASpecificationHasEveryField) {
  EXPECT_EQ(to_json(specs()[0]).dump(),
            R"({"name":"samples","type":"int","default":64,"min":1.0,"max":1048576.0,)"
            R"("choices":[],"unit":"samples per pixel","doc":"Paths through each pixel."})");
}

}  // namespace
}  // namespace base
