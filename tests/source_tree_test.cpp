#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <regex>
#include <set>
#include <string>

#include "tests/places.h"
#include "tests/source_tree.h"

namespace tests {
namespace {

constexpr std::size_t kMostFileLines = 500;
constexpr std::size_t kMostFunctionLines = 80;
constexpr std::size_t kMostReadmeLines = 150;
constexpr std::uintmax_t kMostPictureBytes = 300'000;

TEST(SourceTree, TopLevelIsWhatTheOwnerFixed) {
  const std::set<std::string> accepted{"CMakeLists.txt", "README.md", "renderers", "metrics",
                                       "perception",     "suites",    "results",   "tests"};
  for (const auto& entry : std::filesystem::directory_iterator(tests::kSourceFolder)) {
    const std::string name = entry.path().filename().string();
    const bool is_build = name == "build" || name.starts_with("build-");
    EXPECT_TRUE(name.starts_with(".") || is_build || accepted.contains(name)) << name;
  }
}

TEST(SourceTree, FilesAndReadmesStayReadable) {
  for (const SourceFile& file : source_files({".h", ".cpp", ".glsl", ".js", ".css", ".txt"})) {
    if (file.path.starts_with("tests/data/")) continue;
    EXPECT_LE(file.lines.size(), kMostFileLines) << file.path;
  }
  for (const SourceFile& file : source_files({".md"})) {
    EXPECT_LE(file.lines.size(), kMostReadmeLines) << file.path;
  }
}

/// True for a line that opens a function body at namespace scope.
bool opens_function(const std::string& line) {
  static const std::regex kOther(
      R"(^(namespace|struct|class|enum|union|extern|const |constexpr |inline constexpr|static const).*)");
  if (line.empty() || line[0] == ' ' || line[0] == '}' || !line.ends_with("{")) return false;
  return !std::regex_match(line, kOther) || line.find('(') != std::string::npos;
}

TEST(SourceTree, FunctionsFitOnAScreen) {
  for (const SourceFile& file : source_files({".h", ".cpp"})) {
    std::size_t begin = 0;
    bool is_open = false;
    for (std::size_t i = 0; i < file.lines.size(); ++i) {
      if (!is_open && opens_function(file.lines[i])) {
        is_open = true;
        begin = i;
      } else if (is_open && file.lines[i] == "}") {
        is_open = false;
        EXPECT_LE(i - begin, kMostFunctionLines) << file.path << ":" << begin + 1;
      }
    }
  }
}

TEST(SourceTree, NoUnfinishedWork) {
  const std::regex unfinished(R"(\b(TO[D]O|FIX[M]E|XX[X])\b|#if[ ]0)");
  for (const SourceFile& file : source_files({".h", ".cpp", ".glsl", ".js", ".css", ".md"})) {
    for (std::size_t i = 0; i < file.lines.size(); ++i) {
      EXPECT_FALSE(std::regex_search(file.lines[i], unfinished)) << file.path << ":" << i + 1;
    }
  }
}

TEST(SourceTree, HeadersSayPragmaOnceFirst) {
  for (const SourceFile& file : source_files({".h"})) {
    ASSERT_FALSE(file.lines.empty()) << file.path;
    EXPECT_EQ(file.lines.front(), "#pragma once") << file.path;
  }
}

TEST(SourceTree, EveryTopFolderHasAReadme) {
  for (const char* folder : {"perception", "metrics", "renderers", "results", "suites", "tests"}) {
    const auto path = std::filesystem::path(tests::kSourceFolder) / folder;
    EXPECT_TRUE(std::filesystem::exists(path / "README.md")) << folder;
    EXPECT_TRUE(std::filesystem::exists(path / "CMakeLists.txt")) << folder;
  }
}

TEST(SourceTree, PicturesAreSmall) {
  const auto folder = std::filesystem::path(tests::kSourceFolder) / ".pictures";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no pictures";
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    EXPECT_LE(entry.file_size(), kMostPictureBytes) << entry.path();
  }
}

}  // namespace
}  // namespace tests
