#include "perception/base/document.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/expect_input_error.h"

namespace base {
namespace {

using tests::input_error_of;

TEST(Document, KeepsKindsValuesAndPlaces) {
  const Node root = parse_document(
      "schema: 1\n"
      "name: box\n"
      "fov: 38.5\n"
      "on_top: true\n"
      "size: [4, 2e2]\n"
      "nested: {a: '7', b: null}\n",
      "s.yaml");
  EXPECT_EQ(root.find("schema")->integer("schema"), 1);
  EXPECT_EQ(root.find("name")->text("name"), "box");
  EXPECT_DOUBLE_EQ(root.find("fov")->number("fov"), 38.5);
  EXPECT_TRUE(root.find("on-top")->boolean("on_top"));
  EXPECT_DOUBLE_EQ(root.find("size")->list("size")[1].number("size"), 200.0);
  EXPECT_EQ(root.find("nested")->find("a")->text("a"), "7");
  EXPECT_TRUE(root.find("nested")->find("b")->is_null());
  const Place place = root.find("nested")->find("a")->place();
  EXPECT_EQ(to_string(place), "s.yaml:6:13");
  EXPECT_EQ(to_string(root.key_place("fov")), "s.yaml:3:1");
}

TEST(Document, ReadsJson) {
  const Node root = parse_document(R"({"a": [1, 2.5, "x\n", false], "b": {"c": null}})", "j.json");
  EXPECT_EQ(root.to_json().dump(), R"({"a":[1,2.5,"x\n",false],"b":{"c":null}})");
}

TEST(Document, RefusesWhatReadersDisagreeOn) {
  EXPECT_EQ(input_error_of([] { parse_document("a: 1\nb: 2\na: 3\n", "s.yaml"); }),
            "s.yaml:3:1: duplicate key \"a\"; it stands first in line 1");
  EXPECT_EQ(input_error_of([] { parse_document("a-b: 1\na_b: 2\n", "s.yaml"); }),
            "s.yaml:2:1: duplicate key \"a_b\"; it stands first in line 1");
  EXPECT_EQ(input_error_of([] { parse_document("a: yes\n", "s.yaml"); }),
            "s.yaml:1:4: \"yes\" is not accepted: write true or false, a finite number, or quote "
            "it if text is meant");
  EXPECT_EQ(input_error_of([] { parse_document("a: 010\n", "s.yaml"); }),
            "s.yaml:1:4: number \"010\" has a leading zero; write it without, or quote it if text "
            "is meant");
  EXPECT_EQ(input_error_of([] { parse_document("a: &x 1\nb: *x\n", "s.yaml"); }),
            "s.yaml:1:4: anchors and aliases are not accepted; write the value out");
  EXPECT_EQ(input_error_of([] { parse_document("a: .nan\n", "s.yaml"); }).substr(0, 10),
            "s.yaml:1:4");
  EXPECT_EQ(input_error_of([] { parse_document("a: 1\n---\nb: 1\n", "s.yaml"); }),
            "s.yaml: holds several documents; one is accepted");
  EXPECT_EQ(input_error_of([] { parse_document("a: 1e999\n", "s.yaml"); }),
            "s.yaml:1:4: number \"1e999\" is out of range");
  EXPECT_EQ(input_error_of([] { parse_document("a: [1, 2\n", "s.yaml"); }).substr(0, 7), "s.yaml:");
}

TEST(Document, QuotedWordsAreText) {
  const Node root = parse_document("a: 'yes'\nb: \"010\"\n", "s.yaml");
  EXPECT_EQ(root.find("a")->text("a"), "yes");
  EXPECT_EQ(root.find("b")->text("b"), "010");
}

TEST(Document, KindErrorsSayWhatWasFound) {
  const Node root = parse_document("fov: wide\nsize: [1]\ncount: 1.5\n", "s.yaml");
  EXPECT_EQ(input_error_of([&] { root.find("fov")->number("fov"); }),
            "s.yaml:1:6: fov must be a number, not \"wide\" (text)");
  EXPECT_EQ(input_error_of([&] { root.find("size")->text("size"); }),
            "s.yaml:2:7: size must be text, not a list");
  EXPECT_EQ(input_error_of([&] { root.find("count")->integer("count"); }),
            "s.yaml:3:8: count must be a whole number, not \"1.5\" (a number)");
  EXPECT_EQ(input_error_of([&] { number_list(*root.find("size"), "size", 2); }),
            "s.yaml:2:7: size must hold 2 numbers, not 1");
}

TEST(MapReader, RefusesKeysNobodyAskedFor) {
  const Node root = parse_document("fov: 40\npostion: [0, 0, 0]\n", "s.yaml");
  MapReader reader(root, "camera");
  EXPECT_DOUBLE_EQ(reader.number("fov", 1.0), 40.0);
  EXPECT_EQ(reader.find("position"), nullptr);
  EXPECT_EQ(input_error_of([&] { reader.finish(); }),
            "s.yaml:2:1: unknown key \"postion\"; did you mean \"position\"? known: fov, position "
            "in camera");
}

TEST(MapReader, NamesTheMissingKey) {
  const Node root = parse_document("a: 1\n", "s.yaml");
  MapReader reader(root, "camera");
  EXPECT_EQ(input_error_of([&] { reader.require("position"); }),
            "s.yaml:1:1: camera has no \"position\"; it is required");
  const Node list = parse_document("[1]", "s.yaml");
  EXPECT_EQ(input_error_of([&] { MapReader(list, "camera"); }),
            "s.yaml:1:1: camera must be a map of keys and values, not a list");
}

TEST(Document, AnEmptyDocumentIsNothingAtItsBegin) {
  for (const char* text : {"", "\n# only a remark\n"}) {
    const Node root = parse_document(text, "s.yaml");
    EXPECT_EQ(input_error_of([&] { MapReader(root, "suite"); }),
              "s.yaml:1:1: suite must be a map of keys and values, not nothing");
  }
}

TEST(Document, MissingFileNamesTheReason) {
  EXPECT_EQ(input_error_of([] { read_document("/no/such.yaml"); }),
            "/no/such.yaml: cannot be read: No such file or directory");
}

}  // namespace
}  // namespace base
