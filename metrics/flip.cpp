#include "metrics/flip.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "metrics/flip_exposures.h"
#include "metrics/flip_filters.h"
#include "metrics/flip_ldr.h"
#include "metrics/metric_input.h"
#include "metrics/score_pooling.h"
#include "metrics/vector_math.h"
#include "perception/base/errors.h"

namespace metrics {
namespace {

using perception::Encoding;

/// 2^100 keeps every product with an ordinary radiance inside the range of float.
constexpr double kLargestExposureEv = 100.0;

enum class Mode { automatic, ldr, hdr };

/// Parameters of the metric, read once.
struct FlipSettings {
  double ppd = 0.0;  ///< 0: of the viewing conditions
  Mode mode = Mode::automatic;
  ToneMapper tone_mapper = ToneMapper::aces;
  ExposureChoice exposures;
};

/// "auto", or a number of stops.
std::optional<double> read_exposure_ev(const base::Parameters& parameters, const char* name) {
  const std::string& text = parameters.text(name);
  if (text == "auto") return std::nullopt;
  double value = 0.0;
  const char* end = text.data() + text.size();
  const auto [last, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || last != end || !(std::abs(value) <= kLargestExposureEv)) {
    throw base::InputError(fmt::format(
        "parameter \"{}\" of metric \"flip\" cannot be \"{}\"; accepted: auto, or a number of "
        "stops from {} to {}",
        name, text, -kLargestExposureEv, kLargestExposureEv));
  }
  return value;
}

FlipSettings read_settings(const base::Parameters& parameters) {
  FlipSettings settings;
  settings.ppd = parameters.real("ppd");
  const std::string& mode = parameters.text("mode");
  settings.mode = mode == "ldr" ? Mode::ldr : mode == "hdr" ? Mode::hdr : Mode::automatic;
  const std::string& mapper = parameters.text("tonemapper");
  settings.tone_mapper = mapper == "hable"      ? ToneMapper::hable
                         : mapper == "reinhard" ? ToneMapper::reinhard
                                                : ToneMapper::aces;
  settings.exposures.start_ev = read_exposure_ev(parameters, "start_exposure");
  settings.exposures.stop_ev = read_exposure_ev(parameters, "stop_exposure");
  settings.exposures.count = static_cast<int>(parameters.integer("exposures"));
  return settings;
}

double resolved_ppd(const FlipSettings& settings, const ViewingConditions& viewing) {
  const double ppd = settings.ppd > 0.0 ? settings.ppd : viewing.pixels_per_degree;
  if (!(ppd >= kFlipLowestPpd && ppd <= kFlipHighestPpd)) {
    throw base::InputError(fmt::format(
        "metric \"flip\": {} pixels per degree; accepted: {} to {}, or ppd=0 for those of the "
        "viewing conditions",
        ppd, kFlipLowestPpd, kFlipHighestPpd));
  }
  return ppd;
}

/// One channel of a row of pixels, clamped: times a gain, or decoded if there is none. Compiled
/// twice, as weighted_sum is (separable_filter.cpp).
[[gnu::target_clones("avx2", "default")]] void read_channel(const float* channel, int width_px,
                                                            std::optional<float> gain,
                                                            float* __restrict values) {
  const float factor = gain.value_or(1.0F);
  for (int x = 0; x < width_px; ++x) {
    const float scaled = channel[3 * x] * factor;
    const float positive = scaled < 0.0F ? 0.0F : scaled;
    values[x] = positive > 1.0F ? 1.0F : positive;
  }
  if (gain) return;
  for (int x = 0; x < width_px; ++x) values[x] = srgb_to_linear(values[x]);
}

/// Rows of a picture of low dynamic range: decoded if display-encoded, else 2^ev x linear.
PictureRows ldr_rows(const Image& rgb, double exposure_ev) {
  std::optional<float> gain;
  if (rgb.encoding != Encoding::display) gain = static_cast<float>(std::exp2(exposure_ev));
  return [&rgb, gain](int y, const RowOfThree& out) {
    const float* row = &rgb.pixels[rgb.offset(0, y)];
    read_channel(row, rgb.width_px, gain, out.first);
    read_channel(row + 1, rgb.width_px, gain, out.second);
    read_channel(row + 2, rgb.width_px, gain, out.third);
  };
}

PictureRows tone_mapped_rows(const Image& linear, ToneMapper mapper, double exposure_ev) {
  return [&linear, mapper, exposure_ev](int y, const RowOfThree& out) {
    tone_map_row(mapper, exposure_ev, &linear.pixels[linear.offset(0, y)], linear.width_px, out);
  };
}

/// The buffers of one comparison.
struct Comparison {
  Comparison(const Image& size, double ppd)
      : observer(size.width_px, size.height_px, make_flip_filters(ppd)),
        reference(size.width_px, size.height_px),
        test(size.width_px, size.height_px),
        map(size.width_px, size.height_px) {}

  void compare(const PictureRows& reference_rows, const PictureRows& test_rows) {
    observer.look(reference_rows, reference);
    observer.look(test_rows, test);
    raise_to_flip_difference(reference, test, map);
  }

  FlipObserver observer;
  SeenPicture reference;
  SeenPicture test;
  Plane<float> map;
};

std::size_t count_negative(const Image& image) {
  return static_cast<std::size_t>(sum_over_rows(image.height_px, [&](int y) {
    const float* row = &image.pixels[image.offset(0, y)];
    int count = 0;
    for (int i = 0; i < image.width_px * 3; ++i) count += row[i] < 0.0F ? 1 : 0;
    return static_cast<double>(count);
  }));
}

void pool(const Image* mask, Score& score) {
  const Image& map = *score.map;
  score.value = masked_mean(map, mask);
  const WeightedQuartiles quartiles = weighted_quartiles(map, mask);
  const MapExtremes extremes = map_extremes(map, mask);
  score.details.insert(score.details.end(),
                       {{"weighted_median", quartiles.median},
                        {"first_weighted_quartile", quartiles.first},
                        {"third_weighted_quartile", quartiles.third},
                        {"minimum", extremes.minimum},
                        {"maximum", extremes.maximum},
                        {"maximum_x_px", static_cast<double>(extremes.max_x_px)},
                        {"maximum_y_px", static_cast<double>(extremes.max_y_px)}});
}

class Flip : public Metric {
 public:
  explicit Flip(const FlipSettings& settings) : settings_(settings) {}

  Score evaluate(const ImagePair& pair, const ViewingConditions& viewing) const override {
    require_relative_light(pair.reference, "flip");
    require_relative_light(pair.test, "flip");
    const bool both_display =
        pair.reference.encoding == Encoding::display && pair.test.encoding == Encoding::display;
    const bool is_ldr =
        settings_.mode == Mode::ldr || (settings_.mode == Mode::automatic && both_display);

    Comparison comparison(pair.reference, resolved_ppd(settings_, viewing));
    Score score;
    score.details.push_back({"pixels_per_degree", resolved_ppd(settings_, viewing)});
    score.details.push_back({"is_hdr", is_ldr ? 0.0 : 1.0});
    if (is_ldr) {
      compare_ldr(pair, viewing, comparison);
    } else {
      compare_hdr(pair, comparison, score);
    }
    Image map = perception::make_gray_image(pair.reference.width_px, pair.reference.height_px,
                                            "error", Encoding::scene_linear);
    map.pixels = std::move(comparison.map.values);
    score.map = std::move(map);
    pool(pair.mask, score);
    return score;
  }

 private:
  static void compare_ldr(const ImagePair& pair, const ViewingConditions& viewing,
                          Comparison& comparison) {
    const InputImage reference = rgb_input(pair.reference);
    const InputImage test = rgb_input(pair.test);
    comparison.compare(ldr_rows(reference.image(), viewing.exposure_ev),
                       ldr_rows(test.image(), viewing.exposure_ev));
  }

  void compare_hdr(const ImagePair& pair, Comparison& comparison, Score& score) const {
    const InputImage reference = linear_input(pair.reference, "flip");
    const InputImage test = linear_input(pair.test, "flip");
    const ExposureRange range = choose_exposures(
        reference.image(), test.image(), settings_.tone_mapper, settings_.exposures, pair.mask);
    for (int i = 0; i < range.count; ++i) {
      const double exposure_ev = range.exposure_ev(i);
      comparison.compare(tone_mapped_rows(reference.image(), settings_.tone_mapper, exposure_ev),
                         tone_mapped_rows(test.image(), settings_.tone_mapper, exposure_ev));
    }
    const std::size_t negative = count_negative(reference.image()) + count_negative(test.image());
    score.details.insert(score.details.end(),
                         {{"start_exposure", range.start_ev},
                          {"stop_exposure", range.stop_ev},
                          {"exposures", static_cast<double>(range.count)},
                          {"exposure_fallback", static_cast<double>(range.fallback)},
                          {"negative_values", static_cast<double>(negative)}});
  }

  FlipSettings settings_;
};

/// The widest range of exposures that the frames of a sequence ask for: from the exposure of the
/// brightest pixel of all to that of the darkest median. Every frame is judged over the whole range
/// that it would have on its own, and as the others are. Display-encoded references have no say
/// where the mode is automatic: pairs of them are compared without exposures.
class FlipSequenceSettings : public SequenceSettings {
 public:
  explicit FlipSequenceSettings(const base::Parameters& parameters)
      : parameters_(parameters), settings_(read_settings(parameters)) {}

  void add(const Image& reference, const Image* mask) override {
    if (settings_.mode == Mode::automatic && reference.encoding == Encoding::display) return;
    is_hdr_ = true;
    const InputImage linear = linear_input(reference, "flip");
    const auto own = reference_exposures(linear.image(), settings_.tone_mapper, mask);
    if (!own) return;
    if (!widest_) widest_ = own;
    widest_->start_ev = std::min(widest_->start_ev, own->start_ev);
    widest_->stop_ev = std::max(widest_->stop_ev, own->stop_ev);
  }

  /// Exposure 0 where every reference is black, as for one black pair.
  base::Parameters parameters() const override {
    base::Parameters parameters = parameters_;
    if (!is_hdr_) return parameters;
    const ReferenceExposures found = widest_.value_or(ReferenceExposures{});
    if (!settings_.exposures.start_ev) parameters.set("start_exposure", text_of(found.start_ev));
    if (!settings_.exposures.stop_ev) parameters.set("stop_exposure", text_of(found.stop_ev));
    return parameters;
  }

 private:
  /// As the parameters are written, within what they accept; digits that a reader can compare.
  static std::string text_of(double exposure_ev) {
    constexpr double kStepsPerStop = 1e4;
    const double rounded = std::round(exposure_ev * kStepsPerStop) / kStepsPerStop;
    return fmt::format("{}", std::clamp(rounded, -kLargestExposureEv, kLargestExposureEv));
  }

  base::Parameters parameters_;
  FlipSettings settings_;
  bool is_hdr_ = false;  ///< a reference was seen that exposures are for
  std::optional<ReferenceExposures> widest_;
};

base::ParameterSpec exposure_parameter(const char* name, const char* doc) {
  base::ParameterSpec spec;
  spec.name = name;
  spec.type = base::ParameterType::text;
  spec.default_value = std::string("auto");
  spec.unit = "stops";
  spec.doc = doc;
  return spec;
}

}  // namespace

MetricInfo flip_info() {
  MetricInfo info;
  info.name = "flip";
  info.summary =
      "Difference noticed when flipping between two pictures: mean over pixels of "
      "colour^(1 - feature), colour and feature differences in [0, 1]; for scene-linear images the "
      "largest over a range of exposures.";
  info.source = "Andersson et al. 2020, doi:10.1145/3406183; 2021, doi:10.2312/egs.20211015";
  info.better = Better::lower;
  info.input = "sRGB-encoded (both: LDR), else scene-linear RGB (HDR)";
  info.identical_value = 0.0;
  info.map_scale = {0.0, 1.0, false, ""};
  constexpr double kMostExposures = 1000.0;
  info.parameters = {
      base::real_parameter("ppd", 0.0, {0.0, kFlipHighestPpd}, "pixels per degree",
                           "resolution at the eye; 0 takes that of the viewing conditions (ours)"),
      base::choice_parameter("mode", {"auto", "ldr", "hdr"}, "auto",
                             "auto compares display-encoded pairs as LDR, others as HDR (ours)"),
      base::choice_parameter("tonemapper", {"aces", "hable", "reinhard"}, "aces",
                             "tone curve of the HDR comparison (Andersson et al. 2021)"),
      exposure_parameter("start_exposure",
                         "first exposure, or auto: the reference's maximum at 0.85 (Andersson et "
                         "al. 2021)"),
      exposure_parameter("stop_exposure",
                         "last exposure, or auto: the reference's median at 0.85 (Andersson et "
                         "al. 2021)"),
      base::integer_parameter(
          "exposures", 0, {0.0, kMostExposures}, "",
          "number of exposures from start to stop; 0: max(2, ceil(stop - start)) "
          "(Andersson et al. 2021); 1: the start only")};
  info.create = [](const base::Parameters& parameters) -> std::unique_ptr<Metric> {
    return std::make_unique<Flip>(read_settings(parameters));
  };
  info.sequence_settings =
      [](const base::Parameters& parameters) -> std::unique_ptr<SequenceSettings> {
    const FlipSettings settings = read_settings(parameters);
    const bool is_open = !settings.exposures.start_ev || !settings.exposures.stop_ev;
    if (settings.mode == Mode::ldr || !is_open) return nullptr;
    return std::make_unique<FlipSequenceSettings>(parameters);
  };
  return info;
}

}  // namespace metrics
