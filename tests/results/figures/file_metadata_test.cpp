// Words about a picture inside its file, read back by the formats' own rules.
#include "results/figures/file_metadata.h"

#include <cstdint>
#include <map>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <zlib.h>

namespace {

using results::figures::add_pdf_metadata;
using results::figures::add_png_metadata;
using results::figures::add_svg_metadata;

/// A document as cairo ends one: objects, a table, a trailer.
std::string small_pdf() {
  std::string pdf = "%PDF-1.5\n1 0 obj\n<< /Type /Catalog >>\nendobj\n";
  const std::size_t table = pdf.size();
  pdf += "xref\n0 2\n0000000000 65535 f \n0000000009 00000 n \n";
  return pdf + fmt::format(
                   "trailer\n<< /Size 2\n   /Root 1 0 R\n   /Info 1 0 R\n>>\nstartxref\n{}\n"
                   "%%EOF\n",
                   table);
}

/// What the last cross-reference table of a file says: where its one object begins.
std::size_t updated_object(const std::string& pdf) {
  const std::size_t start = pdf.rfind("startxref\n") + 10;
  const std::size_t table = std::stoul(pdf.substr(start));
  EXPECT_EQ(pdf.substr(table, 9), "xref\n2 1\n");
  return std::stoul(pdf.substr(table + 9, 10));
}

/// The value that a PDF has for a text.
std::string pdf_text(const std::string& text) {
  std::string pdf = small_pdf();
  EXPECT_TRUE(add_pdf_metadata(pdf, {{"Title", text}}));
  const std::string object = pdf.substr(updated_object(pdf));
  const std::size_t begin = object.find("/Title ") + 7;
  return object.substr(begin, object.find('\n', begin) - begin);
}

TEST(FileMetadata, OfAPdfHasWhatIsNoTextReplaced) {
  EXPECT_NE(pdf_text("\xe0\x80\x80").find("<FEFFFFFDFFFDFFFD>"), std::string::npos) << "overlong";
  EXPECT_NE(pdf_text("\xed\xa0\x80").find("<FEFFFFFDFFFDFFFD>"), std::string::npos) << "surrogate";
  EXPECT_NE(pdf_text("\xf4\x90\x80\x80").find("<FEFFFFFDFFFDFFFDFFFD>"), std::string::npos);
  EXPECT_NE(pdf_text("a\u202eb").find("<FEFF0061005C007500320030003200650062>"), std::string::npos)
      << "spelled out";
}

TEST(FileMetadata, OfAPdfIsItsDocumentInformation) {
  const std::string before = small_pdf();
  std::string pdf = before;
  ASSERT_TRUE(add_pdf_metadata(pdf, {{"Title", "Figure 1 (a\\b)"}, {"Subject", "häß 𝄞"}}));
  EXPECT_TRUE(pdf.starts_with(before)) << "an update leaves what was there";
  const std::string object = pdf.substr(updated_object(pdf));
  EXPECT_TRUE(object.starts_with("2 0 obj\n<< /Title (Figure 1 \\(a\\\\b\\))\n")) << object;
  EXPECT_NE(object.find("/Subject <FEFF006800E400DF0020D834DD1E>"), std::string::npos) << object;
  const std::size_t old_table = before.find("xref\n");
  EXPECT_NE(pdf.find(fmt::format("<< /Size 3 /Root 1 0 R /Info 2 0 R /Prev {} >>", old_table)),
            std::string::npos)
      << pdf;
  EXPECT_TRUE(pdf.ends_with("%%EOF\n"));
}

TEST(FileMetadata, LeavesOtherFilesAsTheyAre) {
  const results::figures::Metadata metadata{{"Title", "a"}};
  for (const std::string& text :
       {std::string("%PDF-1.5\nno table"), std::string("not a file"), std::string()}) {
    std::string bytes = text;
    EXPECT_FALSE(add_pdf_metadata(bytes, metadata));
    EXPECT_FALSE(add_png_metadata(bytes, metadata));
    EXPECT_FALSE(add_svg_metadata(bytes, metadata));
    EXPECT_EQ(bytes, text);
  }
}

std::uint32_t big_endian(const std::string& bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    value = (value << 8U) | static_cast<unsigned char>(bytes[at + i]);
  }
  return value;
}

TEST(FileMetadata, OfAPngIsTextAfterItsHeader) {
  // Signature, header of 13 bytes, end; their checks are not looked at here.
  const std::string signature("\x89PNG\r\n\x1a\n", 8);
  const std::string header("\0\0\0\x0dIHDR\0\0\0\1\0\0\0\1\x08\2\0\0\0____", 25);
  const std::string end("\0\0\0\0IEND____", 12);
  std::string png = signature + header + end;
  ASSERT_TRUE(add_png_metadata(png, {{"Title", "Füße"}, {"Creator", "discern"}}));
  EXPECT_TRUE(png.starts_with(signature + header));
  EXPECT_TRUE(png.ends_with(end));
  std::map<std::string, std::string> texts;
  std::size_t at = 33;
  while (png.substr(at + 4, 4) == "iTXt") {
    const std::uint32_t length = big_endian(png, at);
    const std::string content = png.substr(at + 4, length + 4);
    EXPECT_EQ(big_endian(png, at + 8 + length),
              crc32(0L, reinterpret_cast<const Bytef*>(content.data()),
                    static_cast<uInt>(content.size())));
    const std::size_t name_end = content.find('\0');
    texts[content.substr(4, name_end - 4)] = content.substr(name_end + 5);
    at += 12 + length;
  }
  EXPECT_EQ(png.substr(at), end);
  EXPECT_EQ(texts, (std::map<std::string, std::string>{{"Title", "Füße"}, {"Creator", "discern"}}));
}

TEST(FileMetadata, OfASvgIsEscaped) {
  std::string svg = "<?xml version=\"1.0\"?>\n<svg width=\"1\">\n</svg>\n";
  ASSERT_TRUE(add_svg_metadata(svg, {{"Title", "a < b"}}));
  EXPECT_NE(svg.find("<svg width=\"1\">\n<metadata>\na &lt; b\n</metadata>"), std::string::npos)
      << svg;
}

}  // namespace
