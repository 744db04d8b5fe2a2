#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "results/run_record.h"

namespace results {

/// A number of a record, by its name in JSON.
struct RecordField {
  const char* name;
  const char* unit;
  std::optional<double> (*value)(const RenderRecord& render);
};

/// Times, memory and samples, in the order to list them.
std::span<const RecordField> record_fields();
/// Null if there is no such field.
const RecordField* find_record_field(std::string_view name);

/// The value of a score, or of one of its details; nothing if it has none.
/// @param detail  "" for the value itself
std::optional<double> score_value(const MetricRecord& record, std::string_view detail);

}  // namespace results
