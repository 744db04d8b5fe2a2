#include "renderers/element_hierarchy/link_estimate.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "renderers/element_hierarchy/form_factor.h"
#include "renderers/element_hierarchy/spherical_triangle.h"
#include "renderers/ray_tracing/direction_sampling.h"
#include "renderers/ray_tracing/sample_sequence.h"

namespace renderers::element_hierarchy {

namespace {

using ray_tracing::SampleSequence;
using ray_tracing::SequenceKind;

constexpr double kPi = std::numbers::pi;
constexpr std::uint64_t kSeed = 0x11a5;
/// Samples of one group: the points of a receiver whose visibilities are compared.
constexpr int kGroup = 4;
/// How many times as many rays a link gets while none is through.
constexpr int kBlockedFactor = 4;
/// Patches whose areas differ by less than this factor are both sampled.
constexpr double kSimilarAreas = 2.0;

/// Distance between two boxes, m; 0 if they overlap.
float box_distance_m(const Element& a, const Element& b) {
  const glm::vec3 gap =
      glm::max(glm::vec3(0.0F), glm::max(a.box_min - b.box_max, b.box_min - a.box_max));
  return glm::length(gap);
}

/// Form factor of clusters that face every way: A / (16 pi d^2), at most 1 (Sillion 1995, Sec. 4:
/// both cosines are 1/4 of the total areas).
double isotropic_form_factor(const Element& receiver, const Element& source) {
  const glm::vec3 between =
      0.5F * (receiver.box_min + receiver.box_max) - 0.5F * (source.box_min + source.box_max);
  const double distance2 = std::max(static_cast<double>(glm::dot(between, between)),
                                    static_cast<double>(source.area_m2) / (16.0 * kPi));
  return static_cast<double>(source.area_m2) / (16.0 * kPi * distance2);
}

/// Form factor from a point to a patch: from in front of its plane, all of it above the horizon.
double exact_form_factor(const SidePoint& from, const Element& patch) {
  if (glm::dot(from.surface.position - patch.positions[0], patch.normal) <= 0.0F) return 0.0;
  return point_form_factor(from.surface.position, from.normal, patch.positions);
}

}  // namespace

/// Sums over the samples of one link.
struct LinkEstimator::Samples {
  double form_factor = 0.0;  ///< sum
  double least = std::numeric_limits<double>::infinity();
  double greatest = 0.0;
  int count = 0;
  double traced = 0.0;  ///< weights of the segments
  double seen = 0.0;
  double group_traced = 0.0;
  double group_seen = 0.0;
  double least_visibility = 1.0;
  double greatest_visibility = 0.0;
  double from_source_m = std::numeric_limits<double>::infinity();
  double from_receiver_m = std::numeric_limits<double>::infinity();
  std::uint64_t rays = 0;

  void add(double sample, double at_receiver) {
    ++count;
    form_factor += sample;
    least = std::min(least, at_receiver);
    greatest = std::max(greatest, at_receiver);
  }
  void end_group() {
    if (group_traced > 0.0) {
      const double visibility = group_seen / group_traced;
      least_visibility = std::min(least_visibility, visibility);
      greatest_visibility = std::max(greatest_visibility, visibility);
    }
    group_traced = group_seen = 0.0;
  }
  /// (k + 1) / (n + 2) for k of n rays.
  double possible_visibility() const {
    const auto n = static_cast<double>(rays);
    return (visibility() * n + 1.0) / (n + 2.0);
  }
  double visibility() const { return traced > 0.0 ? seen / traced : 0.0; }
};

std::optional<Link> LinkEstimator::estimate(std::uint32_t receiver, std::uint32_t source,
                                            std::uint64_t& rays) const {
  const Element& p = tree_.at(receiver);
  const Element& q = tree_.at(source);
  if (p.is_patch && q.is_patch && face_away(p, q)) return std::nullopt;
  const bool has_rays = !q.is_patch && (receiver == source || are_near(p, q));
  Link link = has_rays ? from_rays(receiver, source, rays) : from_pairs(receiver, source, rays);
  link.source = source;
  if (receiver == source) link.flags |= self_link;
  return link;
}

/// Pairs of points are of use from a distance of half the larger extent on; ours.
bool LinkEstimator::are_near(const Element& receiver, const Element& source) const {
  return box_distance_m(receiver, source) < 0.5F * std::max(receiver.extent_m(), source.extent_m());
}

Link LinkEstimator::from_pairs(std::uint32_t receiver, std::uint32_t source,
                               std::uint64_t& rays) const {
  const Element& p = tree_.at(receiver);
  const Element& q = tree_.at(source);
  const bool has_cluster = !p.is_patch || !q.is_patch;
  const int count = has_cluster ? settings_.cluster_rays : settings_.patch_rays;
  // Both directions of a pair see the same points.
  const std::uint64_t seed = ray_tracing::hash_combine(
      ray_tracing::hash_combine(kSeed, std::min(receiver, source)), std::max(receiver, source));
  const bool is_exact = q.is_patch && (p.is_patch || settings_.kernel == ClusterKernel::sampled);
  Samples samples;
  bool is_beyond_count = false;
  // Few blocked rays are no proof: links without light are tried longer. What is found then tells
  // that there is light, but does not count: a link would stop where it saw too much.
  const int most = kBlockedFactor * count;
  for (int i = 0; i < (samples.seen > 0.0 ? count : most); ++i) {
    is_beyond_count = i >= count;
    SampleSequence numbers(SequenceKind::sobol, seed, static_cast<std::uint32_t>(i));
    const glm::vec4 u = numbers.next();
    if (is_exact) {
      add_patch_sample(receiver, source, u, samples);
    } else {
      add_pair(p, q, {tree_.sample(receiver, {u.x, u.y}), tree_.sample(source, {u.z, u.w})},
               samples);
    }
    if (i % kGroup == kGroup - 1) samples.end_group();
  }
  samples.end_group();
  rays += samples.rays;
  Link link;
  if (!(samples.seen > 0.0)) link.flags |= fully_occluded;
  const double visibility = is_beyond_count ? 0.0 : samples.visibility();
  const double form_factor = samples.form_factor / samples.count;
  const double spread = std::min(0.5 * (samples.greatest - samples.least), form_factor);
  link.form_factor = static_cast<float>(form_factor);
  link.visibility = share_coded(visibility);
  link.least_visibility = share_coded(std::min(samples.least_visibility, visibility));
  link.greatest_visibility = share_coded(std::max(samples.greatest_visibility, visibility));
  // The mean of a binary visibility v errs by 2 v (1 - v) in L1 (Sillion and Drettakis 1995,
  // "Feature-Based Control of Visibility Error", App. A); half the range of the form factor is the
  // error of a constant (Bekaert and Willems 1996, "Error Control for Radiosity").
  // With the visibility that the rays leave possible (Laplace's rule), as light that no ray has
  // found yet would else never be looked for again.
  const double possible = samples.possible_visibility();
  link.error = log_coded(spread * visibility + form_factor * 2.0 * possible * (1.0 - possible));
  const auto distance_code = [](double distance_m) {
    return std::isfinite(distance_m) ? log_coded(distance_m) : std::uint16_t{0};
  };
  link.occluder_from_source_m = distance_code(samples.from_source_m);
  link.occluder_from_receiver_m = distance_code(samples.from_receiver_m);
  return link;
}

/// From a point on the smaller end, or on each in turn: there the other end's form factor varies
/// less. A_p F_pq = A_q F_qp holds exactly, as both directions see the same samples.
void LinkEstimator::add_patch_sample(std::uint32_t receiver, std::uint32_t source,
                                     const glm::vec4& u, Samples& samples) const {
  const Element& p = tree_.at(receiver);
  const Element& q = tree_.at(source);
  const double area_ratio = static_cast<double>(q.area_m2) / static_cast<double>(p.area_m2);
  const bool is_turn = (samples.count % 2 == 0) == (receiver < source);
  const bool from_receiver =
      !p.is_patch || area_ratio >= kSimilarAreas || (area_ratio * kSimilarAreas > 1.0 && is_turn);
  const SidePoint start = tree_.sample(from_receiver ? receiver : source, {u.x, u.y});
  const Element& target = from_receiver ? q : p;
  const double form_factor = exact_form_factor(start, target);
  double at_receiver = form_factor;
  if (!from_receiver) at_receiver = exact_form_factor(tree_.sample(receiver, {u.x, u.y}), q);
  const double share = from_receiver ? 1.0 : area_ratio;
  samples.add(share * form_factor, at_receiver);
  if (form_factor <= 0.0) return;
  // Uniform over the solid angle: no weight is large where the ends touch.
  const TrianglePoint end =
      sample_solid_angle(start.surface.position, target.positions, {u.z, u.w});
  const SidePoint seen = tree_.point_of(target, end.weights);
  const glm::vec3 direction = glm::normalize(seen.surface.position - start.surface.position);
  const double weight =
      share * end.solid_angle * static_cast<double>(glm::dot(start.normal, direction));
  if (!(weight > 0.0)) return;
  trace_segment(from_receiver ? PointPair{start, seen} : PointPair{seen, start}, weight, samples);
}

void LinkEstimator::add_pair(const Element& p, const Element& q, const PointPair& pair,
                             Samples& samples) const {
  const glm::vec3 between = pair.to.surface.position - pair.from.surface.position;
  const auto distance_m = static_cast<double>(glm::length(between));
  const auto cosine_at = [&](const Element& end, const glm::vec3& normal, const glm::vec3& to) {
    if (settings_.kernel == ClusterKernel::isotropic && !end.is_patch) return 0.25;
    return static_cast<double>(glm::dot(to, normal)) / std::max(distance_m, 1e-30);
  };
  const double cosine_from = cosine_at(p, pair.from.normal, between);
  const double cosine_to = cosine_at(q, pair.to.normal, -between);
  double form_factor = 0.0;
  if (cosine_from > 0.0 && cosine_to > 0.0 && distance_m > 0.0) {
    // A cos cos / (pi r^2): the mean over pairs is the mean form factor.
    form_factor =
        static_cast<double>(q.area_m2) * cosine_from * cosine_to / (kPi * distance_m * distance_m);
  }
  samples.add(form_factor, form_factor);
  if (form_factor > 0.0) trace_segment(pair, form_factor, samples);
}

void LinkEstimator::trace_segment(const PointPair& pair, double weight, Samples& samples) const {
  ++samples.rays;
  samples.traced += weight;
  samples.group_traced += weight;
  const bool from_receiver = samples.count % 4 < 2;
  const ray_tracing::Ray ray = from_receiver ? segment_to(pair.from.surface, pair.to.surface)
                                             : segment_to(pair.to.surface, pair.from.surface);
  ray_tracing::LineHit hit;
  if (!tree_.rays().nearest(ray, hit)) {
    samples.seen += weight;
    samples.group_seen += weight;
    return;
  }
  const auto length_m = static_cast<double>(glm::length(ray.direction));
  double& nearest = from_receiver ? samples.from_receiver_m : samples.from_source_m;
  nearest = std::min(nearest, static_cast<double>(hit.t) * length_m);
}

/// Share of cosine-distributed rays of a receiver that land on a source.
/// @param set  rays of different sets are independent
double LinkEstimator::landing_share(std::uint32_t receiver, const Element& source,
                                    std::uint64_t set, int count, std::uint64_t& rays) const {
  const std::uint64_t seed = ray_tracing::hash_combine(kSeed + 1 + set, receiver);
  int hits = 0;
  for (int i = 0; i < count; ++i) {
    SampleSequence numbers(SequenceKind::sobol, seed, static_cast<std::uint32_t>(i));
    const glm::vec4 u = numbers.next();
    const SidePoint from = tree_.sample(receiver, {u.z, u.w});
    const glm::vec3 direction =
        ray_tracing::frame_around(from.normal).to_world(ray_tracing::cosine_hemisphere({u.x, u.y}));
    ++rays;
    ray_tracing::LineHit hit;
    if (!tree_.rays().nearest(ray_from(from.surface, direction), hit)) continue;
    const std::uint32_t met =
        tree_.root_of(hit.object, hit.triangle, !hit.looks_back, hit.barycentrics);
    if (met == kNoElement) continue;
    const std::uint32_t order = tree_.at(met).root_begin;
    if (order >= source.root_begin && order < source.root_end) ++hits;
  }
  return static_cast<double>(hits) / count;
}

Link LinkEstimator::from_rays(std::uint32_t receiver, std::uint32_t source,
                              std::uint64_t& rays) const {
  const Element& q = tree_.at(source);
  const double seen = landing_share(receiver, q, 0, settings_.near_rays, rays);
  const double form_factor =
      std::max(seen, std::min(1.0, isotropic_form_factor(tree_.at(receiver), q)));
  Link link;
  link.flags = by_rays;
  link.form_factor = static_cast<float>(form_factor);
  link.visibility = share_coded(form_factor > 0.0 ? seen / form_factor : 0.0);
  link.least_visibility = 0;
  link.greatest_visibility = share_coded(1.0);
  // Where the light arrives within the receiver is not known: all of it may be wrong; and what no
  // ray found is below three rays' worth (rule of three, 95 %). By rays of its own: were it by
  // those that count, links that by chance saw too little would be the ones that are left as they
  // are, and light would be lost.
  const int others = std::max(1, settings_.near_rays / 2);
  const double again = landing_share(receiver, q, 1, others, rays);
  link.error = log_coded(again + std::min(form_factor, 3.0 / others));
  if (seen <= 0.0 && again <= 0.0) link.flags |= fully_occluded;
  return link;
}

}  // namespace renderers::element_hierarchy
