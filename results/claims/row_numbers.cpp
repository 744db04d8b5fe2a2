#include "results/claims/row_numbers.h"

#include <algorithm>
#include <optional>
#include <tuple>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "results/tables.h"

namespace results::claims {
namespace {

Noise noise_of(const Quantity& quantity) {
  return quantity.kind == Quantity::Kind::score ? Noise::seeds : Noise::repetitions;
}

/// Names of a kind that the row's records have.
std::set<std::string> names_of_row(const Run& run, const SummaryRow& row, Quantity::Kind kind) {
  std::set<std::string> names;
  for (const std::size_t index : row.records) {
    const RenderRecord& render = run.cells[index].render;
    if (kind == Quantity::Kind::stage) {
      for (const renderers::StageRecord& stage : render.stages) {
        if (stage.phase != renderers::Phase::new_view) names.insert(stage.path);
      }
    } else if (kind == Quantity::Kind::counter) {
      for (const auto& [name, value] : render.counters) names.insert(name);
    }
  }
  return names;
}

/// Details that scores of a metric have.
std::set<std::string> details_of(const Run& run, const std::string& metric) {
  std::set<std::string> names;
  for (const MetricRecord& record : run.metrics) {
    if (record.metric != metric) continue;
    for (const auto& [name, value] : record.details) names.insert(name);
  }
  return names;
}

/// Numbers the groups of samples that belong to one repetition or seed.
std::vector<std::uint32_t> groups_of(const std::vector<Sample>& samples) {
  std::vector<std::uint32_t> groups;
  std::uint32_t group = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const bool is_next = i > 0 && (samples[i].seed != samples[i - 1].seed ||
                                   samples[i].repetition != samples[i - 1].repetition);
    if (is_next) ++group;
    groups.push_back(group);
  }
  return groups;
}

std::size_t seeds_in(const std::vector<Sample>& samples) {
  std::set<std::uint64_t> seeds;
  for (const Sample& sample : samples) seeds.insert(sample.seed);
  return seeds.size();
}

auto key_of(const Sample& sample) { return std::tie(sample.seed, sample.repetition, sample.frame); }

/// The value of a record among samples that are sorted by record; 0 if it has none.
double value_at(const std::vector<Sample>& samples, const Sample& record) {
  const auto found =
      std::lower_bound(samples.begin(), samples.end(), record,
                       [](const Sample& a, const Sample& b) { return key_of(a) < key_of(b); });
  return found != samples.end() && key_of(*found) == key_of(record) ? found->value : 0.0;
}

}  // namespace

std::string RowNumbers::row_name(std::size_t row) const {
  const RowFacts& facts = values_.rows()[row];
  return fmt::format("{} on {} at {}", facts.method, facts.scene, facts.budget);
}

std::set<std::string> RowNumbers::stage_paths(std::size_t row) const {
  return names_of_row(values_.run(), values_.summary().rows[row], Quantity::Kind::stage);
}

void RowNumbers::require_complete(std::size_t row) const {
  const SummaryRow& summary = values_.summary().rows[row];
  const bool has_other = std::any_of(summary.statuses.begin(), summary.statuses.end(),
                                     [](const auto& entry) { return !is_success(entry.first); });
  if (!has_other && summary.missing_cells == 0) return;
  throw base::InputError(
      fmt::format("{} is not complete: {}", row_name(row), format_statuses(summary)));
}

std::vector<Sample> RowNumbers::samples(std::size_t row, const Quantity& quantity) const {
  std::vector<Sample> samples = values_.samples(row, quantity);
  if (quantity.kind == Quantity::Kind::parameter && !samples.empty()) return samples;
  require_complete(row);
  const SummaryRow& summary = values_.summary().rows[row];
  const bool is_score = quantity.kind == Quantity::Kind::score;
  if (is_score && !samples.empty() && seeds_in(samples) < summary.seeds) {
    throw base::InputError(fmt::format("{} of {} is finite for {} of {} seeds", quantity.text,
                                       row_name(row), seeds_in(samples), summary.seeds));
  }
  if (!samples.empty()) return samples;
  std::string has;
  if (quantity.kind == Quantity::Kind::stage || quantity.kind == Quantity::Kind::counter) {
    const auto names = names_of_row(values_.run(), summary, quantity.kind);
    if (!names.empty()) has = fmt::format("; it has: {}", fmt::join(names, ", "));
  } else if (is_score && !quantity.detail.empty()) {
    const auto details = details_of(values_.run(), quantity.name);
    if (std::find(details.begin(), details.end(), quantity.detail) != details.end()) {
      throw base::InputError(fmt::format("{} of {} is no number", quantity.text, row_name(row)));
    }
    has = fmt::format("; details of {}: {}", quantity.name, fmt::join(details, ", "));
  }
  throw base::InputError(fmt::format("{} has no {}{}", row_name(row), quantity.text, has));
}

const Number& RowNumbers::estimate(std::size_t row, const Quantity& quantity) {
  const auto [entry, is_new] = estimates_.try_emplace(
      {row, fmt::format("{}.{}", static_cast<int>(quantity.kind), quantity.text)});
  Number& number = entry->second;
  if (!is_new) return number;
  try {
    const std::vector<Sample> all = samples(row, quantity);
    const bool is_score = quantity.kind == Quantity::Kind::score;
    const bool is_mean = is_score && is_sequence_metric(quantity.name);
    const std::vector<double> groups = values_over_frames(all, is_mean);
    if (quantity.kind == Quantity::Kind::parameter) {
      number.value = groups.front();
    } else if (is_score) {
      number = resampled_mean(groups, row, Noise::seeds);
    } else {
      number = resampled_median(groups, row, Noise::repetitions);
    }
  } catch (...) {
    estimates_.erase(entry);
    throw;
  }
  return number;
}

Number RowNumbers::share(std::size_t row, std::span<const Quantity> stages, bool lacks_none) {
  Quantity timed;
  timed.name = timed.text = "total_s";
  timed.is_first_frame = stages.front().is_first_frame;
  std::vector<Sample> shares = samples(row, timed);
  for (Sample& share : shares) share.value = 1.0 / share.value;
  std::vector<double> stage_sums(shares.size(), 0.0);
  for (const Quantity& stage : stages) {
    const std::vector<Sample> times =
        lacks_none ? samples(row, stage) : values_.samples(row, stage);
    for (std::size_t i = 0; i < shares.size(); ++i) stage_sums[i] += value_at(times, shares[i]);
  }
  for (std::size_t i = 0; i < shares.size(); ++i) shares[i].value *= stage_sums[i];
  return resampled_median(values_over_frames(shares), row, Noise::repetitions);
}

Number RowNumbers::last(std::size_t row, const Quantity& quantity) {
  const std::vector<Sample> all = samples(row, quantity);
  const std::vector<std::uint32_t> groups = groups_of(all);
  std::vector<double> values;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (i + 1 == all.size() || groups[i + 1] != groups[i]) values.push_back(all[i].value);
  }
  const bool is_score = quantity.kind == Quantity::Kind::score;
  return is_score ? resampled_mean(values, row, Noise::seeds)
                  : resampled_median(values, row, Noise::repetitions);
}

std::vector<PooledSample> RowNumbers::pool(std::span<const std::size_t> rows,
                                           const Quantity& quantity,
                                           std::vector<PooledRow>& pooled) const {
  std::vector<PooledSample> pool;
  for (const std::size_t row : rows) {
    const std::vector<Sample> all = samples(row, quantity);
    const std::vector<std::uint32_t> groups = groups_of(all);
    const auto slot = static_cast<std::uint32_t>(pooled.size());
    for (std::size_t i = 0; i < all.size(); ++i) pool.push_back({all[i].value, slot, groups[i]});
    pooled.push_back({row, groups.back() + 1U});
  }
  return pool;
}

Number RowNumbers::quantile(std::span<const std::size_t> rows, const Quantity& quantity, double q) {
  std::vector<PooledRow> pooled;
  std::vector<PooledSample> all = pool(rows, quantity, pooled);
  return pooled_quantile(std::move(all), pooled, noise_of(quantity), q);
}

Number RowNumbers::share_of(std::span<const std::size_t> rows, const Quantity& quantity,
                            const std::function<bool(double)>& condition) {
  std::vector<PooledRow> pooled;
  const std::vector<PooledSample> all = pool(rows, quantity, pooled);
  return pooled_share(all, pooled, noise_of(quantity), condition);
}

}  // namespace results::claims
