#pragma once

#include "metrics/metric.h"

namespace metrics {

/// `holes`: share of the pixels that stick out of their neighbourhood as none does in the
/// reference, such as gaps left by upsampling, single shadowed or lit pixels and fireflies; ours.
///
/// With Y the scene-linear luminance (below 0 as 0), R the ring of the pixels whose larger distance
/// in x and y is exactly `radius` (the image's border cuts it) and f a hundredth of the reference's
/// mean luminance over the pixels of the mask (the test's if the reference is black), a pixel is
///   a peak if  Y - max R > threshold max(max R, f),
///   a dip if   min R - Y > threshold max(min R, f).
/// It counts if it is a peak of the test and not of the reference, or a dip of the test and not of
/// the reference. Every pixel of a spot of at most radius x radius pixels on an even ground counts;
/// lines do not, nor do steps. A pixel without a ring (image of 1x1) is neither.
MetricInfo holes_info();

}  // namespace metrics
