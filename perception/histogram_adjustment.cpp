// Ward Larson, Rushmeier, Piatko 1997, "A Visibility Matching Tone Reproduction Operator for High
// Dynamic Range Scenes", doi:10.1109/2945.646233. Method, formulas and the tolerance of 2.5 % are
// recalled; the ceiling's meaning, dLd/dLw <= dLt(Ld) / dLt(Lw) on foveal averages, was checked
// against Radiance's pcond3.c. Glare, colour sensitivity and acuity of the paper are left out.

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "perception/base/errors.h"
#include "perception/color_conversion.h"
#include "perception/tone_mapping.h"

namespace perception {
namespace {

constexpr double kDarkest_cd_m2 = 1e-4;       ///< darker samples do not count
constexpr double kTrimmingTolerance = 0.025;  ///< share of the samples, stops the iteration
constexpr int kMostIterations = 200;

/// Means over squares of about one degree, the samples a fovea would take.
std::vector<double> foveal_samples(const Image& light, double side_px) {
  const Image pixels = light.channel_count() == 1 ? light : rgb_of(light);
  const int side = std::max(1, static_cast<int>(std::lround(side_px)));
  const int columns = (pixels.width_px + side - 1) / side;
  const int rows = (pixels.height_px + side - 1) / side;
  std::vector<double> sums(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
  std::vector<double> counts(sums.size());
  for (int y = 0; y < pixels.height_px; ++y) {
    for (int x = 0; x < pixels.width_px; ++x) {
      double luminance = 0.0;
      for (int c = 0; c < pixels.channel_count(); ++c) {
        const double weight = pixels.channel_count() == 1
                                  ? 1.0
                                  : static_cast<double>(kRec709Luma[static_cast<std::size_t>(c)]);
        luminance += weight * static_cast<double>(pixels.at(x, y, c));
      }
      if (!std::isfinite(luminance)) continue;
      const auto cell = static_cast<std::size_t>(y / side) * static_cast<std::size_t>(columns) +
                        static_cast<std::size_t>(x / side);
      sums[cell] += luminance;
      counts[cell] += 1.0;
    }
  }
  std::vector<double> samples;
  for (std::size_t i = 0; i < sums.size(); ++i) {
    if (counts[i] > 0.0 && sums[i] / counts[i] >= kDarkest_cd_m2) {
      samples.push_back(sums[i] / counts[i]);
    }
  }
  return samples;
}

/// Histogram of brightness B = log L_w over equal bins.
struct Histogram {
  double low = 0.0;   ///< log of the darkest sample
  double high = 0.0;  ///< log of the brightest
  std::vector<double> counts;

  double bin_width() const { return (high - low) / static_cast<double>(counts.size()); }
  double total() const { return std::accumulate(counts.begin(), counts.end(), 0.0); }
  double centre(std::size_t bin) const {
    return low + (static_cast<double>(bin) + 0.5) * bin_width();
  }
};

Histogram histogram_of(const std::vector<double>& samples, int bins) {
  const auto [least, most] = std::minmax_element(samples.begin(), samples.end());
  Histogram histogram{std::log(*least), std::log(*most),
                      std::vector<double>(static_cast<std::size_t>(bins))};
  const double width = histogram.bin_width();
  for (const double sample : samples) {
    const double position = width > 0.0 ? (std::log(sample) - histogram.low) / width : 0.0;
    const auto bin =
        std::min(static_cast<std::size_t>(std::max(position, 0.0)), histogram.counts.size() - 1);
    histogram.counts[bin] += 1.0;
  }
  return histogram;
}

/// Display brightness at the bins' edges, Eq. 4: B_de = log Ldmin + (log Ldmax - log Ldmin) P(B_w).
std::vector<double> display_edges(const Histogram& histogram, const DisplayRange& range) {
  const double low = std::log(range.black_cd_m2);
  const double high = std::log(range.peak_cd_m2);
  const double total = histogram.total();
  std::vector<double> edges{low};
  double sum = 0.0;
  for (const double count : histogram.counts) {
    sum += count;
    edges.push_back(low + (high - low) * sum / total);
  }
  return edges;
}

/// Most samples a bin may hold. Linear ceiling: T db / (log Ldmax - log Ldmin); by visibility that
/// times [dLt(Ld) / dLt(Lw)] [Lw / Ld].
double ceiling_of(const Histogram& histogram, std::size_t bin, double display_brightness,
                  const DisplayRange& range, const HistogramSettings& settings) {
  const double linear =
      histogram.total() * histogram.bin_width() / std::log(range.peak_cd_m2 / range.black_cd_m2);
  if (!settings.limits_contrast) return linear;
  const double world = std::exp(histogram.centre(bin));
  const double display = std::exp(display_brightness);
  return linear * threshold_cd_m2(settings.curve, display) /
         threshold_cd_m2(settings.curve, world) * world / display;
}

/// Trims the bins above their ceilings, with the ceilings of the trimmed histogram again, until
/// less than the tolerance is cut. False if the histogram shrinks to nothing: its occupied bins
/// cannot fill the display without contrast that the scene does not have.
bool trim(Histogram& histogram, const DisplayRange& range, const HistogramSettings& settings) {
  const double least_total = kTrimmingTolerance * histogram.total();
  for (int i = 0; i < kMostIterations; ++i) {
    const double total = histogram.total();
    if (total < least_total) return false;
    const std::vector<double> edges = display_edges(histogram, range);
    std::vector<double> trimmed = histogram.counts;
    double trimmings = 0.0;
    for (std::size_t bin = 0; bin < trimmed.size(); ++bin) {
      const double brightness = 0.5 * (edges[bin] + edges[bin + 1]);
      const double ceiling = ceiling_of(histogram, bin, brightness, range, settings);
      if (trimmed[bin] <= ceiling) continue;
      trimmings += trimmed[bin] - ceiling;
      trimmed[bin] = ceiling;
    }
    histogram.counts = std::move(trimmed);
    if (trimmings <= kTrimmingTolerance * total) return true;
  }
  return true;
}

/// One factor for all: Ward 1994, "A Contrast-Based Scalefactor for Luminance Display", dLt(Lda) /
/// dLt(Lwa) with Lda half the display's peak and Lwa the log average (recalled), as far as the
/// scene's darkest and, above all, its brightest sample then fit the display.
ToneCurve scaled_to_display(const std::vector<double>& samples, const DisplayRange& range,
                            const HistogramSettings& settings) {
  double sum = 0.0;
  for (const double sample : samples) sum += std::log(sample);
  const double world = std::exp(sum / static_cast<double>(samples.size()));
  const auto [least, most] = std::minmax_element(samples.begin(), samples.end());
  const double wanted = threshold_cd_m2(settings.curve, 0.5 * range.peak_cd_m2) /
                        threshold_cd_m2(settings.curve, world);
  const double scale = std::max(wanted, range.black_cd_m2 / *least);
  return linear_tone_curve(range, std::min(scale, range.peak_cd_m2 / *most));
}

}  // namespace

ToneCurve histogram_adjustment(const Image& light, const ViewingConditions& viewing,
                               const HistogramSettings& settings) {
  if (light.encoding != Encoding::luminance_cd_m2) {
    throw base::InputError(
        fmt::format("tone curves are of light, but the image is {}; accepted: "
                    "luminance_cd_m2",
                    to_string(light.encoding)));
  }
  if (settings.bins < 2) {
    throw base::InputError(fmt::format("bins are {}; accepted: 2 and more", settings.bins));
  }
  const std::vector<double> samples =
      foveal_samples(light, settings.fovea_deg * viewing.pixels_per_degree);
  if (samples.empty()) {
    throw base::InputError(
        "no pixel of the image has light to adapt to; accepted: at least one of 0.0001 cd/m2");
  }
  const DisplayRange range = display_range(viewing);
  Histogram histogram = histogram_of(samples, settings.bins);
  if (histogram.high - histogram.low <= std::log(range.peak_cd_m2 / range.black_cd_m2)) {
    return scaled_to_display(samples, range, settings);
  }
  if (!trim(histogram, range, settings)) {
    // Ours: all bins alike, the scene's whole log range evenly over the display's.
    std::fill(histogram.counts.begin(), histogram.counts.end(), 1.0);
  }
  const std::vector<double> edges = display_edges(histogram, range);
  std::vector<ToneCurve::Point> points;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const double world = histogram.low + static_cast<double>(i) * histogram.bin_width();
    points.push_back({std::exp(world), std::exp(edges[i])});
  }
  return ToneCurve(std::move(points));
}

}  // namespace perception
