#include "metrics/pu_metrics.h"

#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "metrics/metric_input.h"
#include "metrics/multi_scale_similarity.h"
#include "metrics/score_pooling.h"
#include "metrics/separable_filter.h"
#include "metrics/structural_similarity.h"
#include "perception/perceptual_encoding.h"

namespace metrics {
namespace {

using perception::PerceptualCurve;

/// Luminance of linear Rec.709 (the authors' program, to their digits).
constexpr std::array<double, 3> kLuminanceWeights{0.212656, 0.715158, 0.072186};

/// A picture in PU units over the peak of 256, plane by plane.
struct PuPicture {
  std::vector<Plane<double>> planes;  ///< R, G, B, or luminance alone
  double clipped_values = 0.0;        ///< outside the range of the encoding
};

/// What is encoded: each channel as if it were a luminance, or the luminance.
enum class PuChannels { rgb, luminance };

/// Encodes value(pixel) for every pixel into a plane of its own.
template <typename Value>
void add_plane(const Image& light, PerceptualCurve curve, const Value& value, PuPicture& picture) {
  Plane<double> plane(light.width_px, light.height_px);
  picture.clipped_values += sum_over_rows(light.height_px, [&](int y) {
    const float* rgb = &light.pixels[light.offset(0, y)];
    double* out = plane.row(y);
    int clipped = 0;
    for (int x = 0; x < light.width_px; ++x, rgb += 3) {
      const double luminance = value(rgb);
      if (!perception::is_in_pu_range(luminance)) ++clipped;
      out[x] = perception::pu_encode(luminance, curve) / perception::kPuPeak;
    }
    return static_cast<double>(clipped);
  });
  picture.planes.push_back(std::move(plane));
}

PuPicture pu_picture(const Image& image, const ViewingConditions& viewing, PerceptualCurve curve,
                     PuChannels channels) {
  const InputImage light = light_input(image, viewing);
  PuPicture picture;
  if (channels == PuChannels::luminance) {
    add_plane(
        light.image(), curve,
        [](const float* rgb) {
          double luminance = 0.0;
          for (std::size_t c = 0; c < 3; ++c) luminance += kLuminanceWeights[c] * double{rgb[c]};
          return luminance;
        },
        picture);
    return picture;
  }
  for (int c = 0; c < 3; ++c) {
    add_plane(
        light.image(), curve, [c](const float* rgb) { return double{rgb[c]}; }, picture);
  }
  return picture;
}

/// Mean squared difference of the planes per pixel.
Plane<double> squared_error(const PuPicture& reference, const PuPicture& test) {
  const Plane<double>& first = reference.planes.front();
  Plane<double> error(first.width_px, first.height_px);
  const auto planes = static_cast<double>(reference.planes.size());
  for_each_row(error.height_px, [&](int y) {
    double* out = error.row(y);
    for (std::size_t p = 0; p < reference.planes.size(); ++p) {
      const double* r = reference.planes[p].row(y);
      const double* t = test.planes[p].row(y);
      for (int x = 0; x < error.width_px; ++x) out[x] += (t[x] - r[x]) * (t[x] - r[x]);
    }
    for (int x = 0; x < error.width_px; ++x) out[x] /= planes;
  });
  return error;
}

double masked_plane_mean(const Plane<double>& plane, const Image* mask) {
  double pixels = 0.0;
  double sum = 0.0;
  for (std::size_t i = 0; i < plane.values.size(); ++i) {
    if (!takes_part(mask, i)) continue;
    sum += plane.values[i];
    pixels += 1.0;
  }
  return sum / pixels;
}

class PuPsnr : public Metric {
 public:
  PuPsnr(PerceptualCurve curve, PuChannels channels) : curve_(curve), channels_(channels) {}

  Score evaluate(const ImagePair& pair, const ViewingConditions& viewing) const override {
    const PuPicture reference = pu_picture(pair.reference, viewing, curve_, channels_);
    const PuPicture test = pu_picture(pair.test, viewing, curve_, channels_);
    const Plane<double> error = squared_error(reference, test);
    const double mse = masked_plane_mean(error, pair.mask);
    Score score;
    score.value = mse > 0.0 ? -10.0 * std::log10(mse) : std::numeric_limits<double>::infinity();
    // In units of PU, not of the peak.
    constexpr double kSquaredPeak = perception::kPuPeak * perception::kPuPeak;
    score.details = {{"mse", kSquaredPeak * mse},
                     {"clipped_values", reference.clipped_values + test.clipped_values}};
    score.map = perception::make_gray_image(error.width_px, error.height_px, "error",
                                            perception::Encoding::scene_linear);
    for (std::size_t i = 0; i < error.values.size(); ++i) {
      score.map->pixels[i] = static_cast<float>(kSquaredPeak * error.values[i]);
    }
    return score;
  }

 private:
  PerceptualCurve curve_;
  PuChannels channels_;
};

class PuSimilarity : public Metric {
 public:
  explicit PuSimilarity(PerceptualCurve curve) : curve_(curve) {}

  Score evaluate(const ImagePair& pair, const ViewingConditions& viewing) const override {
    const PuPicture reference = pu_picture(pair.reference, viewing, curve_, PuChannels::luminance);
    const PuPicture test = pu_picture(pair.test, viewing, curve_, PuChannels::luminance);
    Score score = compare(reference.planes.front(), test.planes.front(), pair.mask);
    score.details.push_back({"clipped_values", reference.clipped_values + test.clipped_values});
    return score;
  }

 protected:
  virtual Score compare(const Plane<double>& reference, const Plane<double>& test,
                        const Image* mask) const {
    return score_similarity(reference, test, mask);
  }

 private:
  PerceptualCurve curve_;
};

class PuMultiScaleSimilarity : public PuSimilarity {
 public:
  PuMultiScaleSimilarity(PerceptualCurve curve, int scales)
      : PuSimilarity(curve), scales_(scales) {}

 protected:
  Score compare(const Plane<double>& reference, const Plane<double>& test,
                const Image* mask) const override {
    return score_multi_scale(reference, test, mask, {"pu-ms-ssim", scales_});
  }

 private:
  int scales_;
};

PerceptualCurve curve_of(const base::Parameters& parameters) {
  return perception::perceptual_curve_from_text(parameters.text("encoding"));
}

MetricInfo pu_info(std::string name, std::string summary) {
  MetricInfo info;
  info.name = std::move(name);
  info.summary = std::move(summary);
  info.source = "Mantiuk, Azimi 2021, doi:10.1109/PCS50896.2021.9477471";
  info.better = Better::higher;
  info.input = "absolute light";
  info.parameters = {base::choice_parameter(
      "encoding", perception::perceptual_curve_names(), "banding_glare",
      "fit of the PU21 encoding (Mantiuk, Azimi 2021, who recommend banding_glare)")};
  return info;
}

}  // namespace

MetricInfo pu_psnr_info() {
  MetricInfo info = pu_info("pu-psnr",
                            "Peak signal-to-noise ratio of light in PU21 units, peak 256; infinite "
                            "for equal pictures. The map is the squared error.");
  info.unit = "dB";
  info.identical_value = std::numeric_limits<double>::infinity();
  info.parameters.push_back(base::choice_parameter(
      "channels", {"rgb", "luminance"}, "rgb",
      "encode R, G and B each as if it were a luminance, or the luminance alone (the PU21 program "
      "offers both; rgb is its PSNR)"));
  info.map_unit = "squared PU";
  info.map_scale = {1e-2, 1e4, true, info.map_unit};
  info.create = [](const base::Parameters& parameters) -> std::unique_ptr<Metric> {
    const bool is_rgb = parameters.text("channels") == "rgb";
    return std::make_unique<PuPsnr>(curve_of(parameters),
                                    is_rgb ? PuChannels::rgb : PuChannels::luminance);
  };
  return info;
}

MetricInfo pu_ssim_info() {
  MetricInfo info = pu_info("pu-ssim",
                            "Mean structural similarity (ssim) of luminance in PU21 units, peak "
                            "256. The map is 1 - SSIM.");
  info.identical_value = 1.0;
  info.map_scale = {0.0, 1.0, false, ""};
  info.create = [](const base::Parameters& parameters) -> std::unique_ptr<Metric> {
    return std::make_unique<PuSimilarity>(curve_of(parameters));
  };
  return info;
}

MetricInfo pu_ms_ssim_info() {
  MetricInfo info = pu_info("pu-ms-ssim",
                            "Multi-scale structural similarity (ms-ssim) of luminance in PU21 "
                            "units, peak 256. The map is 1 - the product at each pixel.");
  info.identical_value = 1.0;
  info.parameters.push_back(scales_parameter());
  info.map_scale = {0.0, 1.0, false, ""};
  info.create = [](const base::Parameters& parameters) -> std::unique_ptr<Metric> {
    return std::make_unique<PuMultiScaleSimilarity>(curve_of(parameters),
                                                    static_cast<int>(parameters.integer("scales")));
  };
  return info;
}

}  // namespace metrics
