#include "renderers/final_gather/grid_gather.h"

#include <algorithm>

#include <glm/geometric.hpp>

#include "perception/base/parallel.h"

namespace renderers::final_gather {

using element_hierarchy::kNoElement;

/// A vertex's wish to have a sender evaluated at the point.
struct GridGather::Request {
  const SenderRecord* record;
  float weight;  ///< of the vertex
};

GridGather::GridGather(const SenderTransfer& transfer, const GridAnchors& anchors,
                       const VertexClassifier& classifier)
    : transfer_(transfer), anchors_(anchors), vertices_(anchors.touched().size()) {
  slot_.assign(anchors.grid().size().vertex_count(), kNoElement);
  for (std::uint32_t i = 0; i < anchors.touched().size(); ++i) slot_[anchors.touched()[i]] = i;
  base::parallel_for(vertices_.size(), 4, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      vertices_[i] = classifier.classify(anchors.touched()[i]);
    }
  });
}

const GridVertex* GridGather::vertex(std::uint32_t index) const {
  return slot_[index] == kNoElement ? nullptr : &vertices_[slot_[index]];
}

GatheredLight GridGather::at(const Receiver& receiver) const {
  const GridBlend blend = anchors_.grid().blend(receiver.point.position);
  GatheredLight light;
  std::vector<Request> requests;
  for (std::size_t i = 0; i < blend.count; ++i) {
    const GridVertex* corner = vertex(blend.vertices[i]);
    if (corner == nullptr || blend.weights[i] <= 0.0F) continue;
    add_vertex(*corner, blend.weights[i], receiver.normal, requests, light);
  }
  std::ranges::stable_sort(requests, {}, [](const Request& r) { return r.record->sender; });
  for (std::size_t begin = 0; begin < requests.size();) {
    std::size_t end = begin + 1;
    while (end < requests.size() &&
           requests[end].record->sender == requests[begin].record->sender) {
      ++end;
    }
    resample(receiver, requests.data() + begin, requests.data() + end, light);
    begin = end;
  }
  return light;
}

void GridGather::add_vertex(const GridVertex& vertex, float weight, const glm::vec3& normal,
                            std::vector<Request>& requests, GatheredLight& light) const {
  light.irradiance += weight * vertex.around.at(normal);
  light.senders += static_cast<double>(weight) * vertex.senders;
  for (const SenderRecord& record : vertex.records) {
    if (record.resamples_form_factor || record.resamples_visibility) {
      requests.push_back({&record, weight});
      continue;
    }
    const float form_factor = std::max(0.0F, glm::dot(normal, record.vector_form_factor));
    light.irradiance += weight * form_factor * record.visibility * record.radiosity;
  }
}

void GridGather::resample(const Receiver& receiver, const Request* first, const Request* last,
                          GatheredLight& light) const {
  double form_factor_samples = 0.0;
  double visibility_samples = 0.0;
  for (const Request* r = first; r != last; ++r) {
    const auto weight = static_cast<double>(r->weight);
    if (r->record->resamples_form_factor)
      form_factor_samples += weight * r->record->form_factor_samples;
    if (r->record->resamples_visibility)
      visibility_samples += weight * r->record->visibility_samples;
    double& of_class = !r->record->resamples_visibility    ? light.resampled.x
                       : !r->record->resamples_form_factor ? light.resampled.y
                                                           : light.resampled.z;
    of_class += weight;
  }
  const std::uint32_t sender = first->record->sender;
  Transfer exact;  // both, by one set of samples
  if (visibility_samples > 0.0) exact = transfer_.whole(receiver, sender, visibility_samples);
  double form_factor = exact.form_factor;
  if (form_factor_samples > 0.0) {
    const Transfer finer = transfer_.form_factor(receiver, sender, form_factor_samples);
    form_factor = finer.form_factor;
    light.form_factor_samples += finer.form_factor_samples;
  }
  light.visibility_rays += exact.visibility_rays;
  // Radiosity of what is seen from here: the samples' mean.
  const double through = exact.form_factor * exact.visibility;
  const glm::vec3 seen =
      through > 0.0 ? exact.irradiance / static_cast<float>(through) : glm::vec3(0.0F);
  for (const Request* r = first; r != last; ++r) {
    const SenderRecord& record = *r->record;
    const float stored = std::max(0.0F, glm::dot(receiver.normal, record.vector_form_factor));
    const float factor = record.resamples_form_factor ? static_cast<float>(form_factor) : stored;
    const bool sees = record.resamples_visibility;
    const float visibility = sees ? static_cast<float>(exact.visibility) : record.visibility;
    light.irradiance += r->weight * factor * visibility * (sees ? seen : record.radiosity);
  }
}

double GridGather::elevation(const glm::vec3& place) const {
  const GridBlend blend = anchors_.grid().blend(place);
  double sum = 0.0;
  for (std::size_t i = 0; i < blend.count; ++i) {
    const GridVertex* corner = vertex(blend.vertices[i]);
    sum += static_cast<double>(blend.weights[i]) * (corner != nullptr ? corner->elevation : 1.0);
  }
  return sum;
}

double GridGather::threshold_cd_m2(const glm::vec3& place) const {
  const GridBlend blend = anchors_.grid().blend(place);
  double sum = 0.0;
  for (std::size_t i = 0; i < blend.count; ++i) {
    const GridVertex* corner = vertex(blend.vertices[i]);
    if (corner != nullptr) sum += static_cast<double>(blend.weights[i]) * corner->threshold_cd_m2;
  }
  return sum;
}

std::int64_t GridGather::memory_bytes() const {
  auto bytes = static_cast<std::int64_t>(vertices_.capacity() * sizeof(GridVertex) +
                                         slot_.capacity() * sizeof(std::uint32_t));
  for (const GridVertex& vertex : vertices_) {
    bytes += static_cast<std::int64_t>(vertex.records.capacity() * sizeof(SenderRecord));
  }
  return bytes;
}

}  // namespace renderers::final_gather
