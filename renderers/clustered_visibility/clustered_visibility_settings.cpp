#include "renderers/clustered_visibility/clustered_visibility_settings.h"

#include <array>
#include <bit>
#include <iterator>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "perception/base/errors.h"
#include "renderers/clustered_visibility/filter_settings.h"
#include "renderers/contract/choice_names.h"

namespace renderers::clustered_visibility {

namespace {

using base::boolean_parameter;
using base::choice_parameter;
using base::integer_parameter;
using base::ParameterSpec;
using base::real_parameter;
using shadow_maps::DepthBackend;
using shadow_maps::LayerChoice;

constexpr double kMostMapSide_px = 4096;
constexpr double kMostIterations = 1000;
constexpr double kMostBounces = 8;

constexpr std::array kVisibilities{
    std::pair{"oracle", Visibility::oracle}, std::pair{"hard", Visibility::hard},
    std::pair{"pcf", Visibility::pcf}, std::pair{"cssm", Visibility::cssm},
    std::pair{"msm", Visibility::msm}};
constexpr std::array kStarts{std::pair{"stride", ClusterStart::stride},
                             std::pair{"prefix", ClusterStart::prefix}};
constexpr std::array kSums{std::pair{"integer", ClusterSums::integer},
                           std::pair{"scatter", ClusterSums::scatter}};
constexpr std::array kAreas{std::pair{"rectangle", AreaFrom::rectangle},
                            std::pair{"covariance", AreaFrom::covariance}};
constexpr std::array kClips{std::pair{"all", Clip::all}, std::pair{"behind", Clip::behind}};
constexpr std::array kDepths{std::pair{"exact", DepthBackend::exact},
                             std::pair{"hemicube", DepthBackend::hemicube},
                             std::pair{"vertex", DepthBackend::vertex}};
constexpr std::array kLayerChoices{
    std::pair{"auto", LayerChoice::automatic}, std::pair{"vs_layer", LayerChoice::vs_layer},
    std::pair{"gs_layer", LayerChoice::gs_layer}, std::pair{"per_layer", LayerChoice::per_layer}};
std::vector<ParameterSpec> cluster_parameters() {
  return {
      integer_parameter("vals", 30, {1.0, double{kMostClusters}}, "area lights",
                        "Clusters of the virtual lights, one shadow map each, at most vpls; Dong "
                        "et al. 2009, Sec. 6: 30."),
      real_parameter("position_weight", 0.7, {0.0, 1000.0}, "",
                     "Of the distance in diagonals of the scene's bounds (unit ours); Dong et al. "
                     "2009, Sec. 5.1: 0.7."),
      real_parameter("normal_weight", 0.3, {0.0, 1000.0}, "",
                     "Of the angle between normals in half turns (unit ours); Dong et al. 2009, "
                     "Sec. 5.1: 0.3."),
      integer_parameter("cluster_iterations", 20, {1.0, kMostIterations}, "iterations",
                        "Most assignments of the lights to clusters; ours."),
      choice_parameter("cluster_start", names_of(kStarts), "prefix",
                       "Lights that clusters start from. stride: light k N / M of cluster k (Dong "
                       "et al. 2009, Sec. 6); prefix: light k, which is spread whatever the "
                       "numbers; ours."),
      choice_parameter("cluster_sums", names_of(kSums), "integer",
                       "Who sums the lights of clusters. integer: one work group, the same bits in "
                       "every run; ours; scatter: additive blending of points (Dong et al. 2009, "
                       "Sec. 6), in floats in the device's order."),
      boolean_parameter("warm_start", false,
                        "In a sequence, clusters start from those of the frame before; Dong et "
                        "al. 2009, Sec. 5.2 restart, as warm clusters die out."),
      boolean_parameter("adaptive", false,
                        "As many area lights as the picture needs, vals at most: their number "
                        "doubles until a preview changes visibly (threshold map of the perception "
                        "library) in at most adaptive_tolerance of its pixels; Dong et al. 2009, "
                        "Sec. 8 (future work): ours."),
      integer_parameter("adaptive_first", 4, {1.0, double{kMostClusters}}, "area lights",
                        "With adaptive, the number begun with; ours."),
      real_parameter("adaptive_tolerance", 0.02, {0.0, 1.0}, "",
                     "With adaptive, share of the preview's pixels that may change visibly; ours."),
      integer_parameter("adaptive_preview_px", 32, {1.0, 4096.0}, "pixels",
                        "With adaptive, longer side of the preview; ours."),
      real_parameter("adaptive_ppd", perception::default_viewing_conditions().pixels_per_degree,
                     {1.0, 1000.0}, "pixels per degree",
                     "With adaptive, at which the picture will be seen; default that of FLIP."),
      choice_parameter("area", names_of(kAreas), "rectangle",
                       "Area of a cluster. rectangle: around its lights, in its plane (Dong et "
                       "al. 2009, Sec. 6; axes ours); covariance: of the rectangle with their "
                       "variances; ours."),
      choice_parameter("clip", names_of(kClips), "behind",
                       "What maps leave out below the highest light of their cluster, as the "
                       "centre of a bent cluster lies inside the solid. all: all surfaces; behind: "
                       "those seen from behind; ours. With depth=vertex always all."),
  };
}

std::vector<ParameterSpec> shadow_parameters() {
  return {
      choice_parameter(
          "visibility", names_of(kVisibilities), "msm",
          "Share of an area light that a receiver sees. oracle: of its lights, by "
          "rays; hard: one test in its map; pcf: brute-force percentage-closer "
          "filtering; cssm: convolution soft shadow maps (Dong et al. 2009, Sec. 4); msm: "
          "moment soft shadow maps (Peters et al. 2015, 2017), two lookups; ours."),
      integer_parameter("shadow_map_px", 256, {4.0, kMostMapSide_px}, "pixels",
                        "Side of an area light's map, a power of two; Dong et al. 2009, Sec. 6: "
                        "256."),
      choice_parameter(
          "depth", names_of(kDepths), "exact",
          "What fills the maps. exact: every texel's ray meets the triangles, in "
          "compute; hemicube: five perspective faces, resampled; vertex: triangles cut "
          "small, their vertices projected (Dong et al. 2009, Sec. 6; cutting ours)."),
      real_parameter("tessellated_edge", 0.04, {0.0, 1.0}, "diagonals",
                     "With depth vertex, longest edge of the pieces that triangles are cut into, "
                     "in diagonals of the scene's bounds; 0: not cut; ours."),
      choice_parameter("layer_choice", names_of(kLayerChoices), "auto",
                       "With depth vertex, what chooses a map: the vertex shader or a geometry "
                       "shader of one instanced draw (Dong et al. 2009, Sec. 6), or a draw for "
                       "each; auto: the first that the device can do."),
  };
}

std::vector<ParameterSpec> view_parameters() {
  return {
      integer_parameter("only_val", -1, {-1.0, double{kMostClusters} - 1.0}, "",
                        "Light of this area light alone, to look at single shadows (Dong et al. "
                        "2009, Fig. 4); -1: of all."),
      boolean_parameter("show_lights", false, "Also the images clusters, vpls and light_count."),
      integer_parameter("shown_vals", 0, {0.0, double{kMostClusters}}, "images",
                        "Area lights whose visibility is shown as images val_0, val_1, ...; those "
                        "of most flux."),
  };
}

AreaTest test_of(Visibility visibility) {
  switch (visibility) {
    case Visibility::hard:
      return AreaTest::hard;
    case Visibility::pcf:
      return AreaTest::pcf;
    case Visibility::msm:
      return AreaTest::msm;
    default:
      return AreaTest::cssm;
  }
}

void check_growth(const Settings& settings) {
  if (!settings.growth.is_on) return;
  if (!settings.has_maps()) {
    throw base::InputError(
        "adaptive is true with visibility oracle, which has no maps to grow; accepted: visibility "
        "hard, pcf or cssm");
  }
  if (settings.clusters.is_warm) {
    throw base::InputError(
        "adaptive is true with warm_start: clusters grow from the lights of every frame anew; "
        "accepted: one of them");
  }
}

void check_only_val(const Settings& settings) {
  if (settings.only_val < 0) return;
  const int most = settings.clusters.clusters - 1;
  if (settings.only_val > most) {
    throw base::InputError(
        fmt::format("only_val is {}: there are {} area lights; accepted: -1 to {}",
                    settings.only_val, settings.clusters.clusters, most));
  }
  if (settings.growth.is_on || settings.bounces > 1) {
    throw base::InputError(fmt::format(
        "only_val is {} with {}: one area light of a known number in one bounce can be shown; "
        "accepted: -1",
        settings.only_val, settings.growth.is_on ? "adaptive" : "several bounces"));
  }
}

}  // namespace

std::vector<ParameterSpec> parameter_specs() {
  std::vector<ParameterSpec> specs = many_lights::picture_parameters(kMostLights);
  specs.push_back(integer_parameter(
      "bounces", 1, {1.0, kMostBounces}, "bounces",
      "Interreflections. Beyond the first, surfaces re-emit the light of the set before as vpls "
      "lights more, with clusters and maps of their own; Dong et al. 2009, Sec. 8 (future work): "
      "ours."));
  for (auto group :
       {cluster_parameters(), shadow_parameters(), filter_parameters(), view_parameters()}) {
    specs.insert(specs.end(), std::make_move_iterator(group.begin()),
                 std::make_move_iterator(group.end()));
  }
  return specs;
}

std::vector<base::Preset> presets() {
  const auto text = [](const char* value) { return base::ParameterValue(std::string(value)); };
  base::Preset paper{"paper",
                     {{"light_sampling", text("map")},
                      {"cluster_start", text("stride")},
                      {"cluster_sums", text("scatter")},
                      {"clip", text("all")},
                      {"visibility", text("cssm")},
                      {"depth", text("vertex")},
                      {"terms", base::ParameterValue(std::int64_t{4})},
                      {"basis_bits", text("8")},
                      {"lit_fix", text("scale")},
                      {"kernel", text("paper")},
                      {"blocker_depth", text("raw")},
                      {"finer_levels", base::ParameterValue(0.0)},
                      {"slope_bias", base::ParameterValue(0.0)},
                      {"blur", text("box")}}};
  return {std::move(paper), {"best", {}}};
}

Settings settings_of(const base::Parameters& parameters) {
  const auto integer = [&](const char* name) { return static_cast<int>(parameters.integer(name)); };
  const auto real = [&](const char* name) { return static_cast<float>(parameters.real(name)); };
  Settings settings{many_lights::picture_settings_of(parameters)};
  settings.bounces = integer("bounces");
  settings.visibility = value_of(kVisibilities, parameters.text("visibility"));
  settings.clusters.clusters = integer("vals");
  settings.clusters.position_weight = real("position_weight");
  settings.clusters.normal_weight = real("normal_weight");
  settings.clusters.iterations = integer("cluster_iterations");
  settings.clusters.start = value_of(kStarts, parameters.text("cluster_start"));
  settings.clusters.sums = value_of(kSums, parameters.text("cluster_sums"));
  settings.clusters.is_warm = parameters.boolean("warm_start");
  settings.clusters.area = value_of(kAreas, parameters.text("area"));
  settings.clusters.clip = value_of(kClips, parameters.text("clip"));
  settings.clips_more =
      parameters.text("depth") == "vertex" && settings.clusters.clip == Clip::behind;
  if (settings.clips_more) settings.clusters.clip = Clip::all;
  settings.growth.is_on = parameters.boolean("adaptive");
  settings.growth.first = integer("adaptive_first");
  settings.growth.tolerance = parameters.real("adaptive_tolerance");
  settings.growth.preview_px = integer("adaptive_preview_px");
  settings.growth.viewing.pixels_per_degree = parameters.real("adaptive_ppd");
  settings.shadow_map_px = integer("shadow_map_px");
  settings.depth = value_of(kDepths, parameters.text("depth"));
  settings.vertex_maps.edge_share = real("tessellated_edge");
  settings.vertex_maps.layer_choice = value_of(kLayerChoices, parameters.text("layer_choice"));
  read_filter_settings(parameters, settings.area, settings.convolution);
  settings.area.test = test_of(settings.visibility);
  settings.only_val = integer("only_val");
  settings.shows_lights = parameters.boolean("show_lights");
  settings.shown_vals = integer("shown_vals");
  if (settings.clusters.clusters > settings.virtual_lights) {
    throw base::InputError(
        fmt::format("vals is {}: more area lights than the {} point lights of vpls; accepted: 1 to "
                    "{}",
                    settings.clusters.clusters, settings.virtual_lights, settings.virtual_lights));
  }
  if (!std::has_single_bit(static_cast<unsigned>(settings.shadow_map_px))) {
    throw base::InputError(fmt::format(
        "shadow_map_px is {}, which is no power of two; nearest: {} and {}", settings.shadow_map_px,
        std::bit_floor(static_cast<unsigned>(settings.shadow_map_px)),
        std::bit_ceil(static_cast<unsigned>(settings.shadow_map_px))));
  }
  check_growth(settings);
  check_only_val(settings);
  return settings;
}

Claims claims_of(const base::Parameters& parameters, const scene::Scene& scene) {
  const Settings settings = settings_of(parameters);
  Claims claims;
  claims.transport = settings.bounces > 1 ? Transport::diffuse : Transport::one_bounce;
  claims.part = settings.part;
  const double clamp = many_lights::geometry_clamp_of(settings, scene);
  if (clamp > 0.0) claims.geometry_clamp = clamp;
  return claims;
}

}  // namespace renderers::clustered_visibility
