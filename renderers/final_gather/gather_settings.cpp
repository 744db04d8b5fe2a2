#include "renderers/final_gather/gather_settings.h"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "renderers/contract/choice_names.h"
#include "renderers/element_hierarchy/solver_parameters.h"

namespace renderers::final_gather {

namespace {

using base::choice_parameter;
using base::integer_parameter;

constexpr std::array<std::pair<const char*, Positions>, 2> kSequences{
    {{"random", Positions::random}, {"r2", Positions::r2}}};
constexpr std::array<std::pair<const char*, Reuse>, 2> kReuses{
    {{"fixed", Reuse::fixed}, {"per_pixel", Reuse::per_pixel}}};

}  // namespace

std::vector<base::ParameterSpec> gather_parameters() {
  std::vector<base::ParameterSpec> specs = element_hierarchy::solver_parameters();
  specs.push_back(integer_parameter("gather_samples", 256, {1.0, 1e6}, "samples",
                                    "N of Eq. 1, shared out among the senders of a point by their "
                                    "unoccluded irradiance; not stated (Fig. 6 has 150); ours."));
  specs.push_back(integer_parameter("containing_rays", 100, {1.0, 1e6}, "rays",
                                    "Rays for senders around a point; \"about 100\" (Sec. 4.3)."));
  specs.push_back(choice_parameter("positions", names_of(kReuses), "fixed",
                                   "Samples on a sender: the same for all pixels (Sec. 4.4.1), or "
                                   "drawn for each camera ray."));
  specs.push_back(choice_parameter("sequence", names_of(kSequences), "r2",
                                   "random: independent positions (Sec. 4.4.1); r2: Roberts' "
                                   "sequence; ours."));
  specs.push_back(choice_parameter("form_factors", {"sampled", "exact"}, "exact",
                                   "Of patches, by samples or by Lambert's formula; exact also "
                                   "bounds samples that nearly touch; ours."));
  specs.push_back(choice_parameter("sender_radiosity", {"mean", "leaf"}, "leaf",
                                   "A sample brings the sender's mean or its leaf's radiosity; "
                                   "ours."));
  specs.push_back(choice_parameter("cluster_points", {"area", "power"}, "power",
                                   "Samples on a cluster by the area or the power of what is in "
                                   "it; ours."));
  specs.push_back(integer_parameter("camera_rays", 1, {1.0, 4096.0}, "rays per pixel",
                                    "Camera rays through a pixel; ours."));
  specs.push_back(integer_parameter("border_rays", 8, {1.0, 4096.0}, "rays per pixel",
                                    "At borders of objects, if more than camera_rays: the paper's "
                                    "mean is about 2.5 per pixel; ours."));
  specs.push_back(integer_parameter("environment_samples", 64, {1.0, 65536.0}, "samples",
                                    "On the environment, per camera ray; ours."));
  return specs;
}

std::vector<std::pair<std::string, base::ParameterValue>> paper_gather_values() {
  using Value = base::ParameterValue;
  auto values = element_hierarchy::paper_solver_values();
  values.emplace_back("sequence", Value(std::string("random")));
  values.emplace_back("form_factors", Value(std::string("sampled")));
  values.emplace_back("sender_radiosity", Value(std::string("mean")));
  values.emplace_back("cluster_points", Value(std::string("area")));
  return values;
}

GatherSettings gather_settings_of(const base::Parameters& parameters) {
  const auto integer = [&](const char* name) { return static_cast<int>(parameters.integer(name)); };
  GatherSettings settings;
  settings.solver = element_hierarchy::solver_settings_of(parameters);
  settings.transfer.points.positions = value_of(kSequences, parameters.text("sequence"));
  settings.transfer.reuse = value_of(kReuses, parameters.text("positions"));
  settings.transfer.is_exact = parameters.text("form_factors") == "exact";
  settings.transfer.points.by_leaf = parameters.text("sender_radiosity") == "leaf";
  settings.transfer.points.by_power = parameters.text("cluster_points") == "power";
  settings.gather.samples = integer("gather_samples");
  settings.gather.near_rays = integer("containing_rays");
  settings.camera.camera_rays = integer("camera_rays");
  settings.camera.border_rays = std::max(integer("border_rays"), settings.camera.camera_rays);
  settings.environment_samples = integer("environment_samples");
  return settings;
}

}  // namespace renderers::final_gather
