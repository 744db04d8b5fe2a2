#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "renderers/element_hierarchy/element_tree.h"
#include "renderers/element_hierarchy/link_set.h"
#include "renderers/element_hierarchy/side_views.h"

namespace renderers::element_hierarchy {

/// Light on the elements of a tree: irradiance that links bring, radiosity that follows from it.
///
/// Source: Hanrahan et al. 1991 (gather and push-pull); Sillion 1995, App. I: irradiance is pushed
/// down, not radiosity, and reflectances act at leaves alone.
class RadiosityField {
 public:
  /// B = E everywhere. @param tree  must live as long as this
  /// @param views  of its sides, must live as long as this; nullptr: light on a cluster is the same
  ///   on all that is in it, and a cluster sends the mean of its radiosities
  explicit RadiosityField(const ElementTree& tree, const SideViews* views = nullptr);

  /// Gives elements that the tree got since then their parents' light.
  void grow();

  /// One step of Jacobi's iteration: irradiance from the radiosities that are, then push and pull.
  /// @return max |dB| over the largest reflected radiosity, over leaves and channels; 0 if all is
  ///   dark
  double iterate(const LinkSet& links);

  /// W/m2, of links alone, all that they bring to a leaf. Without views also that of clusters: an
  /// element's own and its ancestors'.
  const std::vector<glm::vec3>& irradiance() const { return irradiance_; }
  /// W/m2, mean over the element.
  const std::vector<glm::vec3>& radiosity() const { return radiosity_; }
  /// W/m2, what reaches others from the element: of a cluster the mean over what can be seen of it.
  const std::vector<glm::vec3>& sent() const { return sent_.out; }
  /// Luminance, W/m2, half the range over the leaves below.
  const std::vector<float>& radiosity_spread() const { return spread_; }

  std::int64_t memory_bytes() const;

  /// Irradiance on the leaves from the emission of elements alone, W/m2, per element as
  /// `irradiance`.
  std::vector<glm::vec3> emitted_irradiance(const LinkSet& links) const;

 private:
  /// What iterations need of an element, side by side: elements are ten times as large.
  struct Node {
    std::uint32_t parent = kNoElement;
    std::uint32_t first_child = kNoElement;
    std::uint32_t child_count = 0;  ///< 0: a leaf
    float area_m2 = 0.0F;
    glm::vec3 reflectance{0.0F};  ///< of leaves, as is the next
    glm::vec3 own_w_m2{0.0F};     ///< emitted, and reflected of light that no link carries
  };
  void add_node(std::uint32_t index);
  void send(const std::vector<glm::vec3>& radiosity, SideViews::Sent& sent) const;
  void push(const std::vector<glm::vec3>& gathered, std::vector<glm::vec3>& irradiance) const;
  glm::vec3 brought(std::uint32_t receiver, const Link& link, const SideViews::Sent& sent) const;
  void gather(const LinkSet& links, const std::vector<glm::vec3>& radiosity,
              const SideViews::Sent& sent, std::vector<glm::vec3>& received) const;
  double push_pull();

  const ElementTree& tree_;
  const SideViews* views_;
  std::vector<Node> nodes_;
  std::vector<glm::vec3> gathered_;
  std::vector<glm::vec3> irradiance_;
  std::vector<glm::vec3> radiosity_;
  SideViews::Sent sent_;
  std::vector<float> least_;     ///< luminance, W/m2, over the leaves below
  std::vector<float> greatest_;  ///< the same
  std::vector<float> spread_;
};

}  // namespace renderers::element_hierarchy
