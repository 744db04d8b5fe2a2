#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "results/html_report/report_data.h"

namespace results::html_report {

/// Number of a picture among the images of its scene, as the viewer counts: references, then rows,
/// from 0, without those that are missing. @param index  into references, or into pictures
std::optional<std::size_t> reference_number(const SceneView& scene, std::size_t index);
std::optional<std::size_t> row_number(const SceneView& scene, std::size_t index);

/// What the viewer knows of the page, as a JSON element: colours and scales of maps and
/// differences; per scene its images (label, size, floats, frames of a sequence) and error maps.
/// Nothing in it can end the element.
std::string viewer_manifest(const ReportData& data);

}  // namespace results::html_report
