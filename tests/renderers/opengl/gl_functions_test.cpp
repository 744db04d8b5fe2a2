#include "renderers/opengl/gl_functions.h"

#include <string>

#include <gtest/gtest.h>

#include "renderers/contract/devices.h"
#include "tests/expect_error.h"

namespace renderers::opengl {
namespace {

void no_function() {}

TEST(GlFunctions, NamesAMissingEntryPoint) {
  tests::expect_error<UnsupportedError>(
      [] {
        load_functions([](const char* name) -> void (*)() {
          return std::string(name) == "glDispatchCompute" ? nullptr : no_function;
        });
      },
      "the driver lacks the OpenGL 4.5 entry point glDispatchCompute");
}

}  // namespace
}  // namespace renderers::opengl
