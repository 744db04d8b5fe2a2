// One reader as a libFuzzer target, DISCERN_FUZZ_READER; built with -DDISCERN_FUZZ=ON.
//   fuzz_gltf --write-seeds=DIR      well-formed inputs and, beside the folder, DIR.dict: words
//   fuzz_gltf -max_total_time=60 -dict=DIR.dict DIR
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <string_view>
#include <typeinfo>

#include <fmt/format.h>

#include "perception/base/atomic_file.h"
#include "perception/base/errors.h"
#include "tests/fuzz/fuzz_targets.h"
#include "tests/fuzz/mutation.h"

namespace {

namespace fs = std::filesystem;

const tests::FuzzTarget& target() {
  static const tests::FuzzTarget& found = []() -> const tests::FuzzTarget& {
    const auto targets = tests::DISCERN_FUZZ_TABLE();
    const auto is_it = [](const tests::FuzzTarget& one) {
      return std::string_view(one.name) == DISCERN_FUZZ_READER;
    };
    const auto at = std::ranges::find_if(targets, is_it);
    if (at != targets.end()) return *at;
    fmt::print(stderr, "no reader is called {}\n", DISCERN_FUZZ_READER);
    std::exit(2);
  }();
  return found;
}

void write_seeds(const fs::path& folder) {
  fs::create_directories(folder);
  const std::vector<std::string> seeds = target().seeds();
  for (std::size_t i = 0; i < seeds.size(); ++i) {
    base::write_text_file(folder / fmt::format("seed-{}", i), seeds[i]);
  }
  std::string dictionary;
  for (const std::string& word : tests::words_of(seeds)) dictionary += "\"" + word + "\"\n";
  base::write_text_file(folder.string() + ".dict", dictionary);
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
  constexpr std::string_view kWriteSeeds = "--write-seeds=";
  for (int i = 1; i < *argc; ++i) {
    const std::string_view word = (*argv)[i];
    if (!word.starts_with(kWriteSeeds)) continue;
    write_seeds(word.substr(kWriteSeeds.size()));
    std::exit(0);
  }
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    target().read(std::string(reinterpret_cast<const char*>(data), size));
  } catch (const base::InputError& error) {
    if (*error.what() == '\0') std::abort();
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}: {}\n", typeid(error).name(), error.what());
    std::abort();
  }
  return 0;
}
