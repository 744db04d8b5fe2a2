#include "perception/pfm_file.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <sstream>

#include <fmt/format.h>

#include "perception/base/atomic_file.h"
#include "perception/base/errors.h"

namespace perception {
namespace {

constexpr int kMaxSidePx = 65536;

struct PfmHeader {
  int width_px = 0;
  int height_px = 0;
  bool is_color = false;
  bool is_little_endian = false;
  std::size_t size_bytes = 0;
};

[[noreturn]] void fail(const std::filesystem::path& path, const std::string& reason) {
  throw base::InputError(fmt::format("{}: cannot be read as PFM: {}", path.string(), reason));
}

PfmHeader parse_header(const std::filesystem::path& path, const std::string& bytes) {
  // The header is three words lines; one white-space character ends it.
  std::istringstream stream(bytes.substr(0, 128));
  stream.imbue(std::locale::classic());
  std::string magic;
  PfmHeader header;
  double scale = 0.0;
  stream >> magic;
  if (magic != "PF" && magic != "Pf") fail(path, "it does not begin with PF or Pf");
  stream >> header.width_px >> header.height_px >> scale;
  if (!stream || header.width_px < 1 || header.height_px < 1 || header.width_px > kMaxSidePx ||
      header.height_px > kMaxSidePx || scale == 0.0 || !std::isfinite(scale)) {
    fail(path, fmt::format("bad header; accepted: PF or Pf, width and height of 1 to {}, and a "
                           "scale that is not 0",
                           kMaxSidePx));
  }
  header.is_color = magic == "PF";
  header.is_little_endian = scale < 0.0;
  header.size_bytes = stream.eof() ? bytes.size() : static_cast<std::size_t>(stream.tellg()) + 1;
  return header;
}

float float_at(const char* bytes, bool is_little_endian) {
  std::uint32_t bits = 0;
  std::memcpy(&bits, bytes, sizeof(bits));
  if (is_little_endian != (std::endian::native == std::endian::little)) {
    bits = __builtin_bswap32(bits);
  }
  return std::bit_cast<float>(bits);
}

}  // namespace

ImageFile read_pfm(const std::filesystem::path& path, std::optional<Encoding> encoding) {
  const std::string bytes = base::read_text_file(path);
  const PfmHeader header = parse_header(path, bytes);
  const std::size_t channels = header.is_color ? 3 : 1;
  const auto row = static_cast<std::size_t>(header.width_px) * channels;
  const std::size_t wanted =
      header.size_bytes + row * static_cast<std::size_t>(header.height_px) * sizeof(float);
  if (bytes.size() < wanted) {
    fail(path, fmt::format("it has {} bytes; its header asks for {}", bytes.size(), wanted));
  }
  Image image(
      header.width_px, header.height_px,
      header.is_color ? std::vector<std::string>{"R", "G", "B"} : std::vector<std::string>{"Y"},
      encoding.value_or(Encoding::scene_linear));
  const char* from = bytes.data() + header.size_bytes;
  for (int y = header.height_px - 1; y >= 0; --y) {
    float* to = image.pixels.data() + image.offset(0, y);
    for (std::size_t i = 0; i < row; ++i, from += sizeof(float)) {
      to[i] = float_at(from, header.is_little_endian);
    }
  }
  return {{{"", std::move(image)}}, {}};
}

}  // namespace perception
