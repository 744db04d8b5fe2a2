#include "perception/exr_header_check.h"

#include <cstdint>
#include <string>
#include <string_view>

#include <gtest/gtest.h>

#include "perception/base/atomic_file.h"
#include "perception/image_file.h"
#include "tests/expect_input_error.h"
#include "tests/temporary_folder.h"

namespace perception {
namespace {

std::string word(std::uint32_t value) {
  std::string bytes;
  for (int i = 0; i < 4; ++i) bytes += static_cast<char>(value >> (8 * i) & 0xffU);
  return bytes;
}

/// An attribute of a text that says another length than it has.
std::string text_attribute(const std::string& name, std::uint32_t length, const std::string& text) {
  return name + '\0' + "string" + '\0' + word(length) + text;
}

/// `input_error_of` where there is none.
constexpr const char* kNone = "no error";

class ExrHeaderCheck : public testing::Test {
 protected:
  static constexpr std::uint32_t kSinglePart = 2;
  static constexpr std::uint32_t kMultiPart = 0x1002;

  std::string message_of(std::uint32_t version, const std::string& headers) const {
    base::write_text_file(path_, word(20000630) + word(version) + headers);
    return tests::input_error_of([&] { check_exr_header(path_); });
  }

  const tests::TemporaryFolder folder_;
  const std::filesystem::path path_ = folder_.path() / "x.exr";
};

/// Found by a fuzzer: OpenEXR made room for the text first, 3 GB of memory for 180 bytes.
TEST_F(ExrHeaderCheck, ATextThatIsLongerThanTheFileIsRefusedBeforeItIsRead) {
  const std::string header = text_attribute("c:encoding", 1644167180, "scene_linear");
  EXPECT_EQ(
      message_of(kSinglePart, header),
      "its attribute \"c:encoding\" has 1644167180 bytes, 12 are left: the file is damaged or "
      "cut");
  EXPECT_EQ(
      tests::input_error_of([&] { read_image(path_); }),
      path_.string() +
          ": cannot be read as EXR: its attribute \"c:encoding\" has 1644167180 bytes, 12 are "
          "left: the file is damaged or cut");
}

TEST_F(ExrHeaderCheck, ATextThatFillsTheFileIsNot) {
  EXPECT_EQ(message_of(kSinglePart, text_attribute("a", 12, "scene_linear")), kNone);
  EXPECT_NE(message_of(kSinglePart, text_attribute("a", 13, "scene_linear")), kNone);
  EXPECT_NE(message_of(kSinglePart, text_attribute("a", 0xffffffff, "scene_linear")), kNone);
}

TEST_F(ExrHeaderCheck, EveryPartOfAFileOfPartsIsLookedAt) {
  const std::string good = text_attribute("a", 1, "x") + '\0';
  const std::string bad = text_attribute("b", 99, "x");
  EXPECT_NE(message_of(kMultiPart, good + good + bad), kNone);
  EXPECT_EQ(message_of(kMultiPart, good + good + '\0' + bad), kNone);  // pixels by then
  EXPECT_EQ(message_of(kSinglePart, good + bad), kNone);
}

TEST_F(ExrHeaderCheck, WhatElseIsWrongIsLeftToTheReader) {
  for (const std::string& headers : {std::string(), std::string("name"), std::string(999, 'n'),
                                     std::string("a\0string\0\1\0", 11)}) {
    EXPECT_EQ(message_of(kMultiPart, headers), kNone);
  }
  base::write_text_file(path_, "no EXR at all");
  EXPECT_NO_THROW(check_exr_header(path_));
  EXPECT_NO_THROW(check_exr_header(folder_.path() / "none.exr"));
}

}  // namespace
}  // namespace perception
