#include "suites/worker_protocol.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/expect_input_error.h"

namespace {

using suites::Job;
using suites::Reply;

TEST(WorkerProtocol, OpenJobSurvivesTheTrip) {
  suites::OpenJob job;
  job.scene_file = "/scenes/with \"quotes\" and\nnewline.yaml";
  job.scene_overlays = {
      base::parse_document("{camera: {up: [0, 1.0, 0]}, environment: null}", "a.yaml"),
      base::parse_document("objects: {b: {mesh: {file: \"1\", up: 'a \"b\"'}}}", "a.yaml")};
  job.frame = 3;
  job.is_sequence = true;
  job.size_px = {40, 30};
  job.renderer = "path";
  job.preset = "paper";
  job.parameters = {{"a", std::int64_t{3}}, {"b", 2.0}, {"c", true}, {"d", std::string("yes")}};
  job.threads = 2;
  job.platform = "osmesa";
  job.warmups = 0;
  const std::string line = to_line(Job(job));
  EXPECT_EQ(line.find('\n'), std::string::npos);
  const auto again = std::get<suites::OpenJob>(suites::job_from_line(line));
  EXPECT_EQ(again.scene_file, job.scene_file);
  ASSERT_EQ(again.scene_overlays.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    // Kinds too: "1" stays text, 1.0 real.
    EXPECT_EQ(again.scene_overlays[i].to_json().dump(), job.scene_overlays[i].to_json().dump());
  }
  EXPECT_EQ(again.frame, 3);
  EXPECT_TRUE(again.is_sequence);
  EXPECT_EQ(again.size_px, job.size_px);
  EXPECT_EQ(again.preset, "paper");
  EXPECT_EQ(again.parameters, job.parameters);  // types too: 2.0 stays real
  EXPECT_EQ(again.threads, 2);
  EXPECT_EQ(again.platform, "osmesa");
  EXPECT_EQ(again.warmups, 0);
}

TEST(WorkerProtocol, RenderOrderSurvivesTheTrip) {
  suites::RenderOrder order;
  order.repetition = 7;
  order.frame = 12;
  order.is_cold = false;
  order.is_last = false;
  order.has_new_view = true;
  order.seed = 9007199254740993U;  // not a double
  order.time_s = 0.1;
  order.image = "a/frame.exr";
  order.checkpoint_folder = "a";
  order.known_pixel_hash = "0123";
  const auto again = std::get<suites::RenderOrder>(suites::job_from_line(to_line(Job(order))));
  EXPECT_EQ(again.repetition, 7);
  EXPECT_EQ(again.frame, 12);
  EXPECT_FALSE(again.is_cold);
  EXPECT_FALSE(again.is_last);
  EXPECT_TRUE(again.has_new_view);
  EXPECT_EQ(again.seed, order.seed);
  EXPECT_FALSE(again.samples.has_value());
  EXPECT_EQ(again.time_s, order.time_s);
  EXPECT_EQ(again.image, order.image);
  EXPECT_EQ(again.checkpoint_folder, order.checkpoint_folder);
  EXPECT_EQ(again.known_pixel_hash, "0123");
}

TEST(WorkerProtocol, RepliesSurviveTheTrip) {
  suites::Rendered rendered;
  rendered.record.status = results::Status::non_finite;
  rendered.record.reason = "1 of 4 pixels";
  rendered.record.renderer = "path";
  rendered.record.total_s = 0.125;
  rendered.record.next_frame_s = 0.25;
  rendered.checkpoints = {{0.5, 4, "checkpoint-000.exr"}};
  const auto again = std::get<suites::Rendered>(suites::reply_from_line(to_line(Reply(rendered))));
  EXPECT_EQ(again.record.status, results::Status::non_finite);
  EXPECT_EQ(again.record.reason, rendered.record.reason);
  EXPECT_DOUBLE_EQ(again.record.total_s, 0.125);
  EXPECT_EQ(again.record.next_frame_s, 0.25);
  ASSERT_EQ(again.checkpoints.size(), 1U);
  EXPECT_EQ(again.checkpoints[0].image, "checkpoint-000.exr");

  const Reply refused = suites::reply_from_line(to_line(Reply(suites::Refused{"no scene"})));
  EXPECT_EQ(std::get<suites::Refused>(refused).reason, "no scene");
  const suites::Reply full = suites::reply_from_line(to_line(Reply(suites::NotStored{"full"})));
  EXPECT_EQ(std::get<suites::NotStored>(full).reason, "full");
  const Reply opened = suites::reply_from_line(to_line(Reply(suites::Opened{0.5, "ff"})));
  EXPECT_DOUBLE_EQ(std::get<suites::Opened>(opened).start_up_s, 0.5);
}

TEST(WorkerProtocol, WhatIsNoJobIsNamed) {
  EXPECT_EQ(tests::input_error_of([] { suites::job_from_line(R"({"job": "opn"})"); }),
            "unknown job \"opn\"; did you mean \"open\"? known: open, render, close");
  EXPECT_NE(tests::input_error_of([] {
              suites::job_from_line("{\"job\": \"rend");
            }).find("not a job of the worker protocol"),
            std::string::npos);
  EXPECT_NE(tests::input_error_of([] {
              suites::job_from_line(R"({"job": "render"})");
            }).find("repetition"),
            std::string::npos);
}

}  // namespace
