#include "renderers/final_gather/sender_transfer.h"

#include <array>
#include <cmath>
#include <span>

#include <glm/geometric.hpp>

#include "renderers/element_hierarchy/form_factor.h"
#include "renderers/ray_tracing/sample_sequence.h"

namespace renderers::final_gather {

using element_hierarchy::Element;
using element_hierarchy::SidePoint;

namespace {

constexpr double kPi = 3.14159265358979323846;

}  // namespace

glm::vec2 sender_position(Positions positions, std::uint64_t key, std::uint32_t index) {
  if (positions == Positions::random) {
    return glm::vec2(
        ray_tracing::SampleSequence(ray_tracing::SequenceKind::random, key, index).next());
  }
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

  std::array<ray_tracing::Ray, ray_tracing::kPacketRays> waiting;
  std::array<double, ray_tracing::kPacketRays> waiting_kernel{};
  std::array<glm::vec3, ray_tracing::kPacketRays> waiting_light{};
  std::size_t count = 0;
};

glm::vec3 SenderTransfer::radiosity_at(const SidePoint& point, std::uint32_t sender) const {
  const auto& radiosity = solution_.field->radiosity();
  if (!settings_.by_leaf) return radiosity[sender];
  const std::uint32_t leaf = solution_.tree->leaf_at(point.surface, point.normal);
  return radiosity[leaf == element_hierarchy::kNoElement ? sender : leaf];
}

/// Kernel A cos cos / (pi r^2 + A / N): the last term bounds samples that nearly touch.
void SenderTransfer::add_sample(const Receiver& receiver, std::uint32_t sender,
                                const glm::vec2& place, double bound_m2, Sums& sums) const {
  sums.weights += sums.weight;
  const SidePoint at = solution_.tree->sample(sender, place);
  const glm::vec3 between = at.surface.position - receiver.point.position;
  const auto distance2 = static_cast<double>(glm::dot(between, between));
  const auto receiver_cosine = static_cast<double>(glm::dot(receiver.normal, between));
  const auto sender_cosine = -static_cast<double>(glm::dot(at.normal, between));
  if (receiver_cosine <= 0.0 || sender_cosine <= 0.0 || distance2 <= 0.0) return;
  const double area_m2 = static_cast<double>(solution_.tree->at(sender).area_m2);
  const double kernel = sums.weight * area_m2 * receiver_cosine * sender_cosine / distance2 /
                        (kPi * distance2 + bound_m2);
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
    const glm::vec3& at = receiver.point.position;
    const bool is_in_front = glm::dot(at - element.positions[0], element.normal) > 0.0F;
    form_factor = is_in_front
                      ? element_hierarchy::point_form_factor(at, receiver.normal, element.positions)
                      : 0.0;
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
  const double area_m2 = static_cast<double>(solution_.tree->at(sender).area_m2);
  const double bound_m2 = settings_.is_exact ? area_m2 / std::fmax(1.0, samples) : 0.0;
  const auto whole_samples = static_cast<std::uint32_t>(samples);
  for (std::uint32_t i = 0; i < whole_samples; ++i) {
    add_sample(receiver, sender, sender_position(settings_.positions, key, i), bound_m2, sums);
  }
  sums.weight = samples - whole_samples;
  if (sums.weight > 0.0) {
    add_sample(receiver, sender, sender_position(settings_.positions, key, whole_samples), bound_m2,
               sums);
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
  const double bound_m2 =
      settings_.is_exact ? static_cast<double>(element.area_m2) / std::fmax(1.0, samples) : 0.0;
  const auto whole_samples = static_cast<std::uint32_t>(samples);
  for (std::uint32_t i = 0; i <= whole_samples; ++i) {
    sums.weight = i < whole_samples ? 1.0 : samples - whole_samples;
    if (sums.weight <= 0.0) break;
    add_sample(receiver, sender, sender_position(settings_.positions, key, i), bound_m2, sums);
  }
  Transfer transfer = finish(receiver, sender, sums);
  transfer.form_factor_samples = samples;
  return transfer;
}

}  // namespace renderers::final_gather
