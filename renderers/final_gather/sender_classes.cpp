#include "renderers/final_gather/sender_classes.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <glm/geometric.hpp>

#include "renderers/final_gather/link_gather.h"
#include "renderers/ray_tracing/surface_brdf.h"

namespace renderers::final_gather {

using element_hierarchy::Element;

namespace {

constexpr double kPi = std::numbers::pi;

}  // namespace

double largest_hidden(std::vector<double> errors, double threshold) {
  std::ranges::sort(errors);
  double largest = 0.0;
  double sum = 0.0;
  for (const double error : errors) {
    sum += error * error;
    if (sum > threshold * threshold) break;
    largest = error;
  }
  return largest;
}

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
  std::vector<ClassifiedSender> far;
  for (const Sender& sender : senders) {
    ++vertex.senders;
    if (sender.is_occluded || sender.irradiance <= 0.0) continue;
    if (is_near(solution.tree->at(sender.element), around.place)) {
      near.push_back(sender.element);
      continue;
    }
    const auto classified = evaluate(sender, class_samples_for(around, sender, vertex));
    if (classified) far.push_back(*classified);
  }
  decide(around, far, vertex);
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

ClassifiedSender SenderClasses::judge(const Surrounding& around, const Sender& sender,
                                      const Spread& spread, const GatherVertex& vertex) const {
  const auto radiosity = static_cast<double>(
      ray_tracing::luminance(transfer_.points().mean_radiosity(sender.element)));
  // Eq. 2.
  const double form_factor_error =
      around.reflectance * radiosity * (spread.greatest - spread.least) * spread.visibility;
  ClassifiedSender classified;
  classified.form_factor_error_cd_m2 = shown_change(vertex, form_factor_error);
  classified.light_cd_m2 = shown_change(vertex, around.reflectance * radiosity * spread.mean);
  // Eq. 3: all of the light, if there is an edge of a shadow.
  if (spread.is_partly_visible) {
    classified.visibility_error_cd_m2 = settings_.has_reflectance
                                            ? classified.light_cd_m2
                                            : shown_change(vertex, radiosity * spread.mean);
  }
  classified.penumbra_px = penumbra_px(around, sender);
  classified.is_seen = spread.visibility > 0.0;
  SenderRecord& record = classified.record;
  record.sender = sender.element;
  record.visibility = static_cast<float>(spread.visibility);
  record.radiosity = spread.radiosity;
  const double share = sender.irradiance / around.irradiance_sum;
  record.form_factor_samples = static_cast<float>(std::max(1.0, settings_.gather_samples * share));
  return classified;
}

void SenderClasses::decide(const Surrounding& around, std::vector<ClassifiedSender>& senders,
                           GatherVertex& vertex) const {
  const auto cut = [&](double ClassifiedSender::*error, double threshold) {
    if (!settings_.judges_together) return threshold;
    std::vector<double> errors;
    for (const ClassifiedSender& sender : senders) errors.push_back(sender.*error);
    return largest_hidden(std::move(errors), threshold);
  };
  const double form_factor_cut =
      cut(&ClassifiedSender::form_factor_error_cd_m2,
          perception_.at_frequency(around.thresholds_cd_m2, around.cell_frequency_cpd));
  const double visibility_cut =
      cut(&ClassifiedSender::visibility_error_cd_m2, vertex.threshold_cd_m2);
  double rivals = 0.0;
  for (ClassifiedSender& sender : senders) {
    SenderRecord& record = sender.record;
    record.resamples_form_factor =
        settings_.resamples_all || sender.form_factor_error_cd_m2 > form_factor_cut;
    record.resamples_visibility =
        settings_.resamples_all || sender.visibility_error_cd_m2 > visibility_cut;
    if (record.resamples_visibility) rivals += 1.0;
  }
  for (ClassifiedSender& sender : senders) {
    SenderRecord& record = sender.record;
    record.visibility_samples =
        static_cast<float>(visibility_samples(around, sender, rivals, vertex));
    if (sender.is_seen || record.resamples_visibility) vertex.records.push_back(record);
  }
}

double SenderClasses::penumbra_px(const Surrounding& around, const Sender& sender) const {
  const Element& element = transfer_.solution().tree->at(sender.element);
  const auto length_m =
      static_cast<double>(glm::distance(0.5F * (element.box_min + element.box_max), around.place));
  // An occluder farther from the sender than the vertex is another receiver's.
  if (!(sender.from_source_m > 0.0 && sender.from_source_m < length_m)) return 0.0;
  return static_cast<double>(element.extent_m()) * (length_m - sender.from_source_m) /
         sender.from_source_m * around.pixels_per_m;
}

double SenderClasses::visibility_samples(const Surrounding& around, const ClassifiedSender& sender,
                                         double rivals, const GatherVertex& vertex) const {
  double bounded = static_cast<double>(sender.record.form_factor_samples);
  if (settings_.has_penumbra_bound && sender.penumbra_px > 0.0) {
    bounded = std::min(bounded, sender.penumbra_px);
  }
  if (settings_.has_contrast_bound && vertex.threshold_cd_m2 > 0.0) {
    // Steps of several senders add up as independent errors do.
    const double together = settings_.judges_together ? std::sqrt(std::max(1.0, rivals)) : 1.0;
    bounded = std::min(
        bounded, hidden_steps(perception_, around.thresholds_cd_m2, together * sender.light_cd_m2,
                              perception_.degrees(sender.penumbra_px)));
  }
  return std::max(1.0, bounded);
}

}  // namespace renderers::final_gather
