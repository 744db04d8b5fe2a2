#include "results/figures/file_metadata.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>

#include <fmt/format.h>
#include <zlib.h>

#include "perception/base/code_points.h"
#include "results/figures/gnuplot_text.h"
#include "results/markup_text.h"

namespace results::figures {

namespace {

/// Code points of UTF-8; what is none becomes U+FFFD.
std::vector<char32_t> code_points(std::string_view text) {
  constexpr char32_t kReplacement = 0xFFFD;
  std::vector<char32_t> points;
  while (!text.empty()) {
    const base::FirstCharacter first = base::first_character(text);
    points.push_back(first.code_point.value_or(kReplacement));
    text.remove_prefix(first.bytes);
  }
  return points;
}

/// ISO 32000-1, Sec. 7.9.2.2: ASCII as it is, else UTF-16 with a byte order mark.
std::string pdf_string(std::string_view text) {
  const bool is_ascii = std::ranges::all_of(
      text, [](char c) { return static_cast<unsigned char>(c) < 0x80 && (c >= ' ' || c == '\n'); });
  if (is_ascii) {
    std::string literal = "(";
    for (const char c : text) {
      if (c == '(' || c == ')' || c == '\\') literal += '\\';
      literal += c;
    }
    return literal + ")";
  }
  std::string hex = "<FEFF";
  for (char32_t point : code_points(base::with_spelled_directions(text))) {
    if (point >= 0x10000) {
      point -= 0x10000;
      hex += fmt::format("{:04X}{:04X}", 0xD800U + (point >> 10U), 0xDC00U + (point & 0x3FFU));
    } else {
      hex += fmt::format("{:04X}", static_cast<std::uint32_t>(point));
    }
  }
  return hex + ">";
}

/// The text after the last place of a key, up to the next of the delimiters.
std::optional<std::string> last_value(std::string_view text, std::string_view key) {
  const std::size_t at = text.rfind(key);
  if (at == std::string_view::npos) return std::nullopt;
  const std::size_t begin = text.find_first_not_of(" \r\n", at + key.size());
  if (begin == std::string_view::npos) return std::nullopt;
  const std::size_t end = text.find_first_of("/>\r\n", begin);
  std::string value(text.substr(begin, end == std::string_view::npos ? end : end - begin));
  while (!value.empty() && value.back() == ' ') value.pop_back();
  return value;
}

bool is_number(const std::optional<std::string>& text) {
  return text && !text->empty() && text->size() < 12 &&
         std::ranges::all_of(*text, [](char c) { return c >= '0' && c <= '9'; });
}

void append_big_endian(std::string& bytes, std::uint32_t value) {
  for (const unsigned shift : {24U, 16U, 8U, 0U}) bytes += static_cast<char>(value >> shift);
}

std::string png_chunk(const std::string& type, const std::string& data) {
  std::string bytes;
  append_big_endian(bytes, static_cast<std::uint32_t>(data.size()));
  const std::string content = type + data;
  bytes += content;
  const auto* begin = reinterpret_cast<const Bytef*>(content.data());
  append_big_endian(
      bytes, static_cast<std::uint32_t>(crc32(0L, begin, static_cast<uInt>(content.size()))));
  return bytes;
}

}  // namespace

bool add_svg_metadata(std::string& svg, const Metadata& metadata) {
  const std::size_t begin = svg.find("<svg");
  const std::size_t end = begin == std::string::npos ? begin : svg.find('>', begin);
  if (end == std::string::npos) return false;
  std::string element = "\n<metadata>";
  for (const auto& [name, text] : metadata) element += "\n" + escape(gnuplot_comment(text));
  svg.insert(end + 1, element + "\n</metadata>");
  return true;
}

bool add_pdf_metadata(std::string& pdf, const Metadata& metadata) {
  const std::size_t trailer = pdf.rfind("trailer");
  if (!pdf.starts_with("%PDF-") || trailer == std::string::npos) return false;
  const std::string_view tail = std::string_view(pdf).substr(trailer);
  const std::optional<std::string> size = last_value(tail, "/Size");
  const std::optional<std::string> root = last_value(tail, "/Root");
  const std::optional<std::string> table = last_value(tail, "startxref");
  if (!is_number(size) || !root || !is_number(table)) return false;
  if (!pdf.ends_with('\n')) pdf += '\n';
  const std::size_t object = pdf.size();
  pdf += fmt::format("{} 0 obj\n<<", *size);
  for (const auto& [name, text] : metadata) pdf += fmt::format(" /{} {}\n", name, pdf_string(text));
  pdf += ">>\nendobj\n";
  const std::size_t update = pdf.size();
  // Sec. 7.5.4: an entry is twenty bytes, its end of line among them.
  pdf += fmt::format(
      "xref\n{0} 1\n{1:010} 00000 n \ntrailer\n<< /Size {2} /Root {3} /Info {0} 0 R "
      "/Prev {4} >>\nstartxref\n{5}\n%%EOF\n",
      *size, object, std::stoll(*size) + 1, *root, *table, update);
  return true;
}

bool add_png_metadata(std::string& png, const Metadata& metadata) {
  // Signature and header chunk: 8 bytes; length, type, 13 bytes, check.
  constexpr std::size_t kHeaderEnd = 8 + 4 + 4 + 13 + 4;
  if (png.size() < kHeaderEnd || !png.starts_with("\x89PNG\r\n\x1a\n")) return false;
  std::string chunks;
  for (const auto& [name, text] : metadata) {
    // Keyword, not compressed, no language, no translated keyword, text.
    chunks += png_chunk("iTXt", name + std::string(5, '\0') + text);
  }
  png.insert(kHeaderEnd, chunks);
  return true;
}

}  // namespace results::figures
