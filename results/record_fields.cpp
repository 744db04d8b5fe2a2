#include "results/record_fields.h"

#include <array>

#include "perception/base/names.h"

namespace results {
namespace {

const std::array<RecordField, 12> kFields{{
    {"total_s", "s", [](const RenderRecord& r) { return std::optional(timed_s(r)); }},
    {"prepare_s", "s", [](const RenderRecord& r) { return std::optional(r.prepare_s); }},
    {"update_s", "s", [](const RenderRecord& r) { return r.update_s; }},
    {"render_s", "s", [](const RenderRecord& r) { return std::optional(r.render_s); }},
    {"next_frame_s", "s", [](const RenderRecord& r) { return r.next_frame_s; }},
    {"new_view_s", "s", [](const RenderRecord& r) { return r.new_view_s; }},
    {"start_up_s", "s", [](const RenderRecord& r) { return std::optional(r.start_up_s); }},
    {"readback_s", "s", [](const RenderRecord& r) { return std::optional(r.readback_s); }},
    {"unattributed_s", "s", [](const RenderRecord& r) { return std::optional(r.unattributed_s); }},
    {"peak_memory_bytes", "bytes",
     [](const RenderRecord& r) { return std::optional(static_cast<double>(r.peak_memory_bytes)); }},
    {"pixels", "",
     [](const RenderRecord& r) {
       return std::optional(static_cast<double>(r.width_px) * static_cast<double>(r.height_px));
     }},
    {"samples", "",
     [](const RenderRecord& r) {
       return r.samples ? std::optional(static_cast<double>(*r.samples)) : std::nullopt;
     }},
}};

}  // namespace

std::span<const RecordField> record_fields() { return kFields; }

const RecordField* find_record_field(std::string_view name) {
  for (const RecordField& field : kFields) {
    if (base::is_same_name(field.name, name)) return &field;
  }
  return nullptr;
}

std::optional<double> score_value(const MetricRecord& record, std::string_view detail) {
  if (detail.empty()) return record.value;
  for (const auto& [name, value] : record.details) {
    if (base::is_same_name(name, detail)) return value;
  }
  return std::nullopt;
}

}  // namespace results
