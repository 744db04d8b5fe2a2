#include "renderers/clustered_visibility/filter_settings.h"

#include <array>
#include <utility>

#include "renderers/contract/choice_names.h"

namespace renderers::clustered_visibility {

namespace {

using base::boolean_parameter;
using base::choice_parameter;
using base::integer_parameter;
using base::real_parameter;

constexpr std::array kPrefilters{std::pair{"mip", Prefilter::mip},
                                 std::pair{"sat", Prefilter::sat}};
constexpr std::array kFormats{std::pair{"8", BasisFormat::bits_8},
                              std::pair{"16", BasisFormat::bits_16},
                              std::pair{"32", BasisFormat::bits_32}};
constexpr std::array kFixes{std::pair{"scale", LitFix::scale}, std::pair{"offset", LitFix::offset}};
constexpr std::array kKernels{std::pair{"paper", KernelWidth::paper},
                              std::pair{"conformal", KernelWidth::conformal}};
constexpr std::array kBlockers{std::pair{"raw", BlockerDepth::raw},
                               std::pair{"corrected", BlockerDepth::corrected}};

}  // namespace

std::vector<base::ParameterSpec> filter_parameters() {
  return {
      integer_parameter("terms", 8, {1.0, double{kMostTerms}}, "terms",
                        "Of the series of the depth comparison, a sine and a cosine each; Dong et "
                        "al. 2009, Sec. 6: 4."),
      choice_parameter("basis_bits", names_of(kFormats), "16",
                       "Bits of a stored sine or cosine; Dong et al. 2009, Sec. 6: 8."),
      choice_parameter("prefilter", names_of(kPrefilters), "mip",
                       "mip: trilinear in levels (Dong et al. 2009, Sec. 6); sat: summed-area "
                       "tables."),
      real_parameter("damping", 0.5, {0.0, 10.0}, "",
                     "a of exp(-a (k / K)^2), against ringing; ours."),
      choice_parameter("lit_fix", names_of(kFixes), "offset",
                       "What makes a receiver at a blocker's depth lit: scale doubles the series, "
                       "offset takes it at its first maximum (both: Annen et al. 2007, "
                       "recalled)."),
      choice_parameter("kernel", names_of(kKernels), "conformal",
                       "Width of an angle in the map. paper: alpha / pi (Dong et al. 2009, Sec. "
                       "4.2); conformal: that of the projection at the receiver; ours."),
      choice_parameter("blocker_depth", names_of(kBlockers), "corrected",
                       "Mean depth of blockers. raw: as printed; corrected: without the share of "
                       "what is not before the receiver; ours."),
      real_parameter("search_scale", 1.0, {0.01, 100.0}, "",
                     "Of the angle in which blockers are looked for; ours."),
      real_parameter("finer_levels", 1.0, {0.0, 4.0}, "levels",
                     "With mip, the level taken is so much finer than the one whose texels are as "
                     "wide as the kernel; 0.5 has the kernel's variance; ours, measured."),
      real_parameter("slope_bias", 0.25, {0.0, 10.0}, "",
                     "With cssm, compared depths are less by this share of what the receiver's "
                     "plane rises within half a kernel, against shadows of slanted receivers on "
                     "themselves; 0: none; ours."),
      boolean_parameter("foreshorten", false,
                        "The light's size shrinks with its cosine to the receiver; ours."),
      real_parameter("contact_strength", 0.0, {0.0, 1000.0}, "",
                     "A of visibility^(1 + A exp(-B gap)), darker contacts; 0: off; ours."),
      real_parameter("contact_range", 10.0, {0.0, 1000.0}, "",
                     "B of the same, per depth of the scene; ours."),
      integer_parameter("moment_taps", 1, {1.0, 4.0}, "lookups",
                        "With msm, along each side of a kernel's box: with 2, and "
                        "moment_finer_levels 0.8, the penumbra of a lone light is 0.87 as wide as "
                        "it should be, not half, for 2.4 times the gather; among many lights no "
                        "gain; ours."),
      real_parameter("moment_finer_levels", 1.25, {0.0, 4.0}, "levels",
                     "With msm, the same as finer_levels; ours, measured: wider kernels have the "
                     "penumbra of a lone light, narrower ones leak less among many."),
      real_parameter("moment_slope", 1.3, {0.0, 10.0}, "",
                     "With msm, depths before a receiver that are within this share of what its "
                     "plane rises within half a kernel count as its own; ours."),
      real_parameter("moment_bias", 3e-7, {0.0, 0.1}, "",
                     "With msm, share of the moments of an even spread that is mixed in, against "
                     "rounding; ours."),
      real_parameter("blocked_bias", 0.01, {0.0, 1.0}, "",
                     "With msm, share of blockers that are taken to lie at the receiver; ours."),
  };
}

void read_filter_settings(const base::Parameters& parameters, AreaVisibilitySettings& area,
                          ConvolutionSettings& convolution) {
  const auto real = [&](const char* name) { return static_cast<float>(parameters.real(name)); };
  convolution.terms = static_cast<int>(parameters.integer("terms"));
  convolution.format = value_of(kFormats, parameters.text("basis_bits"));
  convolution.prefilter = value_of(kPrefilters, parameters.text("prefilter"));
  area.fix = value_of(kFixes, parameters.text("lit_fix"));
  area.kernel = value_of(kKernels, parameters.text("kernel"));
  area.blocker = value_of(kBlockers, parameters.text("blocker_depth"));
  area.damping = real("damping");
  area.search_scale = real("search_scale");
  area.finer_levels = real("finer_levels");
  area.slope_bias = real("slope_bias");
  area.is_foreshortened = parameters.boolean("foreshorten");
  area.contact_strength = real("contact_strength");
  area.contact_range = real("contact_range");
  area.moments = {static_cast<int>(parameters.integer("moment_taps")), real("moment_finer_levels"),
                  real("moment_slope"), real("moment_bias"), real("blocked_bias")};
}

}  // namespace renderers::clustered_visibility
