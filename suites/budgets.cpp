#include "suites/budgets.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "metrics/metric_list.h"
#include "perception/base/names.h"
#include "perception/base/units.h"

namespace suites {
namespace {

constexpr const char* kAccepted =
    "{samples: N}, {time: 10s}, {time: {of: METHOD}}, {error: {metric: M, at: V}} or fixed";

std::vector<const base::Node*> one_or_many(const base::Node& node) {
  std::vector<const base::Node*> values;
  if (!node.is_list()) return {&node};
  for (const base::Node& value : node.list("values")) values.push_back(&value);
  return values;
}

Budget samples_budget(const base::Node& node) {
  const std::int64_t samples = node.integer("samples");
  if (samples < 1) {
    throw base::InputError(node.place(),
                           fmt::format("samples is {}; accepted: 1 or more", samples));
  }
  Budget budget;
  budget.samples = samples;
  return budget;
}

Budget time_budget(const base::Node& node) {
  Budget budget;
  if (node.is_map()) {
    base::MapReader reader(node, "time");
    budget.time_of = reader.require("of").text("of");
    reader.finish();
  } else {
    budget.time_s = base::parse_duration_s(node.scalar_text("time"), node.place());
  }
  return budget;
}

void append_error_budgets(const base::Node& node, std::vector<Budget>& budgets) {
  base::MapReader reader(node, "error");
  const base::Node& metric = reader.require("metric");
  const base::Node& targets = reader.require("at");
  reader.finish();
  const metrics::AnyMetricChoice choice =
      metrics::parse_any_metric_choice(metric.text("metric"), metric.place());
  if (!std::holds_alternative<metrics::MetricChoice>(choice)) {
    throw base::InputError(metric.place(),
                           fmt::format("metric \"{}\" scores sequences; accepted: image metrics",
                                       description_of(choice).name));
  }
  for (const base::Node* target : one_or_many(targets)) {
    const double at = target->number("at");
    if (is_error(description_of(choice)) && at <= 0.0) {
      throw base::InputError(target->place(), fmt::format("at is {}; accepted: above 0", at));
    }
    Budget budget;
    budget.error = ErrorTarget{text_of(choice), at};
    budgets.push_back(std::move(budget));
  }
}

void append_budgets(const base::Node& node, std::vector<Budget>& budgets) {
  if (node.kind() == base::Node::Kind::text && node.text("budget") == "fixed") {
    budgets.emplace_back();
    return;
  }
  if (!node.is_map()) {
    throw base::InputError(node.place(), fmt::format("a budget must be {}; found {}", kAccepted,
                                                     base::Node::kind_name(node.kind())));
  }
  base::MapReader reader(node, "budget");
  const base::Node* samples = reader.find("samples");
  const base::Node* time = reader.find("time");
  const base::Node* error = reader.find("error");
  reader.finish();
  if ((samples != nullptr) + (time != nullptr) + (error != nullptr) != 1) {
    throw base::InputError(node.place(), "a budget needs exactly one of: samples, time, error");
  }
  if (error != nullptr) {
    append_error_budgets(*error, budgets);
    return;
  }
  for (const base::Node* value : one_or_many(samples != nullptr ? *samples : *time)) {
    budgets.push_back(samples != nullptr ? samples_budget(*value) : time_budget(*value));
  }
}

/// A bound of the search as the file states it, else as the parameter declares it.
double read_bound(const base::Node* node, const char* key, std::optional<double> declared,
                  const base::Node& search) {
  if (node != nullptr) {
    const double value = node->number(key);
    const bool is_inside = value > 0.0;
    if (is_inside) return value;
    throw base::InputError(node->place(), fmt::format("{} is {}; accepted: above 0", key, value));
  }
  if (declared && *declared > 0.0) return *declared;
  throw base::InputError(
      search.place(), fmt::format("search needs `{}`: the parameter declares no such bound above "
                                  "0",
                                  key));
}

const base::ParameterSpec& searched_parameter(const base::Node& name,
                                              const renderers::RendererInfo& renderer) {
  std::vector<std::string> numbers;
  for (const base::ParameterSpec& spec : renderer.parameters) {
    const bool is_number =
        spec.type == base::ParameterType::integer || spec.type == base::ParameterType::real;
    if (!is_number) continue;
    if (base::is_same_name(spec.name, name.text("setting"))) return spec;
    numbers.push_back(spec.name);
  }
  throw base::InputError(
      name.place(), base::unknown_name(fmt::format("setting of renderer \"{}\"", renderer.name),
                                       name.text("setting"), numbers));
}

}  // namespace

std::string Budget::name() const {
  if (samples) return fmt::format("{}spp", *samples);
  if (time_s) return fmt::format("{}s", *time_s);
  if (!time_of.empty()) return "time-of-" + time_of;
  if (error) return fmt::format("{}={}", error->metric, error->at);
  return "fixed";
}

std::vector<Budget> read_budgets(const base::Node& node) {
  std::vector<Budget> budgets;
  for (const base::Node& item : node.list("budgets")) {
    const std::size_t before = budgets.size();
    append_budgets(item, budgets);
    for (std::size_t i = before; i < budgets.size(); ++i) {
      const auto end = budgets.begin() + static_cast<std::ptrdiff_t>(i);
      if (std::find(budgets.begin(), end, budgets[i]) != end) {
        throw base::InputError(item.place(),
                               fmt::format("budget {} is listed twice", budgets[i].name()));
      }
    }
  }
  if (budgets.empty()) {
    throw base::InputError(node.place(), "budgets is empty; accepted: samples, time, error, fixed");
  }
  return budgets;
}

SearchedSetting read_search(const base::Node& node, const renderers::RendererInfo& renderer) {
  SearchedSetting search;
  const base::Node* name = &node;
  const base::Node* from = nullptr;
  const base::Node* to = nullptr;
  if (node.is_map()) {
    base::MapReader reader(node, "search");
    name = &reader.require("setting");
    from = reader.find("from");
    to = reader.find("to");
    reader.finish();
  }
  const bool is_samples =
      renderer.progressive_unit && base::is_same_name(name->text("setting"), "samples");
  if (is_samples) {
    search.from = read_bound(from, "from", search.from, node);
    search.to = read_bound(to, "to", search.to, node);
  } else {
    const base::ParameterSpec& spec = searched_parameter(*name, renderer);
    search.name = spec.name;
    search.is_whole = spec.type == base::ParameterType::integer;
    search.from = read_bound(from, "from", spec.min, node);
    search.to = read_bound(to, "to", spec.max, node);
    for (const auto& [bound, value] : {std::pair(from, search.from), std::pair(to, search.to)}) {
      const bool is_declared =
          value >= spec.min.value_or(value) && value <= spec.max.value_or(value);
      if (bound == nullptr || is_declared) continue;
      throw base::InputError(
          bound->place(),
          fmt::format("{} lies outside what {} of renderer \"{}\" accepts: {} to {}", value,
                      spec.name, renderer.name,
                      spec.min.value_or(-std::numeric_limits<double>::infinity()),
                      spec.max.value_or(std::numeric_limits<double>::infinity())));
    }
  }
  if (search.is_whole) {
    search.from = std::ceil(search.from);
    search.to = std::floor(search.to);
  }
  if (search.from >= search.to) {
    throw base::InputError(node.place(), fmt::format("search goes from {} to {}; accepted: from "
                                                     "below to",
                                                     search.from, search.to));
  }
  return search;
}

bool is_error(const metrics::MetricDescription& metric) {
  return metric.better == metrics::Better::lower && metric.identical_value == 0.0;
}

bool is_searched(const Budget& budget, bool has_search) {
  return budget.error || !budget.time_of.empty() || (budget.time_s && has_search);
}

}  // namespace suites
