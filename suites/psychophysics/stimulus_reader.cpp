#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "perception/base/names.h"
#include "perception/base/units.h"
#include "suites/psychophysics/readers.h"
#include "suites/safe_name.h"

namespace suites::psychophysics {
namespace {

using perception::EdgeInNoise;
using perception::GaborPatch;
using perception::NoiseKind;
using perception::Stimulus;
using perception::StimulusPair;

constexpr double kLargest = std::numeric_limits<double>::max();
constexpr double kTiny = 1e-9;

double db_of(double contrast) { return 20.0 * std::log10(contrast); }

/// "2.5%" or 0.025. @param least, most  accepted contrasts
double read_contrast(const base::Node& node, const char* what, double least, double most) {
  if (node.is_number()) return bounded_number(node, what, least, most);
  const double value = base::parse_percent(node.scalar_text(what), node.place());
  if (value >= least && value <= most) return value;
  throw base::InputError(
      node.place(), fmt::format("{} is {}; accepted: {:g}% to {:g}%", what, node.scalar_text(what),
                                100.0 * least, 100.0 * most));
}

/// A number of the stimulus, else of the experiment.
double setting(base::MapReader& reader, const char* key, const std::optional<double>& fallback) {
  if (const base::Node* node = reader.find(key)) return bounded_number(*node, key, kTiny, kLargest);
  if (fallback) return *fallback;
  throw base::InputError(reader.node().place(),
                         fmt::format("{} is missing; it stands here or in the experiment", key));
}

struct ReadGabor {
  GaborPatch patch;
  double eccentricity_deg = 0.0;
};

ReadGabor read_gabor(const base::Node& node, const char* what) {
  base::MapReader reader(node, what);
  ReadGabor gabor;
  GaborPatch& patch = gabor.patch;
  patch.frequency_cpd =
      bounded_number(reader.require("frequency_cpd"), "frequency_cpd", kTiny, kLargest);
  const base::Node& sigma = reader.require("sigma_deg");
  if (sigma.is_list()) {
    const std::vector<double> sigmas = base::number_list(sigma, "sigma_deg", 2);
    patch.sigma_along_deg = sigmas[0];
    patch.sigma_across_deg = sigmas[1];
  } else {
    patch.sigma_along_deg = patch.sigma_across_deg = sigma.number("sigma_deg");
  }
  if (!(patch.sigma_along_deg > 0.0 && patch.sigma_across_deg > 0.0)) {
    throw base::InputError(sigma.place(),
                           "sigma_deg must be above 0; accepted: degrees, or two of "
                           "them, along and across the change");
  }
  patch.orientation_deg = reader.number("orientation_deg", 0.0);
  patch.phase_deg = reader.number("phase_deg", 0.0);
  if (const base::Node* eccentricity = reader.find("eccentricity_deg")) {
    gabor.eccentricity_deg = bounded_number(*eccentricity, "eccentricity_deg", 0.0, 90.0);
  }
  reader.finish();
  return gabor;
}

NoiseKind read_noise(const base::Node& node) {
  const std::vector<std::string> known{"none", "white", "pink", "brown", "narrow_band"};
  const std::string name = base::snake_case(node.text("noise"));
  const auto found = std::find(known.begin(), known.end(), name);
  if (found == known.end()) {
    throw base::InputError(node.place(), base::unknown_name("noise", node.text("noise"), known));
  }
  return static_cast<NoiseKind>(found - known.begin());
}

/// Builds a trial from its node, key by key.
class TrialReader {
 public:
  TrialReader(const base::Node& node, const StimulusDefaults& defaults, std::size_t number)
      : reader_(node, "stimulus"), defaults_(defaults) {
    trial_.facts.id = read_safe_name(reader_.require("id"), "id");
    trial_.facts.x = static_cast<double>(number);
    trial_.facts.series = reader_.text("series", "");
    read_half();
  }

  Trial take() {
    const std::string kind = only_key(reader_, {"modelfest", "gabor", "edge", "spot"});
    if (kind == "spot") {
      read_spot();
    } else {
      trial_.facts.mean_cd_m2 = setting(reader_, "mean_cd_m2", defaults_.mean_cd_m2);
      trial_.pixels_per_degree = setting(reader_, "ppd", defaults_.pixels_per_degree);
      if (kind == "edge") read_edge();
      if (kind == "modelfest") read_modelfest();
      if (kind == "gabor") read_patch();
    }
    trial_.facts.description = reader_.text("description", trial_.facts.description);
    read_observed();
    reader_.finish();
    return std::move(trial_);
  }

 private:
  void read_half() {
    const base::Node* node = reader_.find("half");
    if (node == nullptr) return;
    const std::string name = base::snake_case(node->text("half"));
    using results::psychophysics::Half;
    if (name == to_string(Half::calibration)) {
      trial_.facts.half = Half::calibration;
    } else if (name == to_string(Half::held_out)) {
      trial_.facts.half = Half::held_out;
    } else {
      throw base::InputError(
          node->place(),
          base::unknown_name("half", name, std::vector<std::string>{"calibration", "held_out"}));
    }
  }

  /// A disc on a field, both as luminances.
  void read_spot() {
    base::MapReader spot(reader_.require("spot"), "spot");
    const double log10_field = spot.require("log10_field").number("log10_field");
    const double diameter_deg =
        bounded_number(spot.require("diameter_deg"), "diameter_deg", kTiny, 90.0);
    spot.finish();
    log10_field_ = log10_field;
    trial_.is_spot = true;
    trial_.facts.mean_cd_m2 = std::pow(10.0, log10_field + defaults_.log10_unit_cd_m2);
    trial_.pixels_per_degree = setting(reader_, "ppd", defaults_.pixels_per_degree);
    trial_.facts.description = fmt::format("spot, {:g} deg wide, on a field of {:.3g} cd/m2",
                                           diameter_deg, trial_.facts.mean_cd_m2);
    const Stimulus disc =
        perception::disc_stimulus(diameter_deg, setting(reader_, "size_deg", defaults_.size_deg));
    trial_.range.largest = 1e6;
    set_x("field", trial_.facts.mean_cd_m2);
    trial_.pairs.push_back(
        [disc, mean = trial_.facts.mean_cd_m2, ppd = trial_.pixels_per_degree](double contrast) {
          // A step may be many times its field: full contrast, scaled.
          StimulusPair pair;
          pair.reference = perception::stimulus_image(disc, 0.0, mean, ppd);
          pair.test = perception::stimulus_image(disc, 1.0, mean, ppd);
          for (std::size_t i = 0; i < pair.test.pixels.size(); ++i) {
            const float step = pair.test.pixels[i] - pair.reference.pixels[i];
            pair.test.pixels[i] = pair.reference.pixels[i] + static_cast<float>(contrast) * step;
          }
          return pair;
        });
  }

  void read_edge() {
    base::MapReader reader(reader_.require("edge"), "edge");
    EdgeInNoise edge;
    edge.ramp_deg = bounded_number(reader.require("ramp_deg"), "ramp_deg", kTiny, 90.0);
    if (const base::Node* noise = reader.find("noise")) edge.noise = read_noise(*noise);
    edge.noise_centre_cpd = reader.number("noise_centre_cpd", edge.noise_centre_cpd);
    if (const base::Node* rms = reader.find("noise_rms")) {
      edge.noise_rms = bounded_number(*rms, "noise_rms", 0.0, 1.0);
    }
    reader.finish();
    edge.size_deg = setting(reader_, "size_deg", defaults_.size_deg);
    edge.mean_cd_m2 = trial_.facts.mean_cd_m2;
    edge.pixels_per_degree = trial_.pixels_per_degree;
    trial_.facts.description = fmt::format(
        "edge, ramp {:g} deg, in {} noise", edge.ramp_deg,
        edge.noise == NoiseKind::none ? "no"
                                      : reader_.node().find("edge")->find("noise")->text("noise"));
    if (edge.noise == NoiseKind::narrow_band) {
      trial_.facts.description += fmt::format(" at {:g} cpd", edge.noise_centre_cpd);
    }
    const int samples = edge.noise == NoiseKind::none ? 1 : defaults_.noise_samples;
    for (int seed = 1; seed <= samples; ++seed) {
      edge.seed = static_cast<std::uint64_t>(seed);
      trial_.pairs.emplace_back([edge](double contrast) mutable {
        edge.edge_rms = contrast;
        return perception::edge_in_noise(edge);
      });
    }
  }

  void read_modelfest() {
    const base::Node& number = reader_.require("modelfest");
    try {
      add_pattern(perception::modelfest_stimulus(static_cast<int>(number.integer("modelfest"))));
    } catch (const base::InputError& error) {
      throw base::InputError(number.place(), error.what());
    }
  }

  void read_patch() {
    const double size_deg = setting(reader_, "size_deg", defaults_.size_deg);
    const ReadGabor gabor = read_gabor(reader_.require("gabor"), "gabor");
    trial_.eccentricity_deg = gabor.eccentricity_deg;
    set_x("frequency", gabor.patch.frequency_cpd);
    const Stimulus target = perception::gabor_stimulus(gabor.patch, size_deg);
    const base::Node* pedestal = reader_.find("pedestal");
    const base::Node* masker = reader_.find("masker");
    if (pedestal != nullptr && masker != nullptr) {
      throw base::InputError(masker->place(), "a stimulus has a pedestal or a masker, not both");
    }
    if (pedestal != nullptr) {
      const double contrast = read_contrast(*pedestal, "pedestal", 0.0, 1.0);
      set_x("pedestal", 100.0 * contrast);
      add_masked(target, target, contrast);
    } else if (masker != nullptr) {
      base::MapReader reader(*masker, "masker");
      const double contrast = read_contrast(reader.require("contrast"), "contrast", 0.0, 1.0);
      const base::Node& patch = reader.require("gabor");
      reader.finish();
      set_x("mask", 100.0 * contrast);
      add_masked(target, perception::gabor_stimulus(read_gabor(patch, "gabor").patch, size_deg),
                 contrast);
    } else {
      add_pattern(target);
    }
  }

  /// A target on a plain field.
  void add_pattern(const Stimulus& target) {
    trial_.facts.description = target.description;
    trial_.plain = target;
    if (trial_.eccentricity_deg > 0.0) {
      trial_.facts.description += fmt::format(", {:g} deg off the fovea", trial_.eccentricity_deg);
      return;
    }
    trial_.pairs.push_back(
        [target, mean = trial_.facts.mean_cd_m2, ppd = trial_.pixels_per_degree](double contrast) {
          return StimulusPair{perception::stimulus_image(target, 0.0, mean, ppd),
                              perception::stimulus_image(target, contrast, mean, ppd)};
        });
  }

  void add_masked(const Stimulus& target, const Stimulus& masker, double masker_contrast) {
    if (masker_contrast == 0.0) {
      add_pattern(target);
      return;
    }
    trial_.facts.description = fmt::format("{} on {} of {:.3g} %", target.description,
                                           masker.description, 100.0 * masker_contrast);
    trial_.pairs.push_back(
        [=, mean = trial_.facts.mean_cd_m2, ppd = trial_.pixels_per_degree](double contrast) {
          return perception::masked_pair(target, contrast, masker, masker_contrast, mean, ppd);
        });
  }

  void set_x(const char* axis, double x) {
    if (defaults_.axis == axis) trial_.facts.x = x;
  }

  void read_observed() {
    base::MapReader observed(reader_.require("observed"), "observed");
    const std::string kind =
        only_key(observed, {"contrast", "db", "sensitivity", "elevation", "log10_step"});
    const base::Node& value = observed.require(kind);
    if (kind == "contrast")
      trial_.facts.observed_db = db_of(read_contrast(value, "contrast", kTiny, 1e6));
    if (kind == "db") trial_.facts.observed_db = value.number("db");
    if (kind == "sensitivity") {
      trial_.facts.observed_db = -db_of(bounded_number(value, "sensitivity", kTiny, kLargest));
    }
    if (kind == "elevation") {
      trial_.facts.observed_db = db_of(bounded_number(value, "elevation", kTiny, kLargest));
      trial_.facts.over = observed.required_text("over");
    }
    if (kind == "log10_step") {
      if (!trial_.is_spot) {
        throw base::InputError(value.place(),
                               "log10_step is for a spot; accepted here: contrast, "
                               "db, sensitivity, elevation");
      }
      trial_.facts.observed_db = 20.0 * (value.number("log10_step") - log10_field_);
    }
    if (const base::Node* sd = observed.find("sd_db")) {
      trial_.facts.sd_db = bounded_number(*sd, "sd_db", 0.0, 1000.0);
    }
    observed.finish();
  }

  base::MapReader reader_;
  const StimulusDefaults& defaults_;
  Trial trial_;
  double log10_field_ = 0.0;
};

}  // namespace

Trial read_trial(const base::Node& node, const StimulusDefaults& defaults, std::size_t number) {
  return TrialReader(node, defaults, number).take();
}

}  // namespace suites::psychophysics
