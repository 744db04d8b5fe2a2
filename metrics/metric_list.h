#pragma once

#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "metrics/metric.h"

namespace metrics {

/// Every metric of the program, sorted by name.
std::span<const MetricInfo> metric_list();

/// @throws base::InputError with the nearest known name
const MetricInfo& find_metric(std::string_view name, const base::Place& place);

/// A metric with resolved parameters, as a user wrote it: `flip` or `relmse,trim=0.001`.
struct MetricChoice {
  std::string text;  ///< as given; the key of the score in every output
  const MetricInfo* info = nullptr;
  base::Parameters parameters;
};

/// @throws base::InputError for an unknown metric or parameter
MetricChoice parse_metric_choice(std::string_view text, const base::Place& place);

/// Every metric of sequences, sorted by name.
std::span<const SequenceMetricInfo> sequence_metric_list();

/// @throws base::InputError with the nearest known name
const SequenceMetricInfo& find_sequence_metric(std::string_view name, const base::Place& place);

/// A sequence metric with resolved parameters: `flicker` or `flicker,csf=barten_1989`.
struct SequenceMetricChoice {
  std::string text;  ///< as given
  const SequenceMetricInfo* info = nullptr;
  base::Parameters parameters;
};

/// @throws base::InputError for an unknown metric or parameter
SequenceMetricChoice parse_sequence_metric_choice(std::string_view text, const base::Place& place);

/// A choice from either table.
using AnyMetricChoice = std::variant<MetricChoice, SequenceMetricChoice>;

/// @throws base::InputError for an unknown metric, with the names of both tables, or parameter
AnyMetricChoice parse_any_metric_choice(std::string_view text, const base::Place& place);

/// As given.
const std::string& text_of(const AnyMetricChoice& choice);
const base::Parameters& parameters_of(const AnyMetricChoice& choice);
const MetricDescription& description_of(const AnyMetricChoice& choice);

/// The entry of either table; null if neither has the name.
const MetricDescription* find_description(std::string_view name);

struct ScoreOptions {
  bool ignore_non_finite = false;  ///< score the other pixels and divide by their number
  bool with_map = true;
};

/// Scores a pair with everything that holds for all metrics: sizes must agree, non-finite pixels
/// make the value NaN (or are left out on request) and are counted, empty masks are refused.
/// @throws base::InputError naming both sizes, or the encodings the metric takes
Score score(const MetricChoice& choice, const ImagePair& pair, const ViewingConditions& viewing,
            const ScoreOptions& options = {});

}  // namespace metrics
