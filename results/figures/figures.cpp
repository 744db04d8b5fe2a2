#include "results/figures/figures.h"

#include <algorithm>

#include <fmt/format.h>

#include "perception/base/atomic_file.h"
#include "perception/base/parallel.h"
#include "perception/image_file.h"
#include "results/figures/figure_kinds.h"
#include "results/figures/gnuplot_process.h"
#include "results/figures/provenance.h"

namespace results::figures {

namespace fs = std::filesystem;

namespace {

FigureDrawing drawing_of(const FigureSpec& figure, const FigureRun& run) {
  switch (figure.kind) {
    case FigureKind::error_vs_parameter:
      return parameter_figure(figure, run);
    case FigureKind::error_vs_time:
      return time_figure(figure, run);
    case FigureKind::error_chain:
      return chain_figure(figure, run);
    case FigureKind::pareto:
      return pareto_figure(figure, run);
    case FigureKind::stage_stack:
      return stage_figure(figure, run);
    case FigureKind::image_grid:
      return image_figure(figure, run);
    case FigureKind::false_colour:
      return map_figure(figure, run);
    case FigureKind::series:
      break;
  }
  return series_figure(figure, run);
}

void write_pictures(const FigureDrawing& drawing, const fs::path& folder) {
  std::error_code error;
  fs::remove_all(folder, error);
  if (drawing.pictures.empty()) return;
  fs::create_directories(folder, error);
  if (error) throw base::InputError(folder.string() + ": " + error.message());
  base::parallel_for(drawing.pictures.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      perception::write_png(folder / drawing.pictures[i].name, drawing.pictures[i].image);
    }
  });
}

const char* extension_of(FigureFormat format) {
  switch (format) {
    case FigureFormat::pdf:
      return "pdf";
    case FigureFormat::png:
      return "png";
    case FigureFormat::svg:
      break;
  }
  return "svg";
}

FigureOutcome write_one(const FigureSpec& figure, const FigureRun& run, const fs::path& out_folder,
                        std::span<const FigureFormat> formats) {
  const FigureDrawing drawing = drawing_of(figure, run);
  gnuplot_program();  // before anything is written
  std::error_code error;
  fs::create_directories(out_folder, error);
  if (error) throw base::InputError(out_folder.string() + ": " + error.message());
  FigureOutcome outcome{figure.id, {}, drawing.page.notes, ""};
  const Metadata provenance = provenance_of(figure, run.run());
  const fs::path script = out_folder / (figure.id + ".gp");
  const fs::path table = out_folder / (figure.id + ".csv");
  write_pictures(drawing, out_folder / (figure.id + "-images"));
  base::write_text_file(table, to_csv(drawing.table));
  base::write_text_file(script, figure_script(figure.id, drawing, lines_of(provenance)));
  std::string names;
  for (const FigureFormat format : formats) {
    names += (names.empty() ? "" : " ") + std::string(extension_of(format));
    outcome.files.push_back(out_folder / (figure.id + "." + extension_of(format)));
  }
  if (!names.empty()) run_gnuplot(out_folder, script.filename().string(), names);
  for (const fs::path& file : outcome.files) stamp(file, provenance);
  outcome.files.push_back(table);
  outcome.files.push_back(script);
  return outcome;
}

}  // namespace

FigureOutcome write_figure(const FigureSpec& figure, const RunValues& run,
                           const fs::path& out_folder, std::span<const FigureFormat> formats) {
  return write_one(figure, run, out_folder, formats);
}

std::vector<FigureOutcome> write_figures(const std::vector<FigureSpec>& figures,
                                         const RunValues& run, const fs::path& out_folder,
                                         std::span<const FigureFormat> formats) {
  const FigureRun shared(run);
  std::vector<FigureOutcome> outcomes(figures.size());
  base::parallel_for(figures.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      try {
        outcomes[i] = write_one(figures[i], shared, out_folder, formats);
      } catch (const base::InputError& error) {
        outcomes[i] = {figures[i].id, {}, {}, error.what()};
      }
    }
  });
  return outcomes;
}

}  // namespace results::figures
