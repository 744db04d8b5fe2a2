#include "renderers/indirect_view/view_settings.h"

#include <array>
#include <utility>

#include "renderers/contract/choice_names.h"

namespace renderers::indirect_view {

namespace {

constexpr std::array<std::pair<const char*, HemisphereSequence>, 3> kSequences{
    {{"random", HemisphereSequence::random},
     {"strata", HemisphereSequence::strata},
     {"sobol", HemisphereSequence::sobol}}};

}  // namespace

std::vector<base::ParameterSpec> view_parameters() {
  return {base::integer_parameter("samples", 8, {1.0, 65536.0}, "samples per pixel",
                                  "Camera rays per pixel, each with a sample on the lights and, "
                                  "where the technique gathers, a gather of its own; ours."),
          base::choice_parameter(
              "part", {"all", "indirect"}, "all",
              "indirect: without emission seen by the camera and light that meets one surface.")};
}

ViewSettings view_settings_of(const base::Parameters& parameters) {
  return {parameters.integer("samples"), part_from_text(parameters.text("part"))};
}

std::vector<base::ParameterSpec> hemisphere_parameters() {
  return {
      base::integer_parameter("gather_rays", 64, {1.0, 1e6}, "rays",
                              "Cosine-distributed rays of a final gather, per camera ray; "
                              "ours."),
      base::choice_parameter(
          "gather_sequence", names_of(kSequences), "sobol",
          "Directions of these rays: independent, one in each cell of a grid, or Owen-scrambled "
          "Sobol' points that go on from camera ray to camera ray; ours.")};
}

HemisphereRays hemisphere_rays_of(const base::Parameters& parameters) {
  return {static_cast<int>(parameters.integer("gather_rays")),
          value_of(kSequences, parameters.text("gather_sequence"))};
}

RendererInfo view_info() {
  RendererInfo info;
  info.claims = [](const base::Parameters& parameters, const scene::Scene&) {
    return Claims{Transport::diffuse, part_from_text(parameters.text("part")), std::nullopt};
  };
  info.possible_claims = {{Transport::diffuse, Part::all, std::nullopt},
                          {Transport::diffuse, Part::indirect, std::nullopt}};
  info.supports = {Feature::point_light,      Feature::spot_light,  Feature::area_light,
                   Feature::emission_profile, Feature::environment, Feature::texture,
                   Feature::glossy,           Feature::animation};
  info.progressive_unit = "samples per pixel";
  info.uses_seed = true;
  return info;
}

}  // namespace renderers::indirect_view
