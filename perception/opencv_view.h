#pragma once

#include <opencv2/core/mat.hpp>

#include "perception/image.h"

namespace perception {

/// The image's pixels as an OpenCV matrix (rows x columns, CV_32FC(channels)) without a copy; it
/// is valid as long as the image lives unchanged in size. Internal: include it in .cpp files only.
cv::Mat opencv_view(Image& image);
const cv::Mat opencv_view(const Image& image);

}  // namespace perception
