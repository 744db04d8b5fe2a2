#include "renderers/light_propagation/light_propagation_settings.h"

#include <array>
#include <bit>
#include <string>
#include <utility>

#include "perception/base/errors.h"
#include "renderers/contract/choice_names.h"

namespace renderers::light_propagation {

namespace {

using base::boolean_parameter;
using base::choice_parameter;
using base::integer_parameter;

constexpr std::array<std::pair<const char*, SampleArea>, 2> kAreas{
    {{"clipped", SampleArea::clipped}, {"count", SampleArea::count}}};
constexpr std::array<std::pair<const char*, Sources>, 2> kSources{
    {{"poisson", Sources::poisson}, {"rsm", Sources::rsm}}};
constexpr std::array<std::pair<const char*, Lookup>, 2> kLookups{
    {{"face_flux", Lookup::face_flux}, {"half_cell", Lookup::half_cell}}};

}  // namespace

std::vector<base::ParameterSpec> parameter_specs() {
  return {
      choice_parameter("backend", {"auto", "cpu"}, "auto",
                       "Where light is gathered and propagated; auto: the CPU, the one there is."),
      choice_parameter("part", {"all", "indirect"}, "all",
                       "indirect: without emission seen by the camera and light that meets one "
                       "surface."),
      integer_parameter("cells", 32, {4.0, 128.0}, "cells",
                        "Of the volume along the scene's longest side, its margin of two included; "
                        "ours."),
      base::real_parameter("grid_shift", 0.0, {-0.99, 0.99}, "cells",
                           "Of the volume from the scene's middle along all axes: how much a "
                           "picture hangs on where cells lie; ours."),
      integer_parameter("steps", 64, {0.0, 100'000.0}, "steps",
                        "Of propagation; light spreads by the root of their number, and none is "
                        "right everywhere; ours: twice the cells of the longest side."),
      boolean_parameter("clamp", false,
                        "Negative intensities towards faces count as 0: makes 12 to 14 % of light "
                        "in the first step; ours."),
      boolean_parameter("geometry_volume", true,
                        "Surfaces block light between cells; the paper follows Kaplanyan and "
                        "Dachsbacher 2010."),
      choice_parameter("sources", names_of(kSources), "poisson",
                       "poisson: samples on surfaces gather all lights (Sec. 3.2); rsm: what rays "
                       "from point and spot lights meet, the classic volume of Kaplanyan and "
                       "Dachsbacher 2010; no area lights."),
      integer_parameter("rsm_rays", 65536, {1.0, 16'777'216.0}, "rays",
                        "From each light with sources=rsm; ours: a map of 256 x 256."),
      base::real_parameter("samples_per_face", 4.0, {0.25, 256.0}, "samples",
                           "On a surface as large as a cell's face, at least; ours."),
      choice_parameter("sample_area", names_of(kAreas), "clipped",
                       "What a sample stands for: clipped: its share of the surface in its cell, "
                       "ours; count: a cell's face by the cell's number of samples (Sec. 3.2)."),
      integer_parameter("light_points", 16, {4.0, 4096.0}, "points",
                        "Points of each area light and of the environment that samples look at, a "
                        "power of two; ours."),
      choice_parameter("lookup", names_of(kLookups), "face_flux",
                       "Irradiance by the flux through a cell's face, ours; or by the intensity "
                       "from half a cell away."),
      integer_parameter("light_samples", 16, {1.0, 4096.0}, "samples",
                        "Direct light: samples of area lights and environment per pixel; ours."),
  };
}

std::vector<base::Preset> presets() {
  using Value = base::ParameterValue;
  // Sec. 3.2: voxels divided by their number of samples, then "the standard LPV": read half a cell
  // away; its number of steps is that of Kaplanyan and Dachsbacher's cascades (recalled).
  base::Preset paper{"paper",
                     {{"sample_area", Value(std::string("count"))},
                      {"lookup", Value(std::string("half_cell"))},
                      {"steps", Value(std::int64_t{8})}}};
  return {std::move(paper), base::Preset{"best", {}}};
}

Settings settings_of(const base::Parameters& parameters) {
  const auto integer = [&](const char* name) { return static_cast<int>(parameters.integer(name)); };
  Settings settings;
  settings.part = part_from_text(parameters.text("part"));
  settings.cells = integer("cells");
  settings.grid_shift = static_cast<float>(parameters.real("grid_shift"));
  settings.propagation.steps = integer("steps");
  settings.propagation.has_clamp = parameters.boolean("clamp");
  settings.has_geometry_volume = parameters.boolean("geometry_volume");
  settings.samples.per_cell_face = parameters.real("samples_per_face");
  settings.samples.area = value_of(kAreas, parameters.text("sample_area"));
  settings.light_points = integer("light_points");
  settings.sources = value_of(kSources, parameters.text("sources"));
  settings.rsm_rays = integer("rsm_rays");
  settings.lookup = value_of(kLookups, parameters.text("lookup"));
  settings.light_samples = integer("light_samples");
  if (!std::has_single_bit(static_cast<unsigned>(settings.light_points))) {
    throw base::InputError("light-propagation: light_points is " +
                           std::to_string(settings.light_points) + "; accepted: powers of two");
  }
  return settings;
}

Claims claims_of(const base::Parameters& parameters) {
  return {Transport::one_bounce, part_from_text(parameters.text("part")), std::nullopt};
}

}  // namespace renderers::light_propagation
