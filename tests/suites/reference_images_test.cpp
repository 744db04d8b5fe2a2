#include "suites/reference_images.h"

#include <cmath>
#include <thread>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "perception/base/atomic_file.h"
#include "perception/image_file.h"
#include "renderers/scene/scene_file.h"
#include "suites/file_lock.h"
#include "suites/interruption.h"
#include "suites/reference_check.h"
#include "suites/reference_rendering.h"
#include "tests/expect_input_error.h"
#include "tests/suites/test_suite.h"
#include "tests/temporary_folder.h"

namespace {

using renderers::Part;
using renderers::Transport;
using suites::Reference;

const renderers::Devices kDevices{1, "auto", nullptr};

class References : public testing::Test {
 protected:
  References() : store_(folder_.path() / "results") {
    tests::write_scene(folder_.path());
    scene_ = renderers::scene::read_scene_file(folder_.path() / "walls.yaml").at_frame(0);
  }
  suites::ReferenceKey key(std::int64_t samples = 8, Transport transport = Transport::full) {
    suites::ReferenceKey made;
    made.scene = &scene_;
    made.size_px = {16, 12};
    made.claims.transport = transport;
    made.spec.samples = samples;
    return made;
  }
  std::filesystem::path folder_of(const suites::ReferenceKey& of) {
    return folder_.path() / "results" / "references" / of.hash();
  }

  tests::TemporaryFolder folder_;
  renderers::scene::Scene scene_;
  suites::ReferenceStore store_;
};

TEST_F(References, AreRenderedOnceAndThenLoaded) {
  EXPECT_FALSE(store_.contains(key()));
  EXPECT_FALSE(store_.load(key()).has_value());
  const Reference made = store_.get(key(), kDevices, {});
  EXPECT_EQ(made.samples, 8);
  EXPECT_EQ(made.all.width_px, 16);
  EXPECT_TRUE(std::filesystem::exists(folder_of(key()) / "reference.exr"));
  EXPECT_TRUE(store_.contains(key()));
  int calls = 0;
  const Reference again = store_.get(key(), kDevices, [&](double) { return ++calls < 0; });
  EXPECT_EQ(calls, 0);
  EXPECT_EQ(perception::pixel_hash(again.all), perception::pixel_hash(made.all));
  EXPECT_EQ(again.info->at("pixel_hash"), perception::pixel_hash(made.all));
  EXPECT_EQ(again.info->at("transport"), "full");
}

TEST_F(References, AnOwnPictureIsThatOfItsSeedAndHasItsOwnHash) {
  auto own = key(3, Transport::one_bounce);
  own.spec.own = suites::OwnReference{suites::reference_method(own), 5};
  own.spec.seed = 5;
  EXPECT_NE(own.hash(), key(3, Transport::one_bounce).hash());
  auto other = own;
  other.spec.seed = 6;
  EXPECT_NE(own.hash(), other.hash());

  const Reference made = store_.get(own, kDevices, {});
  suites::ReferenceRenderer renderer(own, kDevices);
  EXPECT_EQ(perception::pixel_hash(made.all), perception::pixel_hash(renderer.render(3, 5).all));
  EXPECT_EQ(made.samples, 3);
  EXPECT_NE(tests::input_error_of([&] {
              store_.extend(own, 1, kDevices, {});
            }).find("to which no samples can be added"),
            std::string::npos);
}

TEST_F(References, HashFollowsWhatItIsAnImageOfAndNotTheSamples) {
  const std::string hash = key().hash();
  EXPECT_EQ(key(4096).hash(), hash);
  EXPECT_NE(key(8, Transport::direct).hash(), hash);
  auto clamped = key();
  clamped.claims.geometry_clamp = 2.0;
  EXPECT_NE(clamped.hash(), hash);
  auto larger = key();
  larger.size_px.width = 17;
  EXPECT_NE(larger.hash(), hash);
  scene_.camera.vertical_fov_deg += 1.0F;
  EXPECT_NE(key().hash(), hash);
}

TEST_F(References, MoreSamplesThanAskedAreFine) {
  store_.get(key(16), kDevices, {});
  EXPECT_EQ(store_.get(key(4), kDevices, {}).samples, 16);
}

TEST_F(References, PartsAddUpAndDirectTransportHasNoIndirectPart) {
  const Reference full = store_.get(key(), kDevices, {});
  const Reference direct = store_.get(key(8, Transport::direct), kDevices, {});
  ASSERT_FALSE(full.indirect.is_empty());
  double indirect_sum = 0.0;
  for (std::size_t i = 0; i < full.all.pixels.size(); ++i) {
    EXPECT_GE(full.all.pixels[i] + 1e-5F, full.indirect.pixels[i]);
    indirect_sum += static_cast<double>(full.indirect.pixels[i]);
    EXPECT_FLOAT_EQ(direct.image(Part::indirect).pixels[i], 0.0F);
  }
  EXPECT_GT(indirect_sum, 0.0);
}

TEST_F(References, PiecesAreMergedBySamplesAndVarianceFallsWithThem) {
  suites::ReferenceEstimate a;
  a.samples = 1;
  a.all = a.indirect = a.variance =
      perception::make_rgb_image(1, 1, perception::Encoding::scene_linear);
  suites::ReferenceEstimate b = a;
  b.samples = 3;
  a.all.pixels = {4.0F, 0.0F, 0.0F};
  a.variance.pixels = {16.0F, 0.0F, 0.0F};
  b.all.pixels = {8.0F, 0.0F, 0.0F};
  b.variance.pixels = {16.0F, 0.0F, 0.0F};
  suites::merge(a, b);
  EXPECT_EQ(a.samples, 4);
  EXPECT_FLOAT_EQ(a.all.pixels[0], 7.0F);                                // (1*4 + 3*8) / 4
  EXPECT_FLOAT_EQ(a.variance.pixels[0], (1.0F + 9.0F) / 16.0F * 16.0F);  // w1^2 v1 + w2^2 v2
}

TEST_F(References, ExtendingAddsAnIndependentPieceAndLowersTheVariance) {
  const Reference before = store_.get(key(16), kDevices, {});
  const Reference after = store_.extend(key(16), 48, kDevices, {});
  EXPECT_EQ(after.samples, 64);
  EXPECT_NE(perception::pixel_hash(after.all), perception::pixel_hash(before.all));
  double before_sum = 0.0;
  double after_sum = 0.0;
  for (std::size_t i = 0; i < before.variance.pixels.size(); ++i) {
    before_sum += static_cast<double>(before.variance.pixels[i]);
    after_sum += static_cast<double>(after.variance.pixels[i]);
  }
  EXPECT_GT(before_sum, 0.0);
  EXPECT_LT(after_sum, 0.5 * before_sum);
  const auto& chunks = after.info->at("chunks");
  ASSERT_EQ(chunks.size(), 2U);
  EXPECT_NE(chunks[0].at("seed"), chunks[1].at("seed"));
}

TEST_F(References, StoppingKeepsTheFinishedPieces) {
  // 16x12 pixels make pieces of 256 samples: stop after the first of three.
  int calls = 0;
  EXPECT_THROW(store_.get(key(768), kDevices, [&](double) { return ++calls < 2; }),
               suites::Interrupted);
  EXPECT_EQ(store_.samples_of(key()), 256);
  EXPECT_FALSE(store_.contains(key(768)));
  EXPECT_EQ(store_.get(key(300), kDevices, {}).samples, 300);
}

TEST_F(References, VerifyAcceptsAnHonestReference) {
  // Enough pixels that a share of them means something: 2 % of 192 would be four.
  const suites::ReferenceKey wanted = [&] {
    suites::ReferenceKey larger = key(256);
    larger.size_px = {64, 48};
    return larger;
  }();
  store_.get(wanted, kDevices, {});
  const auto honest = store_.verify(wanted, kDevices);
  EXPECT_TRUE(honest.at("ok").get<bool>()) << honest.dump();
  EXPECT_EQ(honest.at("pixels"), 64 * 48);
}

TEST_F(References, TheCheckRefusesABiasOfFivePercent) {
  const auto wanted = key(256);
  suites::ReferenceRenderer renderer(wanted, kDevices);
  suites::ReferenceEstimate a = renderer.render(256, 77);
  const suites::ReferenceEstimate b = renderer.render(256, 78);
  const auto honest = suites::z_test(a, b);
  EXPECT_TRUE(honest.at("ok").get<bool>()) << honest.dump();
  for (float& value : a.all.pixels) value *= 1.05F;
  const auto biased = suites::z_test(a, b);
  EXPECT_FALSE(biased.at("ok").get<bool>()) << biased.dump();
}

TEST_F(References, AnImageThatItsDescriptionDoesNotMatchIsRefused) {
  store_.get(key(), kDevices, {});
  const auto path = folder_of(key()) / "reference.exr";
  perception::ImageFile file = perception::read_image_file(path);
  file.parts.front().image.pixels[0] += 1.0F;
  perception::write_exr(path, file);
  EXPECT_EQ(tests::input_error_of([&] { store_.get(key(), kDevices, {}); }),
            path.string() +
                ": is not the image that reference.json describes (its pixels were changed, or "
                "storing it was cut short); delete the folder to render it again");
}

TEST(ReferencePieces, ARemainderTooSmallForAVarianceIsTakenAlong) {
  EXPECT_EQ(suites::piece_samples(257, 256), 257);
  EXPECT_EQ(suites::piece_samples(272, 256), 256);
  EXPECT_EQ(suites::piece_samples(5, 256), 5);
}

TEST_F(References, ListNamesTheReferencesAndTheUnreadableOnes) {
  EXPECT_TRUE(store_.list().empty());
  store_.get(key(), kDevices, {});
  ASSERT_EQ(store_.list().size(), 1U);
  EXPECT_TRUE(store_.list()[0].at("is_readable").get<bool>());
  const auto path = folder_of(key()) / "reference.exr";
  std::filesystem::resize_file(path, std::filesystem::file_size(path) / 2);
  EXPECT_FALSE(store_.list()[0].at("is_readable").get<bool>());
}

TEST_F(References, ARendererThatCannotRenderTheTransportIsRefused) {
  auto wrong = key();
  wrong.spec.renderer = "blank";
  EXPECT_EQ(tests::input_error_of([&] { store_.get(wrong, kDevices, {}); }),
            "reference: renderer \"blank\" cannot render transport full with geometry_clamp 0; a "
            "reference needs a renderer with the parameters transport and geometry_clamp, e.g. "
            "path");
}

TEST_F(References, ASecondRendererOfTheSameReferenceWaitsAndUsesIt) {
  std::filesystem::create_directories(folder_of(key()));
  auto lock = std::make_unique<suites::FileLock>(folder_of(key()) / "lock", nullptr);
  int polls = 0;
  EXPECT_THROW(store_.get(key(), kDevices, [&](double) { return ++polls < 3; }),
               suites::Interrupted);
  EXPECT_EQ(polls, 3);
  std::thread holder([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(150));
    lock.reset();
  });
  EXPECT_EQ(store_.get(key(), kDevices, {}).samples, 8);
  holder.join();
}

TEST(ReferencePieces, AreSmallerForLargerImages) {
  EXPECT_EQ(suites::chunk_samples({16, 16}), 256);
  EXPECT_EQ(suites::chunk_samples({400, 400}), 32);
  EXPECT_EQ(suites::chunk_samples({3840, 2160}), 16);
}

}  // namespace
