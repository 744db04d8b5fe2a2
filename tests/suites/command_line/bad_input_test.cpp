#include "tests/places.h"
#include "tests/suites/command_line/program_test.h"

namespace tests {
namespace {

class BadInput : public ProgramTest {
 protected:
  std::vector<std::string> render(const std::vector<std::string>& more) const {
    std::vector<std::string> all{"render", "--scene", "furnace", "--renderer", "path",
                                 "--size", "8x8",     "--out",   path("a.exr")};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }

  /// Expects exit code 2 and a message that begins so.
  void expect_message_begins(const std::vector<std::string>& words,
                             const std::string& message) const {
    const base::CommandResult result = discern(words);
    EXPECT_EQ(result.exit.code, 2);
    EXPECT_EQ(result.stdout_text, "");
    EXPECT_EQ(result.stderr_text.find("discern: error: " + message), 0U) << result.stderr_text;
  }
};

TEST_F(BadInput, VerbsAndOptions) {
  expect_refused(
      {},
      "no verb given; known: list, check, run, render, diff, thresholds, ref, eval, "
      "report, claims, papers, accept, compare, figure, view, table, cheapest, history, bisect, "
      "merge, doctor, schema, completions, man; "
      "see discern --help");
  expect_refused(
      {"rendr"},
      "unknown verb \"rendr\"; did you mean \"render\"? known: list, check, run, render, "
      "diff, thresholds, ref, eval, report, claims, papers, accept, compare, figure, view, table, "
      "cheapest, "
      "history, bisect, merge, doctor, schema, completions, man");
  expect_message_begins({"render", "--scne", "furnace"},
                        "discern render: unknown option \"--scne\"; did you mean \"--scene\"? "
                        "known: ");
  expect_message_begins({"diff", "a", "b", "--fail-abov=1"},
                        "discern diff: unknown option \"--fail-abov\"; did you mean "
                        "\"--fail-above\"? known: ");
  expect_refused({"render", "--scene", "furnace", "--renderer", "path", "--size", "8x8"},
                 "discern render: --out is required; see discern render --help");
  expect_message_begins({"list"}, "discern list: ");
  expect_message_begins({"--versoin"}, "discern: ");
  expect_message_begins({"list", "scenes", "suites"}, "discern list: ");
}

TEST_F(BadInput, NumbersAndSizes) {
  expect_refused(render({"--samples", "many"}),
                 "--samples: \"many\" is not accepted; accepted: a whole number from 1 to "
                 "2147483647");
  expect_refused(render({"--samples=0"}),
                 "--samples: \"0\" is not accepted; accepted: a whole number from 1 to 2147483647");
  expect_refused(render({"--seed", "-1"}),
                 "--seed: \"-1\" is not accepted; accepted: a whole number from 0 to 2147483647");
  expect_refused(render({"--exposure", "bright"}),
                 "--exposure: \"bright\" is not accepted; accepted: a number");
  expect_message_begins(render({"--time", "10"}), "--time: ");
  expect_message_begins(
      {"render", "--scene", "furnace", "--renderer", "path", "--size", "8", "--out", path("a.exr")},
      "--size: ");
}

TEST_F(BadInput, NamesOfRenderersPresetsParametersAndScenes) {
  expect_message_begins({"render", "--scene", "furnace", "--renderer", "pth", "--size", "8x8",
                         "--out", path("a.exr")},
                        "--renderer: unknown renderer \"pth\"; did you mean \"path\"? known: ");
  expect_message_begins(render({"--preset", "papr"}), "--preset: ");
  expect_message_begins(render({"--set", "max_dept=3"}),
                        "--set: unknown parameter \"max_dept\"; did you mean \"max_depth\"?");
  expect_message_begins(render({"--set", "max_depth=deep"}), "--set: ");
  expect_refused(render({"--set", "max_depth"}),
                 "--set: \"max_depth\" is not a setting; accepted: name=value");
  expect_message_begins({"render", "--scene", "furnce", "--renderer", "path", "--size", "8x8",
                         "--out", path("a.exr")},
                        "--scene: unknown scene \"furnce\"; did you mean \"furnace\"?");
  expect_refused(render({"--device", "osmes"}),
                 "--device: unknown device \"osmes\"; did you mean \"osmesa\"? known: auto, "
                 "egl-device, egl-surfaceless, osmesa");
}

TEST_F(BadInput, OneBudgetAtATime) {
  expect_refused(render({"--samples", "4", "--time", "1s"}),
                 "--time: cannot be given together with a number of samples");
}

TEST_F(BadInput, OutputsThatCannotBeWritten) {
  expect_refused({"render", "--scene", "furnace", "--renderer", "path", "--size", "8x8", "--out",
                  path("a.jpg")},
                 "--out: \"" + path("a.jpg") + "\" has extension \".jpg\"; accepted: .exr, .png");
  expect_refused({"render", "--scene", "furnace", "--renderer", "path", "--size", "8x8", "--out",
                  path("none/a.exr")},
                 "--out: folder \"" + path("none") + "\" does not exist");
  expect_refused(render({"--exposure", "1"}),
                 "--exposure: EXR keeps scene-linear values; accepted with a .png output only");
}

TEST_F(BadInput, ARendererWithoutAProgressiveUnitTakesNoBudget) {
  expect_refused({"render", "--scene", "furnace", "--renderer", "blank", "--size", "8x8",
                  "--samples", "4", "--out", path("a.exr")},
                 "--samples: renderer \"blank\" has no progressive unit and runs once; leave it "
                 "out");
}

TEST_F(BadInput, SceneFilesAreRefusedWithTheirPlace) {
  const auto refused = [&](const std::string& text, const std::string& message) {
    const std::string scene = write_text("a.yaml", text);
    expect_message_begins(
        {"render", "--scene", scene, "--renderer", "path", "--size", "8x8", "--out", path("a.exr")},
        scene + message);
  };
  refused("schema: 1\nscene: a\n",
          ":1:1: scene has no camera; add camera: {position, look_at, vertical_fov_deg}");
  refused("schema: 1\nscene: a\nlihgts: []\n", ":3:1: unknown key \"lihgts\"");
  refused("schema: 1\nscene: a\nscene: b\n", ":3:1: ");
}

TEST_F(BadInput, MetricsTheirParametersAndViewing) {
  const std::string image = write_image("r.exr", 16, 16, 0.5F);
  expect_message_begins({"diff", image, image, "--metric", "flp"},
                        "--metric: unknown metric \"flp\"; did you mean \"flip\"? known: ");
  expect_message_begins({"diff", image, image, "--metric", "mse,trm=0.1"}, "--metric");
  expect_refused({"diff", image, image, "--metric", "mse", "--metric", "mse"},
                 "--metric: \"mse\" is given twice");
  expect_message_begins({"diff", image, image, "--display", "standard_5k"},
                        "--display: unknown viewing preset \"standard_5k\"; did you mean "
                        "\"standard_4k\"?");
  expect_refused({"diff", image, image, "--ppd", "0"}, "--ppd: 0; accepted: a number above 0");
  expect_message_begins({"diff", image, image, "--encoding", "linear"}, "");
  expect_refused({"diff", image, image, "--at", "16,0"},
                 "--at: the pixel 16,0 is outside the image of 16x16 pixels");
  expect_refused({"diff", image, image, "--region", "0,0,4,4", "--at", "5,0"},
                 "--at: the pixel 5,0 is outside --region 0,0,4,4");
}

TEST_F(BadInput, RunsAndReferencesThatDoNotExist) {
  EXPECT_EQ(discern({"report", "last"}).exit.code, 2);
  EXPECT_EQ(discern({"eval", "nothing"}).exit.code, 2);
  expect_refused({"ref", "bild"},
                 "discern ref: unknown action \"bild\"; did you mean \"build\"? known: build, "
                 "extend, verify, info");
  expect_refused({"ref", "build"},
                 "discern ref build: which references? accepted: a suite, or at least one --scene");
  expect_refused({"ref", "build", "quick", "--size", "8x8"},
                 "discern ref build: --size, --transport, --geometry-clamp and --frame belong to "
                 "--scene; the suite states its own");
  expect_refused({"ref", "extend", "--scene", "furnace"},
                 "discern ref extend: --samples is required: how many to add");
  expect_refused({"ref", "verify", "--scene", "furnace", "--size", "8x8"},
                 "discern ref verify: reference \"furnace full\" is not stored; discern ref build "
                 "makes it");
}

TEST_F(BadInput, HelpAndVersionAreNoErrors) {
  const auto version = discern({"--version"});
  EXPECT_EQ(version.exit.code, 0);
  EXPECT_EQ(version.stdout_text.find("discern "), 0U);
  for (const char* verb :
       {"list", "check", "run", "render", "diff", "ref", "eval", "report", "schema"}) {
    const auto help = discern({verb, "--help"});
    EXPECT_EQ(help.exit.code, 0) << verb;
    EXPECT_NE(help.stdout_text.find("--help"), std::string::npos) << verb;
  }
  EXPECT_EQ(discern({"--help"}).stdout_text.find("worker"), std::string::npos);
}

TEST_F(BadInput, AFullDiskIsAnError) {
  const auto result =
      base::run_command({"/bin/sh", "-c", std::string(tests::kProgram) + " --version > /dev/full"},
                        std::chrono::seconds(60));
  EXPECT_EQ(result.exit.code, 2);
  EXPECT_EQ(result.stderr_text, "discern: error: cannot write to the standard output\n");
}

TEST_F(BadInput, DevicesAreKnownWhereverTheyAreGiven) {
  const std::string message =
      "--device: unknown device \"cuda\"; known: auto, egl-device, egl-surfaceless, osmesa";
  expect_refused({"run", "--scene", "furnace", "--method", "blank", "--device", "cuda"}, message);
  expect_refused({"ref", "build", "--scene", "furnace", "--device", "cuda"}, message);
  expect_refused({"probe-device", "osmes"},
                 "discern probe-device: unknown platform \"osmes\"; did you mean \"osmesa\"? "
                 "known: egl-device, egl-surfaceless, osmesa");
}

}  // namespace
}  // namespace tests
