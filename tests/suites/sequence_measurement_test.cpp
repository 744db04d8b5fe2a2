// Further frames, further views, and what a renderer keeps between its lives.
#include <cmath>

#include "suites/measurement.h"
#include "suites/stage_sums.h"
#include "tests/suites/measuring_fixture.h"

namespace {

using renderers::Phase;
using renderers::scene::Scene;
using results::RenderRecord;
using results::Status;
using suites::MeasuredRenderer;
using suites::Measurement;
using tests::Measuring;

std::vector<renderers::StageRecord> of_phase(const RenderRecord& record, Phase phase) {
  std::vector<renderers::StageRecord> stages;
  for (const renderers::StageRecord& stage : record.stages) {
    if (stage.phase == phase) stages.push_back(stage);
  }
  return stages;
}

/// What happened to a renderer that a test stands in for.
struct Diary {
  std::vector<std::shared_ptr<renderers::WarmStore>> stores;
  std::vector<renderers::scene::Camera> cameras;
  std::string fails_in;     ///< create | prepare | update | render
  int lives_that_fail = 0;  ///< the first ones; all if negative
};

/// Writes down what it is asked for, and fails where it is told to.
class DiaryRenderer final : public renderers::Renderer {
 public:
  DiaryRenderer(Diary& diary, bool fails) : diary_(diary), fails_(fails) { fail("create"); }
  void prepare(const Scene&, renderers::StageTimer&) override { fail("prepare"); }
  void update(const Scene&, renderers::StageTimer&) override { fail("update"); }
  renderers::Frame render(const renderers::RenderJob& job, renderers::StageTimer&) override {
    fail("render");
    diary_.cameras.push_back(job.camera);
    renderers::Frame frame;
    frame.radiance =
        perception::make_rgb_image(job.width_px, job.height_px, perception::Encoding::scene_linear);
    frame.device = "a rasterizer";
    frame.gl_platform = "osmesa";
    return frame;
  }

 private:
  void fail(const std::string& where) const {
    if (fails_ && diary_.fails_in == where) {
      throw renderers::UnsupportedError("no " + where + " on this device");
    }
  }
  Diary& diary_;
  bool fails_;
};

class MeasuringSequences : public Measuring {
 protected:
  MeasuringSequences() {
    const auto file = renderers::scene::read_scene_file(folder_.path() / "moving.yaml");
    for (int frame = 0; frame <= 5; ++frame) frames_.push_back(file.at_frame(frame));
  }

  suites::MeasureRequest frame_of(suites::MeasureRequest request, std::size_t frame, bool is_last) {
    request.scene = &frames_[frame];
    request.frame = static_cast<int>(frame);
    request.is_last = is_last;
    return request;
  }

  /// A request for the renderer that keeps the diary.
  suites::MeasureRequest diary_request() {
    suites::MeasureRequest made = request("blank");
    info_ = *made.method.info;
    info_.create = [this](const base::Parameters&, const renderers::Devices& devices) {
      diary_.stores.push_back(devices.warm);
      const auto life = static_cast<int>(diary_.stores.size());
      const bool fails = diary_.lives_that_fail < 0 || life <= diary_.lives_that_fail;
      return std::make_unique<DiaryRenderer>(diary_, fails);
    };
    made.method.info = &info_;
    return made;
  }

  std::vector<Scene> frames_;
  renderers::RendererInfo info_;
  Diary diary_;
};

TEST_F(MeasuringSequences, AFrameOfASequenceHasThePixelsOfAColdStartAtIt) {
  suites::MeasureRequest asked = request("path");
  asked.samples = 4;
  MeasuredRenderer renderer(asked.method, frames_[0], asked.devices,
                            {.renders = 1, .is_sequence = true});
  std::vector<std::string> hashes;
  for (std::size_t frame = 0; frame < frames_.size(); ++frame) {
    const suites::MeasureRequest one = frame_of(asked, frame, frame == 5);
    hashes.push_back(
        (frame == 0 ? renderer.measure(one) : renderer.measure_next(one)).record.pixel_hash);
  }
  for (std::size_t frame = 0; frame < frames_.size(); ++frame) {
    EXPECT_EQ(suites::measure_once(frame_of(asked, frame, true)).record.pixel_hash, hashes[frame])
        << frame;
  }
  EXPECT_NE(hashes[2], hashes[3]);  // the block has moved
  EXPECT_FALSE(renderer.has_next());
}

TEST_F(MeasuringSequences, TheNextFrameIsUpdateAndRenderWithoutReadback) {
  const suites::MeasureRequest asked =
      request("blank", {"prepare_sleep_s=0.3", "update_sleep_s=0.02", "sleep_s=0.03",
                        "readback_sleep_s=0.1", "radiance=1", "radiance_per_frame=0.5"});
  MeasuredRenderer renderer(asked.method, frames_[0], asked.devices, {.renders = 0});
  const RenderRecord first = renderer.measure(frame_of(asked, 0, false)).record;
  EXPECT_FALSE(first.next_frame_s.has_value());
  EXPECT_FALSE(first.update_s.has_value());
  ASSERT_TRUE(renderer.has_next());

  const Measurement measurement = renderer.measure_next(frame_of(asked, 3, true));
  const RenderRecord& next = measurement.record;
  EXPECT_EQ(next.frame, 3);
  EXPECT_EQ(measurement.frame.radiance.at(0, 0), 2.5F);
  EXPECT_TRUE(std::isnan(next.total_s));
  EXPECT_TRUE(std::isnan(next.prepare_s));
  EXPECT_GE(next.update_s.value(), 0.02);
  EXPECT_GE(next.readback_s, 0.1);
  EXPECT_GE(next.next_frame_s.value(), 0.02 + 0.03);
  EXPECT_DOUBLE_EQ(next.next_frame_s.value(),
                   next.update_s.value() + next.render_s - next.readback_s);
  EXPECT_LT(next.next_frame_s.value(), 0.3);  // nothing was prepared again
  EXPECT_NEAR(next.unattributed_s,
              next.next_frame_s.value() - (suites::top_level_s(next.stages) - next.readback_s),
              1e-12);
  EXPECT_TRUE(of_phase(next, Phase::prepare).empty());
  ASSERT_EQ(of_phase(next, Phase::update).size(), 1U);
  EXPECT_EQ(of_phase(next, Phase::update)[0].path, "scene_update");
  EXPECT_EQ(of_phase(next, Phase::render).size(), 2U);
}

TEST_F(MeasuringSequences, ATimeBudgetIsThatOfEachFrame) {
  suites::MeasureRequest asked = request("blank", {"prepare_sleep_s=0.05", "update_sleep_s=0.02"});
  asked.time_budget_s = 1.0;
  MeasuredRenderer renderer(asked.method, frames_[0], asked.devices, {.renders = 0});
  const RenderRecord first = renderer.measure(frame_of(asked, 0, false)).record;
  const RenderRecord next = renderer.measure_next(frame_of(asked, 1, true)).record;
  EXPECT_DOUBLE_EQ(number_of(first, "time_budget_s"), 1.0 - first.prepare_s);
  EXPECT_DOUBLE_EQ(number_of(next, "time_budget_s"), 1.0 - next.update_s.value());
}

TEST_F(MeasuringSequences, AFailureEndsTheSequence) {
  const suites::MeasureRequest asked = request("blank", {"behaviour=exception", "fail_at_frame=1"});
  MeasuredRenderer renderer(asked.method, frames_[0], asked.devices, {.renders = 0});
  EXPECT_EQ(renderer.measure(frame_of(asked, 0, false)).record.status, Status::ok);
  const RenderRecord failed = renderer.measure_next(frame_of(asked, 1, false)).record;
  EXPECT_EQ(failed.status, Status::crash);
  EXPECT_FALSE(failed.next_frame_s.has_value());
  EXPECT_FALSE(renderer.has_next());
}

TEST_F(MeasuringSequences, ANewViewIsTimedByItselfAndThrownAway) {
  suites::MeasureRequest asked =
      request("blank", {"prepare_sleep_s=0.04", "sleep_s=0.02", "readback_sleep_s=0.05"});
  const RenderRecord without = suites::measure_once(asked).record;
  EXPECT_FALSE(without.new_view_s.has_value());
  EXPECT_TRUE(of_phase(without, Phase::new_view).empty());
  asked.has_new_view = true;
  const RenderRecord record = suites::measure_once(asked).record;
  ASSERT_TRUE(record.new_view_s.has_value());
  EXPECT_GE(*record.new_view_s, 0.02);
  EXPECT_GE(record.readback_s, 0.05);
  EXPECT_LT(record.readback_s, 2 * 0.05);  // the new view's is not in it
  EXPECT_DOUBLE_EQ(record.total_s, record.prepare_s + record.render_s - record.readback_s);
  double stages_s = 0.0;
  for (const Phase phase : {Phase::prepare, Phase::render}) {
    stages_s += suites::top_level_s(of_phase(record, phase));
  }
  EXPECT_NEAR(record.unattributed_s, record.total_s - (stages_s - record.readback_s), 1e-12);
  EXPECT_EQ(of_phase(record, Phase::new_view).size(), 2U);
  EXPECT_EQ(record.pixel_hash, without.pixel_hash);
}

TEST_F(MeasuringSequences, ANewViewHasAnotherCamera) {
  suites::MeasureRequest asked = diary_request();
  asked.has_new_view = true;
  MeasuredRenderer renderer(asked.method, scene_, asked.devices, {.renders = 0});
  renderer.measure(asked);
  ASSERT_EQ(diary_.cameras.size(), 2U);
  EXPECT_EQ(diary_.cameras[0].position, scene_.camera.position);
  EXPECT_NE(diary_.cameras[1].position, scene_.camera.position);
  EXPECT_EQ(diary_.cameras[1].look_at, scene_.camera.look_at);
}

TEST_F(MeasuringSequences, ANewViewIsNoPartOfASequenceWithHistory) {
  suites::MeasureRequest asked = diary_request();
  info_.history = true;
  asked.has_new_view = true;
  MeasuredRenderer renderer(asked.method, frames_[0], asked.devices, {.renders = 0});
  EXPECT_FALSE(renderer.measure(frame_of(asked, 0, false)).record.new_view_s.has_value());
  EXPECT_EQ(diary_.cameras.size(), 1U);
  // Where nothing follows it disturbs nothing.
  EXPECT_TRUE(renderer.measure(frame_of(asked, 0, true)).record.new_view_s.has_value());
}

TEST_F(MeasuringSequences, RenderersOfOneProcessShareWhatIsWarm) {
  const suites::MeasureRequest asked = diary_request();
  MeasuredRenderer renderer(asked.method, scene_, asked.devices, {.renders = 1});
  renderer.measure(asked);
  renderer.measure(asked);
  ASSERT_EQ(diary_.stores.size(), 3U);  // the warm-up and two repetitions
  EXPECT_NE(diary_.stores[0], nullptr);
  EXPECT_EQ(diary_.stores[1], diary_.stores[0]);
  EXPECT_EQ(diary_.stores[2], diary_.stores[0]);
}

TEST_F(MeasuringSequences, TheWarmUpOfASequenceUpdates) {
  const suites::MeasureRequest asked = diary_request();
  const MeasuredRenderer still(asked.method, frames_[0], asked.devices, {.renders = 1});
  EXPECT_EQ(diary_.cameras.size(), 1U);
  const MeasuredRenderer moving(asked.method, frames_[0], asked.devices,
                                {.renders = 1, .is_sequence = true});
  EXPECT_EQ(diary_.cameras.size(), 3U);
  EXPECT_FALSE(moving.has_next());
}

TEST_F(MeasuringSequences, TheDeviceIsTheOneOfTheFrame) {
  const RenderRecord record = suites::measure_once(diary_request()).record;
  EXPECT_EQ(record.device, "a rasterizer");
  EXPECT_EQ(record.gl_platform, "osmesa");
  const RenderRecord on_cpu = suites::measure_once(request("blank")).record;
  EXPECT_EQ(on_cpu.device, "cpu");
  EXPECT_FALSE(on_cpu.gl_platform.has_value());
}

TEST_F(MeasuringSequences, WhatTheDeviceLacksIsUnsupported) {
  for (const std::string where : {"create", "prepare", "render"}) {
    const suites::MeasureRequest asked = diary_request();
    diary_.fails_in = where;
    diary_.lives_that_fail = -1;
    const RenderRecord record = suites::measure_once(asked).record;
    EXPECT_EQ(record.status, Status::unsupported) << where;
    EXPECT_EQ(record.reason, "no " + where + " on this device");
    EXPECT_TRUE(record.notes.empty());  // the warm-up lacked the same
  }
}

TEST_F(MeasuringSequences, AnUpdateThatTheDeviceLacksIsUnsupported) {
  const suites::MeasureRequest asked = diary_request();
  diary_.fails_in = "update";
  diary_.lives_that_fail = -1;
  MeasuredRenderer renderer(asked.method, frames_[0], asked.devices,
                            {.renders = 1, .is_sequence = true});
  EXPECT_EQ(renderer.measure(frame_of(asked, 0, false)).record.status, Status::ok);
  const RenderRecord next = renderer.measure_next(frame_of(asked, 1, false)).record;
  EXPECT_EQ(next.status, Status::unsupported);
  EXPECT_EQ(next.reason, "no update on this device");
  EXPECT_FALSE(renderer.has_next());
}

TEST_F(MeasuringSequences, AWarmUpThatLacksSomethingLeavesTheRepetitionToItself) {
  const suites::MeasureRequest asked = diary_request();
  diary_.fails_in = "render";
  diary_.lives_that_fail = 1;
  const RenderRecord record = suites::measure_once(asked).record;
  EXPECT_EQ(record.status, Status::ok);
  ASSERT_EQ(record.notes.size(), 1U);
  EXPECT_EQ(record.notes[0], "the warm-up failed: no render on this device");
}

}  // namespace
