#include "renderers/opengl/shader_source.h"

#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "perception/base/errors.h"
#include "renderers/opengl/shader_files.h"
#include "tests/expect_error.h"
#include "tests/places.h"
#include "tests/temporary_folder.h"

namespace renderers::opengl {
namespace {

constexpr std::array kFiles{
    ShaderFile{"a/main.comp.glsl",
               "#include \"a/one.glsl\"\nint x;\n#include \"a/two.glsl\"\n"
               "int y;\n"},
    ShaderFile{"a/one.glsl", "int one;\n"},
    ShaderFile{"a/two.glsl", "  #  include \"a/one.glsl\"  // again\nint two;\n"},
    ShaderFile{"a/circle.comp.glsl", "int c;\n#include \"a/circle_b.glsl\"\n"},
    ShaderFile{"a/circle_b.glsl", "\n\n#include \"a/circle.comp.glsl\"\n"},
    ShaderFile{"a/self.comp.glsl", "#include \"a/self.comp.glsl\"\n"},
    ShaderFile{"a/lost.comp.glsl", "int l;\n#include \"a/nowhere.glsl\"\n"},
    ShaderFile{"a/quiet.comp.glsl", "// #include \"a/nowhere.glsl\"\nint q;"}};

ExpandedShader expand(const std::string& path, Defines defines = {}) {
  return expand_shader({kFiles, {path}, std::move(defines)}, path);
}

/// Sets an environment variable while it lives.
class EnvironmentVariable {
 public:
  EnvironmentVariable(const char* name, const std::string& value) : name_(name) {
    setenv(name, value.c_str(), 1);
  }
  ~EnvironmentVariable() { unsetenv(name_); }
  EnvironmentVariable(const EnvironmentVariable&) = delete;
  EnvironmentVariable& operator=(const EnvironmentVariable&) = delete;

 private:
  const char* name_;
};

TEST(ShaderSource, IncludesEachFileOnceAndKeepsItsLines) {
  const ExpandedShader shader = expand("a/main.comp.glsl", {{"N", "8"}, {"FAST", ""}});
  EXPECT_EQ(shader.text,
            "#version 450 core\n#define N 8\n#define FAST \n"
            "#line 1 0\n#line 1 1\nint one;\n#line 2 0\nint x;\n"
            "#line 1 2\n#line 2 2\nint two;\n#line 4 0\nint y;\n");
  const std::vector<std::string> files{"a/main.comp.glsl", "a/one.glsl", "a/two.glsl"};
  EXPECT_EQ(shader.files, files);
}

TEST(ShaderSource, IgnoresIncludesInComments) {
  EXPECT_EQ(expand("a/quiet.comp.glsl").files.size(), 1U);
}

TEST(ShaderSource, RefusesCircles) {
  tests::expect_error<base::InputError>(
      [] { expand("a/circle.comp.glsl"); },
      "a/circle_b.glsl:3: shader files include each other in a circle: "
      "a/circle.comp.glsl > a/circle_b.glsl > a/circle.comp.glsl");
  tests::expect_error<base::InputError>(
      [] { expand("a/self.comp.glsl"); },
      "a/self.comp.glsl:1: shader files include each other in a circle: "
      "a/self.comp.glsl > a/self.comp.glsl");
}

TEST(ShaderSource, NamesTheLineThatIncludesAMissingFile) {
  tests::expect_error_with<base::InputError>(
      [] { expand("a/lost.comp.glsl"); },
      {"a/lost.comp.glsl:2: no shader file \"a/nowhere.glsl\" is embedded; known: "
       "a/main.comp.glsl, a/one.glsl, "});
}

TEST(ShaderSource, ReadsFromDiskWhereAskedTo) {
  const tests::TemporaryFolder folder;
  std::filesystem::create_directories(folder.path() / "a");
  std::ofstream(folder.path() / "a/main.comp.glsl") << "#include \"a/new.glsl\"\n";
  std::ofstream(folder.path() / "a/new.glsl") << "int fresh;\n";
  const EnvironmentVariable variable("DISCERN_SHADERS", folder.path().string());
  EXPECT_EQ(expand("a/main.comp.glsl").text,
            "#version 450 core\n#line 1 0\n#line 1 1\nint fresh;\n#line 2 0\n");
  tests::expect_error<base::InputError>([] { expand("a/lost.comp.glsl"); },
                                        "cannot read the shader file \"" + folder.path().string() +
                                            "/a/lost.comp.glsl\" (DISCERN_SHADERS is set)");
}

TEST(ShaderSource, EmbedsTheKitsFilesAsTheyAre) {
  bool has_scene = false;
  for (const ShaderFile& file : shader_files()) {
    std::ifstream stream(std::string(tests::kSourceFolder) + "/" + std::string(file.path));
    const std::string text{std::istreambuf_iterator<char>(stream), {}};
    EXPECT_EQ(file.text, text) << file.path;
    // Named by no one, only included.
    has_scene = has_scene || file.path == "renderers/opengl/shaders/scene.glsl";
  }
  EXPECT_TRUE(has_scene);
}

TEST(ReadableLog, NamesFilesForBothDrivers) {
  const std::vector<std::string> files{"a.comp.glsl", "b.glsl"};
  EXPECT_EQ(readable_log("1:12(3): error: `y' undeclared\n0:4(10): warning: hm\n", files),
            "b.glsl:12:3: error: `y' undeclared\na.comp.glsl:4:10: warning: hm");
  EXPECT_EQ(readable_log("1(12) : error C1503: undefined variable \"y\"\n", files),
            "b.glsl:12: error C1503: undefined variable \"y\"");
  EXPECT_EQ(readable_log("Link info\n7(1) : error\n", files), "Link info\n7(1) : error");
}

}  // namespace
}  // namespace renderers::opengl
