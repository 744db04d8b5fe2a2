// Laws that hold for every metric of the table, on display-encoded and on scene-linear images.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <tuple>

#include "metrics/metric_list.h"
#include "perception/base/names.h"
#include "perception/base/parallel.h"
#include "tests/metrics/feature_metrics.h"
#include "tests/metrics/metric_pictures.h"

namespace {

using namespace tests;
using metrics::Better;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// Equal, or both no number.
bool is_same(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

class MetricLaws : public testing::TestWithParam<std::tuple<std::string, Encoding>> {
 protected:
  const std::string& name() const { return std::get<0>(GetParam()); }
  Encoding encoding() const { return std::get<1>(GetParam()); }
  const metrics::MetricInfo& info() const { return metrics::find_metric(name(), {}); }
  Image reference(int width_px = 64, int height_px = 48) const {
    return wavy_picture(width_px, height_px, encoding());
  }
  /// True if a is a worse score than b.
  bool is_worse(double a, double b) const { return info().better == Better::lower ? a > b : a < b; }
};

TEST_P(MetricLaws, IdenticalImagesHaveTheIdenticalValue) {
  const auto score = score_of(name(), reference(), reference());
  EXPECT_EQ(score.value, info().identical_value);
  for (const float value : score.map->pixels) EXPECT_EQ(value, 0.0F);
  EXPECT_EQ(score.map->width_px, 64);
  EXPECT_EQ(score.map->height_px, 48);
  EXPECT_EQ(score.map->channel_count(), 1);
}

TEST_P(MetricLaws, MoreNoiseIsWorse) {
  if (is_blind_to_noise_on_waves(name())) return;  // see the metric's own test
  double last = info().identical_value;
  for (const float amplitude : {0.01F, 0.03F, 0.1F, 0.25F}) {
    const double value = score_of(name(), reference(), with_noise(reference(), amplitude)).value;
    // What counts visible pixels need not see the weakest noise; daly-vdp weighs every channel on
    // its own, so that noise of all frequencies is seen later.
    const bool counts_visible = name() == "visible-difference" || name() == "yee" ||
                                name() == "edge-excess" || name() == "holes";
    const bool may_be_unseen =
        (counts_visible && amplitude == 0.01F) || (name() == "daly-vdp" && amplitude <= 0.03F);
    EXPECT_TRUE(is_worse(value, last) || (may_be_unseen && value == last))
        << amplitude << ": " << value << " after " << last;
    last = value;
  }
}

TEST_P(MetricLaws, ExchangeOfTheImages) {
  const Image test = with_noise(reference(), 0.2F);
  const double forth = score_of(name(), reference(), test).value;
  const double back = score_of(name(), test, reference()).value;
  // relmse and others divide by the reference; HDR-FLIP takes its exposures, cvvdp its sensitivity
  // from it; edges and holes count that it lacks.
  const std::set<std::string> with_roles{"contrast-kept", "cvvdp",         "edge-excess",
                                         "holes",         "relative-rmse", "relmse"};
  const bool is_symmetric =
      !with_roles.contains(name()) && !(name() == "flip" && encoding() == Encoding::scene_linear);
  if (is_symmetric) {
    EXPECT_DOUBLE_EQ(forth, back);
  } else {
    EXPECT_NE(forth, back);
  }
}

TEST_P(MetricLaws, TheMaskRestrictsThePooledValue) {
  if (name() == "penumbra-width") return;  // the masks cut its line; see its own test
  Image test = reference(64, 64);
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 16; ++x) test.at(x, y, 1) += 0.2F;
  }
  const Image good = mask_where(64, 64, [](int x, int) { return x >= 48; });
  const Image bad = mask_where(64, 64, [](int x, int) { return x < 16; });
  const double whole = score_of(name(), reference(64, 64), test).value;
  const double value = score_of(name(), reference(64, 64), test, &good).value;
  // In these the coarsest bands reach across the whole picture.
  if (name() == "cvvdp" || name() == "threshold-ratio") {
    EXPECT_TRUE(is_worse(whole, value));
  } else {
    EXPECT_EQ(value, info().identical_value);
  }
  // A shift of brightness has none of the features that some metrics look for.
  if (judges_one_feature(name())) return;
  EXPECT_TRUE(is_worse(score_of(name(), reference(64, 64), test, &bad).value, whole));
}

TEST_P(MetricLaws, AFullMaskChangesNothing) {
  const Image test = with_noise(reference(), 0.1F);
  const Image full = mask_where(64, 48, [](int, int) { return true; });
  EXPECT_EQ(score_of(name(), reference(), test, &full).value,
            score_of(name(), reference(), test).value);
}

TEST_P(MetricLaws, NonFinitePixelsAreCountedAndPoisonTheValue) {
  for (const bool is_in_reference : {true, false}) {
    Image broken = reference();
    broken.at(20, 10, 2) = kNan;
    broken.at(5, 30, 0) = std::numeric_limits<float>::infinity();
    const Image whole = reference();
    const auto score =
        is_in_reference ? score_of(name(), broken, whole) : score_of(name(), whole, broken);
    EXPECT_TRUE(std::isnan(score.value));
    EXPECT_EQ(score.non_finite_pixels, 2U);
  }
}

TEST_P(MetricLaws, EachKindOfNonFiniteValuePoisonsTheValueAlone) {
  constexpr float kInfinite = std::numeric_limits<float>::infinity();
  for (const float value : {kNan, kInfinite, -kInfinite}) {
    for (const bool is_in_reference : {true, false}) {
      Image broken = reference();
      broken.at(7, 11, 1) = value;
      const Image whole = reference();
      const auto score =
          is_in_reference ? score_of(name(), broken, whole) : score_of(name(), whole, broken);
      EXPECT_TRUE(std::isnan(score.value)) << value << (is_in_reference ? " in the reference" : "");
      EXPECT_EQ(score.non_finite_pixels, 1U);
    }
  }
}

TEST_P(MetricLaws, IgnoringThemIsMaskingThem) {
  const Image clean = with_noise(reference(), 0.1F);
  Image broken = clean;
  broken.at(20, 10, 2) = kNan;
  Image patched = clean;
  for (int c = 0; c < 3; ++c) patched.at(20, 10, c) = reference().at(20, 10, c);
  const Image mask = mask_where(64, 48, [](int x, int y) { return x != 20 || y != 10; });
  const metrics::ScoreOptions options{.ignore_non_finite = true, .with_map = true};
  const auto score = score_of(name(), reference(), broken, nullptr, options);
  EXPECT_EQ(score.value, score_of(name(), reference(), patched, &mask).value);
  EXPECT_EQ(score.non_finite_pixels, 1U);
  if (is_blind_to_noise_on_waves(name())) return;
  if (name() == "threshold-ratio") return;  // a median: one pixel more may leave it where it is
  // Dividing by all pixels, the broken one included, gives another number.
  EXPECT_NE(score.value, score_of(name(), reference(), patched).value);
}

TEST_P(MetricLaws, TinyImagesHaveAValue) {
  for (const auto& [width, height] : {std::pair{1, 1}, {2, 1}, {1, 3}, {7, 7}, {10, 12}, {17, 1}}) {
    const Image small = reference(width, height);
    const double identical = score_of(name(), small, small).value;
    const bool lacks_the_feature = judges_one_feature(name()) && std::isnan(identical);
    EXPECT_TRUE(lacks_the_feature || identical == info().identical_value) << identical;
    const double value = score_of(name(), small, with_noise(small, 0.2F)).value;
    if (judges_one_feature(name())) continue;  // there is no place for it
    EXPECT_TRUE(std::isfinite(value)) << width << "x" << height;
    EXPECT_TRUE(is_worse(value, info().identical_value)) << width << "x" << height;
  }
}

TEST_P(MetricLaws, AlphaChangesNothingAndOneChannelIsGray) {
  const Image test = with_noise(reference(), 0.1F);
  Image with_alpha(64, 48, {"R", "G", "B", "A"}, encoding());
  for (std::size_t i = 0; i < test.pixel_count(); ++i) {
    std::copy_n(&test.pixels[3 * i], 3, &with_alpha.pixels[4 * i]);
    with_alpha.pixels[4 * i + 3] = 0.25F;
  }
  const double value = score_of(name(), reference(), test).value;
  EXPECT_EQ(score_of(name(), reference(), with_alpha).value, value);

  Image gray = perception::make_gray_image(64, 48, "Y", encoding());
  for (std::size_t i = 0; i < gray.pixels.size(); ++i) gray.pixels[i] = test.pixels[3 * i];
  const Image as_rgb = picture(64, 48, encoding(), [&](int x, int y) -> std::array<float, 3> {
    const float v = gray.at(x, y);
    return {v, v, v};
  });
  EXPECT_EQ(score_of(name(), reference(), gray).value, score_of(name(), reference(), as_rgb).value);
}

TEST_P(MetricLaws, NegativeValuesHaveAScore) {
  Image test = reference();
  test.at(20, 20, 0) = -0.4F;
  test.at(40, 12, 2) = -3.0F;
  const double value = score_of(name(), reference(), test).value;
  EXPECT_TRUE(std::isfinite(value)) << value;
  EXPECT_FALSE(is_worse(info().identical_value, value)) << value;
}

TEST_P(MetricLaws, MirroredImagesScoreTheSame) {
  // 128 x 64: whole at every level of a decimated pyramid, whose grid starts at the other end of a
  // mirrored picture all the same.
  const Image first = reference(128, 64);
  const Image second = with_noise(first, 0.15F);
  const double value = score_of(name(), first, second).value;
  const double mirrored = score_of(name(), in_mirror(first), in_mirror(second)).value;
  const bool lack_the_feature =
      judges_one_feature(name()) && std::isnan(value) && std::isnan(mirrored);
  if (lack_the_feature) return;
  EXPECT_NEAR(mirrored, value, 0.02 * std::abs(value) + 1e-9);
}

TEST_P(MetricLaws, ThreadsDoNotChangeAByte) {
  const Image test = with_noise(reference(131, 77), 0.1F);
  const auto with_threads = [&](int threads) {
    const base::ThreadLimit limit(threads);
    return score_of(name(), reference(131, 77), test);
  };
  const auto one = with_threads(1);
  const auto two = with_threads(2);
  EXPECT_TRUE(is_same(one.value, two.value)) << one.value << " " << two.value;
  EXPECT_EQ(one.map->pixels, two.map->pixels);
  ASSERT_EQ(one.details.size(), two.details.size());
  for (std::size_t i = 0; i < one.details.size(); ++i) {
    EXPECT_TRUE(is_same(one.details[i].value, two.details[i].value)) << one.details[i].name;
  }
}

std::vector<std::string> metric_names() {
  std::vector<std::string> names;
  for (const auto& info : metrics::metric_list()) names.push_back(info.name);
  return names;
}

INSTANTIATE_TEST_SUITE_P(EveryMetric, MetricLaws,
                         testing::Combine(testing::ValuesIn(metric_names()),
                                          testing::Values(Encoding::display,
                                                          Encoding::scene_linear)),
                         [](const auto& test) {
                           return base::snake_case(std::get<0>(test.param)) +
                                  (std::get<1>(test.param) == Encoding::display ? "_display"
                                                                                : "_linear");
                         });

}  // namespace
