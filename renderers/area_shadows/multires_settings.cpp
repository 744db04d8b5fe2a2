#include "renderers/area_shadows/multires_settings.h"

#include <array>
#include <iterator>
#include <string>
#include <utility>

#include "renderers/area_shadows/screen_shadows_renderer.h"
#include "renderers/contract/choice_names.h"

namespace renderers::area_shadows {

namespace {

using base::boolean_parameter;
using base::choice_parameter;
using base::integer_parameter;
using base::ParameterSpec;
using base::real_parameter;

template <typename Value, std::size_t count>
using Names = std::array<std::pair<const char*, Value>, count>;

constexpr Names<DepthMeasure, 2> kDepthMeasures{
    {{"plane", DepthMeasure::plane}, {"range", DepthMeasure::range}}};
constexpr Names<NormalMeasure, 2> kNormalMeasures{
    {{"cone", NormalMeasure::cone}, {"range", NormalMeasure::range}}};
constexpr Names<TestPoints, 2> kTestPoints{
    {{"same", TestPoints::same}, {"rotated", TestPoints::rotated}}};
constexpr Names<IrradianceEstimate, 2> kEstimates{
    {{"ratio", IrradianceEstimate::ratio}, {"sum", IrradianceEstimate::sum}}};
constexpr Names<Upsampling, 3> kUpsamplings{{{"rbf", Upsampling::rbf},
                                             {"multi_pass", Upsampling::multi_pass},
                                             {"nearest", Upsampling::nearest}}};
constexpr Names<RbfForm, 3> kForms{
    {{"normalised", RbfForm::normalised}, {"planar", RbfForm::planar}, {"raw", RbfForm::raw}}};
constexpr Names<RbfChoice, 2> kChoices{
    {{"sectors", RbfChoice::sectors}, {"nearest", RbfChoice::nearest}}};

std::vector<ParameterSpec> refinement_parameters() {
  return {
      backend_parameter(),
      integer_parameter("coarsest_level", 5, {0.0, 8.0}, "",
                        "Fragments begin with 2^coarsest_level pixels; ours, the paper's figure "
                        "shows 16."),
      integer_parameter(
          "rays_per_quadrant", 16, {4.0, 64.0}, "rays",
          "Points of a light that each quadrant tests, a power of two; a pixel is lit "
          "by four times as many. Sec. 3.1.2: 16."),
      choice_parameter("test_points", names_of(kTestPoints), "rotated",
                       "same: all quadrants test the same points, and differing bits count; "
                       "rotated: each others, and numbers of bits count; the paper does not say."),
      integer_parameter("bit_threshold", 4, {0.0, 64.0}, "bits",
                        "So many differing bits split a fragment; Sec. 3.1.2: 1. Numbers of bits "
                        "of rotated points differ by 1 to 2 without a cause; the default is ours."),
      integer_parameter("bits_per_level", 1, {0.0, 64.0}, "bits",
                        "So many fewer split a fragment for each level above 1, but no fewer than "
                        "2 by that: pixels between its quadrants are not tested; ours."),
      boolean_parameter("ring", true,
                        "Compare quadrants also with those around the fragment, without further "
                        "rays: an edge between two fragments shows in neither; ours."),
      boolean_parameter("gass", true,
                        "Quadrants with a steep difference of lit points are cut twice at once, "
                        "Sec. 3.1.3."),
      real_parameter("gass_threshold", 4.0, {0.0, 16.0}, "of 16 points",
                     "What is steep; Sec. 3.1.3: above 4."),
      boolean_parameter("extra_samples", true,
                        "Three pixels of each fragment above level 2 are lit as well, Sec. 3.1.4."),
      integer_parameter("free_level", 1, {0.0, 8.0}, "",
                        "Fragments up to this level are not split for their geometry: at level 1 "
                        "all pixels have been tested; ours, for visibility; the paper's is 0."),
      boolean_parameter("extra_tests", true,
                        "Extra samples are tested before a fragment is final, and split it if they "
                        "differ from its quadrants; ours."),
      boolean_parameter("reuse", true,
                        "Irradiance by the bits of the tests, Sec. 3.1.2; false: their rays are "
                        "cast once more."),
      boolean_parameter("audit", false,
                        "After the picture, and outside of its times and rays: light every pixel "
                        "and count what fragments and interpolation missed; ours."),
      choice_parameter("estimate", names_of(kEstimates), "ratio",
                       "Irradiance of coarse fragments: sum: by their visible points; ratio: "
                       "unoccluded irradiance by all points times the share not in shadow, ours."),
  };
}

std::vector<ParameterSpec> upsampling_parameters() {
  return {
      choice_parameter("upsampling", names_of(kUpsamplings), "rbf",
                       "rbf: in one pass by radial basis functions, Sec. 3.1.5; multi_pass: level "
                       "by level as Nichols et al. do; nearest: each pixel its fragment's value."),
      choice_parameter("upsampled", {"visibility", "irradiance"}, "visibility",
                       "irradiance, as in the paper; visibility: its share of the unoccluded one, "
                       "which each pixel finds for itself without rays; ours."),
      choice_parameter("rbf_form", names_of(kForms), "planar",
                       "raw: Eqs. 1 and 2, which do not reproduce a constant; normalised: divided "
                       "by what a constant comes out as; planar: the same for what differs from a "
                       "plane; ours."),
      choice_parameter("rbf_choice", names_of(kChoices), "nearest",
                       "Samples of a pixel: nearest: the nearest ones (Fig. 5); sectors: the "
                       "nearest in each sector around it; ours."),
      integer_parameter("rbf_bases", 6, {3.0, static_cast<double>(kMostBases)}, "samples",
                        "Basis functions of a pixel; Sec. 3.1.5: 3; the default is ours."),
      real_parameter("rbf_spread", 2.0, {0.1, 100.0}, "",
                     "C of Eq. 2b, in squares of a fragment's width; the paper's is 2."),
      integer_parameter("copied_level", 0, {-1.0, 8.0}, "",
                        "Fragments up to this level give all their pixels their value; Sec. 3.1.5: "
                        "2; the default is ours."),
  };
}

}  // namespace

std::vector<ParameterSpec> discontinuity_parameters() {
  return {
      choice_parameter("depth_measure", names_of(kDepthMeasures), "plane",
                       "plane: how far 3 x 3 pixels are off the middle one's plane, by its depth, "
                       "ours; range: by how much their depths differ, by its depth."),
      real_parameter("depth_threshold", 0.005, {0.0, 1e6}, "",
                     "Splits a block; under range three times as much by level; ours."),
      choice_parameter("normal_measure", names_of(kNormalMeasures), "cone",
                       "cone: 1 - cosine between the normals of a block that are furthest apart, "
                       "ours; range: difference of their coordinates right or up."),
      real_parameter("normal_threshold", 0.1, {0.0, 1e6}, "", "Splits a block; ours."),
  };
}

DiscontinuitySettings discontinuity_settings(const base::Parameters& parameters) {
  DiscontinuitySettings settings;
  settings.depth = value_of(kDepthMeasures, parameters.text("depth_measure"));
  settings.depth_threshold = static_cast<float>(parameters.real("depth_threshold"));
  settings.normal = value_of(kNormalMeasures, parameters.text("normal_measure"));
  settings.normal_threshold = static_cast<float>(parameters.real("normal_threshold"));
  return settings;
}

std::vector<ParameterSpec> multires_parameters() {
  std::vector<ParameterSpec> specs;
  for (auto group :
       {refinement_parameters(), discontinuity_parameters(), upsampling_parameters()}) {
    specs.insert(specs.end(), std::make_move_iterator(group.begin()),
                 std::make_move_iterator(group.end()));
  }
  return specs;
}

std::vector<base::Preset> multires_presets() {
  using Value = base::ParameterValue;
  // Sec. 3.1.1: discontinuities as Nichols et al. find them; Sec. 3.1.2: no look at neighbours,
  // bits give the irradiance; Sec. 3.1.5: raw functions around the nearest samples.
  base::Preset paper{"paper",
                     {{"depth_measure", Value(std::string("range"))},
                      {"depth_threshold", Value(0.1)},
                      {"normal_measure", Value(std::string("range"))},
                      {"normal_threshold", Value(0.2)},
                      {"test_points", Value(std::string("same"))},
                      {"bit_threshold", Value(std::int64_t{1})},
                      {"bits_per_level", Value(std::int64_t{0})},
                      {"ring", Value(false)},
                      {"extra_tests", Value(false)},
                      {"free_level", Value(std::int64_t{0})},
                      {"estimate", Value(std::string("sum"))},
                      {"upsampled", Value(std::string("irradiance"))},
                      {"rbf_form", Value(std::string("raw"))},
                      {"rbf_bases", Value(std::int64_t{3})},
                      {"copied_level", Value(std::int64_t{2})}}};
  return {std::move(paper), base::Preset{"best", {}}};
}

MultiresSettings multires_settings(const base::Parameters& parameters) {
  const auto integer = [&](const char* name) { return static_cast<int>(parameters.integer(name)); };
  MultiresSettings settings;
  settings.discontinuities = discontinuity_settings(parameters);
  settings.rays_per_quadrant = integer("rays_per_quadrant");
  check_power_of_two("multires-shadows", "rays_per_quadrant", settings.rays_per_quadrant);
  settings.reuses_bits = parameters.boolean("reuse");
  settings.has_audit = parameters.boolean("audit");
  RefinementSettings& refinement = settings.refinement;
  refinement.coarsest_level = integer("coarsest_level");
  refinement.test_points = value_of(kTestPoints, parameters.text("test_points"));
  refinement.bit_threshold = integer("bit_threshold");
  refinement.bits_per_level = integer("bits_per_level");
  refinement.has_ring = parameters.boolean("ring");
  refinement.free_level = integer("free_level");
  settings.upsamples_visibility = parameters.text("upsampled") == "visibility";
  refinement.compares_facing = settings.upsamples_visibility;
  const bool has_extra_tests =
      parameters.boolean("extra_samples") && parameters.boolean("extra_tests");
  refinement.extra_from_level = has_extra_tests ? settings.light.extra_from_level : -1;
  refinement.gradient_threshold =
      parameters.boolean("gass") ? static_cast<float>(parameters.real("gass_threshold")) / 16.0F
                                 : -1.0F;
  settings.light.estimate = value_of(kEstimates, parameters.text("estimate"));
  settings.light.has_rotated_points = refinement.test_points == TestPoints::rotated;
  settings.light.has_extra_samples = parameters.boolean("extra_samples");
  settings.upsampling = value_of(kUpsamplings, parameters.text("upsampling"));
  settings.rbf.rbf.form = value_of(kForms, parameters.text("rbf_form"));
  settings.rbf.rbf.choice = value_of(kChoices, parameters.text("rbf_choice"));
  settings.rbf.rbf.bases = static_cast<std::size_t>(integer("rbf_bases"));
  settings.rbf.rbf.spread = static_cast<float>(parameters.real("rbf_spread"));
  settings.rbf.copied_level = integer("copied_level");
  return settings;
}

}  // namespace renderers::area_shadows
