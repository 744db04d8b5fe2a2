#include "renderers/final_gather/sender_classes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "renderers/final_gather/link_gather.h"
#include "renderers/ray_tracing/surface_brdf.h"

namespace renderers::final_gather {

using element_hierarchy::Element;

namespace {

constexpr double kPi = std::numbers::pi;

}  // namespace

/// @param values  one per anchor
double SenderClasses::pooled(const Surrounding& around, std::vector<double> values) const {
  if (settings_.pooling == Pooling::minimum) return *std::ranges::min_element(values);
  double weight = 0.0;
  double sum = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto share = static_cast<double>(around.anchors[i]->weight);
    weight += share;
    sum += share * values[i];
  }
  if (settings_.pooling == Pooling::mean) return sum / weight;
  // Pixels at borders of objects have more anchors, with as many values that are the same.
  const auto quartile = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 4);
  std::ranges::nth_element(values, quartile);
  return *quartile;
}

/// The minimum is too conservative, as masking varies fast (Sec. 5.2.1).
void SenderClasses::weigh(Surrounding& around, GatherVertex& vertex) const {
  const auto& tree = *transfer_.solution().tree;
  const std::size_t frequencies = perception_.frequency_count();
  around.thresholds_cd_m2.assign(frequencies, 0.0);
  if (around.anchors.empty()) return;
  std::vector<double> values(around.anchors.size());
  const auto pool = [&](const auto& of_pixel) {
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = of_pixel(around.anchors[i]->pixel);
    return pooled(around, values);
  };
  for (std::size_t f = 0; f < frequencies; ++f) {
    around.thresholds_cd_m2[f] =
        pool([&](std::size_t pixel) { return perception_.threshold_cd_m2(pixel, f); });
  }
  vertex.elevation = pool([&](std::size_t pixel) { return perception_.elevation(pixel); });
  double weight = 0.0;
  for (const Anchor* anchor : around.anchors) {
    const auto share = static_cast<double>(anchor->weight);
    vertex.base_threshold_cd_m2 += share * perception_.base_threshold_cd_m2(anchor->pixel);
    vertex.world_cd_m2 += share * perception_.world_cd_m2(anchor->pixel);
    around.reflectance +=
        share * static_cast<double>(ray_tracing::luminance(tree.at(anchor->leaf).reflectance));
    if (perception_.elevation(anchor->pixel) < 0.5 * vertex.elevation) vertex.weak_share += share;
    weight += share;
  }
  vertex.base_threshold_cd_m2 /= weight;
  vertex.world_cd_m2 /= weight;
  vertex.weak_share /= weight;
  around.reflectance /= weight;
  vertex.threshold_cd_m2 = perception_.at_frequency(
      around.thresholds_cd_m2,
      std::max(around.cell_frequency_cpd, perception_.edge_frequency_cpd()));
}

std::vector<std::uint32_t> SenderClasses::classify(Surrounding& around, GatherVertex& vertex,
                                                   const Evaluate& evaluate) const {
  weigh(around, vertex);
  const element_hierarchy::Solution& solution = transfer_.solution();
  const std::vector<Sender> senders = collect_senders(solution, around.leaves);
  for (const Sender& sender : senders) {
    if (!sender.is_occluded) around.irradiance_sum += sender.irradiance;
  }
  std::vector<std::uint32_t> near;
  for (const Sender& sender : senders) {
    ++vertex.senders;
    if (sender.is_occluded || sender.irradiance <= 0.0) continue;
    if (is_near(solution.tree->at(sender.element), around.place)) {
      near.push_back(sender.element);
      continue;
    }
    const auto record = evaluate(sender, class_samples_for(around, sender, vertex));
    if (record) vertex.records.push_back(*record);
  }
  vertex.near_senders = static_cast<std::uint32_t>(near.size());
  return near;
}

double SenderClasses::shown_change(const GatherVertex& vertex, double radiosity_w_m2) const {
  const double scale = transfer_.solution().tree->rays().scene().luminance_scale_cd_m2;
  return perception_.shown_change_cd_m2(vertex.world_cd_m2, scale * radiosity_w_m2 / kPi);
}

int SenderClasses::class_samples_for(const Surrounding& around, const Sender& sender,
                                     const GatherVertex& vertex) const {
  const double share = sender.irradiance / around.irradiance_sum;
  int count = std::max(settings_.least_samples,
                       static_cast<int>(std::lround(settings_.class_samples * share)));
  // An occluded share q is missed with probability (1 - q)^N: few rays are not enough for light
  // that is visible by itself. Masking plays no part, so that it changes no estimate.
  const double change = shown_change(vertex, around.reflectance * sender.irradiance);
  if (change > vertex.base_threshold_cd_m2) count = std::max(count, settings_.significant_samples);
  return count;
}

SenderRecord SenderClasses::record_of(const Surrounding& around, const Sender& sender,
                                      const Spread& spread, const GatherVertex& vertex) const {
  const element_hierarchy::Solution& solution = transfer_.solution();
  const auto radiosity =
      static_cast<double>(ray_tracing::luminance(solution.field->sent()[sender.element]));
  // Eq. 2 and Eq. 3.
  const double form_factor_error =
      around.reflectance * radiosity * (spread.greatest - spread.least) * spread.visibility;
  const double visibility_error =
      spread.is_partly_visible
          ? (settings_.has_reflectance ? around.reflectance : 1.0) * radiosity * spread.mean
          : 0.0;
  SenderRecord record;
  record.sender = sender.element;
  record.visibility = static_cast<float>(spread.visibility);
  record.radiosity = spread.radiosity;
  const double smooth_cd_m2 =
      perception_.at_frequency(around.thresholds_cd_m2, around.cell_frequency_cpd);
  record.resamples_form_factor =
      settings_.resamples_all || shown_change(vertex, form_factor_error) > smooth_cd_m2;
  record.resamples_visibility =
      settings_.resamples_all || shown_change(vertex, visibility_error) > vertex.threshold_cd_m2;
  const double share = sender.irradiance / around.irradiance_sum;
  const double samples = std::max(1.0, settings_.gather_samples * share);
  const double light = around.reflectance * radiosity * spread.mean;
  record.form_factor_samples = static_cast<float>(samples);
  record.visibility_samples =
      static_cast<float>(visibility_samples(around, sender, vertex, light, samples));
  return record;
}

/// @param light  radiosity of the whole sender, W/m2  @param samples  without bounds
double SenderClasses::visibility_samples(const Surrounding& around, const Sender& sender,
                                         const GatherVertex& vertex, double light,
                                         double samples) const {
  const Element& element = transfer_.solution().tree->at(sender.element);
  const auto length_m =
      static_cast<double>(glm::distance(0.5F * (element.box_min + element.box_max), around.place));
  // An occluder farther from the sender than the vertex is another receiver's.
  const bool has_penumbra = sender.from_source_m > 0.0 && sender.from_source_m < length_m;
  const double width_px = has_penumbra ? static_cast<double>(element.extent_m()) *
                                             (length_m - sender.from_source_m) /
                                             sender.from_source_m * around.pixels_per_m
                                       : 0.0;
  double bounded = samples;
  if (settings_.has_penumbra_bound && has_penumbra) bounded = std::min(bounded, width_px);
  if (settings_.has_contrast_bound && vertex.threshold_cd_m2 > 0.0) {
    bounded =
        std::min(bounded, hidden_steps(perception_, around.thresholds_cd_m2,
                                       shown_change(vertex, light), perception_.degrees(width_px)));
  }
  return std::max(1.0, bounded);
}

}  // namespace renderers::final_gather
