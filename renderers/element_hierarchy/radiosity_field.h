#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "renderers/element_hierarchy/element_tree.h"
#include "renderers/element_hierarchy/link_set.h"

namespace renderers::element_hierarchy {

/// Light on the elements of a tree: irradiance that links bring, radiosity that follows from it.
///
/// Source: Hanrahan et al. 1991 (gather and push-pull); Sillion 1995, App. I: irradiance is pushed
/// down, not radiosity, and reflectances act at leaves alone.
class RadiosityField {
 public:
  /// B = E everywhere. @param tree  must live as long as this
  explicit RadiosityField(const ElementTree& tree);

  /// Gives elements that the tree got since then their parents' light.
  void grow();

  /// One step of Jacobi's iteration: irradiance from the radiosities that are, then push and pull.
  /// @return max |dB| / max B over leaves and channels; 0 if all is dark
  double iterate(const LinkSet& links);

  /// W/m2, of links alone, an element's own.
  const std::vector<glm::vec3>& gathered() const { return gathered_; }
  /// W/m2, of links alone: an element's own and its ancestors'. Of leaves: all that links bring.
  const std::vector<glm::vec3>& irradiance() const { return irradiance_; }
  /// W/m2, mean over the element.
  const std::vector<glm::vec3>& radiosity() const { return radiosity_; }
  /// Luminance, W/m2, half the range over the leaves below.
  const std::vector<float>& radiosity_spread() const { return spread_; }

  /// Irradiance on the leaves from the emission of elements alone, W/m2, per element as
  /// `irradiance`.
  std::vector<glm::vec3> emitted_irradiance(const LinkSet& links) const;

 private:
  std::vector<glm::vec3> gather(const LinkSet& links, const std::vector<glm::vec3>& sent) const;
  double push_pull();

  const ElementTree& tree_;
  std::vector<glm::vec3> gathered_;
  std::vector<glm::vec3> irradiance_;
  std::vector<glm::vec3> radiosity_;
  std::vector<float> spread_;
};

}  // namespace renderers::element_hierarchy
