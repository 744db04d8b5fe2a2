#include "renderers/final_gather/record_blend.h"

#include <algorithm>

#include <glm/geometric.hpp>

namespace renderers::final_gather {

namespace {

float stored_form_factor(const SenderRecord& record, const glm::vec3& normal) {
  if (record.form_factor >= 0.0F) return record.form_factor;
  return std::max(0.0F, glm::dot(normal, record.vector_form_factor));
}

}  // namespace

/// A vertex's wish to have a sender evaluated at the point.
struct RecordBlend::Request {
  const SenderRecord* record;
  float weight;  ///< of the vertex
};

/// What the vertices around a point ask for of one sender.
struct RecordBlend::Asked {
  std::span<const Request> requests;
  double form_factor_samples = 0.0;
  double visibility_samples = 0.0;
};

GatheredLight RecordBlend::at(const Receiver& receiver,
                              std::span<const WeightedVertex> vertices) const {
  GatheredLight light;
  std::vector<Request> requests;
  for (const WeightedVertex& corner : vertices) {
    if (corner.vertex != nullptr && corner.weight > 0.0F) {
      add_vertex(corner, receiver.normal, requests, light);
    }
  }
  std::ranges::stable_sort(requests, {}, [](const Request& r) { return r.record->sender; });
  const std::vector<Asked> senders = senders_of(requests, light);
  std::vector<TransferRequest> seen;
  for (const Asked& asked : senders) {
    if (asked.visibility_samples <= 0.0) continue;
    seen.push_back({asked.requests.front().record->sender, asked.visibility_samples});
  }
  const std::vector<Transfer> transfers = transfer_.whole(receiver, seen);
  std::size_t next = 0;
  for (const Asked& asked : senders) {
    resample(receiver, asked, asked.visibility_samples > 0.0 ? transfers[next++] : Transfer{},
             light);
  }
  return light;
}

std::vector<RecordBlend::Asked> RecordBlend::senders_of(std::span<const Request> requests,
                                                        GatheredLight& light) const {
  std::vector<Asked> senders;
  while (!requests.empty()) {
    const std::uint32_t sender = requests.front().record->sender;
    const auto other = std::ranges::find_if(
        requests, [&](const Request& request) { return request.record->sender != sender; });
    Asked asked;
    asked.requests = requests.first(static_cast<std::size_t>(other - requests.begin()));
    requests = requests.subspan(asked.requests.size());
    for (const auto& [record, vertex_weight] : asked.requests) {
      const auto weight = static_cast<double>(vertex_weight);
      if (record->resamples_form_factor) {
        asked.form_factor_samples += weight * static_cast<double>(record->form_factor_samples);
      }
      if (record->resamples_visibility) {
        asked.visibility_samples += weight * static_cast<double>(record->visibility_samples);
      }
      double& of_class = !record->resamples_visibility    ? light.resampled.x
                         : !record->resamples_form_factor ? light.resampled.y
                                                          : light.resampled.z;
      of_class += weight;
    }
    senders.push_back(asked);
  }
  return senders;
}

void RecordBlend::add_vertex(const WeightedVertex& corner, const glm::vec3& normal,
                             std::vector<Request>& requests, GatheredLight& light) const {
  const GatherVertex& vertex = *corner.vertex;
  light.irradiance += corner.weight * (vertex.around.at(normal) + vertex.near_irradiance);
  light.senders += static_cast<double>(corner.weight) * vertex.senders;
  for (const SenderRecord& record : vertex.records) {
    if (record.resamples_form_factor || record.resamples_visibility) {
      requests.push_back({&record, corner.weight});
      continue;
    }
    light.irradiance +=
        corner.weight * stored_form_factor(record, normal) * record.visibility * record.radiosity;
  }
}

/// @param exact  form factor and visibility by one set of samples, if visibility is asked for
void RecordBlend::resample(const Receiver& receiver, const Asked& asked, const Transfer& exact,
                           GatheredLight& light) const {
  double form_factor = exact.form_factor;
  if (asked.form_factor_samples > 0.0) {
    const std::uint32_t sender = asked.requests.front().record->sender;
    const Transfer finer = transfer_.form_factor(receiver, sender, asked.form_factor_samples);
    form_factor = finer.form_factor;
    light.form_factor_samples += finer.form_factor_samples;
  }
  light.visibility_rays += exact.visibility_rays;
  // Radiosity of what is seen from here: the samples' mean.
  const double through = exact.form_factor * exact.visibility;
  const glm::vec3 seen =
      through > 0.0 ? exact.irradiance / static_cast<float>(through) : glm::vec3(0.0F);
  for (const Request& request : asked.requests) {
    const SenderRecord& record = *request.record;
    const float stored = stored_form_factor(record, receiver.normal);
    const float factor = record.resamples_form_factor ? static_cast<float>(form_factor) : stored;
    const bool sees = record.resamples_visibility;
    const float visibility = sees ? static_cast<float>(exact.visibility) : record.visibility;
    light.irradiance += request.weight * factor * visibility * (sees ? seen : record.radiosity);
  }
}

double mean_elevation(std::span<const WeightedVertex> vertices) {
  double sum = 0.0;
  for (const auto& [vertex, weight] : vertices) {
    sum += static_cast<double>(weight) * (vertex != nullptr ? vertex->elevation : 1.0);
  }
  return sum;
}

double mean_threshold_cd_m2(std::span<const WeightedVertex> vertices) {
  double sum = 0.0;
  for (const auto& [vertex, weight] : vertices) {
    if (vertex != nullptr) sum += static_cast<double>(weight) * vertex->threshold_cd_m2;
  }
  return sum;
}

std::int64_t memory_bytes(const std::vector<GatherVertex>& vertices) {
  auto bytes = static_cast<std::int64_t>(vertices.capacity() * sizeof(GatherVertex));
  for (const GatherVertex& vertex : vertices) {
    bytes += static_cast<std::int64_t>(vertex.records.capacity() * sizeof(SenderRecord));
  }
  return bytes;
}

}  // namespace renderers::final_gather
