#include "results/run_record.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/expect_input_error.h"
#include "tests/results/synthetic_run.h"

namespace {

using nlohmann::ordered_json;
using test_results::full_cell_record;
using test_results::full_metric_record;
using test_results::full_render_record;
using tests::input_error_of;

std::vector<std::string> keys_of(const ordered_json& json) {
  std::vector<std::string> keys;
  for (const auto& [key, value] : json.items()) keys.push_back(key);
  return keys;
}

const std::vector<std::string> kRenderKeys{"schema",
                                           "status",
                                           "reason",
                                           "scene",
                                           "scene_hash",
                                           "renderer",
                                           "preset",
                                           "parameters",
                                           "transport",
                                           "part",
                                           "geometry_clamp",
                                           "size_px",
                                           "seed",
                                           "frame",
                                           "samples",
                                           "device",
                                           "gl_platform",
                                           "threads",
                                           "total_s",
                                           "next_frame_s",
                                           "new_view_s",
                                           "prepare_s",
                                           "update_s",
                                           "render_s",
                                           "start_up_s",
                                           "readback_s",
                                           "stages",
                                           "unattributed_s",
                                           "counters",
                                           "peak_memory_bytes",
                                           "non_finite_pixels",
                                           "pixel_hash",
                                           "image",
                                           "notes"};

TEST(RunRecord, RenderFieldsComeInTheDocumentedOrder) {
  EXPECT_EQ(keys_of(to_json(full_render_record())), kRenderKeys);
}

TEST(RunRecord, StageFieldsComeInTheDocumentedOrder) {
  const ordered_json json = to_json(full_render_record());
  const std::vector<std::string> expected{"phase", "path",  "wall_s",    "cpu_s",    "gpu_s",
                                          "clock", "calls", "bytes_cpu", "bytes_gpu"};
  EXPECT_EQ(keys_of(json["stages"][0]), expected);
  EXPECT_TRUE(json["stages"][0]["gpu_s"].is_null());
  EXPECT_EQ(json["stages"][1]["gpu_s"], 0.15);
  EXPECT_EQ(json["stages"][1]["clock"], "gpu-query");
}

TEST(RunRecord, CellLineHasTheSceneOnceAndCheckpointsLast) {
  std::vector<std::string> expected{"schema",      "run",     "cell",     "scene",
                                    "method",      "budget",  "profile",  "repetition",
                                    "started_utc", "machine", "canary_s", "jobs"};
  for (const std::string& key : kRenderKeys) {
    if (key != "schema" && key != "scene") expected.push_back(key);
  }
  expected.push_back("checkpoints");
  EXPECT_EQ(keys_of(to_json(full_cell_record())), expected);
}

TEST(RunRecord, MetricFieldsComeInTheDocumentedOrder) {
  const std::vector<std::string> expected{"schema",       "cell",
                                          "frame",        "against",
                                          "image_hash",   "reference_hash",
                                          "metric",       "parameters",
                                          "version",      "viewing_hash",
                                          "value",        "infinite",
                                          "details",      "map",
                                          "noise_floor",  "reference_pixel_hash",
                                          "context_hash", "id",
                                          "image",        "mask",
                                          "mask_hash"};
  EXPECT_EQ(keys_of(to_json(full_metric_record())), expected);
}

TEST(RunRecord, TextGivesBackTheSameRecord) {
  const std::string render = to_json(full_render_record()).dump();
  EXPECT_EQ(to_json(results::render_record_from_json(ordered_json::parse(render))).dump(), render);
  const std::string cell = to_json(full_cell_record()).dump();
  EXPECT_EQ(to_json(results::cell_record_from_json(ordered_json::parse(cell))).dump(), cell);
  results::MetricRecord score = full_metric_record();
  score.id = "edges";
  score.image = "irradiance";
  score.mask = "normal";
  score.mask_hash = "c0de";
  const std::string metric = to_json(score).dump();
  EXPECT_EQ(to_json(results::metric_record_from_json(ordered_json::parse(metric))).dump(), metric);
}

TEST(RunRecord, ReadingKeepsTypesAndExtremes) {
  const auto record = results::render_record_from_json(to_json(full_render_record()));
  EXPECT_EQ(record.seed, 18446744073709551615ULL);
  EXPECT_EQ(record.status, results::Status::non_finite);
  EXPECT_EQ(std::get<double>(record.counters[0].second), 1024.0);
  EXPECT_EQ(std::get<std::vector<double>>(record.counters[1].second)[1], 2.5);
  EXPECT_EQ(std::get<std::int64_t>(record.parameters[0].second), 8);
  EXPECT_EQ(std::get<double>(record.parameters[1].second), 0.5);
  EXPECT_LT(record.stages[0].gpu_s, 0.0);
}

TEST(RunRecord, NonFiniteNumbersAreNull) {
  auto record = full_render_record();
  record.total_s = std::nan("");
  record.counters = {{"ratio", std::numeric_limits<double>::infinity()}};
  const ordered_json json = to_json(record);
  EXPECT_TRUE(json["total_s"].is_null());
  EXPECT_TRUE(json["counters"]["ratio"].is_null());
  EXPECT_TRUE(std::isnan(results::render_record_from_json(json).total_s));

  auto metric = full_metric_record();
  metric.value = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(to_json(metric)["value"].is_null());
  EXPECT_FALSE(results::metric_record_from_json(to_json(metric)).value.has_value());
}

TEST(RunRecord, AnInfiniteScoreIsKeptApartFromNoNumber) {
  auto metric = full_metric_record();
  EXPECT_EQ(to_json(metric)["infinite"], false);
  metric.value.reset();
  EXPECT_FALSE(results::metric_record_from_json(to_json(metric)).is_infinite);
  metric.is_infinite = true;
  EXPECT_TRUE(results::metric_record_from_json(to_json(metric)).is_infinite);
  metric.is_infinite = false;
  metric.value = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(results::metric_record_from_json(to_json(metric)).is_infinite);

  ordered_json older = to_json(metric);
  older.erase("infinite");
  EXPECT_FALSE(results::metric_record_from_json(older).is_infinite);
  older["infinite"] = 1;
  EXPECT_EQ(input_error_of([&] { results::metric_record_from_json(older); }),
            "metric record: field \"infinite\" must be true or false, found 1");
}

TEST(RunRecord, WholeCountersAreWrittenWithoutAFraction) {
  EXPECT_EQ(to_json(full_render_record())["counters"].dump(), R"({"rays":1024,"links":[1,2.5]})");
}

TEST(RunRecord, AMissingFieldIsNamed) {
  ordered_json json = to_json(full_cell_record());
  json.erase("threads");
  EXPECT_EQ(input_error_of([&] { results::cell_record_from_json(json); }),
            "cell record: field \"threads\" is missing");
}

TEST(RunRecord, AMistypedFieldIsNamedWithWhatWasFound) {
  ordered_json json = to_json(full_render_record());
  json["size_px"] = {640};
  EXPECT_EQ(input_error_of([&] { results::render_record_from_json(json); }),
            "render record: field \"size_px\" must be [width, height], found [640]");
  json = to_json(full_render_record());
  json["stages"][1]["wall_s"] = "fast";
  EXPECT_EQ(input_error_of([&] { results::render_record_from_json(json); }),
            "render record: stages[1]: field \"wall_s\" must be a number or null, found \"fast\"");
  json = to_json(full_render_record());
  json["parameters"]["max_depth"] = ordered_json::array();
  EXPECT_EQ(input_error_of([&] { results::render_record_from_json(json); }),
            "render record: field \"parameters.max_depth\" must be a boolean, a number or text, "
            "found []");
}

TEST(RunRecord, UnknownStatusNamesTheNearestOne) {
  ordered_json json = to_json(full_render_record());
  json["status"] = "timeuot";
  EXPECT_EQ(
      input_error_of([&] { results::render_record_from_json(json); }),
      "render record: field \"status\": unknown status \"timeuot\"; did you mean \"timeout\"? "
      "known: ok, cached, timeout, crash, out_of_memory, non_finite, diverged, unsupported, "
      "skipped");
}

TEST(RunRecord, ANewerSchemaIsRefused) {
  ordered_json json = to_json(full_metric_record());
  json["schema"] = 2;
  EXPECT_EQ(input_error_of([&] { results::metric_record_from_json(json); }),
            "metric record: schema 2 is newer than this program reads; accepted: 1 to 1");
}

TEST(RunRecord, FieldsAddedLaterAreNoError) {
  ordered_json json = to_json(full_metric_record());
  json["added_later"] = 1;
  EXPECT_NO_THROW(results::metric_record_from_json(json));
}

TEST(RunRecord, EveryStatusHasAName) {
  using results::Status;
  for (const Status status :
       {Status::ok, Status::cached, Status::timeout, Status::crash, Status::out_of_memory,
        Status::non_finite, Status::diverged, Status::unsupported, Status::skipped}) {
    EXPECT_EQ(results::status_from_text(results::to_string(status)), status);
    EXPECT_EQ(results::is_success(status), status == Status::ok || status == Status::cached);
  }
}

TEST(RunRecord, LinesOfEarlierVersionsHaveNoFurtherFrames) {
  ordered_json json = to_json(full_render_record());
  for (const char* key : {"next_frame_s", "new_view_s", "update_s"}) json.erase(key);
  const auto record = results::render_record_from_json(json);
  EXPECT_FALSE(record.next_frame_s.has_value());
  EXPECT_FALSE(record.new_view_s.has_value());
  EXPECT_FALSE(record.update_s.has_value());
  EXPECT_EQ(timed_s(record), 1.5);
}

TEST(RunRecord, AFollowingFrameHasNoTotal) {
  results::RenderRecord record = full_render_record();
  record.total_s = std::nan("");
  record.prepare_s = std::nan("");
  record.stages[0].phase = renderers::Phase::update;
  record.stages[1].phase = renderers::Phase::new_view;
  const ordered_json json = to_json(record);
  EXPECT_TRUE(json["total_s"].is_null());
  EXPECT_EQ(json["next_frame_s"], 0.25);
  const auto again = results::render_record_from_json(json);
  EXPECT_TRUE(std::isnan(again.total_s));
  EXPECT_EQ(timed_s(again), 0.25);
  EXPECT_EQ(again.update_s, 0.0625);
  EXPECT_EQ(again.stages[0].phase, renderers::Phase::update);
  EXPECT_EQ(again.stages[1].phase, renderers::Phase::new_view);
}

}  // namespace
