#pragma once

#include "renderers/scene/scene.h"

#include <glm/vec3.hpp>

#include <random>
#include <string>
#include <vector>

namespace renderers::scene {

/// Where a leaf grows.
struct LeafPlace {
  glm::vec3 base{0.0F};
  glm::vec3 along{0.0F, 1.0F, 0.0F};   ///< unit length, to the tip
  glm::vec3 across{1.0F, 0.0F, 0.0F};  ///< unit length
};

/// The word of a bush after some steps from `A`: A -> [&FLA]/////[&FLA]///////[&FLA], F -> S/////F,
/// S -> FL; & bends down, / rolls, [ ] branch, L is a leaf.
/// Source: Prusinkiewicz and Lindenmayer 1990, "The Algorithmic Beauty of Plants", Fig. 1.25 (rules
/// recalled).
std::string bush_word(int steps);

/// Walks a word with a turtle that starts upwards.
/// @param size_m   about the bush's height
/// @param stems    receives the branches
/// @return the places of the leaves
std::vector<LeafPlace> grow(const std::string& word, const glm::vec3& root, float size_m,
                            std::mt19937_64& engine, Mesh& stems);

/// A pointed leaf of 2 `segments` triangles that bends down towards its tip.
void add_leaf(Mesh& mesh, const LeafPlace& place, float length_m, int segments);

}  // namespace renderers::scene
