#include "renderers/element_hierarchy/link_set.h"

#include <algorithm>

namespace renderers::element_hierarchy {

std::uint32_t LinkSet::receiver_of(std::size_t index) const {
  const auto after =
      std::upper_bound(first_.begin(), first_.end(), static_cast<std::uint32_t>(index));
  return static_cast<std::uint32_t>(after - first_.begin()) - 1;
}

void LinkSet::replace(const std::vector<bool>& leaving, std::span<const New> entering,
                      std::size_t elements) {
  std::vector<std::uint32_t> first(elements + 1, 0);
  std::vector<std::uint32_t> receivers(links_.size());
  for (std::uint32_t receiver = 0; receiver + 1 < first_.size(); ++receiver) {
    for (std::uint32_t i = first_[receiver]; i < first_[receiver + 1]; ++i) {
      receivers[i] = receiver;
      if (!leaving[i]) ++first[receiver + 1];
    }
  }
  for (const New& link : entering) ++first[link.receiver + 1];
  for (std::size_t i = 1; i < first.size(); ++i) first[i] += first[i - 1];
  std::vector<Link> links(first.back());
  std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
  for (std::size_t i = 0; i < links_.size(); ++i) {
    if (!leaving[i]) links[next[receivers[i]]++] = links_[i];
  }
  for (const New& link : entering) links[next[link.receiver]++] = link.link;
  links_ = std::move(links);
  first_ = std::move(first);
}

}  // namespace renderers::element_hierarchy
