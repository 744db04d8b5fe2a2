// What a report tells its viewer: images, floats, maps, frames; also of damaged runs.
#include <cmath>
#include <limits>
#include <regex>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "perception/base/atomic_file.h"
#include "perception/image_file.h"
#include "results/html_report/html_report.h"
#include "results/html_report/html_text.h"
#include "results/html_report/picture.h"
#include "tests/results/synthetic_run.h"
#include "tests/results/viewer_run.h"
#include "tests/temporary_folder.h"

namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using results::html_report::html_report;
using tests::TemporaryFolder;

std::string between(const std::string& text, const std::string& from, const std::string& to) {
  const std::size_t begin = text.find(from);
  if (begin == std::string::npos) return "";
  return text.substr(begin + from.size(), text.find(to, begin) - begin - from.size());
}

/// What the page tells the viewer, read as a browser does: the element ends at the first "</".
json manifest_of(const std::string& page) {
  return json::parse(between(page, "id=\"viewer-data\">", "</"));
}

bool has(const std::string& text, const std::string& wanted) {
  return text.find(wanted) != std::string::npos;
}

results::RunFolder empty_run(const TemporaryFolder& folder) {
  return results::RunFolder::open_for_writing(folder.path() / "runs/s/r");
}

/// Appends a cell with an image of one colour.
results::CellRecord add_cell(results::RunFolder& run, const std::string& method,
                             const perception::Image& image, int frame = 0) {
  results::CellRecord cell = test_results::timed_cell("box", method, 1, 1.0);
  cell.render.frame = frame;
  if (frame > 0) {
    cell.render.total_s = std::numeric_limits<double>::quiet_NaN();
    cell.render.next_frame_s = 0.1;
  }
  cell.render.image = "images/" + cell.cell + "/frame-" + std::to_string(frame) + ".exr";
  fs::create_directories((run.path() / cell.render.image).parent_path());
  perception::write_exr(run.path() / cell.render.image, {{{"radiance", image}}, {}});
  run.append(cell);
  return cell;
}

perception::Image plain(int width_px, int height_px, float value) {
  auto image = perception::make_rgb_image(width_px, height_px, perception::Encoding::scene_linear);
  for (float& one : image.pixels) one = value;
  return image;
}

TEST(ReportViewerPage, NamesImagesMapsAndTheirFloats) {
  const TemporaryFolder folder;
  const std::string page =
      html_report(results::load_run(test_results::write_synthetic_run(folder.path(), 16, 12)));
  const json manifest = manifest_of(page);
  ASSERT_EQ(manifest["scenes"].size(), 2U);
  const json& scene = manifest["scenes"][1];
  EXPECT_EQ(scene["name"], "<script>alert(1)</script>");
  EXPECT_EQ(scene["exposure_ev"], 1.0);
  std::vector<std::string> labels;
  for (const json& image : scene["images"]) {
    labels.push_back(image["label"]);
    EXPECT_EQ(image["floats"]["channels"], 3);
    EXPECT_EQ(image["floats"]["width"], 16);
    EXPECT_EQ(image["floats"]["non_finite"], 0);
    const std::string id = image["floats"]["id"];
    EXPECT_TRUE(has(page, "<script type=\"text/plain\" id=\"" + id + "\">")) << id;
  }
  EXPECT_EQ(labels, (std::vector<std::string>{"reference: full", "reference: direct", "direct-only",
                                              "pt8"}));
  ASSERT_EQ(scene["maps"].size(), 9U);  // three metrics; direct-only twice, pt8 once
  EXPECT_EQ(scene["maps"][0]["metric"], "relmse");
  EXPECT_EQ(scene["maps"][0]["image"], 2);
  EXPECT_EQ(scene["maps"][0]["scale"]["logarithmic"], true);
  EXPECT_EQ(scene["maps"][0]["scale"]["low"], 1e-4);
  EXPECT_EQ(scene["maps"][2]["against"], "own = full");
  EXPECT_EQ(scene["maps"][2]["image"], 3);
  EXPECT_TRUE(
      has(page, "data-group=\"scene-2-map-1\" data-image=\"3\" data-against=\"own = full\""));
}

TEST(ReportViewerPage, DifferencesHaveTheScalesOfTheirMetrics) {
  const TemporaryFolder folder;
  auto run = empty_run(folder);
  add_cell(run, "a", plain(2, 2, 1.0F));
  const json manifest = manifest_of(html_report(results::load_run(run.path())));
  EXPECT_EQ(manifest["differences"]["absolute"]["unit"], "radiance");
  EXPECT_EQ(manifest["differences"]["squared"]["low"], 1e-6);
  EXPECT_EQ(manifest["differences"]["relative"]["unit"], "");
  ASSERT_EQ(manifest["colors"].size(), 33U);
  EXPECT_NEAR(manifest["colors"][0][0], 255 * 0.0336, 0.01);
}

TEST(ReportViewerPage, NoNameCanEndAnElement) {
  const TemporaryFolder folder;
  auto run = empty_run(folder);
  const std::string name = "</script><img src=x onerror=alert(1)> \"'&";
  add_cell(run, name, plain(2, 2, 1.0F));
  const std::string page = html_report(results::load_run(run.path()));
  EXPECT_FALSE(has(page, "<img src=x"));
  EXPECT_EQ(manifest_of(page)["scenes"][0]["images"][0]["label"], name);
}

TEST(ReportViewerPage, NoNameTurnsTheDirectionOfText) {
  const TemporaryFolder folder;
  auto run = empty_run(folder);
  add_cell(run, "a\u202eb", plain(2, 2, 1.0F));
  const std::string page = html_report(results::load_run(run.path()));
  EXPECT_FALSE(has(page, "\u202e"));
  EXPECT_EQ(manifest_of(page)["scenes"][0]["images"][0]["label"], "a\\u202eb");
}

TEST(ReportViewerPage, PixelsThatAreNotFiniteAreCountedAndNeverBlack) {
  const TemporaryFolder folder;
  auto run = empty_run(folder);
  perception::Image image = plain(3, 2, 1.0F);
  image.at(1, 0, 2) = std::numeric_limits<float>::quiet_NaN();
  image.at(2, 1, 0) = std::numeric_limits<float>::infinity();
  const results::CellRecord cell = add_cell(run, "a", image);
  const std::string page = html_report(results::load_run(run.path()));
  EXPECT_EQ(manifest_of(page)["scenes"][0]["images"][0]["floats"]["non_finite"], 2);

  const auto picture =
      results::html_report::rendering_picture(run.path() / cell.render.image, "", 0.0);
  ASSERT_TRUE(picture.uri.starts_with("data:image/png;base64,"));
  EXPECT_TRUE(has(page, picture.uri));
  perception::Image shown = plain(3, 2, 1.0F);
  shown.encoding = perception::Encoding::display;
  shown.at(1, 0, 0) = shown.at(2, 1, 0) = 0.0F;  // cyan
  const auto expected = results::html_report::encoded(shown);
  EXPECT_EQ(picture.uri, "data:image/png;base64," + results::html_report::base64(expected.bytes));
}

TEST(ReportViewerPage, MissingImagesHaveNoNumber) {
  const TemporaryFolder folder;
  auto run = empty_run(folder);
  const results::CellRecord gone = add_cell(run, "a", plain(2, 2, 1.0F));
  add_cell(run, "b", plain(4, 3, 1.0F));
  fs::remove(run.path() / gone.render.image);
  const std::string page = html_report(results::load_run(run.path()));
  const json images = manifest_of(page)["scenes"][0]["images"];
  ASSERT_EQ(images.size(), 1U);
  EXPECT_EQ(images[0]["label"], "b");
  EXPECT_TRUE(has(page, "data-group=\"scene-1\" data-image=\"0\""));
  EXPECT_TRUE(has(page, "<div class=\"no-picture\">not yet</div>"));
}

TEST(ReportViewerPage, ImagesOfOtherSizesKeepTheirOwn) {
  const TemporaryFolder folder;
  auto run = empty_run(folder);
  add_cell(run, "a", plain(2, 2, 1.0F));
  add_cell(run, "b", plain(4, 3, 1.0F));
  const json images =
      manifest_of(html_report(results::load_run(run.path())))["scenes"][0]["images"];
  EXPECT_EQ(images[0]["width"], 2);
  EXPECT_EQ(images[1]["width"], 4);
  EXPECT_EQ(images[1]["floats"]["height"], 3);
}

TEST(ReportViewerPage, ASequenceHasTheFloatsOfItsFrames) {
  const TemporaryFolder folder;
  auto run = empty_run(folder);
  for (const int frame : {0, 1, 2})
    add_cell(run, "a", plain(2, 2, 1.0F + static_cast<float>(frame)), frame);
  const std::string page = html_report(results::load_run(run.path()));
  const json image = manifest_of(page)["scenes"][0]["images"][0];
  ASSERT_EQ(image["frames"].size(), 3U);
  EXPECT_EQ(image["frames"][0]["floats"], image["floats"]);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(image["frames"][i]["frame"], i);
    const std::string id = image["frames"][i]["floats"]["id"];
    EXPECT_TRUE(has(page, "<script type=\"text/plain\" id=\"" + id + "\">"));
  }
}

TEST(ReportViewerPage, ASequenceHasTheMapsThatWereKept) {
  const TemporaryFolder folder;
  const std::string page =
      html_report(results::load_run(test_results::write_viewer_run(folder.path())));
  const json scenes = manifest_of(page)["scenes"];
  EXPECT_TRUE(scenes[0]["maps"][0]["frames"].empty());
  const json& map = scenes[1]["maps"].at(0);
  EXPECT_EQ(map["frame"], 5);
  ASSERT_EQ(map["frames"].size(), 2U);
  EXPECT_EQ(map["frames"][0]["floats"], map["floats"]);
  EXPECT_EQ(map["frames"][1]["frame"], 6);
  EXPECT_NE(map["frames"][1]["floats"]["id"], map["floats"]["id"]);
}

TEST(ReportViewerPage, ARunWithoutRowsHasAnEmptyManifest) {
  const TemporaryFolder folder;
  auto run = empty_run(folder);
  run.write_run_json({{"schema", 1}});
  const std::string page = html_report(results::load_run(run.path()));
  EXPECT_TRUE(manifest_of(page)["scenes"].empty());
  EXPECT_FALSE(has(page, "text/plain"));
}

TEST(ReportViewerPage, ASplitReportHasItsDataBesideIt) {
  const TemporaryFolder folder;
  const fs::path run_folder = test_results::write_synthetic_run(folder.path(), 16, 12);
  const results::Run run = results::load_run(run_folder);
  const auto whole = results::html_report::write_report(run);
  EXPECT_FALSE(whole.is_split);
  const auto split = results::html_report::write_report(
      run, {results::html_report::Split::automatic, whole.data_bytes - 1});
  EXPECT_TRUE(split.is_split);
  EXPECT_EQ(split.data_bytes, whole.data_bytes);
  const std::string page = base::read_text_file(split.index);
  EXPECT_FALSE(has(page, "data:image"));
  EXPECT_FALSE(has(page, "text/plain"));
  EXPECT_TRUE(has(page, "script-src 'unsafe-inline' 'self' file:"));
  const std::regex source("src=\"(data/[a-z0-9.]+)\"");
  int pictures = 0;
  for (std::sregex_iterator at(page.begin(), page.end(), source), end; at != end; ++at) {
    EXPECT_TRUE(fs::exists(split.index.parent_path() / (*at)[1].str())) << (*at)[1];
    ++pictures;
  }
  EXPECT_GE(pictures, 8 + 18);  // images and maps of two scenes, and thumbnails
  const json manifest = manifest_of(page);
  for (const json& scene : manifest["scenes"]) {
    for (const json& image : scene["images"]) {
      const std::string id = image["floats"]["id"];
      EXPECT_TRUE(fs::exists(split.index.parent_path() / "data" / (id + ".js"))) << id;
    }
  }
  EXPECT_EQ(results::html_report::write_report(run).is_split, false);
  EXPECT_FALSE(fs::exists(run_folder / "report/data"));
}

}  // namespace
