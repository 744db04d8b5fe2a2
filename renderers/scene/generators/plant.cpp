#include "renderers/scene/generators/plant.h"

#include "renderers/scene/generators/lindenmayer_plant.h"
#include "renderers/scene/generators/uniform_number.h"
#include "renderers/scene/value_reader.h"

#include <fmt/format.h>

#include <cstdint>
#include <random>
#include <utility>

namespace renderers::scene {
namespace {

constexpr double kHeight_m = 0.9;
constexpr int kSteps = 5;
constexpr int kMostSteps = 7;
constexpr int kLeafSegments = 4;
constexpr int kMostSegments = 64;

/// Colours if the scene gives none; ours.
constexpr glm::vec3 kLeafAlbedo{0.14F, 0.34F, 0.09F};
constexpr glm::vec3 kStemAlbedo{0.26F, 0.22F, 0.10F};

int count_or(base::MapReader& reader, const char* key, int fallback, int most) {
  const base::Node* node = reader.find(key);
  return node == nullptr ? fallback : read_count(*node, key, 1, most);
}

struct LeafLengths {
  float least_m = 0.05F;
  float greatest_m = 0.1F;
};

LeafLengths leaf_lengths(base::MapReader& reader) {
  const base::Node* node = reader.find("leaf_length");
  if (node == nullptr) return {};
  const auto numbers = base::number_list(*node, "leaf_length", 2);
  if (!(numbers[0] > 0.0 && numbers[1] >= numbers[0])) {
    throw base::InputError(node->place(),
                           fmt::format("leaf_length is [{:g}, {:g}]; accepted: [least, greatest] "
                                       "above 0",
                                       numbers[0], numbers[1]));
  }
  return {static_cast<float>(numbers[0]), static_cast<float>(numbers[1])};
}

double height_m(base::MapReader& reader) {
  const base::Node* node = reader.find("height");
  const double height = node == nullptr ? kHeight_m : node->number("height");
  if (height > 0.0) return height;
  throw base::InputError(node->place(), fmt::format("height is {:g}; accepted: above 0", height));
}

}  // namespace

std::vector<GeneratedPart> plant(base::MapReader& reader) {
  std::mt19937_64 engine(static_cast<std::uint64_t>(reader.integer("seed", 1)));
  const auto height = static_cast<float>(height_m(reader));
  const int steps = count_or(reader, "steps", kSteps, kMostSteps);
  const int segments = count_or(reader, "leaf_segments", kLeafSegments, kMostSegments);
  const LeafLengths lengths = leaf_lengths(reader);
  GeneratedPart leaves;
  leaves.name = "leaves";
  leaves.material.albedo = kLeafAlbedo;
  GeneratedPart stems;
  stems.name = "stems";
  stems.material.albedo = kStemAlbedo;
  for (const LeafPlace& place :
       grow(bush_word(steps), glm::vec3(0.0F), height, engine, stems.mesh)) {
    add_leaf(leaves.mesh, place, uniform(engine, lengths.least_m, lengths.greatest_m), segments);
  }
  return {std::move(leaves), std::move(stems)};
}

}  // namespace renderers::scene
