#pragma once

#include "metrics/metric.h"

/// Errors of single pixels, pooled by the mean: mse, relmse, relative-rmse, mae, smape on
/// scene-linear R, G, B and psnr on the sRGB-encoded picture.
///
/// With x the test's value of a channel and r the reference's:
///   mse     (x - r)^2
///   relmse  (x - r)^2 / (r^2 + 0.01)      Rousselle, Knaus, Zwicker 2011, Adaptive Sampling and
///           Reconstruction using Greedy Error Minimization, doi:10.1145/2024156.2024193
///   relative-rmse  sqrt(mse) / mean of r, both over pixels and channels; of a reference whose mean
///           is not above 0 it is 0 if mse is 0, else NaN. Not the root of relmse.
///   mae     |x - r|
///   smape   |x - r| / (|x| + |r| + 0.01)  Vogels et al. 2018, Denoising with Kernel Prediction and
///           Asymmetric Loss Functions, doi:10.1145/3197517.3201388
///   psnr    -10 log10(mse) dB of sRGB-encoded values with peak 1; infinite for equal pictures
/// Both papers' formulas are cited from memory; the two constants 0.01 are theirs.
namespace metrics {

MetricInfo mse_info();
MetricInfo relmse_info();
MetricInfo relative_rmse_info();
MetricInfo mae_info();
MetricInfo smape_info();
MetricInfo psnr_info();

}  // namespace metrics
