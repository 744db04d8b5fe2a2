#pragma once

#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "renderers/opengl/context.h"

namespace renderers::opengl {

/// A test that runs with a fresh context of each platform. A platform that is missing fails, except
/// EGL devices, which need hardware. At the end no message of the driver may be left.
class PlatformTest : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override;
  void TearDown() override;

  std::shared_ptr<Context> context_;
};

/// For INSTANTIATE_TEST_SUITE_P: every platform, and its name without signs.
inline auto all_platforms() { return testing::ValuesIn(platform_names()); }
std::string platform_label(const testing::TestParamInfo<std::string>& info);

}  // namespace renderers::opengl
