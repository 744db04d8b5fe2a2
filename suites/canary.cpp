#include "suites/canary.h"

#include <chrono>
#include <numeric>

#include "perception/base/parallel.h"

namespace suites {

namespace {

constexpr std::uint32_t kTableEntries = 1U << 21U;  // of 4 bytes: more than a core's own caches
constexpr std::size_t kPieces = 64;
constexpr int kStepsPerPiece = 1 << 13;

/// A linear congruential step, modulus 2^32: Numerical Recipes, 2nd ed., Sec. 7.1 "Quick and dirty"
/// (constants recalled; any odd increment would do here).
std::uint32_t next(std::uint32_t state) { return state * 1664525U + 1013904223U; }

/// Every step depends on the one before, so that no compiler and no core can skip any.
std::uint64_t work_of(std::size_t piece, const std::vector<std::uint32_t>& table) {
  auto state = static_cast<std::uint32_t>(piece);
  std::uint64_t sum = 0;
  for (int step = 0; step < kStepsPerPiece; ++step) {
    for (int i = 0; i < 4; ++i) state = next(state);
    state ^= table[state >> 11U];
    sum += state;
  }
  return sum;
}

}  // namespace

Canary::Canary() : table_(kTableEntries) {
  std::uint32_t state = 1;
  for (std::uint32_t& entry : table_) entry = state = next(state);
  run();
}

CanaryResult Canary::run() const {
  std::vector<std::uint64_t> sums(kPieces);
  const auto start = std::chrono::steady_clock::now();
  base::parallel_for(kPieces, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t piece = begin; piece < end; ++piece) sums[piece] = work_of(piece, table_);
  });
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
  return {wall.count(), std::accumulate(sums.begin(), sums.end(), std::uint64_t{0})};
}

}  // namespace suites
