// Entry of libFuzzer for one target, DISCERN_FUZZ_TARGET.
#include <cstddef>
#include <cstdint>
#include <string>

#include "perception/base/errors.h"
#include "tests/fuzz/fuzz_targets.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const tests::FuzzTarget& target = tests::fuzz_target(DISCERN_FUZZ_TARGET);
  try {
    target.read(std::string(reinterpret_cast<const char*>(data), size));
  } catch (const base::InputError&) {
    return 0;  // refused in words, as it should be
  }
  return 0;
}
