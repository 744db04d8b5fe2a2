#pragma once

#include "results/figures/figure_page.h"
#include "results/figures/figure_run.h"
#include "results/figures/figure_spec.h"

/// One function per kind of figure. All throw base::InputError for a name that the run does not
/// have, and where no row has what is to be drawn.
namespace results::figures {

FigureDrawing parameter_figure(const FigureSpec& figure, const FigureRun& run);
FigureDrawing time_figure(const FigureSpec& figure, const FigureRun& run);
FigureDrawing chain_figure(const FigureSpec& figure, const FigureRun& run);
FigureDrawing pareto_figure(const FigureSpec& figure, const FigureRun& run);
FigureDrawing stage_figure(const FigureSpec& figure, const FigureRun& run);
FigureDrawing image_figure(const FigureSpec& figure, const FigureRun& run);
FigureDrawing map_figure(const FigureSpec& figure, const FigureRun& run);
FigureDrawing series_figure(const FigureSpec& figure, const FigureRun& run);

}  // namespace results::figures
