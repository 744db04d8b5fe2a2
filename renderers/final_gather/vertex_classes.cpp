#include "renderers/final_gather/vertex_classes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <glm/geometric.hpp>

#include "renderers/element_hierarchy/spherical_triangle.h"
#include "renderers/final_gather/link_gather.h"
#include "renderers/ray_tracing/direction_sampling.h"
#include "renderers/ray_tracing/sample_sequence.h"
#include "renderers/ray_tracing/surface_brdf.h"

namespace renderers::final_gather {

using element_hierarchy::Element;
using element_hierarchy::SidePoint;

namespace {

constexpr double kPi = std::numbers::pi;

}  // namespace

/// Cells around a vertex and what the camera sees in them.
struct VertexClassifier::Neighbourhood {
  std::uint32_t vertex = 0;
  glm::vec3 place{0.0F};
  glm::dvec3 low{0.0};  ///< of the adjacent cells, in grid coordinates
  glm::dvec3 high{0.0};
  std::vector<const Anchor*> anchors;
  std::vector<std::uint32_t> leaves;
  double reflectance = 0.0;              ///< luminance, mean over the anchors
  double irradiance_sum = 0.0;           ///< of the senders that are not occluded
  double pixels_per_m = 0.0;             ///< at the vertex's depth
  double cell_frequency_cpd = 0.0;       ///< of what is interpolated: 1 / (2 cells' width)
  std::vector<double> thresholds_cd_m2;  ///< of every frequency of the view
};

/// Spread of a sender's form factor and visibility.
struct VertexClassifier::Spread {
  double least = std::numeric_limits<double>::infinity();
  double greatest = 0.0;
  double sum = 0.0;
  glm::dvec3 vector{0.0};
  int count = 0;
  int traced = 0;
  int seen = 0;
  glm::vec3 light{0.0F};  ///< W/m2, sum of the radiosities seen
  double visibility() const { return traced > 0 ? static_cast<double>(seen) / traced : 0.0; }
  double mean() const { return count > 0 ? sum / count : 0.0; }
};

VertexClassifier::VertexClassifier(const SenderTransfer& transfer, const GridAnchors& anchors,
                                   const ViewPerception& perception, const ClassSettings& settings)
    : transfer_(transfer),
      anchors_(anchors),
      perception_(perception),
      settings_(settings),
      counter_(transfer.solution().tree->rays()),
      pixels_per_rad_(static_cast<double>(perception.preview().height_px) /
                      anchors.grid().image_height_at_one()) {}

VertexClassifier::Neighbourhood VertexClassifier::neighbourhood_of(std::uint32_t vertex) const {
  Neighbourhood around;
  const GatherGrid& grid = anchors_.grid();
  around.vertex = vertex;
  around.place = grid.vertex(vertex);
  const glm::dvec3 place(grid.vertex_place(vertex));
  around.low = glm::max(place - 1.0, glm::dvec3(0.0));
  around.high = glm::min(place + 1.0, glm::dvec3(grid.size().x, grid.size().y, grid.size().z));
  around.anchors = anchors_.around(vertex);
  around.pixels_per_m = pixels_per_rad_ / grid.view_depth_m(around.place);
  const glm::dvec3 beside = place + glm::dvec3(place.x > 0.0 ? -1.0 : 1.0, 0.0, 0.0);
  const auto width_m = static_cast<double>(glm::distance(around.place, grid.to_world(beside)));
  around.cell_frequency_cpd = 0.5 / perception_.degrees(width_m * around.pixels_per_m);
  const auto& tree = *transfer_.solution().tree;
  double weight = 0.0;
  for (const Anchor* anchor : around.anchors) {
    around.leaves.push_back(anchor->leaf);
    const auto share = static_cast<double>(anchor->weight);
    around.reflectance +=
        share * static_cast<double>(ray_tracing::luminance(tree.at(anchor->leaf).reflectance));
    weight += share;
  }
  if (weight > 0.0) around.reflectance /= weight;
  std::ranges::sort(around.leaves);
  const auto repeated = std::ranges::unique(around.leaves);
  around.leaves.erase(repeated.begin(), repeated.end());
  return around;
}

/// @param values  one per anchor
double VertexClassifier::pooled(const Neighbourhood& around, std::vector<double> values) const {
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
void VertexClassifier::weigh(Neighbourhood& around, GridVertex& result) const {
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
  result.elevation = pool([&](std::size_t pixel) { return perception_.elevation(pixel); });
  double weight = 0.0;
  for (const Anchor* anchor : around.anchors) {
    const auto share = static_cast<double>(anchor->weight);
    result.base_threshold_cd_m2 += share * perception_.base_threshold_cd_m2(anchor->pixel);
    result.world_cd_m2 += share * perception_.world_cd_m2(anchor->pixel);
    if (perception_.elevation(anchor->pixel) < 0.5 * result.elevation) result.weak_share += share;
    weight += share;
  }
  result.base_threshold_cd_m2 /= weight;
  result.world_cd_m2 /= weight;
  result.weak_share /= weight;
  result.threshold_cd_m2 = perception_.at_frequency(
      around.thresholds_cd_m2,
      std::max(around.cell_frequency_cpd, perception_.edge_frequency_cpd()));
}

double VertexClassifier::shown_change(const GridVertex& vertex, double radiosity_w_m2) const {
  const double scale = transfer_.solution().tree->rays().scene().luminance_scale_cd_m2;
  return perception_.shown_change_cd_m2(vertex.world_cd_m2, scale * radiosity_w_m2 / kPi);
}

GridVertex VertexClassifier::classify(std::uint32_t vertex) const {
  Neighbourhood around = neighbourhood_of(vertex);
  GridVertex result;
  weigh(around, result);
  const element_hierarchy::Solution& solution = transfer_.solution();
  const std::vector<Sender> senders = collect_senders(solution, around.leaves);
  std::vector<std::uint32_t> near;
  for (const Sender& sender : senders) {
    if (!sender.is_occluded) around.irradiance_sum += sender.irradiance;
  }
  for (const Sender& sender : senders) {
    ++result.senders;
    if (sender.is_occluded || sender.irradiance <= 0.0) continue;
    if (is_near(solution.tree->at(sender.element), around.place)) {
      near.push_back(sender.element);
      continue;
    }
    const Spread spread = sample(around, sender, class_samples_for(around, sender, result));
    result.visibility_rays += static_cast<std::uint64_t>(spread.traced);
    result.form_factor_samples += static_cast<std::uint64_t>(spread.count);
    if (spread.count == 0) continue;
    const SenderRecord record = record_of(around, sender, spread, result);
    const bool is_dark = spread.seen == 0 && !record.resamples_visibility;
    if (!is_dark) result.records.push_back(record);
  }
  result.near_senders = static_cast<std::uint32_t>(near.size());
  if (!near.empty()) add_near(around, near, result);
  return result;
}

int VertexClassifier::class_samples_for(const Neighbourhood& around, const Sender& sender,
                                        const GridVertex& vertex) const {
  const double share = sender.irradiance / around.irradiance_sum;
  int count = std::max(settings_.least_samples,
                       static_cast<int>(std::lround(settings_.class_samples * share)));
  // An occluded share q is missed with probability (1 - q)^N: few rays are not enough for light
  // that is visible by itself. Masking plays no part, so that it changes no estimate.
  const double change = shown_change(vertex, around.reflectance * sender.irradiance);
  if (change > vertex.base_threshold_cd_m2) count = std::max(count, settings_.significant_samples);
  return count;
}

VertexClassifier::Spread VertexClassifier::sample(const Neighbourhood& around, const Sender& sender,
                                                  int count) const {
  Spread spread;
  for (int i = 0; i < count; ++i) {
    add_sample(around, sender.element, static_cast<std::uint32_t>(i), spread);
  }
  return spread;
}

ray_tracing::SurfacePoint VertexClassifier::point_of(const Anchor& anchor) const {
  return transfer_.solution().tree->rays().point_on_triangle(anchor.object, anchor.triangle,
                                                             anchor.barycentrics);
}

void VertexClassifier::add_sample(const Neighbourhood& around, std::uint32_t sender,
                                  std::uint32_t index, Spread& spread) const {
  const auto& tree = *transfer_.solution().tree;
  const TransferSettings& transfer = transfer_.settings();
  const Element& element = tree.at(sender);
  const std::uint64_t key = ray_tracing::hash_combine(transfer.seed, sender);
  const SidePoint to = tree.sample(sender, sender_position(transfer.positions, key, index));
  // Where: among what the camera sees, or anywhere in the adjacent cells.
  const glm::vec4 u =
      ray_tracing::SampleSequence(ray_tracing::SequenceKind::sobol,
                                  ray_tracing::hash_combine(key, around.vertex), index)
          .next();
  ray_tracing::SurfacePoint start;
  const bool is_anchored = settings_.hit_rule == HitRule::surface;
  bool faces_sender = true;
  if (is_anchored) {
    const auto count = static_cast<float>(around.anchors.size());
    const Anchor& anchor = *around.anchors[static_cast<std::size_t>(u.x * count)];
    start = point_of(anchor);
    const glm::vec3 normal = anchor.is_back ? -start.geometric_normal : start.geometric_normal;
    faces_sender = glm::dot(normal, to.surface.position - start.position) > 0.0F;
  } else {
    start.position =
        anchors_.grid().to_world(around.low + glm::dvec3(u) * (around.high - around.low));
  }
  const glm::vec3 between = to.surface.position - start.position;
  const auto distance2 = static_cast<double>(glm::dot(between, between));
  if (!faces_sender || distance2 <= 0.0) return;
  const double distance_m = std::sqrt(distance2);
  const double cosine = -static_cast<double>(glm::dot(to.normal, between)) / distance_m;
  double omega = 0.0;
  if (cosine > 0.0) omega = static_cast<double>(element.area_m2) * cosine / distance2;
  if (transfer.is_exact && element.is_patch && cosine > 0.0) {
    omega = element_hierarchy::solid_angle(start.position, element.positions);
  }
  const double form_factor = omega / kPi;
  ++spread.count;
  spread.sum += form_factor;
  spread.least = std::min(spread.least, form_factor);
  spread.greatest = std::max(spread.greatest, form_factor);
  spread.vector += form_factor / distance_m * glm::dvec3(between);
  if (omega <= 0.0) return;
  ++spread.traced;
  const auto is_local = [&](const glm::vec3& place) {
    const glm::dvec3 at = anchors_.grid().to_grid(place);
    return glm::all(glm::greaterThanEqual(at, around.low)) &&
           glm::all(glm::lessThanEqual(at, around.high));
  };
  const bool is_occluded =
      is_anchored ? tree.rays().is_occluded(segment_to(start, to.surface))
                  : counter_.is_occluded(start.position, to, settings_.hit_rule, is_local);
  if (is_occluded) return;
  ++spread.seen;
  spread.light += transfer_.radiosity_at(to, sender);
}

SenderRecord VertexClassifier::record_of(const Neighbourhood& around, const Sender& sender,
                                         const Spread& spread, const GridVertex& vertex) const {
  const element_hierarchy::Solution& solution = transfer_.solution();
  const auto radiosity =
      static_cast<double>(ray_tracing::luminance(solution.field->sent()[sender.element]));
  const double visibility = spread.visibility();
  // Eq. 2 and Eq. 3.
  const double form_factor_error =
      around.reflectance * radiosity * (spread.greatest - spread.least) * visibility;
  const bool is_partial = spread.seen > 0 && spread.seen < spread.traced;
  const double visibility_error =
      is_partial
          ? (settings_.has_reflectance ? around.reflectance : 1.0) * radiosity * spread.mean()
          : 0.0;
  SenderRecord record;
  record.sender = sender.element;
  record.visibility = static_cast<float>(visibility);
  if (spread.seen > 0) record.radiosity = spread.light / static_cast<float>(spread.seen);
  record.vector_form_factor = glm::vec3(spread.vector / static_cast<double>(spread.count));
  const double smooth_cd_m2 =
      perception_.at_frequency(around.thresholds_cd_m2, around.cell_frequency_cpd);
  record.resamples_form_factor =
      settings_.resamples_all || shown_change(vertex, form_factor_error) > smooth_cd_m2;
  record.resamples_visibility =
      settings_.resamples_all || shown_change(vertex, visibility_error) > vertex.threshold_cd_m2;
  const double share = sender.irradiance / around.irradiance_sum;
  const double samples = std::max(1.0, settings_.gather_samples * share);
  const double light = around.reflectance * radiosity * spread.mean();
  record.form_factor_samples = static_cast<float>(samples);
  record.visibility_samples =
      static_cast<float>(visibility_samples(around, sender, vertex, light, samples));
  return record;
}

/// @param light  radiosity of the whole sender, W/m2  @param samples  without bounds
double VertexClassifier::visibility_samples(const Neighbourhood& around, const Sender& sender,
                                            const GridVertex& vertex, double light,
                                            double samples) const {
  double width_px = 0.0;  // not known
  if (sender.from_source_m > 0.0) {
    const Element& element = transfer_.solution().tree->at(sender.element);
    const auto length_m = static_cast<double>(
        glm::distance(0.5F * (element.box_min + element.box_max), around.place));
    width_px = static_cast<double>(element.extent_m()) *
               std::max(0.0, length_m - sender.from_source_m) / sender.from_source_m *
               around.pixels_per_m;
  }
  double bounded = samples;
  if (settings_.has_penumbra_bound && sender.from_source_m > 0.0) {
    bounded = std::min(bounded, width_px);
  }
  if (settings_.has_contrast_bound && vertex.threshold_cd_m2 > 0.0) {
    bounded =
        std::min(bounded, hidden_steps(perception_, around.thresholds_cd_m2,
                                       shown_change(vertex, light), perception_.degrees(width_px)));
  }
  return std::max(1.0, bounded);
}

void VertexClassifier::add_near(const Neighbourhood& around,
                                const std::vector<std::uint32_t>& senders,
                                GridVertex& result) const {
  const TransferSettings& transfer = transfer_.settings();
  const std::uint64_t key = ray_tracing::hash_combine(transfer.seed, 0x5e1f + around.vertex);
  const float share_sr = 4.0F * ray_tracing::kPi / static_cast<float>(settings_.containing_rays);
  const std::size_t count = around.anchors.size();
  for (int i = 0; i < settings_.containing_rays; ++i) {
    const glm::vec2 u = sender_position(transfer.positions, key, static_cast<std::uint32_t>(i));
    const float z = 1.0F - 2.0F * u.x;
    const float radius = std::sqrt(std::fmax(0.0F, 1.0F - z * z));
    const float azimuth_rad = 2.0F * ray_tracing::kPi * u.y;
    const glm::vec3 direction(radius * std::cos(azimuth_rad), radius * std::sin(azimuth_rad), z);
    ray_tracing::Ray ray{around.place, direction};
    if (settings_.hit_rule == HitRule::surface) {
      // From a surface that looks that way, if there is one.
      const std::size_t first =
          ray_tracing::hash_combine(key, static_cast<std::uint64_t>(i)) % count;
      bool is_found = false;
      for (std::size_t step = 0; step < count && !is_found; ++step) {
        const Anchor& anchor = *around.anchors[(first + step) % count];
        const ray_tracing::SurfacePoint point = point_of(anchor);
        const float side = anchor.is_back ? -1.0F : 1.0F;
        is_found = side * glm::dot(point.geometric_normal, direction) > 0.0F;
        if (is_found) ray = ray_from(point, direction);
      }
      if (!is_found) continue;
    }
    ++result.visibility_rays;
    const glm::vec3 radiosity = radiosity_on(transfer_.solution(), ray, senders);
    result.around.add(direction, share_sr / ray_tracing::kPi * radiosity);
  }
}

}  // namespace renderers::final_gather
