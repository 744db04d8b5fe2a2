#include "renderers/element_hierarchy/radiosity_field.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "perception/base/parallel.h"
#include "renderers/ray_tracing/surface_brdf.h"

namespace renderers::element_hierarchy {

namespace {

constexpr std::size_t kGrain = 256;

float largest(const glm::vec3& color) { return std::max(color.x, std::max(color.y, color.z)); }

}  // namespace

RadiosityField::RadiosityField(const ElementTree& tree, const SideViews* views)
    : tree_(tree), views_(views) {
  for (const Element& element : tree.elements()) radiosity_.push_back(element.emitted_w_m2);
  gathered_.resize(radiosity_.size(), glm::vec3(0.0F));
  irradiance_ = gathered_;
  spread_.resize(radiosity_.size(), 0.0F);
  sent_ = radiosity_;
  push_pull();
}

void RadiosityField::grow() {
  for (std::size_t i = radiosity_.size(); i < tree_.elements().size(); ++i) {
    const std::uint32_t parent = tree_.elements()[i].parent;
    gathered_.emplace_back(0.0F);
    irradiance_.push_back(irradiance_[parent]);
    radiosity_.push_back(radiosity_[parent]);
    sent_.push_back(radiosity_[parent]);
    spread_.push_back(0.0F);
  }
  push_pull();
}

SideViews::Sent RadiosityField::sent_by(const std::vector<glm::vec3>& radiosity) const {
  return views_ != nullptr ? views_->sent(radiosity)
                           : SideViews::Sent{radiosity, radiosity, {}, {}};
}

/// Adds to each element what its ancestors have.
std::vector<glm::vec3> RadiosityField::push(const std::vector<glm::vec3>& gathered) const {
  if (views_ != nullptr) return views_->push(gathered);
  const std::vector<Element>& elements = tree_.elements();
  std::vector<glm::vec3> irradiance = gathered;
  for (std::size_t i = 1; i < elements.size(); ++i) irradiance[i] += irradiance[elements[i].parent];
  return irradiance;
}

/// Radiosity that a link brings, W/m2.
glm::vec3 RadiosityField::brought(std::uint32_t receiver, const Link& link,
                                  const SideViews::Sent& sent) const {
  if (link.is(self_link)) return sent.inside[link.source];
  // Rays met the source from all around: no one direction stands for them.
  if (link.is(by_rays)) return sent.out[link.source];
  const Element& from = tree_.at(link.source);
  const Element& to = tree_.at(receiver);
  return sent.towards(link.source, (to.box_min + to.box_max) - (from.box_min + from.box_max));
}

std::vector<glm::vec3> RadiosityField::gather(const LinkSet& links,
                                              const SideViews::Sent& sent) const {
  std::vector<glm::vec3> received(tree_.elements().size(), glm::vec3(0.0F));
  base::parallel_for(received.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      for (const Link& link : links.of(static_cast<std::uint32_t>(p))) {
        received[p] += link.transfer() * brought(static_cast<std::uint32_t>(p), link, sent);
      }
    }
  });
  return received;
}

double RadiosityField::iterate(const LinkSet& links) {
  SideViews::Sent sent = sent_by(radiosity_);
  gathered_ = gather(links, sent);
  sent_ = std::move(sent.out);
  return push_pull();
}

double RadiosityField::push_pull() {
  const std::vector<Element>& elements = tree_.elements();
  irradiance_ = push(gathered_);
  float change = 0.0F;
  float most = 0.0F;
  std::vector<float> least(elements.size(), std::numeric_limits<float>::infinity());
  std::vector<float> greatest(elements.size(), 0.0F);
  for (std::size_t i = elements.size(); i-- > 0;) {
    const Element& element = elements[i];
    glm::vec3 radiosity(0.0F);
    if (element.is_leaf()) {
      const glm::vec3 incident =
          irradiance_[i] + element.point_light_w_m2 + element.environment_w_m2;
      radiosity = element.emitted_w_m2 + element.reflectance * incident;
      change = std::max(change, largest(glm::abs(radiosity - radiosity_[i])));
      most = std::max(most, largest(radiosity));
      least[i] = greatest[i] = ray_tracing::luminance(radiosity);
    } else {
      for (std::uint32_t c = 0; c < element.child_count; ++c) {
        const std::uint32_t child = element.first_child + c;
        radiosity += elements[child].area_m2 * radiosity_[child];
        least[i] = std::min(least[i], least[child]);
        greatest[i] = std::max(greatest[i], greatest[child]);
      }
      radiosity /= element.area_m2;
    }
    radiosity_[i] = radiosity;
    spread_[i] = 0.5F * (greatest[i] - least[i]);
  }
  return most > 0.0F ? static_cast<double>(change) / static_cast<double>(most) : 0.0;
}

std::vector<glm::vec3> RadiosityField::emitted_irradiance(const LinkSet& links) const {
  // Clusters send the mean of what is emitted below them.
  std::vector<glm::vec3> emitted;
  emitted.reserve(tree_.elements().size());
  for (const Element& element : tree_.elements()) emitted.push_back(element.emitted_w_m2);
  return push(gather(links, sent_by(emitted)));
}

}  // namespace renderers::element_hierarchy
