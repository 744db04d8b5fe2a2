#include "perception/pfm_file.h"

#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "perception/base/atomic_file.h"
#include "perception/base/errors.h"
#include "tests/expect_error.h"
#include "tests/temporary_folder.h"

namespace perception {
namespace {

std::string float_bytes(const std::vector<float>& values, bool is_swapped) {
  std::string bytes;
  for (const float value : values) {
    auto bits = std::bit_cast<std::uint32_t>(value);
    if (is_swapped) bits = __builtin_bswap32(bits);
    char piece[4];
    std::memcpy(piece, &bits, 4);
    bytes.append(piece, 4);
  }
  return bytes;
}

class PfmFile : public testing::Test {
 protected:
  std::filesystem::path file(const std::string& bytes) {
    base::write_text_file(folder_.path() / "x.pfm", bytes);
    return folder_.path() / "x.pfm";
  }
  tests::TemporaryFolder folder_;
};

TEST_F(PfmFile, StoresTheBottomRowFirst) {
  const ImageFile read =
      read_pfm(file("Pf\n2 2\n-1.0\n" + float_bytes({3, 4, 1, 2}, false)), std::nullopt);
  const Image& image = read.parts.front().image;
  EXPECT_EQ(image.pixels, (std::vector<float>{1, 2, 3, 4}));
  EXPECT_EQ(image.channels, std::vector<std::string>{"Y"});
  EXPECT_EQ(image.encoding, Encoding::scene_linear);
}

TEST_F(PfmFile, ReadsBothByteOrders) {
  const std::vector<float> rgb{0.25F, -1e-20F, 1e20F};
  const auto little = file("PF\n1 1\n-1.0\n" + float_bytes(rgb, false));
  EXPECT_EQ(read_pfm(little, std::nullopt).parts.front().image.pixels, rgb);
  const auto big = file("PF\n1 1\n1.0\n" + float_bytes(rgb, true));
  EXPECT_EQ(read_pfm(big, Encoding::luminance_cd_m2).parts.front().image.pixels, rgb);
}

TEST_F(PfmFile, BadInputSaysWhy) {
  const auto path = (folder_.path() / "x.pfm").string();
  const auto read = [this](const std::string& bytes) { read_pfm(file(bytes), std::nullopt); };
  tests::expect_error<base::InputError>(
      [&] { read("P6\n1 1\n255\nabc"); },
      path + ": cannot be read as PFM: it does not begin with PF or Pf");
  tests::expect_error<base::InputError>(
      [&] {
        read("PF\n2 2\n-1.0\n" + float_bytes({1, 2, 3}, false));
      },
      path + ": cannot be read as PFM: it has 24 bytes; its header asks for 60");
  for (const char* bad : {"PF\n0 1\n-1\n", "PF\n1 1\n0\n", "PF\n1", "PF\n99999 99999\n-1\n",
                          "PF\nx 1\n-1\n", "PF\n1 1\nnan\n"}) {
    tests::expect_error_with<base::InputError>([&] { read(bad); }, {path, "bad header"});
  }
}

}  // namespace
}  // namespace perception
