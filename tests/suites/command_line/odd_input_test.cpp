#include <unistd.h>

#include <array>
#include <cstdint>
#include <fstream>

#include <fmt/format.h>

#include "perception/image_file.h"
#include "tests/places.h"
#include "tests/suites/command_line/bad_input_rows.h"
#include "tests/suites/command_line/program_test.h"

namespace tests {
namespace {

namespace fs = std::filesystem;

/// Inputs that look strange and are good.
class OddInput : public ProgramTest {
 protected:
  /// Runs the program and expects it to succeed.
  std::string done(const std::vector<std::string>& words) const {
    const base::CommandResult result = discern(words);
    EXPECT_EQ(result.exit.code, 0) << result.stderr_text;
    EXPECT_EQ(result.exit.signal, 0) << result.stderr_text;
    return result.stdout_text;
  }

  void render(const std::string& scene, const std::string& size, const std::string& out) const {
    done({"render", "--scene", scene, "--renderer", "path", "--size", size, "--samples", "2",
          "--out", out});
  }

  /// Suite and scene below a folder, with a mesh of one triangle.
  std::string write_suite(const std::string& name) const {
    std::string scene = kGoodScene;
    const std::size_t from = scene.find("quad:");
    const std::size_t size = scene.find("}, material", from) + 1 - from;
    write_text(name + "/a b.obj", "v -1 0 -1\nv 0 0 1\nv 1 0 -1\nf 1 2 3\n");
    write_text(name + "/scene.yaml", scene.replace(from, size, "mesh: {file: a b.obj}"));
    return write_text(name + "/suite.yaml",
                      std::string(kGoodSuite) + "figures: [{id: f, kind: pareto, y: [relmse]}]\n");
  }
};

TEST_F(OddInput, PathsWithSpacesQuotesAndLettersOfOtherAlphabets) {
  for (const std::string name : {"a b", "schön 場 é", "it's \"quoted\"", "-dash", "$HOME `x`"}) {
    const std::string suite = write_suite(name);
    const std::string results = path(name + "/results of it");
    done({"run", suite, "--results", results});
    done({"report", "last", "--results", results});
    done({"figure", suite, "--results", results});
    const std::string image = path(name + "/ü 1.png");
    render(path(name + "/scene.yaml"), "8x8", image);
    done({"diff", image, image, "--metric", "flip", "--map-dir", path(name + "/the maps")});
    EXPECT_TRUE(fs::exists(path(name + "/the maps"))) << name;
    EXPECT_FALSE(fs::is_empty(path(name + "/the maps"))) << name;
  }
}

TEST_F(OddInput, SymbolicLinksAreFollowedOnReading) {
  const std::string suite = write_suite("real");
  fs::create_directory_symlink(path("real"), path("linked"));
  fs::create_symlink(suite, path("real/link.yaml"));
  fs::create_directories(path("elsewhere"));
  fs::create_directory_symlink(path("elsewhere"), path("results"));
  done({"run", path("linked/link.yaml")});
  EXPECT_TRUE(fs::exists(path("elsewhere/runs/small")));
  render(path("linked/scene.yaml"), "8x8", path("a.exr"));
  fs::create_symlink(path("a.exr"), path("b.exr"));
  done({"diff", path("a.exr"), path("b.exr")});
}

TEST_F(OddInput, AnOutputThatIsALinkIsReplacedAndItsTargetKept) {
  write_suite("real");
  write_text("precious.txt", "precious\n");
  fs::create_symlink(path("precious.txt"), path("a.exr"));
  render(path("real/scene.yaml"), "8x8", path("a.exr"));
  EXPECT_FALSE(fs::is_symlink(path("a.exr")));
  EXPECT_EQ(fs::file_size(path("precious.txt")), 9U);
}

TEST_F(OddInput, EveryMetricTakesOnePixel) {
  write_suite("real");
  render(path("real/scene.yaml"), "1x1", path("one.exr"));
  render(path("real/scene.yaml"), "1x1", path("one.png"));
  std::vector<std::string> words;
  const auto list = nlohmann::json::parse(done({"list", "metrics", "--json"}));
  for (const auto& metric : list.at("metrics")) {
    if (metric["name"] == "flicker") continue;  // of sequences
    words.insert(words.end(), {"--metric", metric["name"]});
  }
  ASSERT_GT(words.size(), 20U);
  for (const char* file : {"one.exr", "one.png"}) {
    std::vector<std::string> diff{"diff", path(file), path(file)};
    diff.insert(diff.end(), words.begin(), words.end());
    done(diff);
    done({"thresholds", path(file), "--out", path("maps")});
  }
}

/// As wide and as high as a 16K display.
TEST_F(OddInput, LinesOfSixteenThousandPixels) {
  for (const auto& [width, height] : {std::pair{15360, 3}, std::pair{3, 15360}}) {
    for (const char* file : {"long.exr", "long.png"}) {
      if (std::string(file) == "long.exr") {
        write_image(file, width, height, 0.5F);
      } else {
        const perception::Image image(width, height, {"R", "G", "B"},
                                      perception::Encoding::display);
        perception::write_png(path(file), image);
      }
      const std::string text =
          done({"diff", path(file), path(file), "--metric", "mse", "--metric", "flip", "--metric",
                "visible-difference", "--at", fmt::format("{},{}", width - 1, height - 1)});
      EXPECT_NE(text.find("mse"), std::string::npos);
    }
  }
}

void append(std::string& bytes, const void* values, std::size_t size) {
  bytes.append(static_cast<const char*>(values), size);
}

/// A square of 708 x 708 vertices, 999,698 triangles, as binary PLY.
std::string million_triangles() {
  constexpr std::int32_t kSide = 708;
  std::string bytes = fmt::format(
      "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\n"
      "property float y\nproperty float z\nelement face {}\n"
      "property list uchar int vertex_indices\nend_header\n",
      kSide * kSide, 2 * (kSide - 1) * (kSide - 1));
  for (int i = 0; i < kSide; ++i) {
    for (int j = 0; j < kSide; ++j) {
      const float position[3] = {2.0F * static_cast<float>(i) / kSide - 1.0F, 0.0F,
                                 2.0F * static_cast<float>(j) / kSide - 1.0F};
      append(bytes, position, sizeof(position));
    }
  }
  for (std::int32_t i = 0; i + 1 < kSide; ++i) {
    for (std::int32_t j = 0; j + 1 < kSide; ++j) {
      const std::int32_t a = i * kSide + j;
      for (const auto& corners :
           {std::array{a, a + 1, a + kSide}, std::array{a + 1, a + kSide + 1, a + kSide}}) {
        bytes += '\3';
        append(bytes, corners.data(), sizeof(corners));
      }
    }
  }
  return bytes;
}

TEST_F(OddInput, AMeshOfAMillionTriangles) {
  write_suite("real");
  std::ofstream(path("real/big.ply"), std::ios::binary) << million_triangles();
  const std::string scene = write_text("real/big.yaml",
                                       "schema: 1\ninclude: scene.yaml\nobjects: [{name: floor, "
                                       "mesh: {file: big.ply}, material: white}]\n");
  const auto plan = nlohmann::json::parse(
      done({"check", "--scene", scene, "--method", "path", "--samples", "1", "--json"}));
  EXPECT_EQ(plan["scenes"][0]["faces"], 999698);
  render(scene, "8x8", path("a.exr"));
}

/// Words that run a command as a user who may write nowhere but below one folder.
std::vector<std::string> as_another_user() {
  return {"/usr/bin/setpriv", "--reuid=65534", "--regid=65534", "--clear-groups"};
}

TEST_F(OddInput, AHomeFolderThatCannotBeWrittenIsNotNeeded) {
  write_suite("real");
  fs::create_directory(path("home"));
  fs::permissions(path("home"), fs::perms::owner_read | fs::perms::owner_exec);
  auto variables = environment();
  for (const char* name : {"HOME", "XDG_CACHE_HOME", "XDG_CONFIG_HOME", "TMPDIR"}) {
    variables.emplace_back(name, path("home"));
  }
  // Root may write anywhere: another user then, if the program is where that one can reach it.
  std::vector<std::string> prefix;
  if (geteuid() == 0) {
    prefix = as_another_user();
    fs::permissions(folder(), fs::perms::all);
    auto reach = prefix;
    reach.insert(reach.end(), {kProgram, "--version"});
    auto write = prefix;
    write.insert(write.end(), {"/usr/bin/test", "-w", folder()});
    for (const auto& probe : {reach, write}) {
      if (base::run_command(probe, std::chrono::seconds(60)).exit.code != 0) {
        GTEST_SKIP() << "no other user can run " << kProgram << " in " << folder();
      }
    }
  }
  for (const std::string renderer : {"path", "instant-radiosity"}) {
    auto words = prefix;
    words.insert(words.end(), {kProgram, "render", "--scene", "cornell-box-spot", "--renderer",
                               renderer, "--size", "8x8", "--out", path(renderer + ".png")});
    const auto result = base::run_command(words, std::chrono::seconds(400), variables);
    EXPECT_EQ(result.exit.code, 0) << renderer << ": " << result.stderr_text;
  }
  // What is to be written there is refused, with the folder.
  auto words = prefix;
  words.insert(words.end(), {kProgram, "run", path("real/suite.yaml"), "--results", path("home")});
  const auto run = base::run_command(words, std::chrono::seconds(400), variables);
  EXPECT_EQ(run.exit.code, 2);
  EXPECT_EQ(run.stderr_text.find("discern: error: " + path("home")), 0U) << run.stderr_text;
  EXPECT_NE(run.stderr_text.find("Permission denied"), std::string::npos) << run.stderr_text;
  EXPECT_TRUE(fs::is_empty(path("home")));
}

}  // namespace
}  // namespace tests
