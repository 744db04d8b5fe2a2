#include "perception/exr_header_check.h"

#include <array>
#include <cstdint>
#include <fstream>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "perception/base/errors.h"

namespace perception {
namespace {

constexpr std::uint32_t kMagic = 20000630;
constexpr std::uint32_t kMultiPart = 0x1000;  ///< of the version field
/// Longest name or type, with long names on.
constexpr std::size_t kLongestName_bytes = 255;

std::optional<std::uint32_t> next_word(std::istream& file) {
  std::array<unsigned char, 4> bytes{};
  if (!file.read(reinterpret_cast<char*>(bytes.data()), bytes.size())) return std::nullopt;
  return bytes[0] | bytes[1] << 8U | bytes[2] << 16U | std::uint32_t{bytes[3]} << 24U;
}

/// A text that ends with a 0; nothing if it has no end.
std::optional<std::string> next_text(std::istream& file) {
  std::string text;
  for (char c = 0; file.get(c) && text.size() <= kLongestName_bytes;) {
    if (c == '\0') return text;
    text += c;
  }
  return std::nullopt;
}

/// Passes one header over.
/// @return true if another part's may follow: it had attributes, and ended as it should
bool pass_header(std::istream& file, std::int64_t size_bytes) {
  for (bool has_attributes = false;; has_attributes = true) {
    const auto name = next_text(file);
    if (!name) return false;
    if (name->empty()) return has_attributes;
    const auto type = next_text(file);
    const auto length = type ? next_word(file) : std::nullopt;
    if (!length) return false;
    const std::int64_t left = size_bytes - static_cast<std::int64_t>(file.tellg());
    if (std::int64_t{*length} > left) {
      throw base::InputError(
          fmt::format("its attribute \"{}\" has {} bytes, {} are left: the file is damaged or cut",
                      *name, *length, left));
    }
    file.seekg(*length, std::ios::cur);
  }
}

}  // namespace

void check_exr_header(const std::filesystem::path& path) {
  std::error_code error;
  const auto size_bytes = static_cast<std::int64_t>(std::filesystem::file_size(path, error));
  std::ifstream file(path, std::ios::binary);
  if (error || !file || next_word(file) != kMagic) return;
  const auto version = next_word(file);
  if (!version) return;
  while (pass_header(file, size_bytes) && (*version & kMultiPart) != 0) {
  }
}

}  // namespace perception
