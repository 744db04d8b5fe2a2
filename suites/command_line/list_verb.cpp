#include <ostream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "perception/base/errors.h"
#include "results/run_record.h"
#include "suites/command_line/exit_codes.h"
#include "suites/command_line/list_json.h"
#include "suites/command_line/verbs.h"

namespace suites::command_line {

using nlohmann::ordered_json;

namespace {

/// One kind of thing to list: its entries, and which of their fields a person sees first.
struct Listing {
  const char* kind;
  ordered_json (*entries)();
  ordered_json (*names)();  ///< entries of names alone, which takes no time
  std::vector<std::string> columns;
};

std::vector<Listing> listings() {
  return {{"renderers",
           renderers_json,
           renderer_names,
           {"name", "transports", "progressive", "summary"}},
          {"metrics",
           metrics_json,
           metric_names,
           {"name", "scope", "unit", "better", "input", "summary"}},
          {"scenes",
           scenes_json,
           scene_names,
           {"name", "faces", "lights", "frames", "features", "summary"}},
          {"suites",
           suites_json,
           suite_names,
           {"name", "kind", "scenes", "methods", "profiles", "summary"}},
          {"devices",
           devices_json,
           device_names,
           {"name", "kind", "cores", "renderer", "software", "details"}}};
}

std::string plain(const ordered_json& value) {
  return value.is_string() ? value.get<std::string>() : value.dump();
}

/// Values of a list or a map, "Embree 3.13.5" for the latter.
std::string join(const ordered_json& values) {
  std::string text;
  for (const auto& [key, value] : values.items()) {
    const std::string label = values.is_object() ? key + " " : "";
    text += (text.empty() ? "" : " ") + label + plain(value);
  }
  return text;
}

/// Libraries of the processor, version and limits of a graphics platform, or why it has none.
std::string device_details(const ordered_json& entry) {
  if (!entry["reason"].is_null()) return "not usable: " + entry["reason"].get<std::string>();
  if (entry["version"].is_null()) return join(entry["libraries"]);
  return fmt::format("{}; {}; {}", entry["vendor"].get<std::string>(),
                     entry["version"].get<std::string>(), join(entry["limits"]));
}

/// One field of an entry as a person reads it.
std::string field_text(const ordered_json& entry, const std::string& column) {
  if (column == "transports") {
    std::string text;
    for (const ordered_json& claims : entry.at("claims")) {
      const auto transport = claims.at("transport").get<std::string>();
      if (claims.at("part") == "all") text += (text.empty() ? "" : " ") + transport;
    }
    return text;
  }
  if (column == "summary" && entry.contains("reason") && !entry["reason"].is_null()) {
    return "cannot be read: " + entry["reason"].get<std::string>();
  }
  if (column == "details") return device_details(entry);
  const ordered_json& value = entry.at(column);
  if (value.is_null()) return "-";
  if (value.is_string()) return value.get<std::string>();
  if (value.is_object() && value.contains("unit")) return value["unit"].get<std::string>();
  return value.is_structured() ? join(value) : value.dump();
}

std::string entries_text(const Listing& listing, const ordered_json& entries) {
  std::vector<std::vector<std::string>> rows{listing.columns};
  for (const ordered_json& entry : entries) {
    std::vector<std::string> row;
    for (const std::string& column : listing.columns) row.push_back(field_text(entry, column));
    rows.push_back(std::move(row));
  }
  return text_table(rows);
}

/// Parameters of renderers and metrics, a line each, below the table.
std::string parameters_text(const ordered_json& entries) {
  std::string text;
  for (const ordered_json& entry : entries) {
    if (!entry.contains("parameters") || entry["parameters"].empty()) continue;
    std::vector<std::vector<std::string>> rows;
    for (const ordered_json& p : entry["parameters"]) {
      std::string accepted = p["type"].get<std::string>();
      if (!p["choices"].empty()) accepted = join(p["choices"]);
      if (!p["min"].is_null() || !p["max"].is_null()) {
        accepted += fmt::format(" {} ... {}", p["min"].is_null() ? "" : p["min"].dump(),
                                p["max"].is_null() ? "" : p["max"].dump());
      }
      rows.push_back({"  " + p["name"].get<std::string>(),
                      "default " + (p["default"].is_string() ? p["default"].get<std::string>()
                                                             : p["default"].dump()),
                      accepted, p["doc"].get<std::string>()});
    }
    text += "\n" + entry["name"].get<std::string>() + "\n" + text_table(rows);
  }
  return text;
}

const Listing& find_listing(const std::vector<Listing>& all, const std::string& kind) {
  std::vector<std::string> known;
  for (const Listing& listing : all) {
    if (kind == listing.kind) return listing;
    known.emplace_back(listing.kind);
  }
  throw base::InputError({"discern list"}, base::unknown_name("list", kind, known));
}

}  // namespace

int run_list(const ListArguments& arguments, Console& console) {
  const std::vector<Listing> all = listings();
  const Listing& listing = find_listing(all, arguments.kind);
  const bool has_names_alone = arguments.names && !arguments.json;
  const ordered_json entries =
      with_names_matching(has_names_alone ? listing.names() : listing.entries(), arguments.filter);
  if (has_names_alone) {
    for (const ordered_json& entry : entries)
      console.out << entry.at("name").get<std::string>() << '\n';
    return kAsExpected;
  }
  if (arguments.json) {
    print_json(console,
               {{"schema", results::kSchemaVersion}, {"status", "ok"}, {listing.kind, entries}});
  } else {
    console.out << entries_text(listing, entries) << parameters_text(entries);
  }
  return kAsExpected;
}

}  // namespace suites::command_line
