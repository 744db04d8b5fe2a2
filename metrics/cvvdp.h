#pragma once

#include <array>

#include "metrics/metric.h"

/// ColorVideoVDP for still pictures: quality in just-objectionable differences, from a model of
/// contrast sensitivity and masking in three colour channels on a display of known light.
///
/// Source: Mantiuk, Hanji, Ashraf, Asano, Chapiro 2024, ColorVideoVDP: A visual difference
/// predictor for image, video and display distortions, ACM Trans. Graphics 43(4),
/// doi:10.1145/3658144. Constants and steps are those of the authors' program, version 0.5.7 (MIT
/// licence, (c) its authors), which is written here anew.
namespace metrics {

/// Light of linear Rec.709 in cd/m2 to the opponent space DKL with a white of D65: achromatic
/// (cd/m2), red-green, violet-yellow; by way of XYZ and the cone responses of CIE 2006.
std::array<double, 3> cvvdp_opponent_of(const std::array<double, 3>& light_cd_m2);

/// Quality of a pooled difference, JOD: 10 - 0.044 q^0.93, a line below q = 0.1.
/// @param difference  >= 0
double cvvdp_quality_jod(double difference);

MetricInfo cvvdp_info();

}  // namespace metrics
