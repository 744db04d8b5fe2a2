#pragma once

#include <string>
#include <vector>

namespace tests {

/// Puts text into a file before the program runs.
struct FileEdit {
  std::string file;  ///< in the test's folder; "": none
  std::string
      from;  ///< "" or "*": the whole file, else the first such text of suite.yaml, scene.yaml
  std::string to;
};

/// One bad input and what the program says to it. "@" stands for the test's folder and a slash.
struct BadInputRow {
  std::string what;
  FileEdit edit;
  std::vector<std::string> words;  ///< "@" at the beginning of a word
  std::string message;             ///< of stderr; "..." at its end: what follows is not compared
  int exit_code = 2;
};

/// The files that rows change in one place; each is accepted as it is.
extern const char* const kGoodSuite;
extern const char* const kGoodScene;

/// Words of `check suite.yaml`, and of rendering a scene.
extern const std::vector<std::string> kCheck;
std::vector<std::string> render(const std::string& scene = "@scene.yaml");

/// The table, a list for each kind of input.
const std::vector<BadInputRow>& bad_suites();
const std::vector<BadInputRow>& bad_claims();
const std::vector<BadInputRow>& bad_scenes();
const std::vector<BadInputRow>& bad_meshes();
const std::vector<BadInputRow>& bad_images();
const std::vector<BadInputRow>& bad_options();

}  // namespace tests
