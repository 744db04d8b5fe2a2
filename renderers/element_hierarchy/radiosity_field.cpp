#include "renderers/element_hierarchy/radiosity_field.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "perception/base/parallel.h"
#include "renderers/ray_tracing/surface_brdf.h"

namespace renderers::element_hierarchy {

namespace {

constexpr std::size_t kGrain = 256;

float largest(const glm::vec3& color) { return std::max(color.x, std::max(color.y, color.z)); }

}  // namespace

RadiosityField::RadiosityField(const ElementTree& tree, const SideViews* views)
    : tree_(tree), views_(views) {
  for (const Element& element : tree.elements()) {
    add_node(static_cast<std::uint32_t>(nodes_.size()));
    radiosity_.push_back(element.emitted_w_m2);
  }
  gathered_.resize(radiosity_.size(), glm::vec3(0.0F));
  irradiance_ = gathered_;
  sent_.out = radiosity_;
  push_pull();
}

void RadiosityField::add_node(std::uint32_t index) {
  const Element& element = tree_.at(index);
  const glm::vec3 known_w_m2 = element.point_light_w_m2 + element.environment_w_m2;
  nodes_.push_back({element.parent, element.first_child, element.child_count, element.area_m2,
                    element.reflectance, element.emitted_w_m2 + element.reflectance * known_w_m2});
  if (element.parent == kNoElement) return;
  // It may have been a leaf.
  nodes_[element.parent].first_child = tree_.at(element.parent).first_child;
  nodes_[element.parent].child_count = tree_.at(element.parent).child_count;
}

void RadiosityField::grow() {
  for (std::size_t i = radiosity_.size(); i < tree_.elements().size(); ++i) {
    const std::uint32_t parent = tree_.elements()[i].parent;
    add_node(static_cast<std::uint32_t>(i));
    gathered_.emplace_back(0.0F);
    irradiance_.push_back(irradiance_[parent]);
    radiosity_.push_back(radiosity_[parent]);
    sent_.out.push_back(radiosity_[parent]);
  }
  push_pull();
}

void RadiosityField::send(const std::vector<glm::vec3>& radiosity, SideViews::Sent& sent) const {
  if (views_ != nullptr) {
    views_->send(radiosity, sent);
  } else {
    sent.out = radiosity;
  }
}

/// Adds to each element what its ancestors have; where sides have views of their own, to their
/// parts alone.
void RadiosityField::push(const std::vector<glm::vec3>& gathered,
                          std::vector<glm::vec3>& irradiance) const {
  irradiance = gathered;
  for (std::size_t i = views_ != nullptr ? views_->first_part() : 1; i < nodes_.size(); ++i) {
    irradiance[i] += irradiance[nodes_[i].parent];
  }
}

/// Radiosity that a link brings, W/m2.
glm::vec3 RadiosityField::brought(std::uint32_t receiver, const Link& link,
                                  const SideViews::Sent& sent) const {
  if (link.is(self_link)) return sent.out[link.source];
  // Rays met the source from all around: no one direction stands for them.
  if (link.is(by_rays)) return sent.out[link.source];
  const Element& from = tree_.at(link.source);
  const Element& to = tree_.at(receiver);
  return sent.towards(link.source, (to.box_min + to.box_max) - (from.box_min + from.box_max));
}

void RadiosityField::gather(const LinkSet& links, const std::vector<glm::vec3>& radiosity,
                            const SideViews::Sent& sent, std::vector<glm::vec3>& received) const {
  received.assign(nodes_.size(), glm::vec3(0.0F));
  // Whole sides get theirs, and that of the clusters around them, by their views.
  if (views_ != nullptr) views_->gather(radiosity, received);
  const std::size_t first = views_ != nullptr ? views_->first_part() : 0;
  base::parallel_for(received.size() - first, kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = first + begin; p < first + end; ++p) {
      for (const Link& link : links.of(static_cast<std::uint32_t>(p))) {
        received[p] += link.transfer() * brought(static_cast<std::uint32_t>(p), link, sent);
      }
    }
  });
}

double RadiosityField::iterate(const LinkSet& links) {
  send(radiosity_, sent_);
  gather(links, radiosity_, sent_, gathered_);
  return push_pull();
}

double RadiosityField::push_pull() {
  push(gathered_, irradiance_);
  float change = 0.0F;
  float most = 0.0F;
  least_.resize(nodes_.size());
  greatest_.resize(nodes_.size());
  spread_.resize(nodes_.size());
  for (std::size_t i = nodes_.size(); i-- > 0;) {
    const Node& node = nodes_[i];
    glm::vec3 radiosity(0.0F);
    if (node.child_count == 0) {
      const glm::vec3 reflected = node.reflectance * irradiance_[i];
      radiosity = node.own_w_m2 + reflected;
      change = std::max(change, largest(glm::abs(radiosity - radiosity_[i])));
      most = std::max(most, largest(reflected));
      least_[i] = greatest_[i] = ray_tracing::luminance(radiosity);
    } else {
      least_[i] = std::numeric_limits<float>::infinity();
      greatest_[i] = 0.0F;
      for (std::uint32_t c = 0; c < node.child_count; ++c) {
        const std::uint32_t child = node.first_child + c;
        radiosity += nodes_[child].area_m2 * radiosity_[child];
        least_[i] = std::min(least_[i], least_[child]);
        greatest_[i] = std::max(greatest_[i], greatest_[child]);
      }
      radiosity /= node.area_m2;
    }
    radiosity_[i] = radiosity;
    spread_[i] = 0.5F * (greatest_[i] - least_[i]);
  }
  return most > 0.0F ? static_cast<double>(change) / static_cast<double>(most) : 0.0;
}

std::int64_t RadiosityField::memory_bytes() const {
  return static_cast<std::int64_t>(nodes_.capacity() * sizeof(Node) +
                                   (gathered_.capacity() + irradiance_.capacity() +
                                    radiosity_.capacity() + sent_.out.capacity()) *
                                       sizeof(glm::vec3) +
                                   sent_.directed.capacity() * sizeof(DirectedRadiosity) +
                                   (least_.capacity() + greatest_.capacity() + spread_.capacity()) *
                                       sizeof(float));
}

std::vector<glm::vec3> RadiosityField::emitted_irradiance(const LinkSet& links) const {
  // Clusters send the mean of what is emitted below them.
  std::vector<glm::vec3> emitted;
  emitted.reserve(tree_.elements().size());
  for (const Element& element : tree_.elements()) emitted.push_back(element.emitted_w_m2);
  SideViews::Sent sent;
  send(emitted, sent);
  std::vector<glm::vec3> gathered;
  gather(links, emitted, sent, gathered);
  std::vector<glm::vec3> irradiance;
  push(gathered, irradiance);
  return irradiance;
}

}  // namespace renderers::element_hierarchy
