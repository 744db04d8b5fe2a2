#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "perception/base/parameter_spec.h"
#include "perception/false_color.h"
#include "perception/image.h"
#include "perception/viewing_conditions.h"

namespace metrics {

using perception::Image;
using perception::ViewingConditions;

struct NamedValue {
  std::string name;  ///< snake_case
  double value = 0.0;
};

/// A rectangle of the image worth a look, with the value that makes it so.
struct Region {
  int x_px = 0, y_px = 0, width_px = 0, height_px = 0;
  double value = 0.0;
};

struct Score {
  double value = 0.0;               ///< NaN if the images hold non-finite pixels
  std::vector<NamedValue> details;  ///< a gate may name metric.detail
  std::vector<Region> regions;
  std::size_t non_finite_pixels = 0;
  std::optional<Image> map;  ///< one channel, size of the images, in the metric's map unit
};

/// Two images of the same size. The optional ones have the same size, too; a mask pixel of 0 takes
/// no part in the pooled value.
struct ImagePair {
  const Image& reference;
  const Image& test;
  const Image* reference_variance = nullptr;  ///< variance of the reference's pixel means
  const Image* mask = nullptr;                ///< one channel, 0 or 1
};

class Metric {
 public:
  virtual ~Metric() = default;
  /// @param pair  finite pixels only; `score` below takes care of others
  /// @throws base::InputError for an encoding the metric does not take
  virtual Score evaluate(const ImagePair& pair, const ViewingConditions& viewing) const = 0;
  /// True if any value that is not finite, in a pair without a mask, makes the score not finite:
  /// such values need not be looked for before, then.
  virtual bool shows_non_finite() const { return false; }
};

/// Finds what a metric that follows each reference image must keep fixed over a sequence, so that
/// its scores can be compared from frame to frame. It sees the reference frames one by one, so that
/// memory is bounded by a frame.
class SequenceSettings {
 public:
  virtual ~SequenceSettings() = default;
  /// @param reference  R, G, B of a frame
  /// @param mask       pixels of 0 have no say, at least one is not 0; null: all have
  virtual void add(const Image& reference, const Image* mask) = 0;
  /// The metric's parameters with what was found in the place of what was left open.
  virtual base::Parameters parameters() const = 0;
};

/// Frames of two sequences, in the order in which they are shown.
struct SequencePair {
  std::span<const Image> reference;  ///< at least one frame, all of one size and encoding
  std::span<const Image> test;       ///< as many, of that size
  double frames_per_second = 60.0;   ///< how fast they are shown
  const Image* mask = nullptr;       ///< one channel, 0 or 1, for every frame
};

/// A metric of what changes from frame to frame, which no score of single frames tells.
///
/// The caller holds the frames: a long sequence is scored in spans that overlap by what the metric
/// says it needs, so that memory is bounded by a span.
class SequenceMetric {
 public:
  virtual ~SequenceMetric() = default;
  /// Frames before the one that is judged which its score depends on; spans overlap by so many.
  virtual int history_frames() const = 0;
  /// One score per frame from `history_frames()` on, none for a span that is not longer; each has
  /// the map of its frame. The value of a sequence is the mean over its frames' values.
  /// @param pair  finite pixels only
  /// @throws base::InputError for sizes, numbers of frames or encodings that do not agree
  virtual std::vector<Score> evaluate(const SequencePair& pair,
                                      const ViewingConditions& viewing) const = 0;
};

enum class Better { lower, higher };

/// What one score is of.
enum class MetricScope {
  image,    ///< one image
  sequence  ///< the change to a frame from those before it
};

/// What a table's entry says of a metric, whatever it scores.
struct MetricDescription {
  MetricScope scope = MetricScope::image;
  std::string name;     ///< kebab-case
  std::string summary;  ///< one sentence, with the formula
  std::string unit;     ///< of the value; "" if it has none
  std::string source;   ///< citation
  Better better = Better::lower;
  std::string input;             ///< "scene-linear RGB", "sRGB-encoded", "absolute light"
  double identical_value = 0.0;  ///< of two identical images; may be infinite
  int version = 1;               ///< raised when the numbers change
  std::vector<base::ParameterSpec> parameters;
  std::vector<std::string> shares_model_with;  ///< renderers it steers: "not independent"
  perception::MapScale map_scale;              ///< one fixed scale for every map of this metric
  std::string map_unit;
};

/// A metric's entry in the explicit table of metric_list.h.
struct MetricInfo : MetricDescription {
  std::unique_ptr<Metric> (*create)(const base::Parameters& parameters) = nullptr;
  /// For a metric that chooses settings by the reference image: what finds them for a sequence.
  /// Null, or returning null, where the parameters leave nothing open.
  std::unique_ptr<SequenceSettings> (*sequence_settings)(const base::Parameters& parameters) =
      nullptr;
};

/// A sequence metric's entry in the table of its own.
struct SequenceMetricInfo : MetricDescription {
  SequenceMetricInfo() { scope = MetricScope::sequence; }
  std::unique_ptr<SequenceMetric> (*create)(const base::Parameters& parameters) = nullptr;
};

}  // namespace metrics
