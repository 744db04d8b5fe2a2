#include "suites/picture_memory.h"

#include <gtest/gtest.h>

namespace suites {
namespace {

TEST(PictureMemory, SaysWhatIsNeededAndWhatThereIs) {
  const std::int64_t have_bytes = std::int64_t{6} << 30;
  EXPECT_EQ(lack_of_memory({16384, 16384}, 3, 2, have_bytes).value_or("fits"), "fits");
  EXPECT_EQ(lack_of_memory({16384, 16384}, 3, 2, have_bytes - 1).value_or("fits"),
            "a picture of 16384x16384 pixels takes at least 6.00 GiB of memory (3 channels of 4 "
            "bytes, 2 copies); 6.00 GiB are available; accepted: a smaller size, or a machine with "
            "more memory");
  EXPECT_EQ(lack_of_memory({16384, 16384}, 19, 2, have_bytes).value_or("fits"),
            "a picture of 16384x16384 pixels takes at least 38.0 GiB of memory (19 channels of 4 "
            "bytes, 2 copies); 6.00 GiB are available; accepted: a smaller size, or a machine with "
            "more memory");
}

TEST(PictureMemory, SmallPicturesAreNotRefused) {
  EXPECT_FALSE(lack_of_memory({1024, 1024}, 19, 2, 0).has_value());
  EXPECT_TRUE(lack_of_memory({4096, 4096}, 19, 2, 0).has_value());
}

TEST(PictureMemory, NothingIsRefusedWhereMemoryIsNotKnown) {
  EXPECT_FALSE(lack_of_memory({65536, 65536}, 100, 2, std::nullopt).has_value());
}

TEST(PictureMemory, AFrameIsItsRadianceAndItsOtherImages) {
  renderers::Frame frame;
  EXPECT_EQ(channel_count(frame), 0U);
  frame.radiance = perception::make_rgb_image(2, 2, perception::Encoding::scene_linear);
  frame.aovs.push_back(
      {"depth", perception::make_gray_image(2, 2, "Z", perception::Encoding::scene_linear)});
  EXPECT_EQ(channel_count(frame), 4U);
}

}  // namespace
}  // namespace suites
