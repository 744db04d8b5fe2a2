#include "renderers/opengl/buffer.h"

#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include <fmt/core.h>
#include <gtest/gtest.h>

#include "tests/expect_error.h"
#include "tests/renderers/opengl/platform_test.h"

namespace renderers::opengl {
namespace {

class BufferGlTest : public PlatformTest {};
INSTANTIATE_TEST_SUITE_P(Platforms, BufferGlTest, all_platforms(), platform_label);

std::vector<std::uint32_t> count_up(std::size_t count) {
  std::vector<std::uint32_t> numbers(count);
  std::iota(numbers.begin(), numbers.end(), 1U);
  return numbers;
}

TEST_P(BufferGlTest, HoldsWhatWasWritten) {
  const auto numbers = count_up(777);
  const Buffer buffer = Buffer::of(context_, std::span<const std::uint32_t>(numbers));
  EXPECT_EQ(buffer.size_bytes(), 777U * 4U);
  EXPECT_EQ(buffer.read<std::uint32_t>(777), numbers);
  const std::vector<std::uint32_t> middle{101, 102};
  EXPECT_EQ(buffer.read<std::uint32_t>(2, 400), middle);
}

TEST_P(BufferGlTest, WritesAtAnOffsetOnly) {
  Buffer buffer = Buffer::of(context_, std::span<const std::uint32_t>(count_up(4)));
  const std::vector<std::uint32_t> piece{50, 60};
  buffer.write(std::span<const std::uint32_t>(piece), 4);
  const std::vector<std::uint32_t> expected{1, 50, 60, 4};
  EXPECT_EQ(buffer.read<std::uint32_t>(4), expected);
}

TEST_P(BufferGlTest, FillsEveryWordEvenOfAnOddSize) {
  Buffer buffer(context_, 10);
  buffer.fill(0xA1B2C3D4U);
  EXPECT_EQ(buffer.read<std::uint32_t>(2), std::vector<std::uint32_t>(2, 0xA1B2C3D4U));
  const std::vector<std::uint8_t> tail{0xD4, 0xC3};
  EXPECT_EQ(buffer.read<std::uint8_t>(2, 8), tail);
}

TEST_P(BufferGlTest, OfNothingCanBeBound) {
  const Buffer buffer = Buffer::of(context_, std::span<const double>());
  EXPECT_NE(buffer.id(), 0U);
  EXPECT_EQ(buffer.size_bytes(), sizeof(double));
}

TEST_P(BufferGlTest, ReserveKeepsWhatIsLargeEnough) {
  Buffer buffer;
  buffer.reserve(context_, 100);
  const std::uint32_t id = buffer.id();
  buffer.fill(7);
  buffer.reserve(context_, 60);
  EXPECT_EQ(buffer.id(), id);
  EXPECT_EQ(buffer.size_bytes(), 100U);
  EXPECT_EQ(buffer.read<std::uint32_t>(1).front(), 7U);
  buffer.reserve(context_, 101);
  EXPECT_EQ(buffer.size_bytes(), 101U);
}

TEST_P(BufferGlTest, MovesLeaveNothingBehind) {
  Buffer first = Buffer::of(context_, std::span<const std::uint32_t>(count_up(3)));
  Buffer second = std::move(first);
  EXPECT_EQ(first.id(), 0U);  // NOLINT: a moved-from buffer is empty
  first = std::move(second);
  EXPECT_EQ(second.id(), 0U);
  EXPECT_EQ(first.read<std::uint32_t>(3), count_up(3));
}

TEST_P(BufferGlTest, RefusesWhatNoStorageBlockHolds) {
  const auto limit = static_cast<std::size_t>(context_->limits().storage_block_bytes);
  tests::expect_error<UnsupportedError>([&] { Buffer(context_, limit + 1); },
                                        fmt::format("a buffer of {} bytes is needed; {} allows {}",
                                                    limit + 1, context_->facts().renderer, limit));
}

}  // namespace
}  // namespace renderers::opengl
