#include "renderers/blank/blank_renderer.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <new>
#include <thread>

#include "perception/base/errors.h"

namespace renderers::blank {

namespace {

enum class Behaviour { normal, crash, hang, nan, exception, out_of_memory, allocate, print };

const std::vector<std::string>& behaviour_names() {
  static const std::vector<std::string> names{"normal",    "crash",         "hang",     "nan",
                                              "exception", "out_of_memory", "allocate", "print"};
  return names;
}

Behaviour behaviour_of(const base::Parameters& parameters) {
  const std::vector<std::string>& names = behaviour_names();
  const auto found = std::ranges::find(names, parameters.text("behaviour"));
  return static_cast<Behaviour>(found - names.begin());
}

void sleep_for_s(double seconds) {
  std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
}

[[noreturn]] void sleep_forever() {
  for (;;) std::this_thread::sleep_for(std::chrono::hours(1));
}

/// Takes memory, and touches it, until something stops the process.
[[noreturn]] void allocate_until_killed() {
  constexpr std::size_t kBlock_bytes = std::size_t{16} << 20;
  constexpr std::size_t kMost_bytes = std::size_t{64} << 30;
  std::vector<std::vector<char>> blocks;
  while (blocks.size() * kBlock_bytes < kMost_bytes) blocks.emplace_back(kBlock_bytes, '\1');
  throw base::DeviceError("blank: nothing stopped the allocation of 64 GiB");
}

void print_much() {
  constexpr std::size_t kLine_bytes = 64;
  constexpr std::size_t kLines = (std::size_t{3} << 20) / kLine_bytes;
  std::string line(kLine_bytes, '.');
  line.back() = '\n';
  for (std::size_t i = 0; i < kLines; ++i) std::fwrite(line.data(), 1, line.size(), stdout);
  std::fflush(stdout);
}

void misbehave(Behaviour behaviour) {
  switch (behaviour) {
    case Behaviour::crash:
      std::abort();
    case Behaviour::hang:
      sleep_forever();
    case Behaviour::exception:
      throw base::DeviceError("blank: asked to fail by an exception");
    case Behaviour::out_of_memory:
      throw std::bad_alloc();
    case Behaviour::allocate:
      allocate_until_killed();
    case Behaviour::print:
      print_much();
      return;
    case Behaviour::normal:
    case Behaviour::nan:
      return;
  }
}

class BlankRenderer final : public Renderer {
 public:
  explicit BlankRenderer(const base::Parameters& parameters)
      : behaviour_(behaviour_of(parameters)),
        radiance_(static_cast<float>(parameters.real("radiance"))),
        sleep_s_(parameters.real("sleep_s")) {}

  void prepare(const scene::Scene&, StageTimer& timer) override {
    const auto stage = timer.stage("build");
  }

  Frame render(const RenderJob& job, StageTimer& timer) override {
    const auto stage = timer.stage("transport");
    misbehave(behaviour_);
    if (sleep_s_ > 0.0) sleep_for_s(sleep_s_);
    Frame frame;
    frame.radiance =
        perception::make_rgb_image(job.width_px, job.height_px, perception::Encoding::scene_linear);
    if (radiance_ != 0.0F) std::ranges::fill(frame.radiance.pixels, radiance_);
    if (behaviour_ == Behaviour::nan) {
      frame.radiance.pixels.front() = std::numeric_limits<float>::quiet_NaN();
    }
    return frame;
  }

 private:
  Behaviour behaviour_;
  float radiance_;
  double sleep_s_;
};

base::ParameterSpec real_spec(const char* name, double max, const char* unit, const char* doc) {
  base::ParameterSpec spec;
  spec.name = name;
  spec.type = base::ParameterType::real;
  spec.default_value = 0.0;
  spec.min = 0.0;
  spec.max = max;
  spec.unit = unit;
  spec.doc = doc;
  return spec;
}

base::ParameterSpec behaviour_spec() {
  base::ParameterSpec spec;
  spec.name = "behaviour";
  spec.type = base::ParameterType::choice;
  spec.default_value = std::string("normal");
  spec.choices = behaviour_names();
  spec.doc =
      "Fault injection for tests of a harness. crash: abort; hang: never return; nan: one pixel is "
      "NaN; exception: DeviceError; out_of_memory: bad_alloc; allocate: take memory until killed, "
      "64 GiB at most; print: 3 MiB to stdout.";
  return spec;
}

Claims claims_of(const base::Parameters&) { return {Transport::direct, Part::all, std::nullopt}; }

std::unique_ptr<Renderer> create(const base::Parameters& parameters, const Devices&) {
  return std::make_unique<BlankRenderer>(parameters);
}

}  // namespace

RendererInfo renderer_info() {
  constexpr double kMostRadiance = 1e6;
  constexpr double kMostSleep_s = 3600.0;
  RendererInfo info;
  info.name = "blank";
  info.summary = "A constant image in no time: measures the harness.";
  info.source = "ours";
  info.claims = claims_of;
  info.possible_claims = {{Transport::direct, Part::all, std::nullopt}};
  info.supports = {Feature::point_light, Feature::spot_light, Feature::area_light,
                   Feature::environment, Feature::texture,    Feature::phong,
                   Feature::animation};
  info.parameters = {real_spec("radiance", kMostRadiance, "W/(m2 sr)", "Value of every pixel."),
                     behaviour_spec(),
                     real_spec("sleep_s", kMostSleep_s, "s", "Seconds to sleep in render.")};
  info.presets = {{"paper", {}}, {"best", {}}};
  info.create = create;
  return info;
}

}  // namespace renderers::blank
