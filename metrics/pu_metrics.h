#pragma once

#include "metrics/metric.h"

/// PSNR, SSIM and MS-SSIM of light in perceptually uniform units: what those metrics are for SDR
/// pictures, for displays of any brightness.
///
/// The light of the display is encoded with PU21 (perception/perceptual_encoding.h); 256, near the
/// PU value of 100 cd/m2, stands for the peak of SDR pictures, as the authors of PU21 recommend.
/// Luminances outside 0.005 to 10,000 cd/m2 count as the nearest bound; the detail `clipped_values`
/// tells how many there were in both images.
///
/// Source: Mantiuk, Azimi 2021, doi:10.1109/PCS50896.2021.9477471.
namespace metrics {

MetricInfo pu_psnr_info();
MetricInfo pu_ssim_info();
MetricInfo pu_ms_ssim_info();

}  // namespace metrics
