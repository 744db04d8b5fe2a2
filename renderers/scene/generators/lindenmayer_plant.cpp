#include "renderers/scene/generators/lindenmayer_plant.h"

#include "renderers/scene/generators/mesh_pieces.h"
#include "renderers/scene/generators/uniform_number.h"

#include <glm/geometric.hpp>

#include <cmath>
#include <numbers>

namespace renderers::scene {
namespace {

/// Turn of & and / (22.5 degrees in the source), and how much each varies.
constexpr float kTurn_rad = 22.5F / 180.0F * std::numbers::pi_v<float>;
constexpr float kVariation = 0.35F;

struct Turtle {
  glm::vec3 position{0.0F};
  glm::vec3 heading{0.0F, 1.0F, 0.0F};
  glm::vec3 left{1.0F, 0.0F, 0.0F};
  int depth = 0;  ///< of the branches
};

/// Rodrigues' rotation. @param axis  unit length
glm::vec3 turned_about(const glm::vec3& v, const glm::vec3& axis, float angle_rad) {
  const float c = std::cos(angle_rad);
  return c * v + std::sin(angle_rad) * glm::cross(axis, v) + (1.0F - c) * glm::dot(axis, v) * axis;
}

}  // namespace

std::string bush_word(int steps) {
  std::string word = "A";
  for (int i = 0; i < steps; ++i) {
    std::string next;
    for (const char symbol : word) {
      switch (symbol) {
        case 'A':
          next += "[&FLA]/////[&FLA]///////[&FLA]";
          break;
        case 'F':
          next += "S/////F";
          break;
        case 'S':
          next += "FL";
          break;
        default:
          next += symbol;
      }
    }
    word = std::move(next);
  }
  return word;
}

std::vector<LeafPlace> grow(const std::string& word, const glm::vec3& root, float size_m,
                            std::mt19937_64& engine, Mesh& stems) {
  std::vector<LeafPlace> leaves;
  std::vector<Turtle> stack;
  Turtle turtle;
  turtle.position = root;
  const auto angle = [&] { return kTurn_rad * (1.0F + kVariation * uniform(engine, -1.0F, 1.0F)); };
  for (const char symbol : word) {
    if (symbol == '[') {
      stack.push_back(turtle);
      ++turtle.depth;
    } else if (symbol == ']') {
      turtle = stack.back();
      stack.pop_back();
    } else if (symbol == '&') {
      turtle.heading = glm::normalize(turned_about(turtle.heading, turtle.left, angle()));
    } else if (symbol == '/') {
      turtle.left = glm::normalize(turned_about(turtle.left, turtle.heading, angle()));
    } else if (symbol == 'F') {
      TubeShape stem;
      stem.from = turtle.position;
      turtle.position += turtle.heading * (size_m * 0.045F);
      stem.to = turtle.position;
      stem.from_radius_m = stem.to_radius_m =
          size_m * 0.012F * std::pow(0.7F, static_cast<float>(turtle.depth));
      stem.around = 4;
      stem.has_ends = false;
      add_tube(stems, stem);
    } else if (symbol == 'L') {
      const glm::vec3 outwards = turned_about(turtle.heading, turtle.left, 1.0F);
      leaves.push_back({turtle.position, outwards, turtle.left});
    }
  }
  return leaves;
}

void add_leaf(Mesh& mesh, const LeafPlace& place, float length_m, int segments) {
  const auto first = static_cast<unsigned>(mesh.positions.size());
  const glm::vec3 up = glm::cross(place.along, place.across);
  for (int i = 0; i <= segments; ++i) {
    const float t = static_cast<float>(i) / static_cast<float>(segments);
    // Widest below the middle; the tip keeps a hundredth of the length, so that no edge vanishes.
    const float half_m =
        length_m * (0.01F + 0.22F * std::sin(std::numbers::pi_v<float> * std::pow(t, 0.8F)));
    const glm::vec3 middle =
        place.base + length_m * (t * place.along - 0.25F * t * t * glm::vec3(0.0F, 1.0F, 0.0F));
    const glm::vec3 tangent = glm::normalize(place.along - 0.5F * t * glm::vec3(0.0F, 1.0F, 0.0F));
    const glm::vec3 across =
        glm::normalize(place.across - glm::dot(place.across, tangent) * tangent);
    const glm::vec3 normal = glm::cross(tangent, across);
    for (const float side : {-1.0F, 1.0F}) {
      mesh.positions.push_back(middle + side * half_m * across);
      mesh.normals.push_back(glm::dot(normal, up) < 0.0F ? -normal : normal);
      mesh.uvs.emplace_back(0.5F + 0.5F * side, t);
    }
  }
  for (unsigned i = first; i < first + 2 * static_cast<unsigned>(segments); i += 2) {
    mesh.triangles.emplace_back(i, i + 2, i + 1);
    mesh.triangles.emplace_back(i + 1, i + 2, i + 3);
  }
}

}  // namespace renderers::scene
