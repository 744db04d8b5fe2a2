#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "perception/image.h"
#include "results/figures/figure_run.h"

namespace results::figures {

/// An image of a run, or why there is none.
struct ImageSource {
  std::filesystem::path file;
  std::string part;     ///< of a multi-part file; "" is the first
  std::string missing;  ///< "" if there is a file
};

/// The rendering of a row that its report shows: the first frame of the first seed.
ImageSource rendering_of(const FigureRun& run, std::size_t row);
/// What the rows of a scene are compared with.
/// @param rows     of one scene; with against = own the first one's reference
/// @param against  own | full
ImageSource reference_of(const FigureRun& run, const std::vector<std::size_t>& rows,
                         const std::string& against);
/// The error map of a row's shown frame; of a sequence metric that of the frame that was kept.
ImageSource map_of(const FigureRun& run, std::size_t row, const Quantity& score);

/// Reads it; where it cannot be read, `source.missing` says why.
std::optional<perception::Image> read_source(ImageSource& source);

}  // namespace results::figures
