// How long a report takes to write, to show and to answer, and how large it is.
//
//   benchmark_report [CELLS [SIZE]]      default: 20 cells, 6 images each, of 800x800
//
// Prints a line per figure. The run is made up: renderings are a noisy picture, a different one per
// cell, with five error maps each; four scenes, so every fifth cell shares a reference. The browser
// part needs Chromium and is left out without it.
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <random>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "perception/image_file.h"
#include "perception/viewing_conditions.h"
#include "results/html_report/html_report.h"
#include "tests/browser_session.h"
#include "tests/headless_browser.h"
#include "tests/results/synthetic_run.h"
#include "tests/temporary_folder.h"

namespace {

namespace fs = std::filesystem;
using perception::Encoding;
using perception::Image;

constexpr int kScenes = 4;

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void write(const fs::path& path, const Image& image) {
  fs::create_directories(path.parent_path());
  perception::write_exr(path, {{{"", image}}, {}});
}

/// A picture with gradients and edges under the noise of a path tracer.
Image rendering(int size_px, double noise, unsigned seed) {
  Image image = perception::make_rgb_image(size_px, size_px, Encoding::scene_linear);
  std::mt19937 random(seed);
  std::gamma_distribution<double> sample(1.0 / std::max(1e-9, noise * noise));
  for (int y = 0; y < size_px; ++y) {
    for (int x = 0; x < size_px; ++x) {
      const double u = 8.0 * x / size_px;
      const double v = 8.0 * y / size_px;
      const bool is_dark = (static_cast<int>(u) + static_cast<int>(v)) % 2 == 0;
      const double light = (is_dark ? 0.1 : 0.6) * (1.2 + std::sin(u) * std::cos(v));
      for (int c = 0; c < 3; ++c) {
        const double factor = noise > 0.0 ? sample(random) * noise * noise : 1.0;
        image.at(x, y, c) = static_cast<float>(light * factor * (1.0 - 0.2 * c));
      }
    }
  }
  return image;
}

Image error_map(const Image& test, const Image& truth, double power) {
  Image map =
      perception::make_gray_image(test.width_px, test.height_px, "Y", Encoding::scene_linear);
  for (std::size_t i = 0; i < map.pixels.size(); ++i) {
    double sum = 0.0;
    for (std::size_t c = 0; c < 3; ++c) {
      sum += std::pow(std::abs(test.pixels[3 * i + c] - truth.pixels[3 * i + c]), power) / 3.0;
    }
    map.pixels[i] = static_cast<float>(sum);
  }
  return map;
}

fs::path write_run(const fs::path& root, int cells, int size_px) {
  results::RunFolder run = results::RunFolder::open_for_writing(root / "runs/large/run");
  const Image truth = rendering(size_px, 0.0, 0);
  for (int scene = 0; scene < kScenes; ++scene) {
    write(root / fmt::format("references/r{}/reference.exr", scene), truth);
  }
  for (int i = 0; i < cells; ++i) {
    const Image image = rendering(size_px, 0.3, static_cast<unsigned>(i + 1));
    results::CellRecord cell = test_results::timed_cell(
        fmt::format("scene-{}", i % kScenes), fmt::format("method-{}", i / kScenes), 1, 1.0 + i);
    cell.render.image = "images/" + cell.cell + "/frame.exr";
    write(run.path() / cell.render.image, image);
    run.append(cell);
    double power = 0.5;
    for (const char* metric : {"relmse", "mse", "mae", "smape", "flip"}) {
      results::MetricRecord score = test_results::full_metric_record();
      score.cell = cell.cell;
      score.frame = cell.render.frame;
      score.reference_hash = fmt::format("r{}", i % kScenes);
      score.metric = metric;
      score.map = fmt::format("maps/{}-{}.exr", cell.cell, metric);
      write(run.path() / score.map, error_map(image, truth, power));
      run.append(score);
      power += 0.4;
    }
  }
  nlohmann::ordered_json info{{"schema", 1}, {"suite", "large"}};
  info["viewing"] = perception::to_json(perception::default_viewing_conditions());
  info["metrics"] = {"relmse", "mse", "mae", "smape", "flip"};
  run.write_run_json(info);
  return run.path();
}

void tell_size(const results::html_report::ReportFiles& files) {
  const double payload = 0.75 * static_cast<double>(files.data_bytes);
  const auto page = static_cast<double>(fs::file_size(files.index));
  fmt::print("{:<44}{:.1f} MB\n", "deflated half-float payloads", payload / 1e6);
  fmt::print("{:<44}{:.1f} MB\n", "index.html", page / 1e6);
  if (!files.is_split) fmt::print("{:<44}{:.3f}\n", "page / payloads", page / payload);
}

void browse(const fs::path& index, const fs::path& profile) {
  tests::BrowserSession::Options options;
  options.width_px = 800;
  options.height_px = 900;
  tests::BrowserSession browser(profile, options);
  auto start = std::chrono::steady_clock::now();
  browser.open(index);
  fmt::print("{:<44}{:.2f} s\n", "page loaded", seconds_since(start));
  const nlohmann::json paint = browser.evaluate(
      "performance.getEntriesByName('first-contentful-paint').map(e => e.startTime)[0] ?? -1");
  fmt::print("{:<44}{:.2f} s\n", "first contentful paint", paint.get<double>() / 1000.0);
  fmt::print("{:<44}{:.2f} s\n", "viewer ready for keys",
             browser.evaluate("discernViewer.readyAt").get<double>() / 1000.0);
  start = std::chrono::steady_clock::now();
  browser.evaluate("document.querySelector('img.picture').click()");
  browser.wait_for("discernViewer.displays?.awaited.size === 0 && floatCache.images.size > 0");
  fmt::print("{:<44}{:.2f} s\n", "click to floats", seconds_since(start));
  const nlohmann::json frames = browser.evaluate(
      "new Promise(done => { const v = discernViewer; v.controls.inspector.hidden = true; "
      "v.setViews(4); setTimeout(() => { const first = v.drawCount, t = performance.now(); "
      "const step = () => { v.moveBy(3, 2); if (performance.now() - t < 3000) "
      "requestAnimationFrame(step); else done((v.drawCount - first) / (performance.now() - t) * "
      "1000); }; step(); }, 2000); })");
  fmt::print("{:<44}{:.0f} fps with {}\n", "four views panning, 800x800", frames.get<double>(),
             browser.evaluate("discernViewer.painter.name").get<std::string>());
}

}  // namespace

int main(int argc, char** argv) {
  const int cells = argc > 1 ? std::atoi(argv[1]) : 20;
  const int size_px = argc > 2 ? std::atoi(argv[2]) : 800;
  const tests::TemporaryFolder folder;
  const results::Run run = results::load_run(write_run(folder.path(), cells, size_px));
  const auto start = std::chrono::steady_clock::now();
  const results::html_report::ReportFiles files = results::html_report::write_report(run);
  fmt::print("{:<44}{:.2f} s{}\n", "written", seconds_since(start),
             files.is_split ? ", split" : "");
  tell_size(files);
  if (tests::has_browser()) browse(files.index, folder.path() / "profile");
  return 0;
}
