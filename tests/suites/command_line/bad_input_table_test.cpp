#include <algorithm>
#include <cstdio>
#include <fstream>
#include <iterator>

#include <fmt/format.h>

#include "perception/base/atomic_file.h"
#include "tests/suites/command_line/bad_input_rows.h"
#include "tests/suites/command_line/program_test.h"

namespace tests {
namespace {

namespace fs = std::filesystem;

/// "@" for the folder of the test, as the table has it.
std::string shortened(std::string text, const std::string& folder) {
  const std::string prefix = folder + "/";
  for (std::size_t at = text.find(prefix); at != std::string::npos; at = text.find(prefix)) {
    text.replace(at, prefix.size(), "@");
  }
  return text;
}

std::string bytes_of(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// A small PFM file of one value.
std::string pfm(float value) {
  std::string bytes = "PF\n8 8\n-1.0\n";
  for (int i = 0; i < 8 * 8 * 3; ++i) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof(value));
  }
  return bytes;
}

/// Gives the program one bad input after the other and prints the table of what it says.
class BadInputTable : public ProgramTest {
 protected:
  BadInputTable() {
    write_text("suite.yaml", kGoodSuite);
    write_text("scene.yaml", kGoodScene);
    write_text("broken-run/run.json", "{");
    fs::create_directory(path("folder.exr"));
    fs::create_symlink(path("gone.exr"), path("dangling.exr"));
    fs::create_symlink(path("loop.exr"), path("loop.exr"));
  }

  void write_meshes() const {
    const std::string scene = kGoodScene;
    const std::size_t from = scene.find("quad:");
    const std::size_t size = scene.find("}, material", from) + 1 - from;
    for (const std::string kind : {"obj", "ply", "3ds", "gltf", "glb", "stl"}) {
      write_text("mesh-" + kind + ".yaml",
                 std::string(scene).replace(from, size, "mesh: {file: a." + kind + "}"));
    }
  }

  void write_images() const {
    const auto picture = [&](const std::string& size, const std::string& file) {
      const auto made = discern({"render", "--scene", path("scene.yaml"), "--renderer", "path",
                                 "--size", size, "--samples", "4", "--out", path(file)});
      ASSERT_EQ(made.exit.code, 0) << made.stderr_text;
    };
    picture("8x8", "first.exr");
    picture("8x8", "first.png");
    picture("4x8", "other-size.exr");
    write_text("cut.exr", bytes_of(path("first.exr")).substr(0, 600));
    write_text("cut.png", bytes_of(path("first.png")).substr(0, 70));
    write_text("zero.pfm", pfm(0.0F));
    write_text("half.pfm", pfm(0.5F));
    write_text("nan.pfm", pfm(std::numeric_limits<float>::quiet_NaN()));
  }

  void apply(const FileEdit& edit) const {
    const std::string good = edit.file == "suite.yaml"   ? kGoodSuite
                             : edit.file == "scene.yaml" ? kGoodScene
                                                         : "";
    if (edit.from.empty() || edit.from == "*") {
      write_text(edit.file, edit.to);
      return;
    }
    const std::size_t at = good.find(edit.from);
    ASSERT_NE(at, std::string::npos) << edit.from;
    write_text(edit.file, std::string(good).replace(at, edit.from.size(), edit.to));
  }

  std::vector<std::string> command_of(const BadInputRow& row) const {
    std::vector<std::string> words = row.words;
    for (std::string& word : words) {
      if (word.starts_with('@')) word = path(word.substr(1));
    }
    return words;
  }

  /// True if it is the row's message, or begins so where the row ends in "...".
  static bool is_message(const BadInputRow& row, const std::string& text) {
    if (!row.message.ends_with("...")) return text == row.message;
    return text.starts_with(row.message.substr(0, row.message.size() - 3));
  }

  /// One line of the table.
  void check(const std::string& kind, const BadInputRow& row) const {
    if (!row.edit.file.empty()) apply(row.edit);
    std::vector<std::string> words = command_of(row);
    const base::CommandResult result = discern(words);
    const std::string error = "discern: error: ";
    std::string text = shortened(result.stderr_text, folder().string());
    const bool is_error = text.starts_with(error) && text.ends_with('\n');
    EXPECT_TRUE(is_error) << kind << ", " << row.what << ": " << text;
    if (is_error) text = text.substr(error.size(), text.size() - error.size() - 1);
    EXPECT_TRUE(is_message(row, text)) << kind << ", " << row.what << ": " << text;
    EXPECT_EQ(result.exit.code, row.exit_code) << kind << ", " << row.what;
    EXPECT_EQ(result.exit.signal, 0) << kind << ", " << row.what;
    EXPECT_EQ(result.stdout_text, "") << kind << ", " << row.what;
    fmt::print("| {} | {} | {} | {} |\n", kind, row.what, result.exit.code, text);
    if (row.edit.file == "suite.yaml") write_text("suite.yaml", kGoodSuite);
    if (row.edit.file == "scene.yaml") write_text("scene.yaml", kGoodScene);
  }

  void check_all(const std::string& kind, const std::vector<BadInputRow>& rows) const {
    ASSERT_FALSE(rows.empty());
    fmt::print("| input | what is bad | exit code | message |\n|---|---|---|---|\n");
    for (const BadInputRow& row : rows) check(kind, row);
  }
};

/// A row is worth something only where nothing else is wrong.
TEST_F(BadInputTable, WhatTheRowsChangeIsAcceptedAsItIs) {
  EXPECT_EQ(discern({"check", path("suite.yaml")}).exit.code, 0);
  std::vector<std::string> words = command_of({"", {}, render(), "", 0});
  EXPECT_EQ(discern(words).exit.code, 0);
}

TEST_F(BadInputTable, Suites) { check_all("suite", bad_suites()); }

TEST_F(BadInputTable, ClaimsFiguresAndGates) { check_all("claims", bad_claims()); }

TEST_F(BadInputTable, Scenes) { check_all("scene", bad_scenes()); }

TEST_F(BadInputTable, Meshes) {
  write_meshes();
  check_all("mesh", bad_meshes());
}

TEST_F(BadInputTable, Images) {
  write_images();
  check_all("image", bad_images());
}

TEST_F(BadInputTable, Options) {
  write_images();
  check_all("options", bad_options());
}

/// The same reason where a program reads it.
TEST_F(BadInputTable, JsonSaysTheSame) {
  for (const auto* rows : {&bad_suites(), &bad_claims(), &bad_scenes()}) {
    for (const BadInputRow& row : *rows) {
      apply(row.edit);
      std::vector<std::string> words = command_of(row);
      words.emplace_back("--json");
      const base::CommandResult result = discern(words);
      EXPECT_EQ(result.exit.code, row.exit_code) << row.what;
      EXPECT_EQ(result.stderr_text, "") << row.what;
      const auto json = nlohmann::ordered_json::parse(result.stdout_text, nullptr, false);
      ASSERT_TRUE(json.is_object()) << row.what << result.stdout_text;
      EXPECT_EQ(json.value("status", ""), "error") << row.what;
      EXPECT_EQ(json.value("exit_code", 0), row.exit_code) << row.what;
      const std::string reason = shortened(json.value("reason", ""), folder().string());
      EXPECT_TRUE(is_message(row, reason)) << row.what << ": " << reason;
      write_text("suite.yaml", kGoodSuite);
      write_text("scene.yaml", kGoodScene);
    }
  }
}

}  // namespace
}  // namespace tests
