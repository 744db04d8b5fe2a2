#include "suites/scoring.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <span>
#include <tuple>

#include <fmt/format.h>

#include "perception/image_file.h"
#include "suites/planned_work.h"
#include "suites/suite_runner.h"

namespace suites {
namespace {

namespace fs = std::filesystem;

/// Seed of the noise that is laid over a reference for its noise floor.
constexpr std::uint64_t kNoiseSeed = 1;

/// A score to make: one metric of one frame of a cell against one reference.
struct Wanted {
  const PlannedFrame* frame = nullptr;
  const metrics::MetricChoice* metric = nullptr;
  std::string against;  ///< own | full
  std::size_t reference = 0;
  renderers::Part part = renderers::Part::all;
};

/// Text as part of a file name: "relmse,trim=0.001" -> "relmse-trim-0.001".
std::string file_name_of(const std::string& text) {
  std::string name;
  for (const char c : text) {
    const bool is_kept =
        (std::isalnum(static_cast<unsigned char>(c)) != 0) || c == '.' || c == '_' || c == '-';
    name += is_kept ? c : '-';
  }
  return name;
}

/// What every score of a scene shares.
struct SceneContext {
  perception::ViewingConditions viewing;
  std::string viewing_hash;
};

SceneContext context_of(const ScoringInput& input, const PlannedCell& cell) {
  SceneContext context;
  context.viewing = viewing_of(input.suite, *cell.frames.front().state);
  context.viewing_hash = hash_of(context.viewing).hex();
  return context;
}

/// The reference with noise of its own variance. One draw serves all channels of a pixel: paths
/// carry all of them, so their errors go up and down together.
perception::Image perturbed(const Reference& reference) {
  perception::Image image = reference.all;
  std::mt19937_64 random(kNoiseSeed);
  std::normal_distribution<double> normal;
  const std::size_t channels = image.channels.size();
  for (std::size_t pixel = 0; pixel < image.pixel_count(); ++pixel) {
    const double draw = normal(random);
    for (std::size_t i = pixel * channels; i < (pixel + 1) * channels; ++i) {
      const double sigma = std::sqrt(std::max(0.0F, reference.variance.pixels[i]));
      image.pixels[i] += static_cast<float>(sigma * draw);
    }
  }
  return image;
}

/// The stored image of a cell, with the proof that it is the one that was timed.
perception::Image timed_image(const fs::path& path, const std::string& pixel_hash) {
  perception::Image image = perception::rgb_of(perception::read_image(path));
  if (perception::pixel_hash(image) == pixel_hash) return image;
  throw base::InputError(path.string() +
                         ": is not the image that was timed; its pixels were changed since");
}

/// Scores cell by cell; keeps the references of the scene's state at hand.
class Scorer {
 public:
  explicit Scorer(const ScoringInput& input) : input_(input) {
    for (const PlannedReference& reference : input.plan.references) {
      const ReferenceKey key = reference_key(reference);
      hashes_.push_back(key.hash());
      pixel_hashes_.push_back(input.references.pixel_hash_of(key));
    }
    for (const results::MetricRecord& record : input.known) {
      known_[{record.cell, record.frame, record.against, record.metric}] = &record;
    }
  }

  /// The missing scores of a cell, those of one frame side by side.
  std::vector<Wanted> wanted(std::size_t index) const {
    const PlannedCell& cell = input_.plan.cells[index];
    std::vector<Wanted> all;
    const std::string viewing_hash = context_of(input_, cell).viewing_hash;
    for (const PlannedFrame& frame : cell.frames) {
      if (input_.progress[index].image(frame.frame).empty()) continue;
      const std::size_t own = own_reference(input_.plan, cell, frame);
      const std::size_t full = full_reference(input_.plan, cell, frame);
      for (const metrics::MetricChoice& metric : input_.suite.metrics) {
        const Wanted by_own{&frame, &metric, "own", own, frame.claims.part};
        const Wanted by_full{&frame, &metric, "full", full, renderers::Part::all};
        if (!is_known(index, by_own, viewing_hash)) all.push_back(by_own);
        if (!is_known(index, by_full, viewing_hash)) all.push_back(by_full);
      }
    }
    return all;
  }

  void score_cell(std::size_t index, results::RunFolder& folder, ProgressMeter& meter,
                  ScoringOutcome& outcome);

 private:
  void score_frame(std::size_t index, std::span<const Wanted> all, results::RunFolder& folder,
                   ProgressMeter& meter, ScoringOutcome& outcome);

  bool is_known(std::size_t index, const Wanted& wanted, const std::string& viewing_hash) const {
    const int frame = wanted.frame->frame;
    const auto found =
        known_.find({input_.plan.cells[index].name, frame, wanted.against, wanted.metric->text});
    if (found == known_.end()) return false;
    const results::MetricRecord& record = *found->second;
    return record.image_hash == input_.progress[index].pixel_hash(frame) &&
           record.reference_hash == hashes_[wanted.reference] &&
           record.reference_pixel_hash == pixel_hashes_[wanted.reference] &&
           record.version == wanted.metric->info->version && record.viewing_hash == viewing_hash;
  }
  /// The reference, loaded on first use; null if there is none.
  const Reference* reference(std::size_t index);
  std::optional<double> noise_floor(const Wanted& wanted, const Reference& reference,
                                    const SceneContext& context);
  results::MetricRecord scored(const PlannedCell& cell, const Wanted& wanted,
                               const perception::Image& image, const SceneContext& context,
                               results::RunFolder& folder);
  void keep_map(const metrics::Score& score, const PlannedCell& cell, const Wanted& wanted,
                results::RunFolder& folder, results::MetricRecord& record) const;

  const ScoringInput& input_;
  std::vector<std::string> hashes_;        ///< of the plan's references: what they are images of
  std::vector<std::string> pixel_hashes_;  ///< of their pixels now; "" if there is none
  /// By cell, frame, against, metric.
  std::map<std::tuple<std::string, int, std::string, std::string>, const results::MetricRecord*>
      known_;
  const renderers::scene::Scene* state_ = nullptr;  ///< whose references are loaded
  std::map<std::size_t, std::optional<Reference>> references_;
  std::map<std::pair<std::size_t, std::string>, std::optional<double>> noise_floors_;
};

const Reference* Scorer::reference(std::size_t index) {
  const auto found = references_.find(index);
  if (found != references_.end()) return found->second ? &*found->second : nullptr;
  const ReferenceKey key = reference_key(input_.plan.references[index]);
  auto& loaded = references_[index];
  // A reference on its way, with fewer samples than the suite asks for, is not the truth yet.
  if (input_.references.contains(key)) loaded = input_.references.load(key);
  return loaded ? &*loaded : nullptr;
}

std::optional<double> Scorer::noise_floor(const Wanted& wanted, const Reference& reference,
                                          const SceneContext& context) {
  // The variance is that of the whole image; of a part it is not known.
  if (wanted.part != renderers::Part::all || reference.variance.is_empty()) return std::nullopt;
  const auto key = std::make_pair(wanted.reference, wanted.metric->text);
  const auto found = noise_floors_.find(key);
  if (found != noise_floors_.end()) return found->second;
  const perception::Image noisy = perturbed(reference);
  const metrics::Score score =
      metrics::score(*wanted.metric, {reference.all, noisy}, context.viewing, {false, false});
  std::optional<double> value;
  if (std::isfinite(score.value)) value = score.value;
  noise_floors_[key] = value;
  return value;
}

void Scorer::keep_map(const metrics::Score& score, const PlannedCell& cell, const Wanted& wanted,
                      results::RunFolder& folder, results::MetricRecord& record) const {
  const bool is_first_frame = wanted.frame == &cell.frames.front();
  if (!score.map || cell.seed != 1 || !is_first_frame) return;
  const fs::path name = fs::path("maps") / cell.name /
                        fmt::format("{}.{}.exr", file_name_of(wanted.metric->text), wanted.against);
  fs::create_directories((folder.path() / name).parent_path());
  perception::ImageFile file;
  file.parts.push_back({"map", *score.map});
  file.attributes.text["discern:metric"] = wanted.metric->text;
  file.attributes.text["discern:against"] = wanted.against;
  file.attributes.text["discern:reference"] = hashes_[wanted.reference];
  file.attributes.text["discern:map_unit"] = wanted.metric->info->map_unit;
  perception::write_exr(folder.path() / name, file);
  record.map = name.string();
}

results::MetricRecord Scorer::scored(const PlannedCell& cell, const Wanted& wanted,
                                     const perception::Image& image, const SceneContext& context,
                                     results::RunFolder& folder) {
  const Reference* truth = reference(wanted.reference);
  if (truth == nullptr) throw base::InputError("there is no reference with enough samples");
  const perception::Image& part = truth->image(wanted.part);
  if (part.is_empty()) {
    throw base::InputError("the reference's renderer keeps no indirect part");
  }
  const bool has_variance = wanted.part == renderers::Part::all && !truth->variance.is_empty();
  const metrics::Score score =
      metrics::score(*wanted.metric, {part, image, has_variance ? &truth->variance : nullptr},
                     context.viewing, {false, cell.seed == 1});
  results::MetricRecord record;
  record.cell = cell.name;
  record.frame = wanted.frame->frame;
  record.against = wanted.against;
  record.reference_hash = truth->hash;
  record.reference_pixel_hash = pixel_hashes_[wanted.reference];
  record.metric = wanted.metric->text;
  record.parameters = wanted.metric->parameters.entries();
  record.version = wanted.metric->info->version;
  record.viewing_hash = context.viewing_hash;
  if (std::isfinite(score.value)) record.value = score.value;
  record.is_infinite = std::isinf(score.value) && score.value > 0.0;
  for (const metrics::NamedValue& detail : score.details) {
    record.details.emplace_back(detail.name, detail.value);
  }
  record.noise_floor = noise_floor(wanted, *truth, context);
  keep_map(score, cell, wanted, folder, record);
  return record;
}

void Scorer::score_cell(std::size_t index, results::RunFolder& folder, ProgressMeter& meter,
                        ScoringOutcome& outcome) {
  const std::vector<Wanted> all = wanted(index);
  for (std::size_t begin = 0; begin < all.size();) {
    const auto is_other_frame = [&](const Wanted& one) { return one.frame != all[begin].frame; };
    const auto first = all.begin() + static_cast<std::ptrdiff_t>(begin);
    const auto end = std::find_if(first, all.end(), is_other_frame);
    score_frame(index, std::span(first, end), folder, meter, outcome);
    begin = static_cast<std::size_t>(end - all.begin());
  }
}

void Scorer::score_frame(std::size_t index, std::span<const Wanted> all, results::RunFolder& folder,
                         ProgressMeter& meter, ScoringOutcome& outcome) {
  const PlannedCell& cell = input_.plan.cells[index];
  const PlannedFrame& frame = *all.front().frame;
  const std::string frame_name =
      cell.scene->frames.is_sequence ? fmt::format("frame {} ", frame.frame) : std::string();
  if (frame.state != state_) {
    references_.clear();
    state_ = frame.state;
  }
  const SceneContext context = context_of(input_, cell);
  const std::string& pixel_hash = input_.progress[index].pixel_hash(frame.frame);
  perception::Image image;
  try {
    image = timed_image(folder.path() / input_.progress[index].image(frame.frame), pixel_hash);
  } catch (const base::InputError& error) {
    outcome.failures.push_back(fmt::format("{}: {}", cell.name, error.what()));
    for (std::size_t i = 0; i < all.size(); ++i) meter.finish_step();
    return;
  }
  // A method that claims full transport has one reference: scored once, recorded twice.
  std::map<std::tuple<std::string, std::size_t, renderers::Part>, results::MetricRecord> done;
  for (const Wanted& one : all) {
    if (interrupt_requested) throw Interrupted();
    meter.begin_step(fmt::format("score {} {} {}{}", cell.scene->id, cell.method->id, frame_name,
                                 one.metric->text),
                     work_of_score(cell));
    try {
      const auto key = std::make_tuple(one.metric->text, one.reference, one.part);
      auto found = done.find(key);
      if (found == done.end()) {
        found = done.emplace(key, scored(cell, one, image, context, folder)).first;
      }
      results::MetricRecord record = found->second;
      record.against = one.against;
      record.image_hash = pixel_hash;
      folder.append(record);
      ++outcome.scores;
    } catch (const base::InputError& error) {
      outcome.failures.push_back(fmt::format("{} {}{} {}: {}", cell.name, frame_name,
                                             one.metric->text, one.against, error.what()));
    }
    meter.finish_step();
  }
}

}  // namespace

perception::ViewingConditions viewing_of(const Suite& suite, const renderers::scene::Scene& scene) {
  perception::ViewingConditions viewing = suite.viewing;
  if (suite.exposure_from_scene) viewing.exposure_ev = 0.0;
  if (viewing.luminance_scale_origin == "suite") return viewing;
  viewing.luminance_scale_cd_m2 = scene.luminance_scale_cd_m2;
  viewing.luminance_scale_origin = "scene";
  return viewing;
}

std::size_t missing_scores(const ScoringInput& input) {
  const Scorer scorer(input);
  std::size_t count = 0;
  for (const std::size_t index : input.cells) count += scorer.wanted(index).size();
  return count;
}

ScoringOutcome score_cells(const ScoringInput& input, results::RunFolder& folder,
                           ProgressMeter& meter) {
  Scorer scorer(input);
  ScoringOutcome outcome;
  for (const std::size_t index : input.cells) scorer.score_cell(index, folder, meter, outcome);
  return outcome;
}

}  // namespace suites
