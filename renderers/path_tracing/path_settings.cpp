#include "renderers/path_tracing/path_settings.h"

#include <algorithm>
#include <limits>

namespace renderers::path_tracing {

namespace {

using base::choice_parameter;
using base::integer_parameter;
using base::ParameterSpec;

ParameterSpec geometry_clamp_parameter() {
  return base::real_parameter(
      "geometry_clamp", 0.0, {.min = 0.0}, "1/m2",
      "Bound of cos cos / d2 between the surface seen by the camera and the next one on the path, "
      "as techniques with virtual point lights bound it; later segments are free; 0: none.");
}

constexpr double kMostSamples = 1 << 30;
constexpr double kMostSurfaces = 1 << 20;

}  // namespace

int PathSettings::surface_limit() const {
  int limit = max_depth == 0 ? std::numeric_limits<int>::max() : max_depth;
  if (claims.transport == Transport::direct) limit = std::min(limit, 1);
  if (claims.transport == Transport::one_bounce) limit = std::min(limit, 2);
  return limit;
}

std::vector<ParameterSpec> parameter_specs() {
  return {
      integer_parameter("samples", 64, {1, kMostSamples}, "samples per pixel",
                        "Paths per pixel; the default is ours."),
      choice_parameter("transport", {"direct", "one_bounce", "diffuse", "full"}, "full",
                       "Light paths in the image: growing sets, see renderers/README.md."),
      choice_parameter(
          "part", {"all", "indirect"}, "all",
          "indirect: without emission seen by the camera and light that meets one surface."),
      geometry_clamp_parameter(),
      integer_parameter(
          "max_depth", 0, {0, kMostSurfaces}, "surfaces",
          "Greatest number of surfaces a path meets between light and camera; 1: direct "
          "light, 0: no bound. Mitsuba counts the camera's segment as well: its max_depth "
          "is ours + 1."),
      integer_parameter("roulette_depth", 4, {1, kMostSurfaces}, "surfaces",
                        "Surfaces a path meets before Russian roulette may end it; ours."),
      choice_parameter(
          "sampling", {"mis", "nee", "bsdf"}, "mis",
          "mis: power heuristic of Veach and Guibas 1995; nee: light sampling only; bsdf: "
          "reflected rays only (point and spot lights by light sampling)."),
      base::boolean_parameter(
          "light_rays", true,
          "Also sends a ray from a point or spot light per path and connects its first surface "
          "with "
          "all of the path's, weighted against reflected rays by the power heuristic: for lamps "
          "close to what they light."),
      choice_parameter("sampler", {"sobol", "random"}, "sobol",
                       "sobol: Owen-scrambled Sobol' points of Burley 2020; random: independent."),
      choice_parameter(
          "pixel", {"box", "centre"}, "box",
          "Camera rays over the whole pixel, or all through its centre: the truth for "
          "techniques that look at one surface per pixel, edges and textures included."),
  };
}

std::vector<base::Preset> presets() {
  // Kajiya 1986, Sec. 4: one reflected ray per surface and one ray to a light, all drawn
  // independently; roulette takes the place of its fixed end, which would leave energy out.
  base::Preset paper{"paper",
                     {{"sampling", std::string("nee")},
                      {"light_rays", false},
                      {"sampler", std::string("random")}}};
  return {std::move(paper), base::Preset{"best", {}}};
}

Claims claims_of(const base::Parameters& parameters) {
  Claims claims;
  claims.transport = transport_from_text(parameters.text("transport"));
  claims.part = part_from_text(parameters.text("part"));
  const double clamp = parameters.real("geometry_clamp");
  if (clamp > 0.0) claims.geometry_clamp = clamp;
  return claims;
}

PathSettings settings_of(const base::Parameters& parameters) {
  PathSettings settings;
  settings.samples = parameters.integer("samples");
  settings.claims = claims_of(parameters);
  settings.max_depth = static_cast<int>(parameters.integer("max_depth"));
  settings.roulette_depth = static_cast<int>(parameters.integer("roulette_depth"));
  const std::string& sampling = parameters.text("sampling");
  settings.sampling = sampling == "mis"   ? Sampling::mis
                      : sampling == "nee" ? Sampling::nee
                                          : Sampling::bsdf;
  settings.light_rays = parameters.boolean("light_rays");
  settings.sampler = parameters.text("sampler") == "sobol" ? ray_tracing::SequenceKind::sobol
                                                           : ray_tracing::SequenceKind::random;
  settings.pixel = parameters.text("pixel") == "box" ? PixelFilter::box : PixelFilter::centre;
  return settings;
}

}  // namespace renderers::path_tracing
