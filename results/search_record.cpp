#include "results/search_record.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "results/json_fields.h"
#include "results/run_record.h"

namespace results {

using nlohmann::ordered_json;

ordered_json to_json(const SearchRecord& record) {
  ordered_json json;
  json["schema"] = kSchemaVersion;
  json["scene"] = record.scene;
  json["method"] = record.method;
  json["budget"] = record.budget;
  json["setting"] = record.setting;
  json["quantity"] = record.quantity;
  json["target"] = finite_or_null(record.target);
  json["value"] = record.value ? finite_or_null(*record.value) : ordered_json(nullptr);
  json["achieved"] = record.achieved ? finite_or_null(*record.achieved) : ordered_json(nullptr);
  json["outcome"] = record.outcome;
  json["reason"] = record.reason.empty() ? ordered_json(nullptr) : ordered_json(record.reason);
  json["probes"] = ordered_json::array();
  for (const SearchRecord::Probe& probe : record.probes) {
    json["probes"].push_back(
        {{"setting", probe.setting}, {"measured", finite_or_null(probe.measured)}});
  }
  return json;
}

SearchRecord search_record_from_json(const ordered_json& json) {
  const JsonFields fields(json, "search record");
  SearchRecord record;
  record.scene = fields.text("scene");
  record.method = fields.text("method");
  record.budget = fields.text("budget");
  record.setting = fields.text("setting");
  record.quantity = fields.text("quantity");
  record.target = fields.number("target");
  record.value = fields.optional_number("value");
  record.achieved = fields.optional_number("achieved");
  record.outcome = fields.text("outcome");
  record.reason = fields.optional_text("reason").value_or("");
  const ordered_json& probes = fields.list("probes");
  for (std::size_t i = 0; i < probes.size(); ++i) {
    const JsonFields probe(probes[i], fmt::format("search record: probes[{}]", i));
    record.probes.push_back({probe.number("setting"), probe.number("measured")});
  }
  return record;
}

}  // namespace results
