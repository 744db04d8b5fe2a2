#include <gtest/gtest.h>

#include <atomic>
#include <filesystem>
#include <set>
#include <vector>

#include "perception/base/atomic_file.h"
#include "perception/base/errors.h"
#include "perception/base/hash.h"
#include "perception/base/log_file.h"
#include "perception/base/names.h"
#include "perception/base/parallel.h"
#include "perception/base/quantile.h"
#include "tests/expect_input_error.h"
#include "tests/temporary_folder.h"

namespace base {
namespace {

using tests::input_error_of;

TEST(Errors, UnknownNameOffersTheNearest) {
  const std::vector<std::string> known{"blank", "path"};
  EXPECT_EQ(unknown_name("renderer", "pth", known),
            "unknown renderer \"pth\"; did you mean \"path\"? known: blank, path");
  EXPECT_EQ(unknown_name("renderer", "radiosity", known),
            "unknown renderer \"radiosity\"; known: blank, path");
  EXPECT_EQ(unknown_name("preset", "x", {}), "unknown preset \"x\"; known: none");
}

TEST(Names, DashAndUnderscoreAreTheSame) {
  EXPECT_TRUE(is_same_name("ray-bundles", "Ray_Bundles"));
  EXPECT_FALSE(is_same_name("raybundles", "ray-bundles"));
  EXPECT_EQ(kebab_case("Max_Depth"), "max-depth");
  EXPECT_EQ(snake_case("max-depth"), "max_depth");
  EXPECT_TRUE(is_path_safe("val-30.a_b"));
  for (const char* bad : {"", ".a", "-a", "a/b", "a b", "\xc3\xa4"})
    EXPECT_FALSE(is_path_safe(bad));
}

TEST(Quantile, InterpolatesBetweenOrderStatistics) {
  const std::vector<double> values{4.0, 1.0, 3.0, 2.0};
  EXPECT_DOUBLE_EQ(quantile(values, 0.0), 1.0);
  EXPECT_DOUBLE_EQ(quantile(values, 1.0), 4.0);
  EXPECT_DOUBLE_EQ(quantile(values, 0.25), 1.75);  // numpy.quantile([4, 1, 3, 2], 0.25)
  EXPECT_DOUBLE_EQ(median(values), 2.5);
  EXPECT_DOUBLE_EQ(quantile_of_sorted(std::vector<double>{1.0, 2.0, 3.0, 4.0}, 0.25), 1.75);
}

TEST(Hash, DependsOnContentAndBoundaries) {
  EXPECT_EQ(hash_of("abc"), hash_of("abc"));
  EXPECT_EQ(hash_of("abc").hex().size(), 32U);
  EXPECT_NE(hash_of("abc"), hash_of("abd"));
  Hasher first;
  first.add(std::string_view("a"));
  first.add(std::string_view("bc"));
  Hasher second;
  second.add(std::string_view("ab"));
  second.add(std::string_view("c"));
  EXPECT_NE(first.finish(), second.finish());
  Hasher positive;
  positive.add(0.0);
  Hasher negative;
  negative.add(-0.0);
  EXPECT_EQ(positive.finish(), negative.finish());
}

TEST(Parallel, CoversEveryIndexOnceInAlignedPieces) {
  for (const int threads : {1, 2, 3}) {
    const ThreadLimit limit(threads);
    std::vector<std::atomic<int>> visits(1001);
    parallel_for(visits.size(), 64, [&](std::size_t begin, std::size_t end) {
      EXPECT_EQ(begin % 64, 0U);
      EXPECT_LE(end - begin, 64U);
      for (std::size_t i = begin; i < end; ++i) ++visits[i];
    });
    for (const auto& count : visits) EXPECT_EQ(count, 1);
  }
}

TEST(AtomicFile, LeavesNothingHalfWritten) {
  const tests::TemporaryFolder folder;
  const auto path = folder.path() / "a.txt";
  write_text_file(path, "first");
  EXPECT_THROW(write_file_atomically(path,
                                     [](const std::filesystem::path& temporary) {
                                       write_text_file(temporary, "half");
                                       throw InputError("disk full");
                                     }),
               InputError);
  EXPECT_EQ(read_text_file(path), "first");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
  EXPECT_EQ(input_error_of([&] { write_text_file("/no/such/folder/a", "x"); }),
            "/no/such/folder/a: cannot be written: No such file or directory");
}

TEST(LogFile, KeepsBothEnds) {
  const tests::TemporaryFolder folder;
  const auto path = folder.path() / "log";
  write_text_file(path, "begin" + std::string(1000, '.') + "end!!");
  keep_first_and_last(path, 5);
  EXPECT_EQ(read_text_file(path), "begin\n[... 1000 bytes left out ...]\nend!!");
  keep_first_and_last(path, 5000);
  EXPECT_EQ(read_text_file(path).substr(0, 5), "begin");
}

}  // namespace
}  // namespace base
