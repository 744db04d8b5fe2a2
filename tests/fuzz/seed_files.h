#pragma once

#include <filesystem>
#include <initializer_list>
#include <string>
#include <vector>

#include "perception/base/atomic_file.h"

namespace tests {

using Seeds = std::vector<std::string>;

/// Files of the source tree as well-formed inputs.
inline Seeds files_of(const std::filesystem::path& folder,
                      std::initializer_list<const char*> names) {
  Seeds seeds;
  for (const char* name : names) seeds.push_back(base::read_text_file(folder / name));
  return seeds;
}

}  // namespace tests
