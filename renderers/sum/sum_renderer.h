#pragma once

#include <string>
#include <utility>
#include <vector>

#include "renderers/contract/renderer.h"

/// A renderer whose image is the sum of those of others: direct light by one technique, indirect by
/// another.
namespace renderers::sum {

/// One renderer of a sum.
struct Part {
  RendererInfo info;  ///< without a progressive unit
  std::string name;   ///< snake_case; stands before its parameters, AOVs and counters: "name_..."
  std::string stage;  ///< of the stage vocabulary; all of its stages lie below
  /// Parameters that have these values for good, and are not among those of the sum.
  std::vector<std::pair<std::string, base::ParameterValue>> fixed;
};

/// What a sum is called and what it is an estimate of.
struct Description {
  std::string name;
  std::string summary;
  std::string source;
  Claims claims;
};

/// The entry of a sum. Its presets are those of the first part, of all parts together; it supports
/// what all of them do.
///
/// AOVs are each part's image under the part's name, and its AOVs; counters are those of the parts,
/// and `rays`, the sum. Each part prepares for itself: two that trace rays build two hierarchies.
/// @param claims  gives `description.claims`; `RendererInfo` takes no closure
RendererInfo renderer_info(const Description& description, std::vector<Part> parts,
                           Claims (*claims)(const base::Parameters&, const scene::Scene&));

}  // namespace renderers::sum
