#include "perception/opencv_view.h"

namespace perception {

cv::Mat opencv_view(Image& image) {
  return cv::Mat(image.height_px, image.width_px, CV_32FC(image.channel_count()),
                 image.pixels.data());
}

const cv::Mat opencv_view(const Image& image) {
  // cv::Mat has no read-only form; the const result keeps its pixels from being written through it.
  return cv::Mat(image.height_px, image.width_px, CV_32FC(image.channel_count()),
                 const_cast<float*>(image.pixels.data()));
}

}  // namespace perception
