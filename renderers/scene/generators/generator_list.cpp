#include "renderers/scene/generators/generator_list.h"

#include "perception/base/names.h"
#include "renderers/scene/generators/atrium.h"
#include "renderers/scene/generators/library.h"
#include "renderers/scene/generators/metaballs.h"
#include "renderers/scene/generators/plant.h"
#include "renderers/scene/generators/scattered_boxes.h"
#include "renderers/scene/generators/toy_room.h"

namespace renderers::scene {
namespace {

struct Generator {
  const char* name;
  std::vector<GeneratedPart> (*generate)(base::MapReader& reader);
};

constexpr Generator kGenerators[] = {{"atrium", atrium},
                                     {"library", library},
                                     {"metaballs", metaballs},
                                     {"plant", plant},
                                     {"scattered-boxes", scattered_boxes},
                                     {"toy-room", toy_room}};

}  // namespace

std::vector<GeneratedPart> generate(const base::Node& node) {
  base::MapReader reader(node, "generator");
  const base::Node& name = reader.require("name");
  std::vector<std::string> known;
  for (const Generator& generator : kGenerators) {
    known.emplace_back(generator.name);
    if (!base::is_same_name(generator.name, name.text("name"))) continue;
    std::vector<GeneratedPart> parts = generator.generate(reader);
    reader.finish();
    return parts;
  }
  throw base::InputError(name.place(), base::unknown_name("generator", name.text("name"), known));
}

}  // namespace renderers::scene
