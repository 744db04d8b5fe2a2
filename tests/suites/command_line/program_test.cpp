#include "tests/suites/command_line/program_test.h"
#include "tests/places.h"

#include <unistd.h>

#include <algorithm>
#include <chrono>

#include "perception/base/atomic_file.h"
#include "perception/image_file.h"

namespace tests {

namespace {

constexpr std::chrono::duration<double> kTimeout{120.0};
constexpr const char* kPython = "/usr/bin/python3";

std::filesystem::path fresh_folder() {
  std::string pattern = (std::filesystem::temp_directory_path() / "discern-test-XXXXXX").string();
  if (mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("no temporary folder");
  return pattern;
}

}  // namespace

ProgramTest::ProgramTest() : folder_(fresh_folder()) {}

ProgramTest::~ProgramTest() {
  std::error_code ignored;
  std::filesystem::remove_all(folder_, ignored);
}

std::vector<std::pair<std::string, std::string>> ProgramTest::environment() const {
  return {{"DISCERN_RESULTS", path("results")}};
}

base::CommandResult ProgramTest::discern(const std::vector<std::string>& words) const {
  std::vector<std::string> command{tests::kProgram};
  command.insert(command.end(), words.begin(), words.end());
  return base::run_command(command, kTimeout, environment());
}

nlohmann::ordered_json ProgramTest::discern_json(std::vector<std::string> words,
                                                 const std::string& schema, int exit_code) const {
  words.emplace_back("--json");
  const base::CommandResult result = discern(words);
  EXPECT_EQ(result.exit.code, exit_code) << result.stdout_text << result.stderr_text;
  EXPECT_EQ(schema_problems(schema, result.stdout_text), "") << result.stdout_text;
  return nlohmann::ordered_json::parse(result.stdout_text, nullptr, false);
}

void ProgramTest::expect_refused(const std::vector<std::string>& words, const std::string& message,
                                 int exit_code) const {
  const base::CommandResult result = discern(words);
  EXPECT_EQ(result.exit.code, exit_code);
  EXPECT_EQ(result.stderr_text, "discern: error: " + message + "\n");
  EXPECT_EQ(result.stdout_text, "");
}

std::string ProgramTest::schema_problems(const std::string& schema, const std::string& json) const {
  const base::CommandResult printed = discern({"schema", schema});
  if (printed.exit.code != 0) return printed.stderr_text;
  const std::string script =
      std::string(tests::kSourceFolder) + "/tests/suites/command_line/validate_json.py";
  const base::CommandResult checked =
      base::run_command({kPython, script, write_text("schema.json", printed.stdout_text),
                         write_text("checked.json", json)},
                        kTimeout);
  return checked.exit.code == 0 ? "" : checked.stdout_text + checked.stderr_text;
}

std::string ProgramTest::write_text(const std::string& name, const std::string& text) const {
  std::filesystem::create_directories(std::filesystem::path(path(name)).parent_path());
  base::write_text_file(path(name), text);
  return path(name);
}

std::string ProgramTest::write_image(const std::string& name, int width_px, int height_px,
                                     float value) const {
  perception::Image image =
      perception::make_rgb_image(width_px, height_px, perception::Encoding::scene_linear);
  std::fill(image.pixels.begin(), image.pixels.end(), value);
  return write_image(name, image);
}

std::string ProgramTest::write_image(const std::string& name,
                                     const perception::Image& image) const {
  perception::ImageFile file;
  file.parts.push_back({"radiance", image});
  perception::write_exr(path(name), file);
  return path(name);
}

}  // namespace tests
