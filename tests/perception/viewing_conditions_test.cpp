#include "perception/viewing_conditions.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "perception/base/errors.h"
#include "tests/expect_error.h"

namespace perception {
namespace {

ViewingConditions read(const std::string& text) {
  return read_viewing_conditions(base::parse_document(text, "s.yaml"));
}

void expect_refused(const std::string& text, const std::string& message) {
  tests::expect_error<base::InputError>([&] { read(text); }, message);
}

TEST(PixelsPerDegree, AreThoseOfThePublishedDisplays) {
  EXPECT_NEAR(viewing_preset("standard_4k", {}).pixels_per_degree, 75.402, 5e-4);
  EXPECT_NEAR(viewing_preset("standard_fhd", {}).pixels_per_degree, 37.843, 5e-4);
  // FLIP's 0.7 m, 0.7 m, 3840 px: its small-angle form differs in the eighth digit only.
  EXPECT_NEAR(pixels_per_degree(0.7 / 3840.0, 0.7), default_viewing_conditions().pixels_per_degree,
              1e-6);
  EXPECT_NEAR(default_viewing_conditions().pixels_per_degree, 67.0206, 5e-5);
  // One pixel that fills 90 degrees.
  EXPECT_NEAR(pixels_per_degree(2.0, 1.0), 1.0 / 90.0, 1e-15);
}

TEST(ViewingPreset, HdrDisplaysAre1500NitInADimRoom) {
  for (const std::string name : {"standard_hdr_pq", "standard-hdr-hlg", "standard_hdr_linear"}) {
    const ViewingConditions viewing = viewing_preset(name, {});
    EXPECT_EQ(viewing.peak_cd_m2, 1500.0);
    EXPECT_EQ(viewing.black_cd_m2, 0.0015);  // 1,000,000:1
    EXPECT_EQ(viewing.ambient_lux, 10.0);
    EXPECT_NEAR(viewing.pixels_per_degree, 75.402, 5e-4);
  }
  EXPECT_EQ(viewing_preset("standard_hdr_pq", {}).transfer, DisplayTransfer::pq);
  EXPECT_EQ(viewing_preset("standard_hdr_hlg", {}).transfer, DisplayTransfer::hlg);
}

TEST(ViewingPreset, EveryNameWorksAndAnUnknownOneIsTold) {
  for (const std::string& name : viewing_preset_names()) {
    EXPECT_EQ(viewing_preset(name, {}).origins.display, "preset");
  }
  tests::expect_error<base::InputError>(
      [] {
        viewing_preset("standard_5k", {"s.yaml", 3, 7});
      },
      "s.yaml:3:7: unknown viewing preset \"standard_5k\"; did you mean \"standard_4k\"? known: "
      "flip, standard_4k, standard_fhd, standard_phone, standard_hdr, standard_hdr_pq, "
      "standard_hdr_hlg, standard_hdr_linear, standard_hdr_linear_dark, standard_hdr_linear_zoom, "
      "sdr_4k_30, sdr_fhd_24");
}

TEST(ViewingPreset, NumbersOfTheOtherPublishedDisplays) {
  const ViewingConditions zoom = viewing_preset("standard_hdr_linear_zoom", {});
  EXPECT_EQ(zoom.peak_cd_m2, 10000.0);
  EXPECT_EQ(zoom.black_cd_m2, 0.01);
  EXPECT_NEAR(zoom.pixels_per_degree, 75.402 * 0.25 / 0.7472, 2e-2);
  const ViewingConditions phone = viewing_preset("standard_phone", {});
  EXPECT_EQ(phone.black_cd_m2, 0.05);
  // 6 inches over sqrt(2400^2 + 1080^2) pixels at 0.4 m.
  EXPECT_NEAR(phone.pixels_per_degree, 120.56, 0.01);
  EXPECT_EQ(viewing_preset("sdr_fhd_24", {}).peak_cd_m2, 100.0);
  EXPECT_EQ(viewing_preset("standard_hdr_linear_dark", {}).ambient_lux, 0.0);
  EXPECT_EQ(hash_of(viewing_preset("standard_hdr", {})),
            hash_of(viewing_preset("standard_hdr_pq", {})));
}

TEST(ReadViewing, TheSuiteFormOfTheDesign) {
  const ViewingConditions viewing = read(
      "{ppd: 60, display: {peak_cd_m2: 400, black_cd_m2: 0.1, ambient_lux: 50, transfer: pq}, "
      "exposure: scene}");
  EXPECT_EQ(viewing.pixels_per_degree, 60.0);
  EXPECT_EQ(viewing.peak_cd_m2, 400.0);
  EXPECT_EQ(viewing.black_cd_m2, 0.1);
  EXPECT_EQ(viewing.ambient_lux, 50.0);
  EXPECT_EQ(viewing.transfer, DisplayTransfer::pq);
  EXPECT_TRUE(takes_exposure_from_scene(viewing));
  EXPECT_EQ(viewing.exposure_ev, 0.0);
  EXPECT_EQ(viewing.luminance_scale_origin, "default");
  EXPECT_EQ(viewing.origins.display, "suite");
}

TEST(ReadViewing, PresetDistanceExposureAndScale) {
  const ViewingConditions viewing = read(
      "preset: standard_fhd\ndisplay: {ambient_lux: 10}\nexposure: -1.5\n"
      "luminance_scale_cd_m2: 250\n");
  EXPECT_NEAR(viewing.pixels_per_degree, 37.843, 5e-4);
  EXPECT_EQ(viewing.ambient_lux, 10.0);
  EXPECT_EQ(viewing.peak_cd_m2, 200.0);
  EXPECT_EQ(viewing.exposure_ev, -1.5);
  EXPECT_FALSE(takes_exposure_from_scene(viewing));
  EXPECT_EQ(viewing.luminance_scale_cd_m2, 250.0);
  EXPECT_EQ(viewing.luminance_scale_origin, "suite");
  const ViewingConditions measured =
      read("{distance_m: 0.7, width_m: 0.7, resolution: [3840, 2160]}");
  EXPECT_NEAR(measured.pixels_per_degree, 67.0206, 5e-5);
  EXPECT_TRUE(takes_exposure_from_scene(measured));
}

TEST(ReadViewing, BadInputSaysWhereAndWhatIsAccepted) {
  expect_refused("{exposure: 0}",
                 "s.yaml:1:1: viewing says nothing about distance; accepted: preset, ppd, or "
                 "distance_m with width_m and resolution");
  expect_refused("{ppd: 0.5}", "s.yaml:1:7: ppd is 0.5; accepted: from 1 to 1000");
  expect_refused("{ppd: 60, display: {peak_cd_m2: 0}}",
                 "s.yaml:1:33: peak_cd_m2 is 0; accepted: above 0 to 100000");
  expect_refused("{ppd: 60, display: {peak_cd_m2: 10, black_cd_m2: 20}}",
                 "s.yaml:1:50: black_cd_m2 is 20; accepted: below peak_cd_m2, 10");
  expect_refused("{ppd: 60, display: {ambient_lux: -1}}",
                 "s.yaml:1:34: ambient_lux is -1; accepted: from 0 to 200000");
  expect_refused("{ppd: 60, exposure: bright}",
                 "s.yaml:1:21: exposure is bright; accepted: scene, or stops from -64 to 64");
  expect_refused("{ppd: 60, exposure: 65}",
                 "s.yaml:1:21: exposure is 65; accepted: from -64 to 64");
  expect_refused("{ppd: 60, luminance_scale_cd_m2: 0}",
                 "s.yaml:1:34: luminance_scale_cd_m2 is 0; accepted: above 0 to 1000000000");
  expect_refused("{ppd: 60, distance_m: 1, width_m: 1, resolution: [9, 9]}",
                 "s.yaml:1:23: viewing has both ppd and distance_m; accepted: one of them");
  expect_refused("{ppd: 60, display: {transfer: gamma}}",
                 "s.yaml:1:31: unknown display transfer \"gamma\"; known: srgb, bt1886, pq, hlg, "
                 "linear_hdr");
}

TEST(ReadViewing, UnknownKeysAreRefusedWithTheirPlace) {
  tests::expect_error_with<base::InputError>(
      [] { read("{ppd: 60, exposur: 1}"); },
      {"s.yaml:1:11", "exposur", "exposure", "luminance_scale_cd_m2"});
  tests::expect_error_with<base::InputError>([] { read("{ppd: 60, display: {peak: 1}}"); },
                                             {"s.yaml:1:21", "peak", "peak_cd_m2"});
  tests::expect_error_with<base::InputError>([] { read("{distance_m: 1, width_m: 1}"); },
                                             {"s.yaml:1:1", "resolution"});
}

TEST(Viewing, JsonHoldsConditionsAndOrigins) {
  ViewingConditions viewing = read("{preset: standard_4k, exposure: 2}");
  viewing.luminance_scale_origin = "scene";
  const nlohmann::ordered_json json = to_json(viewing);
  EXPECT_EQ(json["display"].dump(),
            R"({"transfer":"srgb","peak_cd_m2":200.0,"black_cd_m2":0.2,"ambient_lux":250.0,)"
            R"("screen_reflectance":0.005})");
  EXPECT_EQ(json["exposure_ev"], 2.0);
  EXPECT_EQ(json["origins"].dump(), R"({"ppd":"preset","display":"preset","exposure_ev":"suite",)"
                                    R"("luminance_scale_cd_m2":"scene"})");
}

TEST(Viewing, HashChangesWithEveryConditionAndNotWithOrigins) {
  const base::Hash hash = hash_of(ViewingConditions{});
  ViewingConditions other;
  other.luminance_scale_origin = "file";
  other.origins.display = "suite";
  EXPECT_EQ(hash_of(other), hash);
  for (double ViewingConditions::*member :
       {&ViewingConditions::pixels_per_degree, &ViewingConditions::peak_cd_m2,
        &ViewingConditions::black_cd_m2, &ViewingConditions::ambient_lux,
        &ViewingConditions::screen_reflectance, &ViewingConditions::exposure_ev,
        &ViewingConditions::luminance_scale_cd_m2}) {
    other = {};
    other.*member += 0.001;
    EXPECT_NE(hash_of(other), hash);
  }
  other = {};
  other.transfer = DisplayTransfer::pq;
  EXPECT_NE(hash_of(other), hash);
}

TEST(Viewing, IsDescribedInOneLine) {
  ViewingConditions viewing;
  EXPECT_EQ(describe(viewing),
            "67.0 ppd, sRGB, 200 cd/m2 peak, 0.2 black, 250 lux, 1.0 = 100 cd/m2 (default)");
  viewing.exposure_ev = -1.5;
  EXPECT_EQ(describe(viewing),
            "67.0 ppd, sRGB, 200 cd/m2 peak, 0.2 black, 250 lux, 1.0 = 100 cd/m2 (default), "
            "exposure -1.5 EV");
}

}  // namespace
}  // namespace perception
