#include "renderers/final_gather/sender_list.h"

#include <algorithm>
#include <map>
#include <set>
#include <unordered_set>

#include "renderers/ray_tracing/surface_brdf.h"

namespace renderers::final_gather {

using element_hierarchy::Element;
using element_hierarchy::kNoElement;
using element_hierarchy::Link;

namespace {

using SenderMap = std::map<std::uint32_t, Sender>;

/// The smaller of two distances of which 0 means none.
double nearer(double a, double b) {
  if (a <= 0.0) return b;
  return b <= 0.0 ? a : std::min(a, b);
}

void merge(const Sender& other, Sender& into) {
  into.irradiance = std::max(into.irradiance, other.irradiance);
  into.is_occluded = into.is_occluded && other.is_occluded;
  const int links = into.links + other.links;
  into.visibility = (into.links * into.visibility + other.links * other.visibility) / links;
  into.links = links;
  into.least_visibility = std::min(into.least_visibility, other.least_visibility);
  into.greatest_visibility = std::max(into.greatest_visibility, other.greatest_visibility);
  into.from_source_m = nearer(into.from_source_m, other.from_source_m);
  into.from_receiver_m = nearer(into.from_receiver_m, other.from_receiver_m);
}

void add(SenderMap& senders, const Sender& sender) {
  const auto [found, is_new] = senders.try_emplace(sender.element, sender);
  if (!is_new) merge(sender, found->second);
}

Sender sender_of(const Link& link) {
  Sender sender;
  sender.element = link.source;
  sender.irradiance = static_cast<double>(element_hierarchy::from_log_code(link.irradiance));
  sender.is_occluded = link.is(element_hierarchy::fully_occluded);
  const auto share = [](std::uint16_t code) {
    return static_cast<double>(element_hierarchy::from_share_code(code));
  };
  sender.visibility = share(link.visibility);
  sender.least_visibility = share(link.least_visibility);
  sender.greatest_visibility = share(link.greatest_visibility);
  sender.from_source_m =
      static_cast<double>(element_hierarchy::from_log_code(link.occluder_from_source_m));
  sender.from_receiver_m =
      static_cast<double>(element_hierarchy::from_log_code(link.occluder_from_receiver_m));
  return sender;
}

/// Elements that are or have senders above them and have senders below.
std::set<std::uint32_t> elements_to_open(const element_hierarchy::ElementTree& tree,
                                         const SenderMap& senders) {
  std::set<std::uint32_t> open;
  for (const auto& [element, sender] : senders) {
    std::uint32_t top = kNoElement;
    for (std::uint32_t i = tree.at(element).parent; i != kNoElement; i = tree.at(i).parent) {
      if (senders.contains(i)) top = i;
    }
    if (top == kNoElement) continue;
    std::uint32_t i = tree.at(element).parent;
    while (i != top) {
      open.insert(i);
      i = tree.at(i).parent;
    }
    open.insert(top);
  }
  return open;
}

}  // namespace

std::vector<Sender> collect_senders(const element_hierarchy::Solution& solution,
                                    std::span<const std::uint32_t> leaves) {
  const element_hierarchy::ElementTree& tree = *solution.tree;
  SenderMap senders;
  std::unordered_set<std::uint32_t> visited;
  for (const std::uint32_t leaf : leaves) {
    for (std::uint32_t i = leaf; i != kNoElement && visited.insert(i).second;
         i = tree.at(i).parent) {
      for (const Link& link : solution.links.of(i)) add(senders, sender_of(link));
    }
  }
  const auto power = [&](std::uint32_t i) {
    return static_cast<double>(tree.at(i).area_m2 *
                               ray_tracing::luminance(solution.field->sent()[i]));
  };
  // Parents come before children, so each is whole when it is opened.
  for (const std::uint32_t parent : elements_to_open(tree, senders)) {
    const auto node = senders.extract(parent);
    const Sender& from = node.mapped();
    const Element& element = tree.at(parent);
    double whole = 0.0;
    for (std::uint32_t c = 0; c < element.child_count; ++c) {
      whole += power(element.first_child + c);
    }
    for (std::uint32_t c = 0; c < element.child_count; ++c) {
      Sender child = from;
      child.element = element.first_child + c;
      child.irradiance = whole > 0.0 ? from.irradiance * power(child.element) / whole : 0.0;
      add(senders, child);
    }
  }
  std::vector<Sender> result;
  result.reserve(senders.size());
  for (const auto& [element, sender] : senders) result.push_back(sender);
  return result;
}

}  // namespace renderers::final_gather
