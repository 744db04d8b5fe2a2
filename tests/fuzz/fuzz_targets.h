#pragma once

#include <span>
#include <string>
#include <vector>

/// What reads bytes that a stranger may have written. A target may refuse them with
/// base::InputError; anything else that comes of them is a bug.
namespace tests {

struct FuzzTarget {
  const char* name;
  std::vector<std::string> (*seeds)();     ///< well-formed inputs, of which others are made
  void (*read)(const std::string& bytes);  ///< throws base::InputError for what is refused
};

/// Readers of scenes, claims, records, meshes and pictures, which need no renderer.
std::span<const FuzzTarget> file_targets();

/// Readers of suites and worker lines, which know every renderer.
std::span<const FuzzTarget> suite_targets();

}  // namespace tests
