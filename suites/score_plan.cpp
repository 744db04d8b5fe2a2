#include "suites/score_plan.h"

#include <algorithm>

#include "metrics/sequence_score.h"
#include "perception/base/hash.h"
#include "suites/score_images.h"

namespace suites {

ScorePlan::ScorePlan(const ScoringInput& input) : input_(input) {
  for (const SuiteMetric& metric : input.suite.metrics) {
    MetricFacts facts;
    facts.history = frames_needed(metric.choice) - 1;
    facts.mask_hash = mask_file_hash(metric);
    if (const auto* of_image = std::get_if<metrics::MetricChoice>(&metric.choice)) {
      facts.follows_reference = metrics::SharedChoice(*of_image).follows_reference();
    }
    facts_.push_back(facts);
  }
  for (const PlannedReference& reference : input.plan.references) {
    const ReferenceKey key = reference_key(reference);
    hashes_.push_back(key.hash());
    pixel_hashes_.push_back(input.references.pixel_hash_of(key));
  }
  for (const results::MetricRecord& record : input.known) {
    known_[{record.cell, record.frame, record.against, record.metric}] = &record;
  }
}

std::vector<ReferencePart> ScorePlan::truths(std::size_t cell, const std::string& against) const {
  const PlannedCell& planned = input_.plan.cells[cell];
  std::vector<ReferencePart> truths;
  for (const PlannedFrame& frame : planned.frames) {
    truths.push_back(
        against == "own"
            ? ReferencePart{own_reference(input_.plan, planned, frame), frame.claims.part}
            : ReferencePart{full_reference(input_.plan, planned, frame), renderers::Part::all});
  }
  return truths;
}

bool ScorePlan::has_images(std::size_t cell, std::size_t first, std::size_t last) const {
  for (std::size_t i = first; i <= last; ++i) {
    const int frame = input_.plan.cells[cell].frames[i].frame;
    if (input_.progress[cell].image(frame).empty()) return false;
  }
  return true;
}

std::string ScorePlan::hash_of_history(std::size_t cell, std::size_t first, std::size_t end,
                                       const std::vector<ReferencePart>& truths) const {
  base::Hasher hasher;
  for (std::size_t i = first; i < end; ++i) {
    const int number = input_.plan.cells[cell].frames[i].frame;
    hasher.add(input_.progress[cell].pixel_hash(number));
    hasher.add(hashes_[truths[i].reference]);
    hasher.add(pixel_hashes_[truths[i].reference]);
  }
  return hasher.finish().hex();
}

std::string ScorePlan::hash_of_all(const std::vector<ReferencePart>& truths) const {
  base::Hasher hasher;
  for (const ReferencePart& truth : truths) {
    hasher.add(pixel_hashes_[truth.reference]);
    hasher.add(to_string(truth.part));
  }
  return hasher.finish().hex();
}

ScorePlan::FrameTruths ScorePlan::frame_truths(std::size_t cell, const std::string& against) const {
  FrameTruths all{truths(cell, against), ""};
  if (all.parts.size() > 1) all.hash = hash_of_all(all.parts);
  return all;
}

bool ScorePlan::is_known(std::size_t cell, const WantedScore& wanted,
                         const std::string& viewing_hash) const {
  const int frame = input_.plan.cells[cell].frames[wanted.frame].frame;
  const auto found =
      known_.find({input_.plan.cells[cell].name, frame, wanted.against, text_of(*wanted.metric)});
  if (found == known_.end()) return false;
  const results::MetricRecord& record = *found->second;
  return record.image_hash == input_.progress[cell].pixel_hash(frame) &&
         record.reference_hash == hashes_[wanted.truth.reference] &&
         record.reference_pixel_hash == pixel_hashes_[wanted.truth.reference] &&
         record.context_hash == wanted.context_hash &&
         record.version == description_of(wanted.metric->choice).version &&
         record.image == wanted.metric->image_text() && record.mask == wanted.metric->mask.text() &&
         record.mask_hash == wanted.mask_hash && record.viewing_hash == viewing_hash;
}

std::vector<WantedScore> ScorePlan::wanted(std::size_t cell) const {
  const PlannedCell& planned = input_.plan.cells[cell];
  std::vector<WantedScore> of_images;
  std::vector<WantedScore> of_sequences;
  // Without metrics or images the plan need not have the references.
  if (facts_.empty() || !input_.progress[cell].has_images()) return of_images;
  const std::string viewing_hash =
      hash_of(viewing_of(input_.suite, *planned.frames.front().state)).hex();
  const std::map<std::string, FrameTruths> truths{{"own", frame_truths(cell, "own")},
                                                  {"full", frame_truths(cell, "full")}};
  for (std::size_t frame = 0; frame < planned.frames.size(); ++frame) {
    for (std::size_t metric = 0; metric < facts_.size(); ++metric) {
      const MetricFacts& facts = facts_[metric];
      const SuiteMetric& choice = input_.suite.metrics[metric];
      if (!is_wanted(choice, *planned.scene, *planned.method)) continue;
      if (frame < facts.history || !has_images(cell, frame - facts.history, frame)) continue;
      for (const std::string& against : choice.against) {
        const FrameTruths& of_frames = truths.at(against);
        WantedScore one{frame, &choice, against, of_frames.parts[frame], "", facts.mask_hash};
        if (facts.follows_reference) one.context_hash = of_frames.hash;
        if (facts.history > 0) {
          one.context_hash = hash_of_history(cell, frame - facts.history, frame, of_frames.parts);
        }
        if (is_known(cell, one, viewing_hash)) continue;
        (facts.history == 0 ? of_images : of_sequences).push_back(one);
      }
    }
  }
  of_images.insert(of_images.end(), of_sequences.begin(), of_sequences.end());
  return of_images;
}

}  // namespace suites
