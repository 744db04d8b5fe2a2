#include "tests/results/synthetic_run.h"

#include <cmath>
#include <fstream>
#include <random>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "perception/image_file.h"
#include "perception/viewing_conditions.h"
#include "results/run_environment.h"

namespace test_results {

namespace fs = std::filesystem;
using nlohmann::ordered_json;
using perception::Image;
using results::CellRecord;
using results::MetricRecord;
using results::RunFolder;
using results::Status;

namespace {

constexpr const char* kHostileName = "<script>alert(1)</script>";

renderers::StageRecord stage(renderers::Phase phase, const std::string& path, double wall_s) {
  renderers::StageRecord record;
  record.phase = phase;
  record.path = path;
  record.wall_s = wall_s;
  record.cpu_s = 1.9 * wall_s;
  record.calls = 1;
  return record;
}

/// A lit sphere above a floor; noise_level is the relative standard deviation of a pixel.
Image picture(int width_px, int height_px, double noise_level, bool has_floor) {
  Image image = perception::make_rgb_image(width_px, height_px, perception::Encoding::scene_linear);
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  for (int y = 0; y < height_px; ++y) {
    for (int x = 0; x < width_px; ++x) {
      const double u = 2.0 * (x + 0.5) / width_px - 1.0;
      const double v = 1.0 - 2.0 * (y + 0.5) / height_px;
      const double r2 = u * u + v * v;
      double light = has_floor ? 0.15 + 0.25 * (1.0 - v) * std::exp(-2.0 * r2) : 0.02;
      if (r2 < 0.36) light = std::max(0.03, 0.9 * (-0.5 * u + 0.7 * v + std::sqrt(0.36 - r2)));
      light *= std::max(0.0, 1.0 + noise_level * normal(random));
      image.at(x, y, 0) = static_cast<float>(light);
      image.at(x, y, 1) = static_cast<float>(light * (r2 < 0.36 ? 0.55 : 0.95));
      image.at(x, y, 2) = static_cast<float>(light * (r2 < 0.36 ? 0.35 : 1.1));
    }
  }
  return image;
}

Image difference_map(const Image& a, const Image& b) {
  Image map =
      perception::make_gray_image(a.width_px, a.height_px, "Y", perception::Encoding::scene_linear);
  for (int y = 0; y < a.height_px; ++y) {
    for (int x = 0; x < a.width_px; ++x) {
      map.at(x, y) = std::abs(a.at(x, y, 1) - b.at(x, y, 1)) / (b.at(x, y, 1) + 0.01F);
    }
  }
  return map;
}

void write_image(const fs::path& path, const Image& image) {
  fs::create_directories(path.parent_path());
  perception::write_exr(path, {{{"radiance", image}}, {}});
}

/// Writes one run; keeps what its steps share.
class SyntheticRun {
 public:
  SyntheticRun(const fs::path& root, int width_px, int height_px)
      : root_(root),
        folder_(RunFolder::open_for_writing(root / "runs/quick/20261122T001209Z-0a1b2c")),
        width_px_(width_px),
        height_px_(height_px) {}

  fs::path write() {
    truth_ = picture(width_px_, height_px_, 0.0, true);
    write_reference("aaaa");
    write_reference("dddd");
    for (const std::string scene : {"box", kHostileName}) {
      write_path(scene);
      write_direct(scene);
      write_failures(scene);
    }
    folder_.write_run_json(info());
    folder_.write_resolved_suite("schema: 1\nsuite: quick\nscenes: [{id: box}]\n");
    return folder_.path();
  }

 private:
  void write_reference(const std::string& hash) {
    const fs::path path = root_ / "references" / hash / "reference.exr";
    fs::create_directories(path.parent_path());
    const Image shown = hash == "aaaa" ? truth_ : picture(width_px_, height_px_, 0.0, false);
    perception::write_exr(path, {{{"radiance", shown}, {"indirect", shown}}, {}});
    std::ofstream(path.parent_path() / "reference.json") << R"({"samples": 4096, "seed": 1000003})";
  }

  void write_path(const std::string& scene) {
    const Image image = picture(width_px_, height_px_, 0.3, true);
    for (const std::uint64_t seed : {1U, 2U}) {
      for (int repetition = 0; repetition < 2; ++repetition) {
        CellRecord cell = timed_cell(scene, "pt8", seed,
                                     1.2 + 0.05 * repetition + 0.01 * static_cast<double>(seed));
        cell.repetition = repetition;
        cell.render.image = "images/" + cell.cell + "/frame.exr";
        write_image(folder_.path() / cell.render.image, image);
        folder_.append(cell);
        if (repetition == 0) write_scores(cell, image, "aaaa");
      }
    }
  }

  void write_direct(const std::string& scene) {
    const Image image = picture(width_px_, height_px_, 0.1, false);
    CellRecord cell = timed_cell(scene, "direct-only", 1, 0.4);
    cell.render.transport = "direct";
    cell.render.image = "images/" + cell.cell + "/frame.exr";
    write_image(folder_.path() / cell.render.image, image);
    folder_.append(cell);
    write_scores(cell, image, "dddd");
  }

  void write_scores(const CellRecord& cell, const Image& image, const std::string& own) {
    for (const std::string against : {"own", "full"}) {
      const bool is_full = against == "full";
      for (const char* metric : {"relmse", "flip", "psnr"}) {
        MetricRecord score = full_metric_record();
        score.cell = cell.cell;
        score.frame = cell.render.frame;
        score.against = against;
        score.reference_hash = is_full ? "aaaa" : own;
        score.metric = metric;
        const double error = (is_full && own == "dddd" ? 0.2 : 0.01) *
                             (1.0 + 0.1 * static_cast<double>(cell.render.seed));
        score.value = score.metric == "psnr" ? -10.0 * std::log10(error) : error;
        score.noise_floor = score.metric == "psnr" ? 60.0 : 0.011;
        if (score.metric == "flip") score.noise_floor = 0.02;
        score.map = fmt::format("maps/{}-{}-{}.exr", cell.cell, metric, against);
        write_image(folder_.path() / score.map, difference_map(image, truth_));
        folder_.append(score);
      }
    }
  }

  void write_failures(const std::string& scene) {
    CellRecord cell = timed_cell(scene, "broken", 1, 0.0);
    cell.render.stages.clear();
    cell.render.image.clear();
    if (scene == "box") {
      cell.render.status = Status::crash;
      cell.render.reason = "signal 11 (Segmentation fault) in <gather>";
      std::ofstream log(folder_.cell_folder(cell.cell) / "stderr.log");
      for (int line = 1; line <= 60; ++line) log << "log line " << line << " <&>\n";
    } else {
      cell.render.status = Status::unsupported;
      cell.render.reason = "the scene has: environment";
    }
    folder_.append(cell);
  }

  ordered_json info() const {
    ordered_json json;
    json["schema"] = 1;
    json["run"] = folder_.path().filename().string();
    json["suite"] = "quick";
    json["summary"] = "Three methods on two scenes <i>";
    json["profile"] = "smoke";
    json["command"] = "discern run quick --filter \"<b>\"";
    json["environment"] = results::run_environment();
    json["environment"]["started_utc"] = "2026-11-22T00:12:09Z";
    json["state"] = "running";
    json["updated_utc"] = "2026-11-22T00:13:00Z";
    json["viewing"] = perception::to_json(perception::default_viewing_conditions());
    json["scenes"] = {{{"id", "box"}}, {{"id", kHostileName}, {"exposure_ev", 1.0}}};
    json["methods"] = {"direct-only", "pt8", "broken"};
    json["metrics"] = {"relmse", "flip", "psnr"};
    json["references"] = {
        {{"scene", "box"}, {"transport", "full"}, {"geometry_clamp", nullptr}, {"hash", "aaaa"}},
        {{"scene", "attic"}, {"transport", "one_bounce"}, {"reason", "out of <memory>"}}};
    for (const std::string scene : {"box", kHostileName}) {
      json["planned_cells"].push_back({{"cell", scene + ".later.64spp.s1"},
                                       {"scene", scene},
                                       {"method", "later"},
                                       {"budget", "64spp"}});
    }
    return json;
  }

  fs::path root_;
  RunFolder folder_;
  int width_px_;
  int height_px_;
  Image truth_;
};

}  // namespace

results::RenderRecord full_render_record() {
  results::RenderRecord record;
  record.status = Status::non_finite;
  record.reason = "2 pixels are not finite";
  record.scene = "cornell-box";
  record.scene_hash = "0123";
  record.renderer = "path";
  record.preset = "paper";
  record.parameters = {{"max_depth", std::int64_t{8}},
                       {"clamp", 0.5},
                       {"nee", true},
                       {"bounces", std::string("all")}};
  record.transport = "one_bounce";
  record.part = "indirect";
  record.geometry_clamp = 0.1;
  record.width_px = 640;
  record.height_px = 480;
  record.seed = 18446744073709551615ULL;
  record.frame = 3;
  record.samples = 64;
  record.device = "llvmpipe";
  record.gl_platform = "egl-surfaceless";
  record.threads = 2;
  record.total_s = 1.5;
  record.next_frame_s = 0.25;
  record.new_view_s = 0.125;
  record.prepare_s = 0.5;
  record.update_s = 0.0625;
  record.render_s = 1.1;
  record.start_up_s = 0.05;
  record.readback_s = 0.1;
  record.stages = {stage(renderers::Phase::prepare, "build/bvh", 0.1),
                   stage(renderers::Phase::render, "gather", 0.2)};
  record.stages[1].gpu_s = 0.15;
  record.stages[1].clock = renderers::StageClock::gpu_query;
  record.stages[1].bytes_cpu = 12;
  record.stages[1].bytes_gpu = 34;
  record.unattributed_s = 0.01;
  record.counters = {{"rays", 1024.0}, {"links", std::vector<double>{1.0, 2.5}}};
  record.peak_memory_bytes = 1 << 20;
  record.non_finite_pixels = 2;
  record.pixel_hash = "beef";
  record.image = "images/x/frame.exr";
  record.notes = {"one", "two"};
  return record;
}

CellRecord full_cell_record() {
  CellRecord record;
  record.run = "20261122T001209Z-0a1b2c";
  record.cell = "box.pt8.64spp.s1-01234567";
  record.scene = "box";
  record.method = "pt8[max_depth=8]";
  record.budget = "64spp";
  record.profile = "smoke";
  record.repetition = 2;
  record.started_utc = "2026-11-22T00:12:09Z";
  record.machine = "host-cpu";
  record.jobs = 2;
  record.render = full_render_record();
  record.render.scene = record.scene;
  record.checkpoints = {{0.25, 16, "images/x/checkpoint-000.exr"}};
  return record;
}

MetricRecord full_metric_record() {
  MetricRecord record;
  record.cell = "box.pt8.64spp.s1-01234567";
  record.frame = 1;
  record.against = "full";
  record.image_hash = "beef";
  record.reference_hash = "cafe";
  record.reference_pixel_hash = "beef";
  record.context_hash = "feed";
  record.metric = "relmse,trim=0.001";
  record.parameters = {{"trim", 0.001}};
  record.version = 2;
  record.viewing_hash = "f00d";
  record.value = 0.0123;
  record.details = {{"median", 0.01}, {"p95", 0.2}};
  record.map = "maps/x.exr";
  record.noise_floor = 0.001;
  return record;
}

CellRecord timed_cell(const std::string& scene, const std::string& method, std::uint64_t seed,
                      double total_s) {
  CellRecord record = full_cell_record();
  record.scene = scene;
  record.method = method;
  record.cell =
      fmt::format("{}.{}.64spp.s{}-01234567", scene.front() == '<' ? "evil" : scene, method, seed);
  record.repetition = 0;
  record.jobs = 1;
  record.checkpoints.clear();
  results::RenderRecord& render = record.render;
  render.status = Status::ok;
  render.reason.reset();
  render.non_finite_pixels = 0;
  render.next_frame_s.reset();
  render.new_view_s.reset();
  render.update_s.reset();
  render.seed = seed;
  render.transport = "full";
  render.part = "all";
  render.geometry_clamp.reset();
  render.total_s = total_s;
  using renderers::Phase;
  render.stages = {stage(Phase::prepare, "build", 0.2 * total_s),
                   stage(Phase::prepare, "build/bvh", 0.15 * total_s),
                   stage(Phase::prepare, "lights", 0.05 * total_s),
                   stage(Phase::render, "transport", 0.5 * total_s),
                   stage(Phase::render, "gather", 0.15 * total_s),
                   stage(Phase::render, "readback", 0.1 * total_s)};
  render.unattributed_s = 0.1 * total_s;
  return record;
}

fs::path write_synthetic_run(const fs::path& root, int width_px, int height_px) {
  return SyntheticRun(root, width_px, height_px).write();
}

}  // namespace test_results
