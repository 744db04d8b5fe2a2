#pragma once

#include <array>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "results/figures/figure_spec.h"
#include "results/run_values.h"

/// Figures for papers from stored results, drawn by gnuplot.
namespace results::figures {

enum class FigureFormat { pdf, svg, png };
/// For papers and pages; PNG is for what shows neither.
inline constexpr std::array kVectorFormats{FigureFormat::pdf, FigureFormat::svg};

/// What became of one figure.
struct FigureOutcome {
  std::string id;
  std::vector<std::filesystem::path> files;  ///< the pictures, then .csv and .gp
  std::vector<std::string> notes;            ///< what the figure leaves out; also written in it
  std::string error;                         ///< "" if it was made
};

/// Writes <id>.pdf, <id>.svg (<id>.png), <id>.csv (the numbers that are drawn) and <id>.gp (the
/// script) into the folder, pictures beside them in <id>-images/. An older figure of that id is
/// replaced.
/// @throws base::InputError if no row has what is drawn, for a name that the run does not have, if
///   gnuplot is missing or fails, or if a file cannot be written
FigureOutcome write_figure(const FigureSpec& figure, const RunValues& run,
                           const std::filesystem::path& out_folder,
                           std::span<const FigureFormat> formats = kVectorFormats);

/// All figures of a suite; one that cannot be made is an outcome with its error, and the others are
/// made.
std::vector<FigureOutcome> write_figures(const std::vector<FigureSpec>& figures,
                                         const RunValues& run,
                                         const std::filesystem::path& out_folder,
                                         std::span<const FigureFormat> formats = kVectorFormats);

/// Refuses what can be known to be wrong before a run: names of methods, scenes, budgets, scores
/// and parameters. Stages and counters are known only afterwards.
/// @param planned  of the run's plan, without records @throws base::InputError with the place
void check_figures(const std::vector<FigureSpec>& figures, const RunValues& planned);

}  // namespace results::figures
