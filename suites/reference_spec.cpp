#include "suites/reference_spec.h"

#include <vector>

#include <fmt/format.h>

#include "perception/base/names.h"

namespace suites {
namespace {

std::int64_t read_bounded(const base::Node& node, const char* what, std::int64_t high) {
  const std::int64_t value = node.integer(what);
  if (value >= 1 && value <= high) return value;
  throw base::InputError(node.place(),
                         fmt::format("{} is {}; accepted: 1 to {}", what, value, high));
}

std::uint64_t read_seed(const base::Node& node) {
  return static_cast<std::uint64_t>(read_bounded(node, "seed", std::int64_t{1} << 53));
}

OwnReference read_own(const base::Node& node) {
  base::MapReader reader(node, "own");
  OwnReference own;
  const base::Node& renderer = reader.require("renderer");
  own.choice.info = &renderers::find_renderer(renderer.text("renderer"), renderer.place());
  const base::Node* preset = reader.find("preset");
  const base::Preset& values =
      renderers::find_preset(*own.choice.info, preset == nullptr ? "best" : preset->text("preset"),
                             preset == nullptr ? node.place() : preset->place());
  own.choice.preset = values.name;
  std::vector<base::ParameterSetting> settings;
  if (const base::Node* parameters = reader.find("parameters")) {
    const base::MapReader map(*parameters, "parameters");
    for (const auto& [key, value] : parameters->entries()) {
      if (base::is_same_name(key, "part")) {
        throw base::InputError(
            value.place(), "a reference keeps direct and indirect light as parts; leave out part");
      }
      settings.push_back({base::snake_case(key), value});
    }
  }
  own.choice.parameters = base::resolve_parameters(
      own.choice.info->parameters, &values, settings,
      fmt::format("renderer \"{}\" (own reference)", own.choice.info->name));
  if (const base::Node* seed = reader.find("seed")) own.seed = read_seed(*seed);
  reader.finish();
  return own;
}

}  // namespace

ReferenceSpec read_reference(const base::Node& node) {
  base::MapReader reader(node, "reference");
  ReferenceSpec spec;
  if (const base::Node* renderer = reader.find("renderer")) {
    spec.renderer = renderers::find_renderer(renderer->text("renderer"), renderer->place()).name;
  }
  if (const base::Node* samples = reader.find("samples")) {
    spec.samples = read_bounded(*samples, "samples", std::int64_t{1} << 40);
  }
  if (const base::Node* seed = reader.find("seed")) spec.seed = read_seed(*seed);
  if (const base::Node* own = reader.find("own")) spec.own = read_own(*own);
  reader.finish();
  return spec;
}

ReferenceSpec reference_spec_for(const ReferenceSpec& spec, const renderers::scene::Scene& scene,
                                 const renderers::Claims& claims) {
  ReferenceSpec chosen = spec;
  if (!spec.own) return chosen;
  const MethodChoice& choice = spec.own->choice;
  if (choice.info->claims(choice.parameters, scene) != claims) {
    chosen.own.reset();
    return chosen;
  }
  chosen.renderer = choice.info->name;
  chosen.samples =
      choice.info->progressive_unit ? choice.parameters.integer("samples") : std::int64_t{1};
  chosen.seed = spec.own->seed;
  return chosen;
}

}  // namespace suites
