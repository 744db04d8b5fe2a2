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

std::span<const FuzzTarget> fuzz_targets();

}  // namespace tests
