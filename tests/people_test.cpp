// What the models see against what people see, by the catalogue's own suites: the figures that
// suites/catalog/psychophysics/README.md states must not get worse.
//
// With DISCERN_PICTURES=FOLDER a picture of the report is written there.
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "perception/base/child_process.h"
#include "tests/headless_browser.h"
#include "tests/places.h"
#include "tests/temporary_folder.h"

namespace tests {
namespace {

constexpr std::chrono::minutes kLongest{10};

/// {"experiments":[...]} of a suite's cells that match the filter.
nlohmann::json run_suite(const std::string& suite, const std::string& filter,
                         const TemporaryFolder& folder = {}) {
  const base::CommandResult result =
      base::run_command({tests::kProgram, "run", suite, "--filter", filter, "--json", "--results",
                         folder.path().string()},
                        kLongest);
  EXPECT_EQ(result.exit.code, 0) << result.stderr_text;
  return nlohmann::json::parse(result.stdout_text);
}

nlohmann::json model_of(const nlohmann::json& run, const std::string& experiment,
                        const std::string& model) {
  for (const auto& entry : run["experiments"]) {
    if (entry["id"] != experiment) continue;
    for (const auto& one : entry["models"]) {
      if (one["model"] == model) return one;
    }
  }
  ADD_FAILURE() << experiment << ", " << model;
  return {};
}

nlohmann::json phenomenon_of(const nlohmann::json& model, const std::string& id) {
  for (const auto& one : model["phenomena"]) {
    if (one["id"] == id) return one;
  }
  ADD_FAILURE() << id;
  return {};
}

TEST(People, SeePatternsAsTheCsfFiltersSay) {
  const auto run =
      run_suite("psychophysics/modelfest", R"(\.(pattern-castle-achromatic|pattern-daly|cvvdp)$)");
  const auto castle = model_of(run, "modelfest", "pattern-castle-achromatic");
  EXPECT_EQ(castle["thresholds"], 41);
  EXPECT_LT(castle["rms_db"].get<double>(), 2.0);  // no constant of it was fitted here
  EXPECT_LT(model_of(run, "modelfest", "pattern-daly")["rms_db"].get<double>(), 3.5);
  EXPECT_LT(model_of(run, "modelfest", "cvvdp")["rms_after_gain_db"].get<double>(), 3.0);
}

TEST(People, AreMaskedByNoiseInTheOrderThatOrientedChannelsSay) {
  const TemporaryFolder folder;
  const auto run = run_suite("psychophysics/masking", "^edge-in-noise", folder);
  const auto daly = model_of(run, "edge-in-noise", "daly-vdp");
  for (const char* order : {"order-0.048", "order-0.15", "order-0.95"}) {
    EXPECT_EQ(phenomenon_of(daly, order)["is_shown"], true) << order;
  }
  // Masking is what brings the elevations near: without it the same model is far off.
  const double with = model_of(run, "edge-in-noise", "visible-difference")["rms_db"];
  const double without = model_of(run, "edge-in-noise", "visible-difference-off")["rms_db"];
  EXPECT_LT(with, 5.5);
  EXPECT_GT(without, 8.0);

  if (!has_browser()) GTEST_SKIP() << "chromium is not installed";
  const char* kept = std::getenv("DISCERN_PICTURES");
  const auto picture =
      (kept != nullptr ? std::filesystem::path(kept) : folder.path()) / "psychophysics.png";
  const base::CommandResult shown =
      browse(run["report"].get<std::string>(), folder.path() / "profile",
             {"--screenshot=" + picture.string(), "--force-device-scale-factor=0.6",
              "--window-size=1400,1340"});
  EXPECT_EQ(console_lines(shown.stderr_text), "");
  ASSERT_TRUE(std::filesystem::exists(picture)) << shown.stderr_text;
  EXPECT_GT(std::filesystem::file_size(picture), 20000U);
}

TEST(People, NeedMoreOnStrongPedestalsAsTheMaskingCurveSays) {
  const auto run = run_suite("psychophysics/masking",
                             R"(dipper.*\.(visible-difference|visible-difference-off)$)");
  const auto model = model_of(run, "dipper", "visible-difference");
  EXPECT_EQ(phenomenon_of(model, "slope")["is_shown"], true);
  // The curve has no facilitation: the dip is not there, and the table says so.
  EXPECT_EQ(phenomenon_of(model, "dip")["is_shown"], false);
  EXPECT_EQ(phenomenon_of(model_of(run, "dipper", "visible-difference-off"), "slope")["is_shown"],
            false);
}

TEST(People, SeeBetterInTheLightAtTheFrequenciesThatTheCsfsSay) {
  const auto run = run_suite("psychophysics/contrast-sensitivity",
                             R"(\.(castle-achromatic|hdr-vdp2|hdr-vdp3)$)");
  const auto castle = model_of(run, "luminance", "castle-achromatic");
  for (const char* id : {"dark", "bright", "devries-rose"}) {
    EXPECT_EQ(phenomenon_of(castle, id)["is_shown"], true) << id;
  }
  EXPECT_LT(model_of(run, "luminance", "hdr-vdp2")["rms_after_gain_db"].get<double>(), 2.0);
  EXPECT_EQ(
      phenomenon_of(model_of(run, "eccentricity", "castle-achromatic"), "periphery")["is_shown"],
      true);
}

}  // namespace
}  // namespace tests
