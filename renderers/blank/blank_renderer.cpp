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

enum class Behaviour {
  normal,
  crash,
  hang,
  nan,
  exception,
  out_of_memory,
  allocate,
  print,
  unsupported
};

/// `fail_at_frame` for a behaviour that every frame shows.
constexpr std::int64_t kEveryFrame = -1;

const std::vector<std::string>& behaviour_names() {
  static const std::vector<std::string> names{"normal",   "crash",     "hang",
                                              "nan",      "exception", "out_of_memory",
                                              "allocate", "print",     "unsupported"};
  return names;
}

Behaviour behaviour_of(const base::Parameters& parameters) {
  const std::vector<std::string>& names = behaviour_names();
  const auto found = std::ranges::find(names, parameters.text("behaviour"));
  return static_cast<Behaviour>(found - names.begin());
}

void sleep_for_s(double seconds) {
  if (seconds > 0.0) std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
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
    case Behaviour::unsupported:
      throw UnsupportedError("blank: asked to lack what the method needs");
    case Behaviour::normal:
    case Behaviour::nan:
      return;
  }
}

class BlankRenderer final : public Renderer {
 public:
  explicit BlankRenderer(const base::Parameters& parameters)
      : behaviour_(behaviour_of(parameters)),
        fail_at_frame_(parameters.integer("fail_at_frame")),
        radiance_(parameters.real("radiance")),
        radiance_per_frame_(parameters.real("radiance_per_frame")),
        prepare_sleep_s_(parameters.real("prepare_sleep_s")),
        update_sleep_s_(parameters.real("update_sleep_s")),
        sleep_s_(parameters.real("sleep_s")),
        readback_sleep_s_(parameters.real("readback_sleep_s")),
        checkpoints_(parameters.integer("checkpoints")) {}

  void prepare(const scene::Scene&, StageTimer& timer) override {
    const auto stage = timer.stage("build");
    sleep_for_s(prepare_sleep_s_);
  }

  void update(const scene::Scene&, StageTimer& timer) override {
    const auto stage = timer.stage("scene_update");
    sleep_for_s(update_sleep_s_);
  }

  Frame render(const RenderJob& job, StageTimer& timer) override {
    Frame frame;
    {
      const auto stage = timer.stage("transport");
      misbehave(behaviour_at(job.frame_index));
      sleep_for_s(sleep_s_);
      frame.radiance = make_image(job);
    }
    if (job.checkpoint && checkpoints_ > 0) {
      frame.counters.emplace_back("checkpoint_s", hand_over(frame.radiance, job, timer));
    }
    if (job.time_budget_s) frame.counters.emplace_back("time_budget_s", *job.time_budget_s);
    read_back(timer);
    return frame;
  }

 private:
  Behaviour behaviour_at(int frame) const {
    return fail_at_frame_ == kEveryFrame || fail_at_frame_ == frame ? behaviour_
                                                                    : Behaviour::normal;
  }

  perception::Image make_image(const RenderJob& job) const {
    perception::Image image =
        perception::make_rgb_image(job.width_px, job.height_px, perception::Encoding::scene_linear);
    const double value = radiance_ + radiance_per_frame_ * static_cast<double>(job.frame_index);
    if (value != 0.0) std::ranges::fill(image.pixels, static_cast<float>(value));
    if (behaviour_at(job.frame_index) == Behaviour::nan) {
      image.pixels.front() = std::numeric_limits<float>::quiet_NaN();
    }
    return image;
  }

  void read_back(StageTimer& timer) const {
    const auto stage = timer.stage("readback");
    sleep_for_s(readback_sleep_s_);
  }

  /// @return seconds spent in the sink
  double hand_over(const perception::Image& image, const RenderJob& job, StageTimer& timer) const {
    double sink_s = 0.0;
    for (std::int64_t i = 1; i <= checkpoints_; ++i) {
      read_back(timer);
      const double start_s = steady_seconds();
      job.checkpoint(image, i);
      sink_s += steady_seconds() - start_s;
    }
    return sink_s;
  }

  Behaviour behaviour_;
  std::int64_t fail_at_frame_;
  double radiance_;
  double radiance_per_frame_;
  double prepare_sleep_s_;
  double update_sleep_s_;
  double sleep_s_;
  double readback_sleep_s_;
  std::int64_t checkpoints_;
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
      "64 GiB at most; print: 3 MiB to stdout; unsupported: UnsupportedError.";
  return spec;
}

base::ParameterSpec fail_at_frame_spec() {
  constexpr double kMostFrames = 1e6;
  base::ParameterSpec spec;
  spec.name = "fail_at_frame";
  spec.type = base::ParameterType::integer;
  spec.default_value = kEveryFrame;
  spec.min = static_cast<double>(kEveryFrame);
  spec.max = kMostFrames;
  spec.doc = "The one frame that shows `behaviour`; -1: all do.";
  return spec;
}

base::ParameterSpec checkpoints_spec() {
  constexpr double kMostCheckpoints = 1000;
  base::ParameterSpec spec;
  spec.name = "checkpoints";
  spec.type = base::ParameterType::integer;
  spec.default_value = std::int64_t{0};
  spec.min = 0.0;
  spec.max = kMostCheckpoints;
  spec.unit = "images";
  spec.doc = "Images handed to a checkpoint sink, where there is one.";
  return spec;
}

Claims claims_of(const base::Parameters&, const scene::Scene&) {
  return {Transport::direct, Part::all, std::nullopt};
}

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
  info.supports = {Feature::point_light,      Feature::spot_light,  Feature::area_light,
                   Feature::emission_profile, Feature::environment, Feature::texture,
                   Feature::glossy,           Feature::animation};
  info.parameters = {
      real_spec("radiance", kMostRadiance, "W/(m2 sr)", "Value of every pixel."),
      real_spec("radiance_per_frame", kMostRadiance, "W/(m2 sr)",
                "Added to it once per frame number, so that frames differ."),
      behaviour_spec(),
      fail_at_frame_spec(),
      real_spec("sleep_s", kMostSleep_s, "s", "Seconds to sleep in render."),
      real_spec("prepare_sleep_s", kMostSleep_s, "s", "Seconds to sleep in prepare."),
      real_spec("update_sleep_s", kMostSleep_s, "s", "Seconds to sleep in update."),
      real_spec("readback_sleep_s", kMostSleep_s, "s",
                "Seconds to sleep in stage readback, once an image."),
      checkpoints_spec()};
  info.presets = {{"paper", {}}, {"best", {}}};
  info.create = create;
  return info;
}

}  // namespace renderers::blank
