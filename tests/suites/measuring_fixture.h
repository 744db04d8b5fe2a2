#pragma once

#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "renderers/scene/scene_file.h"
#include "suites/measurement.h"
#include "tests/suites/test_suite.h"
#include "tests/temporary_folder.h"

namespace tests {

/// Measures single images of 12x10 pixels.
class Measuring : public testing::Test {
 protected:
  Measuring() {
    write_scene(folder_.path());
    scene_ = renderers::scene::read_scene_file(folder_.path() / "walls.yaml").at_frame(0);
  }

  suites::MeasureRequest request(const std::string& renderer,
                                 const std::vector<std::string>& settings = {}) {
    const base::Place place{"test", 0, 0};
    suites::MeasureRequest made;
    made.scene = &scene_;
    made.method.info = &renderers::find_renderer(renderer, place);
    made.method.preset = "best";
    std::vector<base::ParameterSetting> parsed;
    for (const std::string& text : settings) parsed.push_back(base::parse_setting(text, "test"));
    made.method.parameters = base::resolve_parameters(
        made.method.info->parameters, &renderers::find_preset(*made.method.info, "best", place),
        parsed, "test");
    made.size_px = {12, 10};
    made.devices.threads = 1;
    return made;
  }

  /// A counter that is one number.
  static double number_of(const results::RenderRecord& record, const std::string& name) {
    for (const auto& [counter, value] : record.counters) {
      if (counter == name) return std::get<double>(value);
    }
    throw std::runtime_error("no counter " + name);
  }

  TemporaryFolder folder_;
  renderers::scene::Scene scene_;
};

}  // namespace tests
