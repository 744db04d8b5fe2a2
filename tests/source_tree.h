#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "tests/places.h"

namespace tests {

/// One text file of the source tree.
struct SourceFile {
  std::string path;  ///< relative to the root, with forward slashes
  std::vector<std::string> lines;
};

inline bool has_extension(const std::string& path, std::initializer_list<const char*> extensions) {
  for (const char* extension : extensions) {
    if (path.ends_with(extension)) return true;
  }
  return false;
}

/// The tree's files with one of the extensions, outputs and hidden folders left out.
inline std::vector<SourceFile> source_files(std::initializer_list<const char*> extensions) {
  const std::filesystem::path root = tests::kSourceFolder;
  std::vector<SourceFile> files;
  for (const char* folder : {"perception", "metrics", "renderers", "results", "suites", "tests"}) {
    for (auto entry = std::filesystem::recursive_directory_iterator(root / folder);
         entry != std::filesystem::recursive_directory_iterator(); ++entry) {
      const std::string path = std::filesystem::relative(entry->path(), root).generic_string();
      const bool is_output =
          path == "results/runs" || path == "results/references" || path == "results/baselines";
      if (is_output) entry.disable_recursion_pending();
      if (!entry->is_regular_file() || !has_extension(path, extensions)) continue;
      SourceFile file{path, {}};
      std::ifstream stream(entry->path());
      for (std::string line; std::getline(stream, line);) file.lines.push_back(line);
      files.push_back(std::move(file));
    }
  }
  return files;
}

}  // namespace tests
