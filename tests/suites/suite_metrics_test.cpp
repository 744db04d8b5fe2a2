// Metrics of a suite that look at a part of the picture.
#include "suites/suite_metrics.h"

#include <algorithm>
#include <map>

#include "perception/image_file.h"
#include "results/claims/claim_result.h"
#include "results/tables.h"
#include "suites/score_images.h"
#include "tests/expect_input_error.h"
#include "tests/suites/runs_fixture.h"

namespace {

using perception::Image;
using results::MetricRecord;
using suites::MaskSpec;
using suites::RunOutcome;
using suites::Suite;
using suites::SuiteMetric;

/// Two methods that claim one bounce, which the scene has a picture of its own of.
const std::string kMethods =
    "methods: [{id: pt, renderer: path, parameters: {transport: one_bounce}},\n"
    "          {id: other, renderer: path, parameters: {transport: one_bounce}}]\n"
    "budgets: [{samples: 8}]\n";

std::string head_with_own() {
  std::string head = tests::kSuiteHead;
  const std::string sampled = "samples: 16}";
  head.replace(head.find(sampled), sampled.size(),
               "samples: 16, own: {renderer: path, parameters: {transport: one_bounce, "
               "samples: 3}}}");
  return head;
}

class SuiteMetrics : public tests::Runs {
 protected:
  Suite read(const std::string& metrics) {
    return tests::suite_from(folder_.path(), head_with_own() + kMethods + metrics);
  }
  std::string error_of(const std::string& metrics) {
    return tests::input_error_of([&] { read(metrics); });
  }
  results::Run run_of(const std::string& metrics) {
    outcome_ = tests::run(read(metrics), options());
    return results::load_run(outcome_.run_folder);
  }
  static const MetricRecord& score(const results::Run& run, const std::string& metric,
                                   const std::string& method = "pt",
                                   const std::string& against = "own") {
    const auto found = std::find_if(run.metrics.begin(), run.metrics.end(), [&](const auto& one) {
      return one.metric == metric && one.against == against &&
             one.cell.find("walls." + method + ".") == 0;
    });
    if (found == run.metrics.end()) throw base::InputError("no score of " + metric);
    return *found;
  }
  static Image part_of(const std::filesystem::path& file, const std::string& name) {
    for (const auto& part : perception::read_image_file(file).parts) {
      if (part.name == name) return part.image;
    }
    throw base::InputError(file.string() + " has no " + name);
  }
  Image reference_part(const MetricRecord& score, const std::string& name) {
    return part_of(
        folder_.path() / "results" / "references" / score.reference_hash / "reference.exr", name);
  }
  /// Mean squared difference over the pixels of a mask.
  static double mse(const Image& a, const Image& b, const Image* mask) {
    double sum = 0.0;
    double count = 0.0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
      if (mask != nullptr && mask->pixels[i / 3] == 0.0F) continue;
      const double difference = double{a.pixels[i]} - double{b.pixels[i]};
      sum += difference * difference;
      count += 1.0;
    }
    return sum / count;
  }
  /// A mask of 16 x 16 whose left columns count.
  std::string write_mask(int columns) {
    Image mask = perception::make_gray_image(16, 16, "Y", perception::Encoding::scene_linear);
    for (int y = 0; y < 16; ++y) {
      for (int x = 0; x < columns; ++x) mask.at(x, y) = 0.75F;
    }
    perception::write_exr(folder_.path() / "left.exr", {{{"", mask}}, {}});
    return "left.exr";
  }

  RunOutcome outcome_;
};

TEST_F(SuiteMetrics, ReadBackFromTheResolvedSuite) {
  write_mask(4);
  const Suite suite = read(
      "metrics:\n"
      "  - relmse\n"
      "  - {id: tail, metric: relmse, parameters: {trim: 0.25}, scenes: [walls], methods: [pt]}\n"
      "  - {id: lit, metric: mse, image: direct, scale: 0.5, mask: left.exr}\n"
      "  - {id: inside, metric: mse, mask: {interior_of: normal, beyond_px: 2}, against: full}\n");
  ASSERT_EQ(suite.metrics.size(), 4U);
  EXPECT_EQ(text_of(suite.metrics[1]), "tail:relmse,trim=0.25");
  EXPECT_EQ(parameters_of(suite.metrics[1].choice).real("trim"), 0.25);
  EXPECT_EQ(suite.metrics[1].against, (std::vector<std::string>{"own", "full"}));
  EXPECT_EQ(suite.metrics[2].against, std::vector<std::string>{"own"});
  EXPECT_EQ(suite.metrics[2].image_text(), "direct * 0.5");
  EXPECT_EQ(suite.metrics[2].mask.file, folder_.path() / "left.exr");
  EXPECT_EQ(suite.metrics[3].mask.text(), "interior of normal, 2 px");
  EXPECT_EQ(suite.metrics[3].against, std::vector<std::string>{"full"});
  const std::string text = suites::resolved_yaml(suite);
  const Suite again = suites::parse_suite(base::parse_document(text, "resolved.yaml"),
                                          folder_.path() / "else" / "resolved.yaml", "");
  EXPECT_EQ(suites::resolved_yaml(again), text);
}

TEST_F(SuiteMetrics, RefuseWhatIsAmbiguousOrUnknown) {
  EXPECT_EQ(error_of("metrics: [{id: flip, metric: relmse}]\n"),
            "trial.yaml:8:16: id \"flip\" is the name of a metric; accepted: another name");
  EXPECT_EQ(error_of("metrics: [{id: a, metric: mse}, {id: a, metric: relmse}]\n"),
            "trial.yaml:8:33: metric \"a\" is listed twice");
  EXPECT_EQ(error_of("metrics: [{id: a, metric: mse, methods: [ptt]}]\n"),
            "trial.yaml:8:11: unknown method \"ptt\"; did you mean \"pt\"? known: other, pt");
  EXPECT_NE(error_of("metrics: [{id: a, metric: mse, imgae: direct}]\n").find("\"imgae\""),
            std::string::npos);
  EXPECT_NE(error_of("metrics: [{id: a, metric: mse, mask: none.png}]\n").find("does not exist"),
            std::string::npos);
  EXPECT_NE(error_of("metrics: [{id: a, metric: mse, maps: none}]\n").find("unknown maps \"none\""),
            std::string::npos);
  EXPECT_NE(error_of("metrics: [{id: a, metric: mse, scale: 2}]\n").find("scale is 2"),
            std::string::npos);
  EXPECT_NE(
      error_of("metrics: [{id: a, metric: mse, mask: {edges_of: normal}}]\n").find("within_px"),
      std::string::npos);
  // A search scores whole pictures.
  EXPECT_NE(error_of("metrics: [{id: a, metric: mse}]\n"
                     "profiles: {p: {budgets: [{error: {metric: mse, at: 1}}]}}\n")
                .find("none of this suite's metrics"),
            std::string::npos);
}

TEST_F(SuiteMetrics, AnAovIsComparedWithThatOfTheOwnPicture) {
  const results::Run run = run_of(
      "metrics: [mse, {id: lit, metric: mse, image: direct, scale: 2},\n"
      "          {id: bounce, metric: mse, image: indirect, against: [own, full]}]\n");
  EXPECT_EQ(outcome_.failed_scores, 0U);
  const MetricRecord& lit = score(run, "lit:mse");
  EXPECT_EQ(lit.id, "lit");
  EXPECT_EQ(lit.image, "direct * 2");
  const auto picture = run.folder / run.cells.at(0).render.image;
  const Image direct = part_of(picture, "direct");
  EXPECT_NEAR(lit.value.value(), 4.0 * mse(reference_part(lit, "direct"), direct, nullptr), 1e-9);
  // The variance of the reference is of all light.
  EXPECT_FALSE(lit.noise_floor.has_value());
  EXPECT_NE(lit.value, score(run, "mse").value);
  // Every reference keeps its indirect light, the sampled one as well.
  const MetricRecord& bounce = score(run, "bounce:mse", "pt", "full");
  EXPECT_NEAR(bounce.value.value(),
              mse(reference_part(bounce, "indirect"), part_of(picture, "indirect"), nullptr), 1e-9);
}

TEST_F(SuiteMetrics, AMaskLeavesPixelsOut) {
  const std::string metrics =
      "metrics: [mse, {id: left, metric: mse, mask: " + write_mask(4) +
      "},\n  {id: near, metric: mse, mask: {edges_of: normal, within_px: 1}},\n"
      "  {id: far, metric: mse, mask: {interior_of: normal, beyond_px: 1}}]\n";
  const results::Run run = run_of(metrics);
  EXPECT_EQ(outcome_.failed_scores, 0U);
  const auto picture = run.folder / run.cells.at(0).render.image;
  const Image test = part_of(picture, "radiance");
  const MetricRecord& left = score(run, "left:mse");
  const Image reference = reference_part(left, "radiance");
  Image mask = perception::make_gray_image(16, 16, "Y", perception::Encoding::scene_linear);
  for (int y = 0; y < 16; ++y) {
    for (int x = 0; x < 4; ++x) mask.at(x, y) = 1.0F;
  }
  EXPECT_NEAR(left.value.value(), mse(reference, test, &mask), 1e-9);
  EXPECT_EQ(left.mask, (folder_.path() / "left.exr").string());
  EXPECT_FALSE(left.mask_hash.empty());
  // The noise floor of a part is that of its pixels.
  EXPECT_TRUE(score(run, "left:mse", "pt", "full").noise_floor.has_value());
  EXPECT_NE(score(run, "left:mse", "pt", "full").noise_floor,
            score(run, "mse", "pt", "full").noise_floor);

  const Image edges = suites::near_steps(reference_part(left, "normal"), 1);
  const double share =
      static_cast<double>(std::count(edges.pixels.begin(), edges.pixels.end(), 1.0F)) / 256.0;
  ASSERT_GT(share, 0.0);
  ASSERT_LT(share, 1.0);
  const double near = score(run, "near:mse").value.value();
  const double far = score(run, "far:mse").value.value();
  EXPECT_NEAR(near, mse(reference, test, &edges), 1e-9);
  // Both parts make up the whole.
  EXPECT_NEAR(share * near + (1.0 - share) * far, score(run, "mse").value.value(), 1e-9);
}

TEST_F(SuiteMetrics, AnotherMaskFileMakesItsScoresAnew) {
  const std::string metrics =
      "metrics: [mse, {id: left, metric: mse, mask: " + write_mask(4) + "}]\n";
  const double before = score(run_of(metrics), "left:mse").value.value();
  const Suite suite = read(metrics);
  EXPECT_EQ(suites::evaluate_run(suite, outcome_.run_folder, options(), {}), 0U);
  write_mask(9);
  // Two cells, own and full.
  EXPECT_EQ(suites::evaluate_run(suite, outcome_.run_folder, options(), {}), 4U);
  EXPECT_NE(score(results::load_run(outcome_.run_folder), "left:mse").value.value(), before);
}

TEST_F(SuiteMetrics, AnAovThatIsNotThereIsAFailureThatNamesThoseThatAre) {
  const results::Run run = run_of(
      "metrics: [mse, {id: a, metric: mse, image: irradiance, methods: [pt]},\n"
      "  {id: b, metric: mse, mask: albedo, against: full, methods: [pt]}]\n");
  EXPECT_EQ(outcome_.failed_scores, 2U);
  EXPECT_EQ(suites::exit_code_of(outcome_), 3);
  const auto failures = run.info->at("score_failures").get<std::vector<std::string>>();
  ASSERT_EQ(failures.size(), 2U);
  EXPECT_NE(failures[0].find("a:mse own: the reference"), std::string::npos) << failures[0];
  EXPECT_NE(failures[0].find("has no AOV \"irradiance\"; it has: albedo, normal, depth, direct, "
                             "indirect"),
            std::string::npos)
      << failures[0];
  // The reference of all light is sampled and keeps one.
  EXPECT_NE(failures[1].find("has no AOV \"albedo\"; it has: indirect"), std::string::npos)
      << failures[1];
}

TEST_F(SuiteMetrics, AnOwnPictureThatWasStoredWithoutAovsIsMadeAgain) {
  const results::Run before = run_of("metrics: [mse]\n");
  const auto folder =
      folder_.path() / "results" / "references" / score(before, "mse").reference_hash;
  perception::ImageFile file = perception::read_image_file(folder / "reference.exr");
  file.parts.resize(1);
  perception::write_exr(folder / "reference.exr", file);
  auto info = nlohmann::ordered_json::parse(base::read_text_file(folder / "reference.json"));
  info.erase("aovs");
  base::write_text_file(folder / "reference.json", info.dump());
  // Nothing looks at them: what is stored will do.
  EXPECT_EQ(run_of("metrics: [mse, relmse]\n").info->at("references").size(), 2U);
  EXPECT_EQ(perception::read_image_file(folder / "reference.exr").parts.size(), 1U);
  run_of("metrics: [mse, {id: lit, metric: mse, image: direct}]\n");
  EXPECT_EQ(outcome_.failed_scores, 0U);
  EXPECT_GT(perception::read_image_file(folder / "reference.exr").parts.size(), 2U);
}

TEST_F(SuiteMetrics, RestrictedOnesAreOfTheirRowsAndClaimsNameThemById) {
  const results::Run run = run_of(
      "metrics: [mse, {id: lit, metric: mse, image: direct, methods: [pt]}]\n"
      "claims:\n"
      "  - {id: c, item: a, says: b, measure: \"value(pt, lit)\", expect: \">= 0\"}\n"
      "  - {id: d, item: a, says: b, measure: \"value(other, lit)\", expect: \">= 0\"}\n");
  EXPECT_EQ(outcome_.failed_scores, 0U);
  EXPECT_EQ(run.metrics.size(), 5U);  // mse of two methods, own and full; lit of one, own
  const Suite suite = read("metrics: [mse, {id: lit, metric: mse, image: direct}]\n");
  EXPECT_EQ(suite.metrics[1].methods.size(), 0U);

  const results::RunValues values(run);
  const auto claims = results::claims::claims_from_json(run.info->at("claims"));
  const auto first = results::claims::evaluate(claims[0], values);
  ASSERT_TRUE(first.value.has_value()) << first.reason;
  EXPECT_EQ(*first.value, score(run, "lit:mse").value);
  EXPECT_EQ(results::claims::evaluate(claims[1], values).reason,
            "other on walls at 8spp has no lit");

  const std::string table = to_text(results::summary_table(values.summary()));
  EXPECT_NE(table.find("lit:mse (own)"), std::string::npos) << table;
  EXPECT_EQ(table.find("lit:mse (full)"), std::string::npos) << table;
  EXPECT_NE(table.find("n/a"), std::string::npos) << table;
  EXPECT_EQ(table.find("not yet"), std::string::npos) << table;
}

TEST_F(SuiteMetrics, AClaimOnAnIdThatIsNotThereIsRefusedBeforeTheRun) {
  const Suite suite = read(
      "metrics: [{id: lit, metric: mse, image: direct}]\n"
      "claims: [{id: c, item: a, says: b, measure: \"value(pt, score.lti)\", expect: \">= 0\"}]\n");
  EXPECT_NE(tests::input_error_of([&] { tests::run(suite, options()); }).find("\"lti\""),
            std::string::npos);
}

TEST_F(SuiteMetrics, OfSequencesLookAtAovsAndMaskFilesToo) {
  write_mask(16);
  const std::string methods = "methods: [{id: pt, renderer: path}]\nbudgets: [{samples: 8}]\n";
  const Suite suite = tests::suite_from(
      folder_.path(),
      tests::kSequenceHead + methods +
          "metrics: [flicker, {id: all, metric: flicker, mask: left.exr},\n"
          "  {id: bounce, metric: flicker, image: indirect, against: [own, full]}]\n");
  const RunOutcome outcome = tests::run(suite, options());
  EXPECT_EQ(outcome.failed_scores, 0U);
  std::map<std::string, double> values;
  for (const MetricRecord& record : results::load_run(outcome.run_folder).metrics) {
    if (record.frame == 3) values[record.metric + " " + record.against] = record.value.value();
  }
  ASSERT_EQ(values.size(), 6U);
  // A mask of all pixels changes nothing.
  EXPECT_EQ(values["all:flicker own"], values["flicker own"]);
  EXPECT_NE(values["bounce:flicker full"], values["flicker full"]);
  EXPECT_NE(tests::input_error_of([&] {
              tests::suite_from(folder_.path(),
                                tests::kSequenceHead + methods +
                                    "metrics: [{id: a, metric: flicker, mask: indirect}]\n");
            }).find("scores sequences and cannot have the mask indirect; accepted: a file"),
            std::string::npos);
}

TEST(NearSteps, AreBothSidesOfAStepAndTheirNeighbours) {
  Image image = perception::make_gray_image(8, 4, "Y", perception::Encoding::scene_linear);
  for (int y = 0; y < 4; ++y) {
    for (int x = 3; x < 8; ++x) image.at(x, y) = 0.6F;
  }
  const auto columns = [](const Image& mask) {
    std::string text;
    for (int x = 0; x < mask.width_px; ++x) text += mask.at(x, 2) > 0.0F ? '1' : '0';
    return text;
  };
  EXPECT_EQ(columns(suites::near_steps(image, 0)), "00110000");
  EXPECT_EQ(columns(suites::near_steps(image, 2)), "11111100");
  // A step of less than a half is none; nor are two that add up.
  for (float& value : image.pixels) value *= 0.5F;
  EXPECT_EQ(columns(suites::near_steps(image, 2)), "00000000");
  // One pixel spreads to a square, its neighbours being sides of its steps.
  Image spot = perception::make_gray_image(9, 9, "Y", perception::Encoding::scene_linear);
  spot.at(4, 4) = 1.0F;
  const Image wide = suites::near_steps(spot, 1);
  EXPECT_EQ(std::count(wide.pixels.begin(), wide.pixels.end(), 1.0F), 21);
}

}  // namespace
