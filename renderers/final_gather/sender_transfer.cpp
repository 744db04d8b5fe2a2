#include "renderers/final_gather/sender_transfer.h"

#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>

#include <glm/geometric.hpp>

#include "renderers/element_hierarchy/form_factor.h"
#include "renderers/final_gather/visible_part.h"
#include "renderers/ray_tracing/sample_sequence.h"

namespace renderers::final_gather {

using element_hierarchy::Element;
using element_hierarchy::SidePoint;

namespace {

constexpr double kPi = std::numbers::pi;

/// Clear of the patch's plane: on the patch itself rounding would decide between 0 and 1.
bool is_in_front(const Receiver& receiver, const Element& patch) {
  constexpr float kClear = 1e-5F;
  return glm::dot(receiver.point.position - patch.positions[0], patch.normal) >
         kClear * patch.extent_m();
}

double exact_form_factor(const Receiver& receiver, const Element& patch) {
  if (!is_in_front(receiver, patch)) return 0.0;
  return element_hierarchy::point_form_factor(receiver.point.position, receiver.normal,
                                              patch.positions);
}

}  // namespace

glm::vec2 sender_position(Positions positions, std::uint64_t key, std::uint32_t index) {
  if (positions == Positions::random) {
    return glm::vec2(
        ray_tracing::SampleSequence(ray_tracing::SequenceKind::random, key, index).next());
  }
  // 1 / g and 1 / g^2 with g^3 = g + 1 (Roberts 2018).
  constexpr double kStepX = 0.75487766624669276;
  constexpr double kStepY = 0.56984029099805327;
  const std::uint64_t shift = ray_tracing::mix_bits(key);
  const double x = static_cast<double>(shift >> 32) * 0x1p-32 + kStepX * (index + 1.0);
  const double y = static_cast<double>(shift & 0xffffffffU) * 0x1p-32 + kStepY * (index + 1.0);
  const auto fraction = [](double value) {
    return std::fmin(static_cast<float>(value - std::floor(value)), 0x1.fffffep-1F);
  };
  return {fraction(x), fraction(y)};
}

/// Sums over samples, and the rays that wait for a packet.
struct SenderTransfer::Sums {
  double weight = 1.0;  ///< of the sample on its way
  double weights = 0.0;
  double kernel = 0.0;
  double seen = 0.0;
  glm::dvec3 light{0.0};
  double rays = 0.0;
  bool has_rays = true;
  double area_m2 = 0.0;             ///< of what samples lie on
  double bound_m2 = 0.0;            ///< added to pi r^2
  std::optional<VisiblePart> part;  ///< of a patch, with exact form factors

  std::array<ray_tracing::Ray, ray_tracing::kPacketRays> waiting;
  std::array<double, ray_tracing::kPacketRays> waiting_kernel{};
  std::array<glm::vec3, ray_tracing::kPacketRays> waiting_light{};
  std::size_t count = 0;
};

glm::vec3 SenderTransfer::radiosity_at(const SidePoint& point, std::uint32_t sender) const {
  const element_hierarchy::RadiosityField& field = *solution_.field;
  if (!settings_.by_leaf) return field.sent()[sender];
  const std::uint32_t leaf = solution_.tree->leaf_at(point.surface, point.normal);
  return leaf == element_hierarchy::kNoElement ? field.sent()[sender] : field.radiosity()[leaf];
}

void SenderTransfer::begin(const Receiver& receiver, std::uint32_t sender, double samples,
                           Sums& sums) const {
  const Element& element = solution_.tree->at(sender);
  sums.area_m2 = static_cast<double>(element.area_m2);
  if (!settings_.is_exact) return;
  if (element.is_patch && !is_in_front(receiver, element)) {
    sums.area_m2 = 0.0;
    return;
  }
  // Samples below the horizon would leave the visibility to the few that are not.
  if (element.is_patch) {
    sums.part.emplace(element, receiver.point.position, receiver.normal);
    sums.area_m2 *= sums.part->share();
  }
  sums.bound_m2 = sums.area_m2 / std::fmax(1.0, samples);
}

/// Kernel A cos cos / (pi r^2 + A / N): the last term bounds samples that nearly touch.
void SenderTransfer::add_sample(const Receiver& receiver, std::uint32_t sender,
                                const glm::vec2& place, Sums& sums) const {
  sums.weights += sums.weight;
  if (sums.area_m2 <= 0.0) return;
  const SidePoint at =
      sums.part ? solution_.tree->point_of(solution_.tree->at(sender), sums.part->sample(place))
                : solution_.tree->sample(sender, place);
  const glm::vec3 between = at.surface.position - receiver.point.position;
  const auto distance2 = static_cast<double>(glm::dot(between, between));
  const auto receiver_cosine = static_cast<double>(glm::dot(receiver.normal, between));
  const auto sender_cosine = -static_cast<double>(glm::dot(at.normal, between));
  if (receiver_cosine <= 0.0 || sender_cosine <= 0.0 || distance2 <= 0.0) return;
  const double kernel = sums.weight * sums.area_m2 * receiver_cosine * sender_cosine / distance2 /
                        (kPi * distance2 + sums.bound_m2);
  sums.kernel += kernel;
  if (!sums.has_rays) return;
  sums.waiting[sums.count] = segment_to(receiver.point, at.surface);
  sums.waiting_kernel[sums.count] = kernel;
  sums.waiting_light[sums.count] = radiosity_at(at, sender);
  if (++sums.count == ray_tracing::kPacketRays) trace(sums);
}

void SenderTransfer::trace(Sums& sums) const {
  if (sums.count == 0) return;
  const std::uint32_t occluded =
      solution_.tree->rays().occluded_mask(std::span(sums.waiting).first(sums.count));
  for (std::size_t i = 0; i < sums.count; ++i) {
    if ((occluded >> i) & 1U) continue;
    sums.seen += sums.waiting_kernel[i];
    sums.light += sums.waiting_kernel[i] * glm::dvec3(sums.waiting_light[i]);
  }
  sums.rays += static_cast<double>(sums.count);
  sums.count = 0;
}

Transfer SenderTransfer::finish(const Receiver& receiver, std::uint32_t sender,
                                const Sums& sums) const {
  Transfer transfer;
  transfer.visibility_rays = sums.rays;
  const Element& element = solution_.tree->at(sender);
  double form_factor = sums.kernel / sums.weights;
  double scale = 1.0 / sums.weights;
  if (settings_.is_exact && element.is_patch) {
    form_factor = exact_form_factor(receiver, element);
    scale = sums.kernel > 0.0 ? form_factor / sums.kernel : 0.0;
  }
  transfer.form_factor = form_factor;
  transfer.visibility = sums.kernel > 0.0 ? sums.seen / sums.kernel : 0.0;
  transfer.irradiance = glm::vec3(scale * sums.light);
  return transfer;
}

Transfer SenderTransfer::whole(const Receiver& receiver, std::uint32_t sender,
                               double samples) const {
  std::uint64_t key = ray_tracing::hash_combine(settings_.seed, sender);
  if (settings_.reuse == Reuse::per_pixel) {
    key = ray_tracing::hash_combine(key, receiver.ray_number);
  }
  Sums sums;
  begin(receiver, sender, samples, sums);
  const auto whole_samples = static_cast<std::uint32_t>(samples);
  for (std::uint32_t i = 0; i < whole_samples; ++i) {
    add_sample(receiver, sender, sender_position(settings_.positions, key, i), sums);
  }
  sums.weight = samples - whole_samples;
  if (sums.weight > 0.0) {
    add_sample(receiver, sender, sender_position(settings_.positions, key, whole_samples), sums);
  }
  trace(sums);
  Transfer transfer = finish(receiver, sender, sums);
  transfer.form_factor_samples = samples;
  return transfer;
}

Transfer SenderTransfer::form_factor(const Receiver& receiver, std::uint32_t sender,
                                     double samples) const {
  Sums sums;
  sums.has_rays = false;
  const Element& element = solution_.tree->at(sender);
  if (settings_.is_exact && element.is_patch) {
    sums.weights = 1.0;
    Transfer transfer = finish(receiver, sender, sums);
    transfer.form_factor_samples = 1.0;
    return transfer;
  }
  const std::uint64_t key = ray_tracing::hash_combine(settings_.seed, sender);
  begin(receiver, sender, samples, sums);
  const auto whole_samples = static_cast<std::uint32_t>(samples);
  for (std::uint32_t i = 0; i <= whole_samples; ++i) {
    sums.weight = i < whole_samples ? 1.0 : samples - whole_samples;
    if (sums.weight <= 0.0) break;
    add_sample(receiver, sender, sender_position(settings_.positions, key, i), sums);
  }
  Transfer transfer = finish(receiver, sender, sums);
  transfer.form_factor_samples = samples;
  return transfer;
}

}  // namespace renderers::final_gather
