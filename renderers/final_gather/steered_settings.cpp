#include "renderers/final_gather/steered_settings.h"

#include <array>
#include <initializer_list>
#include <string>
#include <utility>

#include "renderers/contract/choice_names.h"

namespace renderers::final_gather {

namespace {

using base::boolean_parameter;
using base::choice_parameter;
using base::integer_parameter;
using base::ParameterSpec;
using base::real_parameter;

constexpr std::array<std::pair<const char*, HitRule>, 4> kHitRules{{{"naive", HitRule::naive},
                                                                    {"literal", HitRule::literal},
                                                                    {"local", HitRule::local},
                                                                    {"surface", HitRule::surface}}};
constexpr std::array<std::pair<const char*, DepthSpacing>, 2> kSpacings{
    {{"reciprocal", DepthSpacing::reciprocal}, {"logarithmic", DepthSpacing::logarithmic}}};
constexpr std::array<std::pair<const char*, GridSpace>, 2> kSpaces{
    {{"perspective", GridSpace::perspective}, {"world", GridSpace::world}}};
constexpr std::array<std::pair<const char*, GridBlending>, 2> kBlendings{
    {{"tetrahedra", GridBlending::tetrahedra}, {"trilinear", GridBlending::trilinear}}};
constexpr std::array<std::pair<const char*, MaskedBy>, 2> kMaskings{
    {{"all", MaskedBy::all}, {"matched", MaskedBy::matched}}};
constexpr std::array<std::pair<const char*, Pooling>, 3> kPoolings{
    {{"mean", Pooling::mean}, {"quartile", Pooling::quartile}, {"minimum", Pooling::minimum}}};
constexpr std::array<std::pair<const char*, ToneOperator>, 2> kTones{
    {{"histogram", ToneOperator::histogram}, {"linear", ToneOperator::linear}}};

constexpr std::array<std::pair<const char*, SurfaceUse>, 2> kSurfaceUses{
    {{"never", SurfaceUse::never}, {"finely_cut", SurfaceUse::finely_cut}}};
constexpr std::array<std::pair<const char*, DecidedFor>, 2> kDecisions{
    {{"vertices", DecidedFor::vertices}, {"patches", DecidedFor::patches}}};
constexpr std::array<std::pair<const char*, VertexVisibility>, 2> kVisibilities{
    {{"links", VertexVisibility::links}, {"rays", VertexVisibility::rays}}};

std::vector<ParameterSpec> space_parameters() {
  return {
      integer_parameter("grid_vertices", 10000, {8.0, 1e7}, "vertices",
                        "About so many vertices of the grid (Sec. 6)."),
      choice_parameter("depth", names_of(kSpacings), "reciprocal",
                       "Slices uniform after the perspective (Sec. 4.2), or as deep as cells are "
                       "wide; ours."),
      choice_parameter("grid", names_of(kSpaces), "perspective",
                       "Cells are of one size on the screen, or in the world (Sec. 4.2)."),
      choice_parameter("blend", names_of(kBlendings), "tetrahedra",
                       "Four vertices around a point (Sec. 4.4), or all eight of its cell."),
      choice_parameter("hit_rule", names_of(kHitRules), "surface",
                       "Visibility around a vertex: naive; literal: forgives a sheet or two "
                       "boundaries anywhere (Sec. 4.3); local: within the cells; surface: from "
                       "points that the camera sees; the last two ours."),
      choice_parameter("surface_gather", names_of(kSurfaceUses), "finely_cut",
                       "finely_cut: triangles whose smallest patch is smaller than the grid's "
                       "cells are gathered by the vertices of their patches (Sec. 4.5)."),
  };
}

ParameterSpec vertex_visibility_parameter() {
  return choice_parameter("vertex_visibility", names_of(kVisibilities), "rays",
                          "What a vertex of a surface stores: visibility of the links (Scheel et "
                          "al. 2001), or that of rays; ours.");
}

std::vector<ParameterSpec> class_parameters() {
  return {
      integer_parameter("class_samples", 256, {1.0, 1e6}, "samples",
                        "N of Eq. 1 while senders are classified; not stated; ours."),
      integer_parameter("least_samples", 4, {2.0, 1e6}, "samples",
                        "Least number per sender while classifying; ours."),
      integer_parameter("significant_samples", 24, {2.0, 1e6}, "samples",
                        "Least number for senders whose light is visible by itself; ours."),
      choice_parameter("visibility_error", {"literal", "reflected"}, "reflected",
                       "Eq. 3 as it is, or times the reflectance as Eq. 2; ours."),
      choice_parameter("errors", {"each", "together"}, "together",
                       "What is interpolated must be invisible sender by sender (Sec. 4.3), or all "
                       "of it together: root of the sum of squares; ours."),
      boolean_parameter("resample_all", false, "Every sender at every point, whatever its error."),
  };
}

std::vector<ParameterSpec> perception_parameters() {
  return {
      boolean_parameter("masking", true,
                        "Thresholds are raised where the preview's contrasts mask (Sec. 5.2)."),
      choice_parameter("masked_by", names_of(kMaskings), "matched",
                       "Contrasts that hide an artefact: all together (Sec. 5.2), or those within "
                       "an octave of its frequency; ours."),
      choice_parameter("masking_pooling", names_of(kPoolings), "mean",
                       "Of the pixels around a vertex (Sec. 5.2.1); quartile: the lower one; "
                       "ours."),
      choice_parameter("threshold_profile", {"rama99", "rama99_calibrated", "yee_compat"},
                       "rama99_calibrated",
                       "Model of thresholds: that of Ramasubramanian et al. 1999, which the paper "
                       "takes; calibrated: TVI of a fifth, as patterns are seen; ours."),
      real_parameter("threshold_scale", 1.0, {0.0, 1e6}, "",
                     "Multiplies every threshold; 8 is a control that must be seen; ours."),
      choice_parameter("tone", names_of(kTones), "histogram",
                       "Tone curve of the preview; not stated: that of Ward Larson et al. 1997, "
                       "whose TVI the paper takes; ours."),
      real_parameter("ppd", 67.0, {1.0, 1000.0}, "pixels/degree", "Of the viewer; ours."),
      real_parameter("peak_cd_m2", 200.0, {1.0, 10000.0}, "cd/m2", "Of the display; ours."),
      boolean_parameter("penumbra_bound", true,
                        "No more shadow samples than the widest penumbra has pixels (Sec. 5.3)."),
      boolean_parameter("contrast_bound", true,
                        "No more shadow samples than visible steps of the sender's light (Sec. "
                        "5.3)."),
  };
}

/// Those of all gathers, then these groups.
std::vector<ParameterSpec> with_gather_parameters(
    std::initializer_list<std::vector<ParameterSpec>> groups) {
  std::vector<ParameterSpec> specs = gather_parameters();
  for (const std::vector<ParameterSpec>& group : groups) {
    specs.insert(specs.end(), group.begin(), group.end());
  }
  return specs;
}

base::Preset paper_preset() {
  using Value = base::ParameterValue;
  base::Preset paper{"paper", paper_gather_values()};
  paper.values.emplace_back("threshold_profile", Value(std::string("rama99")));
  paper.values.emplace_back("masked_by", Value(std::string("all")));
  paper.values.emplace_back("visibility_error", Value(std::string("literal")));
  paper.values.emplace_back("errors", Value(std::string("each")));
  paper.values.emplace_back("vertex_visibility", Value(std::string("links")));
  return paper;
}

/// What gathers by grid and by surface share.
SteeredSettings shared_settings_of(const base::Parameters& parameters) {
  const auto integer = [&](const char* name) { return static_cast<int>(parameters.integer(name)); };
  SteeredSettings settings;
  ClassSettings& classes = settings.classes;
  classes.class_samples = integer("class_samples");
  classes.least_samples = integer("least_samples");
  classes.significant_samples = integer("significant_samples");
  classes.gather_samples = integer("gather_samples");
  classes.containing_rays = integer("containing_rays");
  classes.has_reflectance = parameters.text("visibility_error") == "reflected";
  classes.judges_together = parameters.text("errors") == "together";
  classes.has_penumbra_bound = parameters.boolean("penumbra_bound");
  classes.has_contrast_bound = parameters.boolean("contrast_bound");
  classes.pooling = value_of(kPoolings, parameters.text("masking_pooling"));
  classes.resamples_all = parameters.boolean("resample_all");
  settings.vertex_visibility = value_of(kVisibilities, parameters.text("vertex_visibility"));
  settings.perception.tone = value_of(kTones, parameters.text("tone"));
  settings.perception.profile = parameters.text("threshold_profile");
  settings.perception.has_masking = parameters.boolean("masking");
  settings.perception.masked_by = value_of(kMaskings, parameters.text("masked_by"));
  settings.perception.threshold_scale = parameters.real("threshold_scale");
  settings.perception.pixels_per_degree = parameters.real("ppd");
  settings.perception.peak_cd_m2 = parameters.real("peak_cd_m2");
  return settings;
}

}  // namespace

std::vector<ParameterSpec> grid_parameters() {
  return with_gather_parameters({space_parameters(),
                                 {vertex_visibility_parameter()},
                                 class_parameters(),
                                 perception_parameters()});
}

std::vector<base::Preset> grid_presets() {
  base::Preset paper = paper_preset();
  paper.values.emplace_back("hit_rule", base::ParameterValue(std::string("literal")));
  return {std::move(paper), base::Preset{"best", {}}};
}

SteeredSettings grid_settings_of(const base::Parameters& parameters) {
  SteeredSettings settings = shared_settings_of(parameters);
  settings.grid.vertices = static_cast<int>(parameters.integer("grid_vertices"));
  settings.grid.spacing = value_of(kSpacings, parameters.text("depth"));
  settings.grid.space = value_of(kSpaces, parameters.text("grid"));
  settings.grid.blending = value_of(kBlendings, parameters.text("blend"));
  settings.hit_rule = value_of(kHitRules, parameters.text("hit_rule"));
  settings.surface = value_of(kSurfaceUses, parameters.text("surface_gather"));
  return settings;
}

std::vector<ParameterSpec> surface_parameters() {
  return with_gather_parameters(
      {{choice_parameter("decided_for", names_of(kDecisions), "vertices",
                         "Senders are classified for the patches' vertices and interpolated, or "
                         "for each patch, with seams between patches (Sec. 2)."),
        vertex_visibility_parameter()},
       class_parameters(),
       perception_parameters()});
}

std::vector<base::Preset> surface_presets() { return {paper_preset(), base::Preset{"best", {}}}; }

SteeredSettings surface_settings_of(const base::Parameters& parameters) {
  SteeredSettings settings = shared_settings_of(parameters);
  settings.surface = SurfaceUse::always;
  settings.decided_for = value_of(kDecisions, parameters.text("decided_for"));
  return settings;
}

}  // namespace renderers::final_gather
