#pragma once

#include <string>

#include "perception/base/document.h"
#include "suites/psychophysics/psychophysics_suite.h"

namespace tests {

/// Two patches, one on a pedestal, one spot; four kinds of models.
inline const std::string kSmallSuite = R"(schema: 1
suite: small
kind: psychophysics
summary: Two patches and a spot.
experiments:
  - id: patches
    source: tests
    mean_cd_m2: 30
    ppd: 30
    size_deg: 2
    axis: pedestal
    stimuli:
      - {id: plain, gabor: {frequency_cpd: 4, sigma_deg: 0.3}, pedestal: 0, observed: {db: -40, sd_db: 3}}
      - {id: masked, gabor: {frequency_cpd: 4, sigma_deg: 0.3}, pedestal: 10%, observed: {contrast: 2%}}
    phenomena:
      - {id: masking, says: "a pedestal masks", stimuli: [plain, masked], lower: {by_db: 1}}
  - id: spots
    source: tests
    ppd: 8
    size_deg: 6
    axis: field
    stimuli:
      - {id: spot, spot: {diameter_deg: 3, log10_field: 2}, observed: {log10_step: 0.745}}
models:
  - {id: csf, csf: castle-achromatic}
  - {id: filter, pattern: castle-achromatic}
  - {id: tvi, tvi: ward}
  - {id: metric, metric: visible-difference, reads: jnd_max, matrix: {csf_gain: [0.5, 1]}}
)";

inline suites::psychophysics::PsychophysicsSuite parsed(const std::string& text) {
  return suites::psychophysics::parse_psychophysics_suite(base::parse_document(text, "small.yaml"),
                                                          "small.yaml");
}

/// The small suite with the first occurrence of a text replaced.
inline std::string small_suite_with(const std::string& old_text, const std::string& new_text) {
  std::string text = kSmallSuite;
  return text.replace(text.find(old_text), old_text.size(), new_text);
}

}  // namespace tests
