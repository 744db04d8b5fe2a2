#include "perception/base/units.h"

#include <gtest/gtest.h>

#include "tests/expect_input_error.h"

namespace base {
namespace {

using tests::input_error_of;
const Place kPlace{"s.yaml", 3, 7};

TEST(Units, Durations) {
  EXPECT_DOUBLE_EQ(parse_duration_s("10s", kPlace), 10.0);
  EXPECT_DOUBLE_EQ(parse_duration_s("250ms", kPlace), 0.25);
  EXPECT_DOUBLE_EQ(parse_duration_s("1.5 min", kPlace), 90.0);
  EXPECT_DOUBLE_EQ(parse_duration_s("10m", kPlace), 600.0);
  EXPECT_DOUBLE_EQ(parse_duration_s("2h", kPlace), 7200.0);
  EXPECT_EQ(input_error_of([] { parse_duration_s("10", kPlace); }),
            "s.yaml:3:7: duration \"10\" is not a number with a unit; accepted units: ns, us, ms, "
            "s, min, m, h (e.g. \"2h\")");
  EXPECT_EQ(input_error_of([] { parse_duration_s("-1s", kPlace); }),
            "s.yaml:3:7: duration \"-1s\" must be greater than 0");
}

TEST(Units, BytesAndPercent) {
  EXPECT_EQ(parse_bytes("8GiB", kPlace), std::int64_t{8} << 30);
  EXPECT_EQ(parse_bytes("1.5kB", kPlace), 1500);
  EXPECT_DOUBLE_EQ(parse_percent("2%", kPlace), 0.02);
  EXPECT_EQ(input_error_of([] { parse_percent("0.02", kPlace); }),
            "s.yaml:3:7: percentage \"0.02\" is not a number with a unit; accepted units: % (e.g. "
            "\"2%\")");
  EXPECT_EQ(input_error_of([] { parse_bytes("99999999999GiB", kPlace); }),
            "s.yaml:3:7: size in bytes \"99999999999GiB\" is greater than 8 EiB");
}

TEST(Units, Sizes) {
  EXPECT_EQ(parse_size_px("640x480", kPlace), (SizePx{640, 480}));
  for (const char* bad : {"640", "0x4", "4x0", "640x", "x480", "640x480x3", "640X480", "70000x1"}) {
    EXPECT_NE(input_error_of([&] { parse_size_px(bad, kPlace); }), "no error") << bad;
  }
}

TEST(Units, Formatting) {
  EXPECT_EQ(format_duration(1.2345), "1.23 s");
  EXPECT_EQ(format_duration(0.0831), "83.1 ms");
  EXPECT_EQ(format_duration(12e-6), "12.0 us");
  EXPECT_EQ(format_duration(120.0), "2.00 min");
  EXPECT_EQ(format_bytes(1610612736.0), "1.50 GiB");
  EXPECT_EQ(format_bytes(12.0), "12.0 B");
  EXPECT_EQ(format_significant(0.000123456, 3), "0.000123");
  EXPECT_EQ(format_significant(1.23456e-7, 3), "1.23e-07");
  EXPECT_EQ(utc_now().size(), 20U);
}

}  // namespace
}  // namespace base
