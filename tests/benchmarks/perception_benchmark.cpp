// Time of the viewer's model on a 1920 x 1080 image, on one thread and on all cores.

#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdint>
#include <string>

#include "perception/base/parallel.h"
#include "perception/threshold_map.h"

namespace {

using perception::Encoding;
using perception::Image;

constexpr int kWidthPx = 1920;
constexpr int kHeightPx = 1080;

/// Light of a smooth picture with noise, 10 to 90 cd/m2.
Image noisy_light() {
  Image image = perception::make_gray_image(kWidthPx, kHeightPx, "Y", Encoding::luminance_cd_m2);
  std::uint32_t state = 1;
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    state = state * 1664525U + 1013904223U;
    const float noise = static_cast<float>(state >> 8) * 0x1p-24F - 0.5F;
    const auto phase = static_cast<float>(i % 5000) / 5000.0F;
    image.pixels[i] = 50.0F + 40.0F * std::sin(6.2831853F * phase) + 10.0F * noise;
  }
  return image;
}

struct Case {
  std::string name;
  perception::ThresholdSettings settings;
};

std::vector<Case> all_cases() {
  std::vector<Case> cases(3);
  cases[0].name = "rama99";
  cases[1].name = "rama99,oriented";
  cases[1].settings.masking.bands = perception::MaskingBands::oriented_octaves;
  cases[2].name = "yee_compat";
  cases[2].settings.masking = perception::masking_profile("yee_compat");
  return cases;
}

void map_image(benchmark::State& state, const Case& one, int threads) {
  const base::ThreadLimit limit(threads);
  const Image light = noisy_light();
  const perception::ViewingConditions viewing;
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        perception::threshold_map(light, viewing, one.settings).threshold_cd_m2.pixels.data());
  }
}

void query_field(benchmark::State& state) {
  const perception::ThresholdField field(noisy_light(), {}, {},
                                         perception::ThresholdField::Keeps::bands);
  double x = 0.0;
  double sum = 0.0;
  for (auto _ : state) {
    x = std::fmod(x + 97.31, static_cast<double>(kWidthPx));
    sum += field.threshold_cd_m2(x, 0.5 * x);
  }
  benchmark::DoNotOptimize(sum);
}

void query_target(benchmark::State& state) {
  const perception::ThresholdField field(noisy_light(), {}, {},
                                         perception::ThresholdField::Keeps::bands);
  double x = 0.0;
  double sum = 0.0;
  for (auto _ : state) {
    x = std::fmod(x + 97.31, static_cast<double>(kWidthPx));
    sum += field.threshold_cd_m2(x, 0.5 * x, perception::MaskingTarget{4.0, std::nullopt});
  }
  benchmark::DoNotOptimize(sum);
}

}  // namespace

int main(int argument_count, char** arguments) {
  benchmark::Initialize(&argument_count, arguments);
  for (const Case& one : all_cases()) {
    for (const int threads : {1, 0}) {
      const std::string name =
          "threshold_map/" + one.name + (threads == 1 ? "/one_thread" : "/all_cores");
      benchmark::RegisterBenchmark(name.c_str(), map_image, one, threads)
          ->Unit(benchmark::kMillisecond)
          ->UseRealTime();
    }
  }
  benchmark::RegisterBenchmark("threshold_field/threshold", query_field);
  benchmark::RegisterBenchmark("threshold_field/target", query_target);
  benchmark::RunSpecifiedBenchmarks();
}
