#pragma once

#include <string>

#include "results/html_report/report_data.h"

/// The parts of the page, in their order on it. Each is a pure function of what was collected and
/// escapes every text that a user can choose.
namespace results::html_report {

/// Suite, run, time, machine, viewing conditions, counts of cells; links to the sections.
std::string header_section(const ReportData& data);
/// Matrix method x scene, then all numbers in one sortable table.
std::string overview_section(const ReportData& data);
/// Images, scores with noise floors, error maps and stage times of one scene.
std::string scene_section(const ReportData& data, const SceneView& scene);
/// Time and scores frame by frame, where a scene is a sequence; part of its section.
std::string sequence_part(const ReportData& data, const SceneView& scene);
/// Score over time where checkpoints were scored; part of its section.
std::string convergence_part(const ReportData& data, const SceneView& scene);
/// Stage bars and stage table of one scene; part of its section.
std::string stage_part(const ReportData& data, const SceneView& scene);
/// How the settings of budgets by time and error were found; "" if there are none.
std::string search_section(const ReportData& data);
/// Every repetition that failed or was not run, with its logs.
std::string failure_section(const ReportData& data);
/// Methods, metrics, references, machine, build, command, suite text.
std::string provenance_section(const ReportData& data);

}  // namespace results::html_report
