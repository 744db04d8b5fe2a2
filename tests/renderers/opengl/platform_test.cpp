#include "tests/renderers/opengl/platform_test.h"

#include <algorithm>

namespace renderers::opengl {

void PlatformTest::SetUp() {
  try {
    context_ = Context::create(GetParam());
  } catch (const UnsupportedError& error) {
    if (GetParam() == "egl-device") GTEST_SKIP() << error.what();
    FAIL() << error.what();
  }
}

void PlatformTest::TearDown() {
  if (!context_) return;
  context_->check("the test");
  for (const std::string& message : context_->take_messages()) ADD_FAILURE() << message;
}

std::string platform_label(const testing::TestParamInfo<std::string>& info) {
  std::string label = info.param;
  std::ranges::replace(label, '-', '_');
  return label;
}

}  // namespace renderers::opengl
