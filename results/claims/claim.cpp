#include "results/claims/claim.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "perception/base/names.h"
#include "results/claims/expectation.h"
#include "results/claims/function_table.h"
#include "results/json_fields.h"

namespace results::claims {

using nlohmann::ordered_json;

namespace {

/// Texts of an entry that is one of them or a list.
struct PlacedText {
  std::string text;
  base::Place place;
};

std::vector<PlacedText> one_or_several(const base::Node& node, const char* what) {
  if (!node.is_list()) return {{node.scalar_text(what), node.text_place()}};
  std::vector<PlacedText> texts;
  for (const base::Node& entry : node.list(what)) {
    texts.push_back({entry.scalar_text(what), entry.text_place()});
  }
  if (texts.empty()) {
    throw base::InputError(node.place(), fmt::format("{} is an empty list", what));
  }
  return texts;
}

/// Reads "yes", "share only", "no: reason" into the claim.
void read_comparable(const std::string& text, const base::Place& place, Claim& claim) {
  constexpr std::string_view kNo = "no:";
  if (text == "yes") return;
  if (text == "share only") {
    claim.comparable = Comparable::share_only;
    return;
  }
  const std::size_t reason =
      text.starts_with(kNo) ? text.find_first_not_of(' ', kNo.size()) : std::string::npos;
  if (reason == std::string::npos) {
    throw base::InputError(place, fmt::format("comparable \"{}\" is not known; accepted: \"yes\", "
                                              "\"share only\", \"no: REASON\"",
                                              text));
  }
  claim.comparable = Comparable::no;
  claim.comparable_reason = text.substr(reason);
}

constexpr std::array<const char*, 3> kBelowNoiseNames{"counts", "skip", "inconclusive"};

BelowNoise read_below_noise(const std::string& text, const base::Place& place) {
  for (std::size_t i = 0; i < kBelowNoiseNames.size(); ++i) {
    if (text == kBelowNoiseNames[i]) return static_cast<BelowNoise>(i);
  }
  throw base::InputError(
      place, base::unknown_name(
                 "below_noise", text,
                 std::vector<std::string>(kBelowNoiseNames.begin(), kBelowNoiseNames.end())));
}

/// Reads the expressions, so that their mistakes are told before a run.
void check_language(const Claim& claim) {
  bool is_list = claim.measures.size() > 1;
  bool is_share = false;
  for (std::size_t i = 0; i < claim.measures.size(); ++i) {
    const Expression expression = parse_expression(claim.measures[i], claim.measure_places[i]);
    if (is_list && gives_list(expression)) {
      throw base::InputError(claim.measure_places[i],
                             fmt::format("\"{}\" is a list itself; accepted in a list of measures: "
                                         "single values",
                                         claim.measures[i]));
    }
    is_list = is_list || gives_list(expression);
    is_share = expression.kind == Expression::Kind::call && expression.function->name == "share";
  }
  using Kind = Expectation::Kind;
  const Expectation expectation = parse_expectation(claim.expect, claim.expect_place);
  const bool is_extreme = expectation.kind == Kind::largest || expectation.kind == Kind::smallest;
  const bool is_of_single = expectation.kind == Kind::bound || expectation.kind == Kind::printed;
  if (is_list || is_of_single || (is_extreme && is_share)) return;
  throw base::InputError(
      claim.expect_place,
      fmt::format("\"{}\" says nothing of a single value; accepted: a bound, or a measure that is "
                  "{}series(...) or a list",
                  claim.expect, is_extreme ? "share(...), " : ""));
}

Claim read_claim(const base::Node& node) {
  base::MapReader reader(node, "claim");
  Claim claim;
  const base::Node& id = reader.require("id");
  claim.id = id.scalar_text("id");
  claim.place = id.place();
  if (!base::is_path_safe(claim.id)) {
    throw base::InputError(claim.place, fmt::format("claim id \"{}\" cannot be a file name; "
                                                    "accepted: letters, digits, . _ -",
                                                    claim.id));
  }
  claim.item = reader.required_text("item");
  claim.says = reader.required_text("says");
  for (PlacedText& measure : one_or_several(reader.require("measure"), "measure")) {
    claim.measures.push_back(std::move(measure.text));
    claim.measure_places.push_back(std::move(measure.place));
  }
  const base::Node& expect = reader.require("expect");
  claim.expect = expect.scalar_text("expect");
  claim.expect_place = expect.text_place();
  if (const base::Node* profile = reader.find("profile")) {
    for (PlacedText& name : one_or_several(*profile, "profile")) {
      claim.profiles.push_back(std::move(name.text));
    }
  }
  if (const base::Node* comparable = reader.find("comparable")) {
    read_comparable(comparable->scalar_text("comparable"), comparable->place(), claim);
  }
  if (const base::Node* noise = reader.find("below_noise")) {
    claim.below_noise = read_below_noise(noise->scalar_text("below_noise"), noise->place());
  }
  claim.printed = reader.text("printed", "");
  claim.criterion = reader.text("criterion", "");
  reader.finish();
  check_language(claim);
  return claim;
}

/// A text, or a list of texts, of a claim in run.json.
std::vector<std::string> texts_of(const JsonFields& fields, const char* key) {
  const ordered_json& value = fields.require(key);
  if (value.is_string()) return {value.get<std::string>()};
  std::vector<std::string> texts;
  for (const ordered_json& text : fields.list(key)) {
    if (!text.is_string()) fields.fail(key, "a list of texts", text);
    texts.push_back(text.get<std::string>());
  }
  return texts;
}

Claim claim_from_json(const ordered_json& json) {
  const JsonFields fields(json, "claim");
  Claim claim;
  claim.id = fields.text("id");
  claim.item = fields.text("item");
  claim.says = fields.text("says");
  claim.measures = texts_of(fields, "measure");
  claim.measure_places.resize(claim.measures.size());
  claim.expect = fields.text("expect");
  if (json.contains("profile")) claim.profiles = texts_of(fields, "profile");
  read_comparable(fields.optional_text("comparable").value_or("yes"), {}, claim);
  claim.below_noise =
      read_below_noise(fields.optional_text("below_noise").value_or(kBelowNoiseNames[0]), {});
  claim.printed = fields.optional_text("printed").value_or("");
  claim.criterion = fields.optional_text("criterion").value_or("");
  return claim;
}

ordered_json one_or_list(const std::vector<std::string>& texts) {
  return texts.size() == 1 ? ordered_json(texts.front()) : ordered_json(texts);
}

}  // namespace

std::string Claim::comparable_text() const {
  switch (comparable) {
    case Comparable::yes:
      return "yes";
    case Comparable::share_only:
      return "share only";
    case Comparable::no:
      break;
  }
  return "no: " + comparable_reason;
}

std::string Claim::below_noise_text() const {
  return kBelowNoiseNames[static_cast<std::size_t>(below_noise)];
}

std::vector<Claim> read_claims(const base::Node& list) {
  std::vector<Claim> claims;
  for (const base::Node& node : list.list("claims")) {
    Claim claim = read_claim(node);
    for (const Claim& other : claims) {
      if (!base::is_same_name(other.id, claim.id)) continue;
      throw base::InputError(
          claim.place, fmt::format("claim id \"{}\" is used twice; it stands first in line {}",
                                   claim.id, other.place.line));
    }
    claims.push_back(std::move(claim));
  }
  return claims;
}

ordered_json to_json(const Claim& claim) {
  ordered_json json{{"id", claim.id}, {"item", claim.item}, {"says", claim.says}};
  json["measure"] = one_or_list(claim.measures);
  json["expect"] = claim.expect;
  if (!claim.profiles.empty()) json["profile"] = one_or_list(claim.profiles);
  if (claim.comparable != Comparable::yes) json["comparable"] = claim.comparable_text();
  if (claim.below_noise != BelowNoise::counts) json["below_noise"] = claim.below_noise_text();
  if (!claim.printed.empty()) json["printed"] = claim.printed;
  if (!claim.criterion.empty()) json["criterion"] = claim.criterion;
  return json;
}

ordered_json to_json(std::span<const Claim> claims) {
  ordered_json list = ordered_json::array();
  for (const Claim& claim : claims) list.push_back(to_json(claim));
  return list;
}

std::vector<Claim> claims_from_json(const ordered_json& list) {
  if (!list.is_array()) throw base::InputError("\"claims\" of run.json must be a list");
  std::vector<Claim> claims;
  for (const ordered_json& json : list) claims.push_back(claim_from_json(json));
  return claims;
}

}  // namespace results::claims
