#include "tests/results/figures/synthetic_suite.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <fmt/format.h>

#include "perception/image_file.h"
#include "tests/results/synthetic_run.h"

namespace test_figures {

namespace fs = std::filesystem;
using nlohmann::ordered_json;
using perception::Image;
using renderers::Phase;
using renderers::StageRecord;

namespace {

/// {"id":"val[vals=30]","sweep":{"vals":30}}
ordered_json entry_of(const std::string& id) {
  ordered_json entry{{"id", id}};
  const std::size_t open = id.find('[');
  if (open == std::string::npos || id.back() != ']') return entry;
  std::size_t begin = open + 1;
  while (begin < id.size()) {
    const std::size_t end = std::min(id.find(',', begin), id.size() - 1);
    const std::string item = id.substr(begin, end - begin);
    const std::size_t equal = item.find('=');
    if (equal == std::string::npos) break;
    entry["sweep"][item.substr(0, equal)] = ordered_json::parse(item.substr(equal + 1));
    begin = end + 1;
  }
  return entry;
}

StageRecord stage(Phase phase, const std::string& path, double wall_s) {
  StageRecord record;
  record.phase = phase;
  record.path = path;
  record.wall_s = wall_s;
  record.calls = 1;
  return record;
}

/// A lit room with two balls; `level` is the relative noise.
Image picture(double level, unsigned seed, bool has_indirect) {
  Image image = perception::make_rgb_image(320, 240, perception::Encoding::scene_linear);
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  for (int y = 0; y < image.height_px; ++y) {
    for (int x = 0; x < image.width_px; ++x) {
      const double u = (x - 160.0) / 120.0;
      const double v = (120.0 - y) / 120.0;
      double light =
          (has_indirect ? 0.12 : 0.02) + 0.3 * std::exp(-2.0 * (u * u + (v - 0.6) * (v - 0.6)));
      double red = 1.0;
      double blue = 1.0;
      for (const auto& [cx, hue] : {std::pair{-0.5, 0.4}, std::pair{0.55, 1.6}}) {
        const double r2 = (u - cx) * (u - cx) + (v + 0.35) * (v + 0.35);
        if (r2 > 0.16) continue;
        light = std::max(0.03, 0.9 * (0.8 * (v + 0.35) + std::sqrt(0.16 - r2)) + 0.1);
        red = hue;
        blue = 2.0 - hue;
      }
      light *= std::max(0.0, 1.0 + level * normal(random));
      image.at(x, y, 0) = static_cast<float>(light * red);
      image.at(x, y, 1) = static_cast<float>(0.8 * light);
      image.at(x, y, 2) = static_cast<float>(light * blue);
    }
  }
  return image;
}

void write(const fs::path& path, const Image& image) {
  fs::create_directories(path.parent_path());
  perception::write_exr(path, {{{"radiance", image}}, {}});
}

Image difference(const Image& a, const Image& b) {
  Image map =
      perception::make_gray_image(a.width_px, a.height_px, "Y", perception::Encoding::scene_linear);
  for (int y = 0; y < a.height_px; ++y) {
    for (int x = 0; x < a.width_px; ++x) {
      map.at(x, y) = std::abs(a.at(x, y, 1) - b.at(x, y, 1)) / (b.at(x, y, 1) + 0.1F);
    }
  }
  return map;
}

/// What a method costs and how wrong it is.
struct Model {
  std::string method;
  std::string budget;
  double seconds;
  double error;
};

std::vector<Model> models() {
  std::vector<Model> all;
  for (const int spp : {4, 16, 64, 256}) {
    all.push_back({"pt", fmt::format("{}spp", spp), 0.03 * spp, 0.4 / spp});
  }
  for (const int vals : {2, 5, 10, 30, 100}) {
    all.push_back(
        {fmt::format("val[vals={}]", vals), "fixed", 0.08 + 0.004 * vals, 0.002 + 0.06 / vals});
    all.push_back({fmt::format("val-hard[vals={}]", vals), "fixed", 0.06 + 0.003 * vals,
                   0.006 + 0.05 / vals});
  }
  all.push_back({"novis", "fixed", 0.02, 0.09});
  all.push_back({"light_propagation", "fixed", 0.05, 0.05});
  return all;
}

class RealisticRun {
 public:
  explicit RealisticRun(const fs::path& root)
      : root_(root), suite_(root / "runs/quick/20261122T001209Z-0a1b2c") {}

  results::Run make() {
    suite_.add_scene("horse");
    suite_.add_scene("room[light=2]");
    for (const Model& model : models()) suite_.add_method(model.method);
    suite_.set_metrics({"relmse", "visible-difference", "flip", "ssim"});
    truth_ = picture(0.0, 1, true);
    write(root_ / "references/aaaa/reference.exr", truth_);
    std::size_t number = 0;
    for (const std::string scene : {"horse", "room[light=2]"}) {
      for (const Model& model : models()) add(scene, model, ++number);
    }
    return suite_.run();
  }

 private:
  void add(const std::string& scene, const Model& model, std::size_t number) {
    const double factor = scene == "horse" ? 1.0 : 2.2;
    const std::string name = fmt::format("{:03}", number);
    const Image image = picture(3.0 * std::sqrt(0.1 * model.error), static_cast<unsigned>(number),
                                model.method != "novis");
    write(suite_.run().folder / ("images/" + name + ".exr"), image);
    write(suite_.run().folder / ("maps/" + name + ".exr"), difference(image, truth_));
    for (const std::uint64_t seed : {1U, 2U, 3U, 4U}) {
      const double noise = 1.0 + 0.08 * normal_(random_);
      for (int repetition = 0; repetition < 2; ++repetition) {
        SyntheticSuite::Cell cell{scene, model.method, model.budget, seed, repetition};
        cell.total_s = model.seconds * (1.0 + 0.03 * std::abs(normal_(random_)));
        const double error = factor * model.error * noise;
        if (repetition == 0) {
          cell.scores = {{"relmse", error},
                         {"visible-difference", std::min(0.9, 4.0 * error)},
                         {"flip", std::min(0.8, std::sqrt(error) * 0.4)},
                         {"ssim", 1.0 - std::min(0.9, 3.0 * error)}};
        }
        cell.noise_floor = 0.0015 * factor;
        cell.image = "images/" + name + ".exr";
        cell.map = "maps/" + name + ".exr";
        suite_.add(cell);
      }
      if (model.budget == "256spp") add_checkpoints(factor * model.error * noise, model.seconds);
    }
  }

  /// Scores of images on the way to the cell that was added last.
  void add_checkpoints(double error, double seconds) {
    for (int checkpoint = 0; checkpoint < 6; ++checkpoint) {
      results::CheckpointScore point;
      point.checkpoint = checkpoint;
      const double part = std::pow(0.5, 6 - checkpoint);
      point.elapsed_s = part * seconds;
      for (const results::MetricRecord& score : suite_.run().metrics) {
        if (score.cell == suite_.run().cells.back().cell && score.metric == "relmse" &&
            score.against == "own") {
          point.score = score;
        }
      }
      point.score.value = error / part * (1.0 + 0.1 * normal_(random_));
      suite_.run().checkpoint_scores.push_back(point);
    }
  }

  fs::path root_;
  SyntheticSuite suite_;
  Image truth_;
  std::mt19937 random_{3};
  std::normal_distribution<double> normal_;
};

}  // namespace

SyntheticSuite::SyntheticSuite(fs::path folder) {
  run_.folder = std::move(folder);
  info_ = {{"schema", 1},
           {"run", "20261122T001209Z-0a1b2c"},
           {"suite", "quick"},
           {"environment",
            {{"version", "0.9"}, {"commit", "dd889fa"}, {"machine", "host-cpu"}, {"cpu", "A CPU"}}},
           {"scenes", ordered_json::array()},
           {"methods", ordered_json::array()},
           {"metrics", ordered_json::array()}};
}

void SyntheticSuite::add_scene(const std::string& id) { info_["scenes"].push_back(entry_of(id)); }

void SyntheticSuite::add_method(const std::string& id) {
  for (const ordered_json& known : info_["methods"]) {
    if (known["id"] == id) return;
  }
  info_["methods"].push_back(entry_of(id));
}

void SyntheticSuite::set_metrics(const std::vector<std::string>& metrics) {
  info_["metrics"] = metrics;
}

void SyntheticSuite::add(const Cell& cell) {
  results::CellRecord record =
      test_results::timed_cell(cell.scene, cell.method, cell.seed, cell.total_s);
  record.cell = fmt::format("{}.{}.{}.s{}", cell.scene, cell.method, cell.budget, cell.seed);
  record.budget = cell.budget;
  record.repetition = cell.repetition;
  results::RenderRecord& render = record.render;
  render.image = cell.image;
  render.frame = cell.frame;
  render.counters.clear();
  for (const auto& [name, values] : cell.counters) render.counters.emplace_back(name, values);
  const double s = cell.total_s;
  const Phase first = cell.is_following ? Phase::update : Phase::prepare;
  render.stages = {stage(first, "build", 0.125 * s), stage(first, "lights", 0.0625 * s),
                   stage(Phase::render, "visibility", 0.25 * s),
                   stage(Phase::render, "gather", 0.5 * s)};
  render.unattributed_s = 0.0625 * s;
  if (cell.is_following) {
    render.total_s = render.prepare_s = std::numeric_limits<double>::quiet_NaN();
    render.next_frame_s = s;
  }
  run_.cells.push_back(record);
  for (const auto& [metric, value] : cell.scores) {
    results::MetricRecord score = test_results::full_metric_record();
    score.cell = record.cell;
    score.frame = cell.frame;
    score.against = "own";
    score.reference_hash = "aaaa";
    score.metric = metric;
    score.value = value;
    score.noise_floor = cell.noise_floor;
    score.map = cell.map;
    run_.metrics.push_back(score);
    score.against = "full";
    run_.metrics.push_back(score);
  }
}

results::Run& SyntheticSuite::run() {
  run_.info = std::make_shared<const ordered_json>(info_);
  return run_;
}

results::Run realistic_run(const fs::path& root) { return RealisticRun(root).make(); }

results::Run realistic_sequence() {
  SyntheticSuite suite;
  suite.add_scene("horse");
  suite.set_metrics({"relmse"});
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  for (const std::string method : {"val", "pt"}) {
    suite.add_method(method);
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
      for (int frame = 0; frame < 40; ++frame) {
        SyntheticSuite::Cell cell{"horse", method, "fixed", seed, 0, frame};
        const double wave = 1.0 + 0.4 * std::sin(0.25 * frame);
        cell.total_s = (method == "pt" ? 0.08 : 0.03) * wave * (1.0 + 0.05 * normal(random));
        cell.scores = {
            {"relmse", (method == "pt" ? 0.02 : 0.008) * wave * (1.0 + 0.1 * normal(random))}};
        cell.counters = {{"links", {1000.0 * wave}}};
        cell.is_following = frame > 0;
        cell.image = fmt::format("images/{}.exr", frame);
        suite.add(cell);
      }
    }
  }
  return suite.run();
}

std::vector<results::figures::FigureSpec> figures_of(const std::string& yaml) {
  return results::figures::read_figures(base::parse_document(yaml, "suite.yaml"));
}

}  // namespace test_figures
