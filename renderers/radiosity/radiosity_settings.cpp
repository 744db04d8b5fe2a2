#include "renderers/radiosity/radiosity_settings.h"

#include <array>
#include <string>
#include <utility>

#include "renderers/contract/choice_names.h"
#include "renderers/element_hierarchy/solver_parameters.h"

namespace renderers::radiosity {

namespace {

using element_hierarchy::Shading;

constexpr std::array<std::pair<const char*, Shading>, 2> kShadings{
    {{"flat", Shading::flat}, {"smooth", Shading::smooth}}};
constexpr std::array<std::pair<const char*, DirectMode>, 2> kDirects{
    {{"solution", DirectMode::solution}, {"next_event", DirectMode::next_event}}};

}  // namespace

std::vector<base::ParameterSpec> parameter_specs() {
  std::vector<base::ParameterSpec> specs = element_hierarchy::solver_parameters();
  specs.push_back(base::choice_parameter("shading", names_of(kShadings), "smooth",
                                         "flat: a value per patch; smooth: Gouraud, linear between "
                                         "the patches' vertices (Sec. 5.2)."));
  specs.push_back(base::choice_parameter(
      "direct", names_of(kDirects), "next_event",
      "Direct light of area lights and environment from the solution, as the paper's preview, or "
      "from samples on the lights at every camera ray; ours. Point and spot lights always get a "
      "shadow ray."));
  specs.push_back(base::choice_parameter(
      "part", {"all", "indirect"}, "all",
      "indirect: without emission seen by the camera and light that meets one surface."));
  specs.push_back(base::integer_parameter(
      "camera_rays", 16, {1.0, 4096.0}, "rays per pixel",
      "Rays spread over each pixel, under next_event with one light sample each; ours."));
  return specs;
}

std::vector<base::Preset> presets() {
  base::Preset paper{"paper", element_hierarchy::paper_solver_values()};
  paper.values.emplace_back("direct", base::ParameterValue(std::string("solution")));
  return {std::move(paper), base::Preset{"best", {}}};
}

Settings settings_of(const base::Parameters& parameters) {
  Settings settings;
  settings.solver = element_hierarchy::solver_settings_of(parameters);
  settings.shading = value_of(kShadings, parameters.text("shading"));
  settings.direct = value_of(kDirects, parameters.text("direct"));
  settings.part = part_from_text(parameters.text("part"));
  settings.camera_rays = static_cast<int>(parameters.integer("camera_rays"));
  return settings;
}

Claims claims_of(const base::Parameters& parameters) {
  return {Transport::diffuse, part_from_text(parameters.text("part")), std::nullopt};
}

}  // namespace renderers::radiosity
