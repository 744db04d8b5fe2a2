#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "tests/source_tree.h"

namespace tests {
namespace {

/// Kits of renderers/, each after those it may include; techniques may include all of them.
const std::vector<std::string> kKits{"scene",         "contract",          "ray_tracing",
                                     "opengl",        "gpu_tracing",       "shadow_maps",
                                     "many_lights",   "element_hierarchy", "texel_atlas",
                                     "indirect_view", "soft_shadows"};

const std::map<std::string, int> kRanks{
    {"perception", 0}, {"metrics", 1}, {"renderers", 1}, {"results", 2}, {"suites", 3}};

struct Include {
  std::string target;
  bool is_angled = false;
};

std::optional<Include> include_of(const std::string& line) {
  static const std::regex kPattern(R"re(^\s*#\s*include\s*([<"])([^>"]+)[>"])re");
  std::smatch match;
  if (!std::regex_search(line, match, kPattern)) return std::nullopt;
  return Include{match[2], match[1] == "<"};
}

std::vector<std::string> folders_of(const std::string& path) {
  std::vector<std::string> folders;
  std::size_t begin = 0;
  for (std::size_t end = path.find('/'); end != std::string::npos; end = path.find('/', begin)) {
    folders.push_back(path.substr(begin, end - begin));
    begin = end + 1;
  }
  return folders;
}

std::size_t kit_index(const std::string& folder) {
  return static_cast<std::size_t>(std::find(kKits.begin(), kKits.end(), folder) - kKits.begin());
}

/// Why one file of renderers/ may not include another, or nothing.
std::optional<std::string> renderer_violation(const std::string& from, const std::string& to) {
  const auto from_folders = folders_of(from);
  const auto to_folders = folders_of(to);
  if (from_folders.size() < 2) return std::nullopt;  // the list itself sees every technique
  if (to_folders.size() < 2) return "a technique must not see the list of renderers";
  const std::string& from_part = from_folders[1];
  const std::string& to_part = to_folders[1];
  if (from_part == to_part) return std::nullopt;
  const std::size_t to_index = kit_index(to_part);
  if (to_index == kKits.size()) return "a technique is visible to the list of renderers only";
  if (to_index >= kit_index(from_part)) return "a kit includes only kits before it in the list";
  return std::nullopt;
}

bool is_visible_outside_renderers(const std::string& target) {
  return target.starts_with("renderers/contract/") || target.starts_with("renderers/scene/") ||
         target == "renderers/renderer_list.h";
}

/// Why the file may not include the target, or nothing.
std::optional<std::string> violation(const std::string& from, const std::string& target) {
  if (from.starts_with("tests/")) return std::nullopt;
  if (target.starts_with("tests/")) return "nothing includes tests";
  const auto from_folders = folders_of(from);
  const auto to_folders = folders_of(target);
  if (to_folders.empty() || !kRanks.contains(to_folders[0])) {
    return "includes are relative to the root";
  }
  const std::string& from_top = from_folders[0];
  const std::string& to_top = to_folders[0];
  if (from.starts_with("perception/base/") && !target.starts_with("perception/base/")) {
    return "perception/base includes nothing of ours";
  }
  if (from_top == to_top) {
    return from_top == "renderers" ? renderer_violation(from, target) : std::nullopt;
  }
  if (kRanks.at(to_top) >= kRanks.at(from_top)) return "a folder includes only lower ranks";
  if (to_top == "renderers" && !is_visible_outside_renderers(target)) {
    return "outside renderers/ only contract/, scene/ and renderer_list.h are visible";
  }
  return std::nullopt;
}

TEST(IncludeDirection, RunsOneWay) {
  for (const SourceFile& file : source_files({".h", ".cpp", ".glsl"})) {
    for (const std::string& line : file.lines) {
      const auto include = include_of(line);
      if (!include || include->is_angled) continue;
      const auto reason = violation(file.path, include->target);
      EXPECT_FALSE(reason) << file.path << " includes " << include->target << ": " << *reason;
    }
  }
}

/// Headers that show a third-party type; only .cpp files of their own folder include them.
const std::set<std::string> kInternalHeaders{
    "perception/opencv_view.h", "renderers/opengl/gl_functions.h", "results/record_values.h"};

TEST(IncludeDirection, InternalHeadersStayInTheirFolder) {
  for (const SourceFile& file : source_files({".h", ".cpp"})) {
    for (const std::string& line : file.lines) {
      const auto include = include_of(line);
      if (!include || !kInternalHeaders.contains(include->target)) continue;
      const std::string folder = include->target.substr(0, include->target.rfind('/') + 1);
      const bool is_inside = file.path.ends_with(".cpp") &&
                             (file.path.starts_with(folder) || file.path.starts_with("tests/"));
      EXPECT_TRUE(is_inside) << file.path << " includes " << include->target;
    }
  }
}

TEST(IncludeDirection, ThirdPartyHeadersStayOutOfOurs) {
  for (const SourceFile& file : source_files({".h"})) {
    if (file.path.starts_with("tests/") || kInternalHeaders.contains(file.path)) continue;
    for (const std::string& line : file.lines) {
      const auto include = include_of(line);
      if (!include || !include->is_angled) continue;
      const std::string& target = include->target;
      const bool is_third_party =
          target.find('/') != std::string::npos && !target.starts_with("sys/");
      const bool is_allowed = target == "nlohmann/json_fwd.hpp" ||
                              (target.starts_with("glm/") && file.path.starts_with("renderers/"));
      EXPECT_TRUE(!is_third_party || is_allowed) << file.path << " includes <" << target << ">";
    }
  }
}

TEST(IncludeDirection, TheCommandLineParserStandsInOneFile) {
  std::size_t files = 0;
  for (const SourceFile& file : source_files({".h", ".cpp"})) {
    files += static_cast<std::size_t>(
        std::any_of(file.lines.begin(), file.lines.end(), [](const std::string& line) {
          const auto include = include_of(line);
          return include && include->target.starts_with("CLI/");
        }));
  }
  EXPECT_EQ(files, 1U);
}

/// The rules themselves, so that a rule that lets everything pass is noticed.
TEST(IncludeDirection, RefusesWhatItShould) {
  EXPECT_TRUE(violation("metrics/flip.cpp", "renderers/contract/renderer.h"));
  EXPECT_TRUE(violation("renderers/path_tracing/x.cpp", "metrics/metric.h"));
  EXPECT_TRUE(violation("perception/image.h", "metrics/metric.h"));
  EXPECT_TRUE(violation("perception/base/document.h", "perception/image.h"));
  EXPECT_TRUE(violation("results/tables.cpp", "renderers/path_tracing/path_tracer.h"));
  EXPECT_TRUE(violation("results/tables.cpp", "suites/suite_file.h"));
  EXPECT_TRUE(violation("suites/worker.cpp", "tests/temporary_folder.h"));
  EXPECT_TRUE(violation("renderers/path_tracing/x.cpp", "renderers/blank/blank.h"));
  EXPECT_TRUE(violation("renderers/contract/x.h", "renderers/ray_tracing/x.h"));
  EXPECT_TRUE(violation("renderers/path_tracing/x.cpp", "renderers/renderer_list.h"));
  EXPECT_TRUE(violation("suites/a.cpp", "suite_file.h"));
  EXPECT_FALSE(violation("renderers/path_tracing/x.cpp", "renderers/ray_tracing/x.h"));
  EXPECT_FALSE(violation("renderers/renderer_list.cpp", "renderers/blank/blank.h"));
  EXPECT_FALSE(violation("suites/worker.cpp", "renderers/renderer_list.h"));
  EXPECT_FALSE(violation("metrics/flip.cpp", "perception/image.h"));
}

}  // namespace
}  // namespace tests
