#include "metrics/cvvdp.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "metrics/cvvdp_band.h"
#include "metrics/cvvdp_pyramid.h"
#include "metrics/cvvdp_sensitivity.h"
#include "metrics/metric_input.h"
#include "metrics/score_pooling.h"
#include "metrics/vector_math.h"

namespace metrics {
namespace {

// Constants of the published calibration, version 0.5.7, to seven or eight digits.
constexpr double kPixelPower = 2.0;    // over pixels
constexpr double kBandPower = 4.0;     // over bands
constexpr double kChannelPower = 4.0;  // over channels
constexpr std::array<double, kCvvdpChannels> kBaseWeight{0.0036334, 1.6627724, 4.1187445};
constexpr double kStillPictureGain = 0.5779183;
constexpr double kJodFactor = 0.04395694;
constexpr double kJodPower = 0.93020427;
constexpr double kLineEnd = 0.1;  ///< differences below this lose quality along a line
constexpr double kBestQuality_jod = 10.0;

using Matrix = std::array<std::array<double, 3>, 3>;

/// Linear Rec.709 to CIE XYZ, IEC 61966-2-1 primaries to seven digits.
constexpr Matrix kXyzFromRgb{{{0.4124564, 0.3575761, 0.1804375},
                              {0.2126729, 0.7151522, 0.072175},
                              {0.0193339, 0.119192, 0.9503041}}};
/// CIE XYZ to the responses of long, medium and short cones (CIE 2006).
constexpr Matrix kConesFromXyz{{{0.187596268556126, 0.585168649077728, -0.026384263306304},
                                {-0.133397430663221, 0.405505777260049, 0.034502127690364},
                                {0.000244379021663, -0.000542995890619, 0.019406849066323}}};
constexpr Matrix kOpponentFromCones{
    {{1.0, 1.0, 0.0}, {1.0, -2.311130179947035, 0.0}, {-1.0, -1.0, 50.977571328718781}}};

constexpr Matrix product(const Matrix& a, const Matrix& b) {
  Matrix result{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      for (std::size_t k = 0; k < 3; ++k) result[i][j] += a[i][k] * b[k][j];
    }
  }
  return result;
}

constexpr Matrix kOpponentFromRgb =
    product(product(kOpponentFromCones, kConesFromXyz), kXyzFromRgb);

CvvdpChannelPlanes opponent_planes(const Image& light) {
  CvvdpChannelPlanes planes;
  for (auto& plane : planes) plane = Plane<float>(light.width_px, light.height_px);
  for_each_row(light.height_px, [&](int y) {
    const float* rgb = &light.pixels[light.offset(0, y)];
    for (int x = 0; x < light.width_px; ++x, rgb += 3) {
      for (std::size_t c = 0; c < kCvvdpChannels; ++c) {
        planes[c].row(y)[x] = static_cast<float>(kOpponentFromRgb[c][0] * double{rgb[0]} +
                                                 kOpponentFromRgb[c][1] * double{rgb[1]} +
                                                 kOpponentFromRgb[c][2] * double{rgb[2]});
      }
    }
  });
  return planes;
}

CvvdpChannelPlanes reduced(const CvvdpChannelPlanes& fine) {
  CvvdpChannelPlanes coarse;
  for (std::size_t c = 0; c < kCvvdpChannels; ++c) coarse[c] = cvvdp_reduced(fine[c]);
  return coarse;
}

/// Shares of the next level's pixels that take part: means with weights 1, 2, 1 of those inside.
Plane<float> reduced_weights(const Plane<float>& fine) {
  Plane<float> coarse((fine.width_px + 1) / 2, (fine.height_px + 1) / 2);
  for (int y = 0; y < coarse.height_px; ++y) {
    for (int x = 0; x < coarse.width_px; ++x) {
      float sum = 0.0F, weights = 0.0F;
      for (int j = std::max(2 * y - 1, 0); j <= std::min(2 * y + 1, fine.height_px - 1); ++j) {
        for (int i = std::max(2 * x - 1, 0); i <= std::min(2 * x + 1, fine.width_px - 1); ++i) {
          const float weight = (j == 2 * y ? 2.0F : 1.0F) * (i == 2 * x ? 2.0F : 1.0F);
          sum += weight * fine.row(j)[i];
          weights += weight;
        }
      }
      coarse.row(y)[x] = sum / weights;
    }
  }
  return coarse;
}

/// Pools a plane of differences over its pixels.
/// @param weights  of the pixels; empty: all count
double pooled(const Plane<float>& difference, const Plane<float>& weights) {
  const bool is_weighted = !weights.values.empty();
  double weight_sum = 0.0;
  for (const float weight : weights.values) weight_sum += double{weight};
  if (!is_weighted) weight_sum = static_cast<double>(difference.values.size());
  const double sum = sum_over_rows(difference.height_px, [&](int y) {
    const float* d = difference.row(y);
    double row_sum = 0.0;
    for (int x = 0; x < difference.width_px; ++x) {
      const double value{d[x]};
      const double weight = is_weighted ? double{weights.row(y)[x]} : 1.0;
      row_sum += weight * (value * value + 2.0 * kCvvdpPowerOffset * value);  // cvvdp_power(d, 2)
    }
    return row_sum;
  });
  return cvvdp_power(sum / weight_sum, 1.0 / kPixelPower);
}

/// (x + offset)^4 - offset^4 in single precision.
float fourth_power(float x, float offset) {
  const float square = (x + offset) * (x + offset);
  const float offset_square = offset * offset;
  return square * square - offset_square * offset_square;
}

/// Pools the channels at every pixel (for the heat map).
Plane<float> pooled_channels(const CvvdpChannelPlanes& difference,
                             const std::array<double, kCvvdpChannels>& weights) {
  Plane<float> result(difference[0].width_px, difference[0].height_px);
  constexpr auto kOffset = static_cast<float>(kCvvdpPowerOffset);
  const float at_zero = std::sqrt(std::sqrt(kOffset));
  std::array<float, kCvvdpChannels> gains{};
  for (std::size_t c = 0; c < kCvvdpChannels; ++c) {
    gains[c] = static_cast<float>(kStillPictureGain * weights[c]);
  }
  for_each_row(result.height_px, [&](int y) {
    const float *a = difference[0].row(y), *b = difference[1].row(y), *d = difference[2].row(y);
    float* __restrict out = result.row(y);
    for (int x = 0; x < result.width_px; ++x) {
      const float sum = fourth_power(gains[0] * a[x], kOffset) +
                        fourth_power(gains[1] * b[x], kOffset) +
                        fourth_power(gains[2] * d[x], kOffset);
      out[x] = std::sqrt(std::sqrt(sum + kOffset)) - at_zero;
    }
  });
  return result;
}

/// Differences of all bands: pooled per channel, and per pixel for the heat map.
class BandDifferences {
 public:
  BandDifferences(CvvdpLevel level, Plane<float> weights, double pixels_per_degree) {
    const Plane<float>& size = level.reference[0];
    const std::vector<double> frequencies =
        cvvdp_band_frequencies_cpd(size.width_px, size.height_px, pixels_per_degree);
    const CvvdpSensitivity sensitivity;
    for (std::size_t band = 0; band + 1 < frequencies.size(); ++band) {
      CvvdpLevel coarse{reduced(level.reference), reduced(level.test)};
      const double gain = band == 0 ? 1.0 : 2.0;
      add(cvvdp_band_difference(level, coarse, sensitivity.at(frequencies[band]), gain), weights,
          {1.0, 1.0, 1.0});
      level = std::move(coarse);
      if (!weights.values.empty()) weights = reduced_weights(weights);
    }
    add(cvvdp_base_difference(level, sensitivity.at(frequencies.back())), weights, kBaseWeight);
  }

  std::size_t band_count() const { return maps_.size(); }

  /// A channel's difference, pooled over pixels and bands.
  double of_channel(std::size_t channel) const {
    double sum = 0.0;
    for (const double value : pooled_[channel]) sum += cvvdp_power(value, kBandPower);
    return cvvdp_power(sum, 1.0 / kBandPower);
  }

  /// The bands' differences added up like the layers of a picture.
  Plane<float> at_full_size() const {
    Plane<float> sum = maps_.back();
    for (std::size_t band = maps_.size() - 1; band-- > 0;) {
      Plane<float> finer = maps_[band];
      const float gain = band == 0 ? 1.0F : 0.5F;
      for_each_row(finer.height_px, [&](int y) {
        std::vector<float> expanded(static_cast<std::size_t>(finer.width_px));
        cvvdp_expand_row(sum, y, finer.width_px, expanded.data());
        float* out = finer.row(y);
        for (std::size_t x = 0; x < expanded.size(); ++x) out[x] = gain * out[x] + expanded[x];
      });
      sum = std::move(finer);
    }
    return sum;
  }

 private:
  void add(const CvvdpChannelPlanes& difference, const Plane<float>& pixel_weights,
           const std::array<double, kCvvdpChannels>& channel_weights) {
    for (std::size_t c = 0; c < kCvvdpChannels; ++c) {
      pooled_[c].push_back(channel_weights[c] * pooled(difference[c], pixel_weights));
    }
    maps_.push_back(pooled_channels(difference, channel_weights));
  }

  std::array<std::vector<double>, kCvvdpChannels> pooled_;  ///< by band
  std::vector<Plane<float>> maps_;                          ///< by band
};

/// Quality lost at every pixel, JOD.
Image lost_quality(const Plane<float>& difference) {
  Image map = perception::make_gray_image(difference.width_px, difference.height_px, "error",
                                          perception::Encoding::scene_linear);
  constexpr auto kEnd = static_cast<float>(kLineEnd);
  const auto slope = static_cast<float>(kJodFactor * std::pow(kLineEnd, kJodPower - 1.0));
  for_each_row(map.height_px, [&](int y) {
    const float* d = difference.row(y);
    float* __restrict out = &map.pixels[map.offset(0, y)];
    for (int x = 0; x < map.width_px; ++x) {
      const float bounded = d[x] > kEnd ? d[x] : kEnd;
      const float curve =
          static_cast<float>(kJodFactor) * power_of(bounded, static_cast<float>(kJodPower));
      out[x] = d[x] > kEnd ? curve : slope * d[x];
    }
  });
  return map;
}

class ColorVideoVdp : public Metric {
 public:
  Score evaluate(const ImagePair& pair, const ViewingConditions& viewing) const override {
    CvvdpLevel level{opponent_planes(light_input(pair.reference, viewing).image()),
                     opponent_planes(light_input(pair.test, viewing).image())};
    Plane<float> weights;
    if (pair.mask != nullptr) {
      weights = Plane<float>(pair.mask->width_px, pair.mask->height_px);
      weights.values = pair.mask->pixels;
    }
    const BandDifferences bands(std::move(level), std::move(weights), viewing.pixels_per_degree);

    double sum = 0.0;
    std::array<double, kCvvdpChannels> channels{};
    for (std::size_t c = 0; c < kCvvdpChannels; ++c) {
      channels[c] = bands.of_channel(c);
      sum += cvvdp_power(channels[c], kChannelPower);
    }
    const double difference = kStillPictureGain * cvvdp_power(sum, 1.0 / kChannelPower);
    Score score;
    score.value = cvvdp_quality_jod(difference);
    score.map = lost_quality(bands.at_full_size());
    const MapExtremes extremes = map_extremes(*score.map, pair.mask);
    score.details = {{"difference", difference},
                     {"achromatic", kStillPictureGain * channels[0]},
                     {"red_green", kStillPictureGain * channels[1]},
                     {"violet_yellow", kStillPictureGain * channels[2]},
                     {"bands", static_cast<double>(bands.band_count())},
                     {"lost_jod_maximum", extremes.maximum},
                     {"lost_jod_maximum_x_px", static_cast<double>(extremes.max_x_px)},
                     {"lost_jod_maximum_y_px", static_cast<double>(extremes.max_y_px)}};
    return score;
  }
};

}  // namespace

std::array<double, 3> cvvdp_opponent_of(const std::array<double, 3>& light_cd_m2) {
  std::array<double, 3> opponent{};
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t c = 0; c < 3; ++c) opponent[row] += kOpponentFromRgb[row][c] * light_cd_m2[c];
  }
  return opponent;
}

double cvvdp_quality_jod(double difference) {
  if (difference > kLineEnd) {
    return kBestQuality_jod - kJodFactor * std::pow(difference, kJodPower);
  }
  return kBestQuality_jod - kJodFactor * std::pow(kLineEnd, kJodPower - 1.0) * difference;
}

MetricInfo cvvdp_info() {
  MetricInfo info;
  info.name = "cvvdp";
  info.summary =
      "ColorVideoVDP for still pictures: 10 less the visible difference in just-objectionable "
      "differences (JOD), from contrast sensitivity and masking in three colour channels. The map "
      "is the quality lost at each pixel.";
  info.unit = "JOD";
  info.source = "Mantiuk et al. 2024, doi:10.1145/3658144";
  info.better = Better::higher;
  info.input = "absolute light";
  info.identical_value = kBestQuality_jod;
  info.map_unit = info.unit;
  info.map_scale = {0.0, 4.0, false, info.map_unit};
  info.create = [](const base::Parameters&) -> std::unique_ptr<Metric> {
    return std::make_unique<ColorVideoVdp>();
  };
  return info;
}

}  // namespace metrics
