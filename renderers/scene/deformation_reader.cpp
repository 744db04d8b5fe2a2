#include "renderers/scene/deformation.h"
#include "renderers/scene/value_reader.h"

#include <fmt/format.h>

#include <numbers>
#include <string>

namespace renderers::scene {
namespace {

using Numbers = std::array<double, 3>;

/// A number of a deformation that keys may change.
struct NumberSpec {
  const char* key;
  bool is_angle;  ///< written in degrees, kept in radians
  bool is_required;
};

struct TypeSpec {
  const char* name;
  DeformationType type;
  const char* axis_key;
  std::vector<NumberSpec> numbers;
};

std::vector<TypeSpec> type_specs() {
  return {{"bend",
           DeformationType::bend,
           "axis",
           {{"curvature_deg_per_m", true, true}, {"from", false, true}, {"to", false, true}}},
          {"twist", DeformationType::twist, "axis", {{"rate_deg_per_m", true, true}}},
          {"wave",
           DeformationType::wave,
           "along",
           {{"amplitude", false, true}, {"wavelength", false, true}, {"phase_deg", true, false}}}};
}

TypeSpec read_type(const base::Node& node) {
  std::vector<std::string> known;
  for (TypeSpec& spec : type_specs()) {
    if (node.text("type") == spec.name) return std::move(spec);
    known.emplace_back(spec.name);
  }
  throw base::InputError(node.place(),
                         base::unknown_name("type of deformation", node.text("type"), known));
}

int read_axis(const base::Node& node, const char* what) {
  const std::string& name = node.text(what);
  for (int axis = 0; axis < 3; ++axis) {
    if (name == std::string(1, "xyz"[axis])) return axis;
  }
  throw base::InputError(node.place(),
                         fmt::format("{} \"{}\" is unknown; known: x, y, z", what, name));
}

int read_other_axis(base::MapReader& reader, const char* key, int axis, const char* axis_key) {
  const base::Node& node = reader.require(key);
  const int other = read_axis(node, key);
  if (other != axis) return other;
  throw base::InputError(node.place(), fmt::format("{} and {} must differ", key, axis_key));
}

void check_numbers(const TypeSpec& spec, const Numbers& numbers, const base::Place& place) {
  if (spec.type == DeformationType::wave && !(numbers[1] > 0.0)) {
    throw base::InputError(place, fmt::format("wavelength {} must be greater than 0", numbers[1]));
  }
  if (spec.type == DeformationType::bend &&
      !(numbers[1] <= 0.0 && 0.0 <= numbers[2] && numbers[1] < numbers[2])) {
    throw base::InputError(
        place, fmt::format("a bend from {} to {}: must satisfy from <= 0 <= to, from < to; they "
                           "count from the centre",
                           numbers[1], numbers[2]));
  }
}

/// @param rest  for what is missing; null: required numbers must be there
Numbers read_numbers(base::MapReader& reader, const TypeSpec& spec, const Numbers* rest) {
  Numbers numbers = rest == nullptr ? Numbers{} : *rest;
  for (std::size_t i = 0; i < spec.numbers.size(); ++i) {
    const NumberSpec& number = spec.numbers[i];
    const bool is_required = rest == nullptr && number.is_required;
    const base::Node* node = is_required ? &reader.require(number.key) : reader.find(number.key);
    if (node == nullptr) continue;
    const double value = static_cast<double>(read_float(*node, number.key));
    numbers[i] = number.is_angle ? value * std::numbers::pi / 180.0 : value;
  }
  check_numbers(spec, numbers, reader.node().place());
  return numbers;
}

void read_ramp(const base::Node& node, Deformation& deformation) {
  base::MapReader reader(node, "ramp");
  deformation.ramp_axis = read_axis(reader.require("axis"), "axis");
  deformation.ramp_from_m = static_cast<double>(read_float(reader.require("from"), "from"));
  deformation.ramp_to_m = static_cast<double>(read_float(reader.require("to"), "to"));
  reader.finish();
  if (deformation.ramp_axis == deformation.towards) {
    throw base::InputError(node.place(), "axis of ramp and towards must differ");
  }
  if (deformation.ramp_from_m == deformation.ramp_to_m) {
    throw base::InputError(node.place(), "from and to of ramp must differ");
  }
}

Deformation read_deformation(const base::Node& node) {
  base::MapReader reader(node, "deformation");
  const TypeSpec spec = read_type(reader.require("type"));
  Deformation deformation;
  deformation.type = spec.type;
  deformation.place = node.place();
  deformation.axis = read_axis(reader.require(spec.axis_key), spec.axis_key);
  if (spec.type != DeformationType::twist) {
    deformation.towards = read_other_axis(reader, "towards", deformation.axis, spec.axis_key);
  }
  if (spec.type == DeformationType::wave) {
    if (const auto* ramp = reader.find("ramp")) read_ramp(*ramp, deformation);
  } else if (const auto* center = reader.find("center")) {
    deformation.center = glm::dvec3(read_vec3(*center, "center"));
  }
  const Numbers rest = read_numbers(reader, spec, nullptr);
  deformation.numbers = read_track(reader, rest, [&](base::MapReader& key, const Numbers& missing) {
    return read_numbers(key, spec, &missing);
  });
  reader.finish();
  return deformation;
}

}  // namespace

std::vector<Deformation> read_deformations(const base::Node& node) {
  std::vector<Deformation> deformations;
  for (const base::Node& entry : node.list("deform")) {
    deformations.push_back(read_deformation(entry));
  }
  if (deformations.empty()) throw base::InputError(node.place(), "deform has no entries");
  return deformations;
}

}  // namespace renderers::scene
