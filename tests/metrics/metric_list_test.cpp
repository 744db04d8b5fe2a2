#include "metrics/metric_list.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "perception/base/names.h"
#include "tests/expect_input_error.h"

namespace {

using metrics::parse_metric_choice;
using tests::input_error_of;

std::string parse_error(const std::string& text) {
  return input_error_of([&] { parse_metric_choice(text, {"suite.yaml", 3, 7}); });
}

TEST(MetricList, IsSortedAndComplete) {
  std::vector<std::string> names;
  for (const auto& info : metrics::metric_list()) names.push_back(info.name);
  EXPECT_EQ(names, (std::vector<std::string>{"contrast-kept",
                                             "cvvdp",
                                             "daly-vdp",
                                             "delta-e-2000",
                                             "edge-excess",
                                             "flip",
                                             "holes",
                                             "leak",
                                             "mae",
                                             "ms-ssim",
                                             "mse",
                                             "penumbra-width",
                                             "psnr",
                                             "pu-ms-ssim",
                                             "pu-psnr",
                                             "pu-ssim",
                                             "relative-rmse",
                                             "relmse",
                                             "smape",
                                             "ssim",
                                             "threshold-ratio",
                                             "visible-difference",
                                             "yee"}));
}

TEST(MetricList, EveryEntryDescribesItself) {
  for (const auto& info : metrics::metric_list()) {
    EXPECT_EQ(info.name, base::kebab_case(info.name));
    EXPECT_FALSE(info.summary.empty()) << info.name;
    EXPECT_FALSE(info.source.empty()) << info.name;
    EXPECT_FALSE(info.input.empty()) << info.name;
    EXPECT_LT(info.map_scale.low, info.map_scale.high) << info.name;
    EXPECT_TRUE(!info.map_scale.is_logarithmic || info.map_scale.low > 0.0) << info.name;
    EXPECT_EQ(info.map_scale.unit, info.map_unit) << info.name;
    for (const auto& parameter : info.parameters) {
      EXPECT_EQ(parameter.name, base::snake_case(parameter.name)) << info.name;
      EXPECT_FALSE(parameter.doc.empty()) << info.name << " " << parameter.name;
    }
  }
}

TEST(MetricList, SaysWhichMetricsShareTheModelThatSteersARenderer) {
  for (const auto& info : metrics::metric_list()) {
    const bool is_threshold_model = info.name == "visible-difference" || info.name == "yee" ||
                                    info.name == "edge-excess" || info.name == "threshold-ratio";
    const std::vector<std::string> expected = is_threshold_model
                                                  ? std::vector<std::string>{"grid-final-gather"}
                                                  : std::vector<std::string>{};
    EXPECT_EQ(info.shares_model_with, expected) << info.name;
  }
}

TEST(MetricList, ReadsNamesAndParameters) {
  const auto choice = parse_metric_choice("flip,ppd=40,tonemapper=hable,start-exposure=-2.5", {});
  EXPECT_EQ(choice.text, "flip,ppd=40,tonemapper=hable,start-exposure=-2.5");
  EXPECT_EQ(choice.info->name, "flip");
  EXPECT_EQ(choice.parameters.real("ppd"), 40.0);
  EXPECT_EQ(choice.parameters.text("tonemapper"), "hable");
  EXPECT_EQ(choice.parameters.text("start_exposure"), "-2.5");
  EXPECT_EQ(choice.parameters.text("stop_exposure"), "auto");
  EXPECT_EQ(choice.parameters.integer("exposures"), 0);
}

TEST(MetricList, RefusesUnknownNamesWithTheNearest) {
  EXPECT_EQ(parse_error("relmes"),
            "suite.yaml:3:7: unknown metric \"relmes\"; did you mean \"relmse\"? known: "
            "contrast-kept, cvvdp, daly-vdp, delta-e-2000, edge-excess, flip, holes, leak, mae, "
            "ms-ssim, mse, penumbra-width, psnr, pu-ms-ssim, pu-psnr, pu-ssim, relative-rmse, "
            "relmse, smape, ssim, threshold-ratio, visible-difference, yee");
  EXPECT_EQ(parse_error("relmse,trm=0.1"),
            "suite.yaml:3:7: unknown parameter \"trm\"; did you mean \"trim\"? known: trim of "
            "metric \"relmse\"");
}

TEST(MetricList, RefusesBadValues) {
  EXPECT_EQ(parse_error("mse,trim=0.9"),
            "suite.yaml:3:7: parameter \"trim\" of metric \"mse\" cannot be \"0.9\"; accepted: a "
            "number from 0 to 0.5");
  EXPECT_EQ(parse_error("flip,start_exposure=bright"),
            "parameter \"start_exposure\" of metric \"flip\" cannot be \"bright\"; accepted: auto, "
            "or a number of stops from -100 to 100");
  EXPECT_EQ(parse_error("flip,start_exposure=nan").substr(0, 30),
            "parameter \"start_exposure\" of ");
  EXPECT_EQ(parse_error("flip,tonemapper=filmic"),
            "suite.yaml:3:7: parameter \"tonemapper\" of metric \"flip\" cannot be \"filmic\"; "
            "accepted: one of aces, hable, reinhard");
}

TEST(MetricList, RefusesMalformedSettings) {
  EXPECT_EQ(parse_error("mse,trim"),
            "suite.yaml:3:7: metric \"mse\": \"trim\" is not a setting; accepted: name=value");
  EXPECT_EQ(parse_error("flip,ppd=40,ppd=50"),
            "suite.yaml:3:7: metric \"flip\" is given parameter \"ppd\" twice");
  EXPECT_EQ(parse_error("flip,"),
            "suite.yaml:3:7: metric \"flip\": \"\" is not a setting; accepted: name=value");
}

}  // namespace
