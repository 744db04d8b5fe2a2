#include "results/figures/gnuplot_text.h"

#include <gtest/gtest.h>

#include "results/figures/label_placement.h"

namespace {

using namespace results::figures;

TEST(GnuplotText, MarksOfEnhancedTextAreEscaped) {
  EXPECT_EQ(gnuplot_string("a_b^c{d}@&~\\"), R"('a\_b\^c\{d\}\@\&\~\\')");
  EXPECT_EQ(gnuplot_string("it's `date` \"x\" $y"), R"('it''s `date` "x" $y')");
  EXPECT_EQ(gnuplot_string("line\nbreak\t"), "'line break '");
  EXPECT_EQ(gnuplot_string("50 %"), "'50 %'");
  EXPECT_EQ(gnuplot_tic_string("50 %"), "'50 %%'");
  EXPECT_EQ(gnuplot_bold_string("a_b"), R"('{/:Bold a\_b}')");
  EXPECT_EQ(gnuplot_plain_string("/tmp/o'neil_1"), "'/tmp/o''neil_1'");
}

TEST(GnuplotText, ControlsOfDirectionAreSpelled) {
  EXPECT_EQ(gnuplot_string("a\u202egnp.exe"), R"('a\\u202egnp.exe')");
  EXPECT_EQ(gnuplot_comment("a\u2066b"), R"(a\u2066b)");
}

TEST(GnuplotText, ACommentCannotEndNorSwallowTheNextLine) {
  EXPECT_EQ(gnuplot_comment("a\nsystem('rm')\\"), "a system('rm')\\.");
}

TEST(GnuplotText, ShortenedTextKeepsWholeCharacters) {
  EXPECT_EQ(shortened("short", 10.0, 9.0), "short");
  const std::string cut = shortened("ääääääääääääääääääää", 2.0, 9.0);
  EXPECT_TRUE(cut.ends_with("..."));
  EXPECT_EQ(cut.find("ä..."), cut.size() - 5);
  EXPECT_LE(text_width_cm(cut, 9.0), 2.0);
}

TEST(LabelPlacement, LabelsKeepOffMarksOtherLabelsAndTheEdge) {
  const PageBox box{0.0, 0.0, 10.0, 6.0};
  std::vector<LabelledMark> marks;
  for (int i = 0; i < 12; ++i) marks.push_back({1.0 + 0.7 * i, 3.0 + 0.1 * i, "val[vals=30]"});
  const auto places = place_labels(marks, {{0.0, 2.9, 10.0, 0.02}}, box, 7.5);
  const auto overlap = [](const PageBox& a, const PageBox& b) {
    return a.left < b.right() && b.left < a.right() && a.bottom < b.top() && b.bottom < a.top();
  };
  std::size_t placed = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (!places[i]) continue;
    ++placed;
    EXPECT_GE(places[i]->box.left, 0.0);
    EXPECT_LE(places[i]->box.right(), 10.0);
    EXPECT_FALSE(overlap(places[i]->box, {0.0, 2.9, 10.0, 0.02}));
    for (std::size_t j = 0; j < i; ++j) {
      EXPECT_FALSE(places[j] && overlap(places[i]->box, places[j]->box)) << i << " " << j;
    }
  }
  EXPECT_GE(placed, 8U);
}

}  // namespace
