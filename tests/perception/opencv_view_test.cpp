#include "perception/opencv_view.h"

#include <gtest/gtest.h>

namespace perception {
namespace {

TEST(OpencvView, SharesThePixels) {
  Image image(3, 2, {"R", "G", "B"}, Encoding::scene_linear);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = static_cast<float>(i);
  cv::Mat view = opencv_view(image);
  EXPECT_EQ(view.rows, 2);
  EXPECT_EQ(view.cols, 3);
  EXPECT_EQ(view.type(), CV_32FC3);
  EXPECT_EQ(view.at<cv::Vec3f>(1, 2)[1], image.at(2, 1, 1));
  view.at<cv::Vec3f>(0, 1)[2] = -5.0F;
  EXPECT_EQ(image.at(1, 0, 2), -5.0F);
}

TEST(OpencvView, OfAConstImageSharesToo) {
  const Image image = make_gray_image(4, 3, "Y", Encoding::display);
  const cv::Mat view = opencv_view(image);
  EXPECT_EQ(view.type(), CV_32FC1);
  EXPECT_EQ(static_cast<const void*>(view.data), static_cast<const void*>(image.pixels.data()));
}

}  // namespace
}  // namespace perception
