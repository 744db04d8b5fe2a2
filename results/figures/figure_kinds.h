#pragma once

#include "results/figures/figure_page.h"
#include "results/figures/figure_spec.h"
#include "results/run_values.h"

/// One function per kind of figure. All throw base::InputError for a name that the run does not
/// have, and where no row has what is to be drawn.
namespace results::figures {

FigureDrawing parameter_figure(const FigureSpec& figure, const RunValues& run);
FigureDrawing time_figure(const FigureSpec& figure, const RunValues& run);
FigureDrawing chain_figure(const FigureSpec& figure, const RunValues& run);
FigureDrawing pareto_figure(const FigureSpec& figure, const RunValues& run);
FigureDrawing stage_figure(const FigureSpec& figure, const RunValues& run);
FigureDrawing image_figure(const FigureSpec& figure, const RunValues& run);
FigureDrawing map_figure(const FigureSpec& figure, const RunValues& run);
FigureDrawing series_figure(const FigureSpec& figure, const RunValues& run);

}  // namespace results::figures
