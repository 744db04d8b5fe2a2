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

/// Sums over samples.
struct SenderTransfer::Sums {
  double weight = 1.0;  ///< of the sample on its way
  double weights = 0.0;
  double kernel = 0.0;
  double seen = 0.0;
  glm::dvec3 light{0.0};
  double rays = 0.0;
  double area_m2 = 0.0;             ///< of what samples lie on
  double bound_m2 = 0.0;            ///< added to pi r^2
  std::optional<VisiblePart> part;  ///< of a patch, with exact form factors
};

/// Rays that wait for each other, and what they bring to whose sums if nothing occludes them.
struct SenderTransfer::Packet {
  std::array<ray_tracing::Ray, ray_tracing::kPacketRays> rays;
  std::array<double, ray_tracing::kPacketRays> kernels{};
  std::array<glm::vec3, ray_tracing::kPacketRays> radiosities{};
  std::array<Sums*, ray_tracing::kPacketRays> owners{};
  std::size_t count = 0;
};

void SenderTransfer::begin(const Receiver& receiver, std::uint32_t sender, double samples,
                           Sums& sums) const {
  const Element& element = solution_.tree->at(sender);
  sums.area_m2 = static_cast<double>(element.area_m2);
  if (!settings_.is_exact) return;
  if (element.is_patch && !is_in_front(receiver, element)) {
    sums.area_m2 = 0.0;
    return;
  }
  // Clusters that samples nearly touch are lit by rays: a bound would dim the others.
  if (!element.is_patch) return;
  // Samples below the horizon would leave the visibility to the few that are not.
  sums.part.emplace(element, receiver.point.position, receiver.normal);
  sums.area_m2 *= sums.part->share();
  sums.bound_m2 = sums.area_m2 / std::fmax(1.0, samples);
}

void SenderTransfer::add_samples(const Receiver& receiver, const TransferRequest& request,
                                 Sums& sums, Packet* packet) const {
  begin(receiver, request.sender, request.samples, sums);
  const auto whole_samples = static_cast<std::uint32_t>(request.samples);
  for (std::uint32_t i = 0; i < whole_samples; ++i) {
    add_sample(receiver, request.sender, i, sums, packet);
  }
  sums.weight = request.samples - whole_samples;
  if (sums.weight > 0.0) add_sample(receiver, request.sender, whole_samples, sums, packet);
}

SenderPoint SenderTransfer::point_for(const Receiver& receiver, std::uint32_t sender,
                                      std::uint32_t index, const VisiblePart* part) const {
  const bool is_cut = part != nullptr && part->share() < 1.0;
  if (settings_.reuse == Reuse::fixed && !is_cut) return points_.fixed(sender, index);
  std::uint64_t key = points_.key(sender);
  if (settings_.reuse == Reuse::per_pixel) {
    key = ray_tracing::hash_combine(key, receiver.ray_number);
  }
  const glm::vec2 place = sender_position(settings_.points.positions, key, index);
  if (!is_cut) return points_.at(sender, place);
  return points_.at(sender,
                    solution_.tree->point_of(solution_.tree->at(sender), part->sample(place)));
}

/// Kernel A cos cos / (pi r^2 + A / N): the last term, of patches, bounds samples that nearly
/// touch.
void SenderTransfer::add_sample(const Receiver& receiver, std::uint32_t sender, std::uint32_t index,
                                Sums& sums, Packet* packet) const {
  sums.weights += sums.weight;
  if (sums.area_m2 <= 0.0) return;
  const SenderPoint point = point_for(receiver, sender, index, sums.part ? &*sums.part : nullptr);
  const SidePoint& at = point.side;
  const glm::vec3 between = at.surface.position - receiver.point.position;
  const auto distance2 = static_cast<double>(glm::dot(between, between));
  const auto receiver_cosine = static_cast<double>(glm::dot(receiver.normal, between));
  const auto sender_cosine = -static_cast<double>(glm::dot(at.normal, between));
  if (receiver_cosine <= 0.0 || sender_cosine <= 0.0 || distance2 <= 0.0) return;
  const double kernel = sums.weight * sums.area_m2 * receiver_cosine * sender_cosine / distance2 /
                        (kPi * distance2 + sums.bound_m2);
  sums.kernel += kernel;
  if (packet == nullptr) return;
  packet->rays[packet->count] = segment_to(receiver.point, at.surface);
  packet->kernels[packet->count] = kernel;
  packet->radiosities[packet->count] = point.radiosity;
  packet->owners[packet->count] = &sums;
  if (++packet->count == ray_tracing::kPacketRays) trace(*packet);
}

void SenderTransfer::trace(Packet& packet) const {
  if (packet.count == 0) return;
  const std::uint32_t occluded =
      solution_.tree->rays().occluded_mask(std::span(packet.rays).first(packet.count));
  for (std::size_t i = 0; i < packet.count; ++i) {
    Sums& sums = *packet.owners[i];
    sums.rays += 1.0;
    if ((occluded >> i) & 1U) continue;
    sums.seen += packet.kernels[i];
    sums.light += packet.kernels[i] * glm::dvec3(packet.radiosities[i]);
  }
  packet.count = 0;
}

Transfer SenderTransfer::finish(const Receiver& receiver, const TransferRequest& request,
                                const Sums& sums) const {
  Transfer transfer;
  transfer.visibility_rays = sums.rays;
  transfer.form_factor_samples = request.samples;
  const Element& element = solution_.tree->at(request.sender);
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
  return whole(receiver, std::array{TransferRequest{sender, samples}}).front();
}

std::vector<Transfer> SenderTransfer::whole(const Receiver& receiver,
                                            std::span<const TransferRequest> requests) const {
  std::vector<Sums> sums(requests.size());
  Packet packet;
  for (std::size_t i = 0; i < requests.size(); ++i) {
    add_samples(receiver, requests[i], sums[i], &packet);
  }
  trace(packet);
  std::vector<Transfer> transfers;
  transfers.reserve(requests.size());
  for (std::size_t i = 0; i < requests.size(); ++i) {
    transfers.push_back(finish(receiver, requests[i], sums[i]));
  }
  return transfers;
}

Transfer SenderTransfer::form_factor(const Receiver& receiver, std::uint32_t sender,
                                     double samples) const {
  Sums sums;
  const Element& element = solution_.tree->at(sender);
  if (settings_.is_exact && element.is_patch) {
    sums.weights = 1.0;
    return finish(receiver, {sender, 1.0}, sums);
  }
  add_samples(receiver, {sender, samples}, sums, nullptr);
  return finish(receiver, {sender, samples}, sums);
}

}  // namespace renderers::final_gather
