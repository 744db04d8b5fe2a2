#include "renderers/scene/generators/toy_room.h"

#include "renderers/scene/generators/lindenmayer_plant.h"
#include "renderers/scene/generators/mesh_pieces.h"
#include "renderers/scene/generators/uniform_number.h"
#include "renderers/scene/value_reader.h"

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <map>
#include <random>
#include <string>
#include <utility>

namespace renderers::scene {
namespace {

constexpr int kDefaultTriangles = 250000;
constexpr int kLeastTriangles = 150000;
constexpr int kMostTriangles = 2000000;

constexpr int kBushSteps = 6;
constexpr int kRound = 48;  ///< segments of balls

using Parts = std::map<std::string, Mesh>;

void add_shell(Parts& parts) {
  add_parallelogram(parts["floor"], {-2.5F, 0, -2}, {0, 0, 4}, {5, 0, 0});
  add_parallelogram(parts["ceiling"], {-2.5F, 2.6F, -2}, {5, 0, 0}, {0, 0, 4});
  Mesh& walls = parts["walls"];
  add_parallelogram(walls, {-2.5F, 0, -2}, {5, 0, 0}, {0, 2.6F, 0});
  add_parallelogram(walls, {2.5F, 0, 2}, {-5, 0, 0}, {0, 2.6F, 0});
  add_parallelogram(walls, {-2.5F, 0, 2}, {0, 0, -4}, {0, 2.6F, 0});
  add_parallelogram(walls, {2.5F, 0, -2}, {0, 0, 4}, {0, 2.6F, 0});
  add_parallelogram(parts["lamp"], {-0.5F, 2.58F, -0.4F}, {1, 0, 0}, {0, 0, 0.8F});
  add_parallelogram(parts["window"], {2.48F, 0.9F, -0.9F}, {0, 0, 1.4F}, {0, 1.2F, 0});
  add_parallelogram(parts["rug"], {-1.3F, 0.006F, -0.9F}, {0, 0, 1.9F}, {2.6F, 0, 0});
}

void add_furniture(Mesh& mesh) {
  const glm::mat4 place(1.0F);
  // Shelf at the back wall.
  for (const float x : {-1.0F, -0.02F, 0.96F}) {
    add_cuboid(mesh, {x, 0, 1.65F}, {x + 0.04F, 1.25F, 1.98F}, place);
  }
  for (const float y : {0.05F, 0.45F, 0.85F, 1.25F}) {
    add_cuboid(mesh, {-1.0F, y, 1.65F}, {1.0F, y + 0.03F, 1.98F}, place);
  }
  // Low table with a stool.
  add_cuboid(mesh, {1.35F, 0.46F, 0.35F}, {2.25F, 0.5F, 1.15F}, place);
  for (const float x : {1.38F, 2.16F}) {
    for (const float z : {0.38F, 1.06F}) {
      add_cuboid(mesh, {x, 0, z}, {x + 0.06F, 0.46F, z + 0.06F}, place);
    }
  }
  add_tube(mesh, {{1.1F, 0, 0.6F}, {1.1F, 0.28F, 0.6F}, 0.14F, 0.17F, 24, true});
}

/// A castle, a stair and some that lie about.
void add_blocks(Parts& parts, std::mt19937_64& engine) {
  const auto block = [&](int color, const glm::vec3& low, float size_m, float turn_rad) {
    const glm::mat4 place = glm::rotate(
        glm::translate(glm::mat4(1.0F), low + glm::vec3(0.5F * size_m, 0, 0.5F * size_m)), turn_rad,
        {0, 1, 0});
    add_cuboid(parts[std::string("blocks-") + static_cast<char>('a' + color % 3)],
               {-0.5F * size_m, 0.0F, -0.5F * size_m}, {0.5F * size_m, size_m, 0.5F * size_m},
               place);
  };
  for (int layer = 0; layer < 6; ++layer) {
    for (int i = 0; i < 6 - layer; ++i) {
      block(i + layer,
            {-1.15F + 0.125F * static_cast<float>(i) + 0.0625F * static_cast<float>(layer),
             0.007F + 0.12F * static_cast<float>(layer), 0.55F},
            0.118F, uniform(engine, -0.06F, 0.06F));
    }
  }
  for (int i = 0; i < 16; ++i) {
    // One number a statement: the order of a call's arguments is the compiler's.
    const float turn_rad = uniform(engine, 0.0F, 1.5F);
    const float x = uniform(engine, -1.9F, 1.2F);
    const float z = uniform(engine, -1.3F, 0.4F);
    block(i, {x, 0.007F, z}, 0.1F, turn_rad);
  }
  for (int i = 0; i < 9; ++i) {
    block(i, {-0.9F + 0.2F * static_cast<float>(i), 0.881F, 1.75F}, 0.1F,
          uniform(engine, 0.0F, 1.5F));
  }
}

void add_train(Mesh& body, Mesh& wheels) {
  for (int wagon = 0; wagon < 4; ++wagon) {
    const glm::mat4 place = glm::rotate(
        glm::translate(glm::mat4(1.0F), {0.15F + 0.36F * static_cast<float>(wagon), 0.007F,
                                         -0.4F + 0.1F * static_cast<float>(wagon)}),
        -0.27F, {0, 1, 0});
    const auto at = [&](float x, float y, float z) {
      return glm::vec3(place * glm::vec4(x, y, z, 1.0F));
    };
    add_cuboid(body, {-0.15F, 0.05F, -0.07F}, {0.15F, 0.08F, 0.07F}, place);
    if (wagon == 0) {
      add_tube(body, {at(-0.15F, 0.14F, 0), at(0.04F, 0.14F, 0), 0.06F, 0.06F, 32, true});
      add_tube(body, {at(-0.1F, 0.19F, 0), at(-0.1F, 0.27F, 0), 0.018F, 0.03F, 24, true});
      add_cuboid(body, {0.04F, 0.08F, -0.07F}, {0.15F, 0.25F, 0.07F}, place);
    } else {
      for (const float z : {-0.07F, 0.06F}) {
        add_cuboid(body, {-0.15F, 0.08F, z}, {0.15F, 0.16F, z + 0.01F}, place);
      }
    }
    for (const float x : {-0.09F, 0.09F}) {
      for (const float z : {-0.09F, 0.07F}) {
        add_tube(wheels, {at(x, 0.045F, z), at(x, 0.045F, z + 0.02F), 0.045F, 0.045F, 32, true});
      }
    }
  }
}

/// A bear that sits on the floor, its nose towards -z.
void add_bear(Mesh& mesh, const glm::vec3& at) {
  const auto part = [&](const glm::vec3& center, const glm::vec3& radii_m) {
    add_ellipsoid(mesh, at + center, radii_m, kRound);
  };
  part({0, 0.2F, 0}, {0.15F, 0.2F, 0.13F});
  part({0, 0.48F, -0.02F}, {0.13F, 0.12F, 0.12F});
  part({0, 0.45F, -0.13F}, {0.055F, 0.045F, 0.05F});
  for (const float side : {-1.0F, 1.0F}) {
    part({0.1F * side, 0.59F, 0}, {0.045F, 0.045F, 0.025F});
    part({0.17F * side, 0.27F, -0.07F}, {0.05F, 0.055F, 0.13F});
    part({0.12F * side, 0.065F, -0.16F}, {0.065F, 0.065F, 0.15F});
  }
}

/// Pots with bushes; leaves are left for the end, when their fineness is known.
std::vector<LeafPlace> add_plants(Parts& parts, std::mt19937_64& engine) {
  const std::string word = bush_word(kBushSteps);
  std::vector<LeafPlace> leaves;
  for (const glm::vec2& at :
       {glm::vec2(-2.0F, 1.5F), glm::vec2(1.75F, 1.6F), glm::vec2(-2.1F, -0.6F)}) {
    add_tube(parts["pots"], {{at.x, 0, at.y}, {at.x, 0.3F, at.y}, 0.13F, 0.18F, 48, true});
    const std::vector<LeafPlace> grown =
        grow(word, {at.x, 0.3F, at.y}, 0.9F, engine, parts["stems"]);
    leaves.insert(leaves.end(), grown.begin(), grown.end());
  }
  return leaves;
}

/// Colours of the parts if the scene gives none; ours.
const std::map<std::string, glm::vec3>& part_colors() {
  static const std::map<std::string, glm::vec3> colors{
      {"balls-a", {0.62F, 0.10F, 0.08F}},   {"balls-b", {0.10F, 0.28F, 0.58F}},
      {"bear", {0.42F, 0.26F, 0.13F}},      {"blocks-a", {0.64F, 0.16F, 0.10F}},
      {"blocks-b", {0.66F, 0.52F, 0.10F}},  {"blocks-c", {0.12F, 0.34F, 0.56F}},
      {"ceiling", {0.76F, 0.75F, 0.72F}},   {"floor", {0.48F, 0.34F, 0.20F}},
      {"furniture", {0.62F, 0.47F, 0.29F}}, {"lamp", {0.5F, 0.5F, 0.5F}},
      {"leaves", {0.14F, 0.34F, 0.09F}},    {"pots", {0.54F, 0.27F, 0.16F}},
      {"rug", {0.46F, 0.22F, 0.26F}},       {"stems", {0.26F, 0.22F, 0.10F}},
      {"train", {0.12F, 0.42F, 0.20F}},     {"walls", {0.68F, 0.63F, 0.50F}},
      {"wheels", {0.50F, 0.12F, 0.10F}},    {"window", {0.3F, 0.3F, 0.3F}}};
  return colors;
}

/// Radiance of what shines, W/(m2 sr); ours.
glm::vec3 emission_of(const std::string& part) {
  if (part == "lamp") return {9.0F, 8.2F, 7.0F};
  if (part == "window") return {5.0F, 5.6F, 6.6F};
  return glm::vec3(0.0F);
}

}  // namespace

std::vector<GeneratedPart> toy_room(base::MapReader& reader) {
  std::mt19937_64 engine(static_cast<std::uint64_t>(reader.integer("seed", 1)));
  const base::Node* node = reader.find("triangles");
  int left = node == nullptr ? kDefaultTriangles
                             : read_count(*node, "triangles", kLeastTriangles, kMostTriangles);
  Parts parts;
  add_shell(parts);
  add_furniture(parts["furniture"]);
  add_blocks(parts, engine);
  add_train(parts["train"], parts["wheels"]);
  add_bear(parts["bear"], {0.2F, 0.007F, 0.75F});
  add_ellipsoid(parts["balls-a"], {0.75F, 0.22F, 0.25F}, glm::vec3(0.213F), kRound);
  add_ellipsoid(parts["balls-b"], {-1.35F, 0.14F, -0.35F}, glm::vec3(0.13F), kRound);
  add_ellipsoid(parts["balls-b"], {1.8F, 0.6F, 0.75F}, glm::vec3(0.1F), kRound);
  const std::vector<LeafPlace> leaves = add_plants(parts, engine);
  for (const auto& [name, mesh] : parts) left -= static_cast<int>(mesh.triangles.size());
  // Leaves are as fine as there are triangles left for each.
  Mesh& mesh = parts["leaves"];
  for (std::size_t i = 0; i < leaves.size(); ++i) {
    const int segments = std::max(1, left / (2 * static_cast<int>(leaves.size() - i)));
    left -= 2 * segments;
    add_leaf(mesh, leaves[i], uniform(engine, 0.05F, 0.1F), segments);
  }
  std::vector<GeneratedPart> result;
  for (auto& [name, part_mesh] : parts) {
    GeneratedPart part;
    part.name = name;
    part.mesh = std::move(part_mesh);
    part.material.albedo = part_colors().at(name);
    part.material.emission = emission_of(name);
    result.push_back(std::move(part));
  }
  return result;
}

}  // namespace renderers::scene
