#include "suites/measurement.h"

#include "perception/image_file.h"
#include "suites/stage_sums.h"
#include "tests/suites/measuring_fixture.h"

namespace {

using results::Status;
using suites::Measurement;
using tests::Measuring;

TEST_F(Measuring, RecordHoldsWhatWasAskedAndWhatWasDone) {
  suites::MeasureRequest asked = request("path", {"transport=one_bounce"});
  asked.samples = 3;
  asked.seed = 5;
  const Measurement measurement = suites::measure_once(asked);
  const results::RenderRecord& record = measurement.record;
  EXPECT_EQ(record.status, Status::ok);
  EXPECT_FALSE(record.reason.has_value());
  EXPECT_EQ(record.scene, "two-walls");
  EXPECT_EQ(record.renderer, "path");
  EXPECT_EQ(record.transport, "one_bounce");
  EXPECT_EQ(record.part, "all");
  EXPECT_EQ(record.samples, 3);
  // `--set samples=3` and `--samples 3` are one thing: the record's parameters say so.
  EXPECT_EQ(base::Parameters(record.parameters).integer("samples"), 3);
  EXPECT_EQ(record.seed, 5U);
  EXPECT_EQ(record.width_px, 12);
  EXPECT_EQ(record.threads, 1);
  EXPECT_EQ(record.pixel_hash, perception::pixel_hash(measurement.frame.radiance));
  EXPECT_GT(record.start_up_s, 0.0);
  EXPECT_GT(record.peak_memory_bytes, 1 << 20);
}

TEST_F(Measuring, TheClockAddsUp) {
  suites::MeasureRequest asked = request("path");
  asked.samples = 64;
  asked.checkpoint_folder = folder_.path();
  const results::RenderRecord record = suites::measure_once(asked).record;
  EXPECT_DOUBLE_EQ(record.total_s, record.prepare_s + record.render_s - record.readback_s);
  const double stages_s = suites::top_level_s(record.stages) - record.readback_s;
  EXPECT_NEAR(record.unattributed_s, record.total_s - stages_s, 1e-12);
  // Stages are spans inside prepare and render; what a checkpoint costs is in neither.
  EXPECT_GT(stages_s, 0.0);
  EXPECT_GE(record.unattributed_s, -1e-4);
  for (const renderers::StageRecord& stage : record.stages) {
    EXPECT_EQ(stage.path.find("checkpoint"), std::string::npos);
  }
}

TEST_F(Measuring, SleepIsInTheTotal) {
  const results::RenderRecord record =
      suites::measure_once(request("blank", {"sleep_s=0.05"})).record;
  EXPECT_GE(record.total_s, 0.05);
  EXPECT_GE(record.render_s, 0.05);
  EXPECT_LT(record.prepare_s, 0.05);
  EXPECT_GE(record.start_up_s, 0.05);  // the warm-up sleeps, too
  EXPECT_FALSE(record.samples.has_value());
}

TEST(WarmUp, HasSidesThatArePowersOfTwoWhereThePicturesHave) {
  for (const auto& [pictures, warm_up] : {std::pair{base::SizePx{512, 64}, base::SizePx{64, 64}},
                                          {base::SizePx{800, 600}, base::SizePx{56, 56}},
                                          {base::SizePx{1024, 768}, base::SizePx{64, 56}},
                                          {base::SizePx{1, 3}, base::SizePx{64, 56}}}) {
    const base::SizePx size = suites::warm_up_size(pictures);
    EXPECT_EQ(size.width, warm_up.width);
    EXPECT_EQ(size.height, warm_up.height);
  }
}

TEST_F(Measuring, TotalHoldsPrepareAndRenderButNoReadback) {
  suites::MeasureRequest asked =
      request("blank", {"prepare_sleep_s=0.02", "sleep_s=0.03", "readback_sleep_s=0.2"});
  suites::MeasuredRenderer renderer(asked.method, scene_, asked.devices, {.renders = 0});
  const double start_s = renderers::steady_seconds();
  const results::RenderRecord record = renderer.measure(asked).record;
  const double wall_s = renderers::steady_seconds() - start_s;
  EXPECT_GE(record.prepare_s, 0.02);
  EXPECT_GE(record.total_s, 0.02 + 0.03);
  EXPECT_GE(record.readback_s, 0.2);
  EXPECT_GE(wall_s - record.total_s, 0.2);
}

TEST_F(Measuring, CheckpointsRunOnTheClockOfTheTotal) {
  suites::MeasureRequest asked = request(
      "blank", {"prepare_sleep_s=0.02", "sleep_s=0.03", "readback_sleep_s=0.1", "checkpoints=3"});
  renderers::RendererInfo progressive = *asked.method.info;
  progressive.progressive_unit = "images";
  asked.method.info = &progressive;
  asked.size_px = {512, 512};  // large enough for writing to take its time
  asked.checkpoint_folder = folder_.path();
  suites::MeasuredRenderer renderer(asked.method, scene_, asked.devices, {.renders = 0});
  const double start_s = renderers::steady_seconds();
  const Measurement measurement = renderer.measure(asked);
  const double wall_s = renderers::steady_seconds() - start_s;
  const results::RenderRecord& record = measurement.record;
  ASSERT_EQ(record.status, Status::ok);

  // Three checkpoints and the image itself are read back; storing them is not in the total.
  const double sink_s = number_of(record, "checkpoint_s");
  EXPECT_GT(sink_s, 0.0);
  EXPECT_GE(record.total_s, 0.02 + 0.03);
  // Half of it: the renderer's own view of the sink holds what the machine did between the clocks.
  EXPECT_GE(wall_s - record.total_s, 4 * 0.1 + 0.5 * sink_s);
  EXPECT_GE(wall_s - record.readback_s - record.total_s, 0.5 * sink_s);

  ASSERT_EQ(measurement.checkpoints.size(), 3U);
  for (const results::Checkpoint& checkpoint : measurement.checkpoints) {
    EXPECT_GE(checkpoint.elapsed_s, 0.02 + 0.03);
    EXPECT_LE(checkpoint.elapsed_s, record.total_s);
  }
}

TEST_F(Measuring, WhatPrepareTookIsOffTheTimeBudget) {
  suites::MeasureRequest asked = request("blank", {"prepare_sleep_s=0.05"});
  asked.time_budget_s = 10.0;
  const results::RenderRecord record = suites::measure_once(asked).record;
  const double left_s = number_of(record, "time_budget_s");
  EXPECT_LE(left_s, 10.0 - 0.05);
  EXPECT_DOUBLE_EQ(left_s, 10.0 - record.prepare_s);
  asked.time_budget_s = 0.01;
  EXPECT_EQ(number_of(suites::measure_once(asked).record, "time_budget_s"), 0.0);
}

TEST_F(Measuring, RepetitionsGiveTheSamePixelsWhateverTheThreads) {
  suites::MeasureRequest asked = request("path");
  asked.samples = 4;
  const std::string once = suites::measure_once(asked).record.pixel_hash;
  EXPECT_EQ(suites::measure_once(asked).record.pixel_hash, once);
  asked.devices.threads = 2;
  EXPECT_EQ(suites::measure_once(asked).record.pixel_hash, once);
  asked.seed = 2;
  EXPECT_NE(suites::measure_once(asked).record.pixel_hash, once);
}

TEST_F(Measuring, CheckpointsAreImagesWithTimesThatGrow) {
  suites::MeasureRequest asked = request("path");
  asked.samples = 8;
  asked.checkpoint_folder = folder_.path();
  const Measurement measurement = suites::measure_once(asked);
  ASSERT_GE(measurement.checkpoints.size(), 2U);
  double last_s = 0.0;
  std::int64_t last_samples = 0;
  for (const results::Checkpoint& checkpoint : measurement.checkpoints) {
    EXPECT_GT(checkpoint.elapsed_s, last_s);
    EXPECT_GT(checkpoint.samples, last_samples);
    last_s = checkpoint.elapsed_s;
    last_samples = checkpoint.samples;
    EXPECT_EQ(perception::read_image(folder_.path() / checkpoint.image).width_px, 12);
  }
  EXPECT_LE(last_s, measurement.record.total_s);
}

TEST_F(Measuring, CheckpointsDoNotChangeThePixels) {
  suites::MeasureRequest asked = request("path");
  asked.samples = 8;
  const std::string without = suites::measure_once(asked).record.pixel_hash;
  asked.checkpoint_folder = folder_.path();
  EXPECT_EQ(suites::measure_once(asked).record.pixel_hash, without);
}

TEST_F(Measuring, ATimeBudgetIsKept) {
  suites::MeasureRequest asked = request("path");
  asked.time_budget_s = 0.15;
  const results::RenderRecord record = suites::measure_once(asked).record;
  EXPECT_EQ(record.status, Status::ok);
  EXPECT_GE(record.samples.value_or(0), 1);
  EXPECT_LT(record.total_s, 10.0);
}

TEST_F(Measuring, AnExceptionIsARecord) {
  const Measurement measurement = suites::measure_once(request("blank", {"behaviour=exception"}));
  EXPECT_EQ(measurement.record.status, Status::crash);
  EXPECT_EQ(measurement.record.reason, "exception: blank: asked to fail by an exception");
  EXPECT_TRUE(measurement.frame.radiance.is_empty());
  ASSERT_EQ(measurement.record.notes.size(), 1U);
  EXPECT_EQ(measurement.record.notes[0].find("the warm-up failed: "), 0U);
}

TEST_F(Measuring, AParameterThatTheRendererRefusesIsUnsupported) {
  const Measurement measurement =
      suites::measure_once(request("light-propagation", {"light_points=48"}));
  EXPECT_EQ(measurement.record.status, Status::unsupported);
  EXPECT_EQ(measurement.record.reason,
            "light-propagation: light_points is 48; accepted: powers of two");
  EXPECT_TRUE(measurement.is_refused);
  EXPECT_TRUE(measurement.record.notes.empty());
  EXPECT_FALSE(suites::measure_once(request("blank", {"behaviour=unsupported"})).is_refused);
}

/// The warm-up says how many images a frame has: no machine holds those of `path` at this size.
TEST_F(Measuring, APictureThatCannotFitIsNotBegun) {
  suites::MeasureRequest asked = request("path");
  asked.size_px = {65536, 65536};
  asked.samples = 1;
  const Measurement measurement = suites::measure_once(asked);
  EXPECT_EQ(measurement.record.status, Status::out_of_memory);
  EXPECT_EQ(measurement.record.reason.value_or("").find(
                "a picture of 65536x65536 pixels takes at least 608 GiB of memory (19 channels of "
                "4 bytes, 2 copies); "),
            0U)
      << measurement.record.reason.value_or("");
  EXPECT_TRUE(measurement.is_refused);
  EXPECT_TRUE(measurement.frame.radiance.is_empty());
}

TEST_F(Measuring, LackOfMemoryIsARecord) {
  const auto record = suites::measure_once(request("blank", {"behaviour=out_of_memory"})).record;
  EXPECT_EQ(record.status, Status::out_of_memory);
  EXPECT_EQ(record.reason, "the renderer ran out of memory (std::bad_alloc)");
}

TEST_F(Measuring, LackOfMemoryTellsWhatTheDeviceHadNoMemoryFor) {
  suites::MeasureRequest asked = request("blank");
  renderers::RendererInfo large = *asked.method.info;
  large.create = [](const base::Parameters&,
                    const renderers::Devices&) -> std::unique_ptr<renderers::Renderer> {
    throw renderers::DeviceMemoryError("OpenGL: out of memory while making a texture of 8x8");
  };
  asked.method.info = &large;
  const results::RenderRecord record = suites::measure_once(asked).record;
  EXPECT_EQ(record.status, Status::out_of_memory);
  EXPECT_EQ(record.reason,
            "the renderer ran out of memory (OpenGL: out of memory while making a texture of 8x8)");
}

TEST_F(Measuring, PixelsThatAreNoNumbersAreCountedAndKept) {
  const Measurement measurement = suites::measure_once(request("blank", {"behaviour=nan"}));
  EXPECT_EQ(measurement.record.status, Status::non_finite);
  EXPECT_EQ(measurement.record.non_finite_pixels, 1U);
  EXPECT_EQ(measurement.record.reason, "1 of 120 pixels are not finite, the first at (0, 0)");
  EXPECT_FALSE(measurement.frame.radiance.is_empty());
}

TEST_F(Measuring, AFeatureTheRendererLacksIsUnsupported) {
  suites::MeasureRequest asked = request("path");
  renderers::RendererInfo poor = *asked.method.info;
  poor.supports = {renderers::Feature::area_light};
  asked.method.info = &poor;
  asked.samples = 1;
  const results::RenderRecord record = suites::measure_once(asked).record;
  EXPECT_EQ(record.status, Status::unsupported);
  EXPECT_EQ(record.reason, "renderer \"path\" does not support point-light");
}

TEST_F(Measuring, TheImageFileCarriesItsProvenance) {
  suites::MeasureRequest asked = request("path");
  asked.samples = 2;
  const Measurement measurement = suites::measure_once(asked);
  const perception::ImageFile file =
      suites::image_file_of(measurement, scene_.luminance_scale_cd_m2);
  perception::write_exr(folder_.path() / "frame.exr", file);
  const perception::ImageFile again = perception::read_image_file(folder_.path() / "frame.exr");
  EXPECT_EQ(again.parts.front().name, "radiance");
  EXPECT_GT(again.parts.size(), 1U);
  EXPECT_EQ(perception::pixel_hash(again.parts.front().image), measurement.record.pixel_hash);
  EXPECT_EQ(again.attributes.text.at("discern:renderer"), "path");
  EXPECT_DOUBLE_EQ(again.attributes.number.at(perception::kLuminanceScaleAttribute), 50.0);
  EXPECT_DOUBLE_EQ(again.attributes.number.at("discern:samples"), 2.0);
}

}  // namespace
