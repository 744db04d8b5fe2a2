#include "renderers/scene/gltf_check.h"

#include "perception/base/atomic_file.h"
#include "perception/base/errors.h"
#include "renderers/scene/mesh_bytes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>

// Khronos Group, glTF 2.0 Specification: "GLB File Format Specification", "Accessors", "Meshes",
// "Specifying Extensions".

namespace renderers::scene {
namespace {

using nlohmann::json;

constexpr std::size_t kGlbHeaderBytes = 12;
constexpr std::size_t kGlbChunkHeaderBytes = 8;

/// Importers that read level by level on the stack would overflow it.
constexpr int kMostNested = 64;

/// mesh.primitive.mode of separate triangles, also the default.
constexpr std::size_t kTrianglesMode = 4;

/// Bytes of an index by accessor.componentType: unsigned byte, short, int.
const std::map<std::size_t, std::size_t> kIndexBytes{{5121, 1}, {5123, 2}, {5125, 4}};

/// Value of a base64 digit (RFC 4648, Table 1). @return nothing for other characters
std::optional<std::uint32_t> base64_digit(char c) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  const std::size_t digit = kDigits.find(c);
  if (digit == std::string_view::npos) return std::nullopt;
  return static_cast<std::uint32_t>(digit);
}

/// The bytes behind base64 text. @return nothing if it holds other characters
std::optional<std::string> decode_base64(std::string_view text) {
  text = text.substr(0, text.find('='));
  std::string bytes;
  bytes.reserve(text.size() / 4 * 3 + 3);
  std::uint32_t bits = 0;
  int bit_count = 0;
  for (const char c : text) {
    const auto digit = base64_digit(c);
    if (!digit) return std::nullopt;
    bits = (bits << 6U) | *digit;
    bit_count += 6;
    if (bit_count < 8) continue;
    bit_count -= 8;
    bytes += static_cast<char>((bits >> static_cast<unsigned>(bit_count)) & 0xFFU);
  }
  return bytes;
}

class GltfCheck {
 public:
  GltfCheck(std::string_view text, std::optional<std::string_view> binary_chunk,
            const std::filesystem::path& path)
      : path_(path), binary_chunk_(binary_chunk), document_(json::parse(text)) {}

  /// @return extensions that the file uses and could do without
  std::set<std::string> run() {
    const auto version = document_.at("asset").at("version").get<std::string>();
    if (!version.starts_with("2.")) {
      fail(fmt::format("glTF version \"{}\"; accepted: 2.x", version));
    }
    refuse_required_extensions();
    std::set<std::string> extensions = names_in("extensionsUsed");
    collect_extensions(extensions);
    check_meshes();
    return extensions;
  }

 private:
  void check_meshes() {
    if (!document_.contains("meshes")) return;
    const json& meshes = document_.at("meshes");
    for (std::size_t m = 0; m < meshes.size(); ++m) {
      const json& primitives = meshes.at(m).at("primitives");
      for (std::size_t p = 0; p < primitives.size(); ++p) {
        where_ = fmt::format("mesh {}, primitive {}: ", m, p);
        check_primitive(primitives.at(p));
      }
    }
  }

  std::set<std::string> names_in(const char* list) const {
    if (!document_.contains(list)) return {};
    return document_.at(list).get<std::set<std::string>>();
  }

  /// "Specifying Extensions": a file that requires one cannot be shown without it.
  void refuse_required_extensions() const {
    const std::set<std::string> required = names_in("extensionsRequired");
    if (required.empty()) return;
    fail(
        fmt::format("requires the glTF extension{} {}; supported: none, only what glTF 2.0 itself "
                    "says of triangles is read; accepted: the file exported without",
                    required.size() > 1 ? "s" : "", fmt::join(required, ", ")));
  }

  /// Names of extensions wherever they are used: not every writer lists them. What stands in
  /// extras is the application's own.
  void collect_extensions(std::set<std::string>& names) const {
    std::vector<OpenPart> open{{&document_}};
    while (!open.empty()) {
      const OpenPart part = open.back();
      open.pop_back();
      if (part.depth > kMostNested) {
        fail(fmt::format("nests deeper than {} levels; accepted: up to that", kMostNested));
      }
      for (const auto& [key, value] : part.json->items()) {
        const bool is_named = part.json->is_object();
        const bool is_own = part.is_own || (is_named && key == "extras");
        if (is_named && !is_own && key == "extensions" && value.is_object()) {
          for (const auto& [name, use] : value.items()) names.insert(name);
        }
        if (value.is_structured()) open.push_back({&value, part.depth + 1, is_own});
      }
    }
  }

  struct OpenPart {
    const nlohmann::json* json = nullptr;
    int depth = 1;
    bool is_own = false;  ///< within extras
  };

  struct IndexView {
    std::string_view data;
    std::size_t count = 0;
    std::size_t index_bytes = 0;
    std::size_t stride_bytes = 0;
  };

  void check_primitive(const json& primitive) {
    if (!primitive.contains("indices") || !primitive.at("attributes").contains("POSITION")) return;
    const json& positions = item("accessors", natural(primitive.at("attributes"), "POSITION"));
    const std::size_t vertices = natural(positions, "count");
    const IndexView view = indices_of(item("accessors", natural(primitive, "indices")));
    const bool has_faces = natural(primitive, "mode", kTrianglesMode) == kTrianglesMode;
    for (std::size_t i = 0; i < view.count; ++i) {
      const std::uint32_t index = index_at(view, i);
      if (index < vertices) continue;
      fail(fmt::format("{} {} names vertex {}; the primitive has {}", has_faces ? "face" : "corner",
                       has_faces ? i / 3 : i, index, vertices));
    }
  }

  static std::uint32_t index_at(const IndexView& view, std::size_t i) {
    const std::size_t offset = i * view.stride_bytes;
    if (view.index_bytes == 1) return value_at<std::uint8_t>(view.data, offset);
    if (view.index_bytes == 2) return value_at<std::uint16_t>(view.data, offset);
    return value_at<std::uint32_t>(view.data, offset);
  }

  /// The indices' bytes; none for an accessor without a bufferView, whose indices are all 0.
  IndexView indices_of(const json& accessor) {
    if (accessor.contains("sparse")) fail("sparse indices are not supported");
    if (!accessor.contains("bufferView")) return {};
    const std::size_t type = natural(accessor, "componentType");
    const auto known = kIndexBytes.find(type);
    if (known == kIndexBytes.end()) {
      fail(fmt::format("indices of componentType {}; accepted: 5121, 5123, 5125", type));
    }
    const json& view = item("bufferViews", natural(accessor, "bufferView"));
    IndexView result;
    result.index_bytes = known->second;
    result.stride_bytes = natural(view, "byteStride", known->second);
    result.count = natural(accessor, "count");
    const std::string_view buffer = buffer_at(natural(view, "buffer"));
    const std::string_view bytes =
        part(buffer, natural(view, "byteOffset", 0), natural(view, "byteLength"));
    const std::size_t offset = natural(accessor, "byteOffset", 0);
    if (offset > bytes.size()) fail_short(result.count);
    result.data = bytes.substr(offset);
    const std::size_t room = result.data.size();
    const bool fits = result.stride_bytes > 0 && room >= result.index_bytes &&
                      (result.count - 1) <= (room - result.index_bytes) / result.stride_bytes;
    if (result.count > 0 && !fits) fail_short(result.count);
    return result;
  }

  [[noreturn]] void fail_short(std::size_t count) const {
    fail(fmt::format("the {} indices do not fit into their bufferView", count));
  }

  std::string_view part(std::string_view buffer, std::size_t offset, std::size_t length) const {
    if (offset > buffer.size() || length > buffer.size() - offset) {
      fail(fmt::format("truncated: bytes {} + {} of a buffer that has {}", offset, length,
                       buffer.size()));
    }
    return buffer.substr(offset, length);
  }

  std::string_view buffer_at(std::size_t number) {
    const json& buffer = item("buffers", number);
    if (!buffer.contains("uri")) {
      if (number == 0 && binary_chunk_) return *binary_chunk_;
      fail(fmt::format("buffer {} has neither a uri nor a binary chunk", number));
    }
    const auto loaded = buffers_.find(number);
    if (loaded != buffers_.end()) return loaded->second;
    return buffers_[number] = load(buffer.at("uri").get<std::string>(), number);
  }

  std::string load(const std::string& uri, std::size_t number) const {
    if (!uri.starts_with("data:")) return base::read_text_file(path_.parent_path() / uri);
    constexpr std::string_view kMark = ";base64,";
    const std::size_t mark = uri.find(kMark);
    if (mark != std::string::npos) {
      auto bytes = decode_base64(std::string_view(uri).substr(mark + kMark.size()));
      if (bytes) return *std::move(bytes);
    }
    fail(fmt::format("buffer {}: its data URI is not base64", number));
  }

  const json& item(const char* list, std::size_t number) const {
    return document_.at(list).at(number);
  }

  /// A whole number >= 0 of a map; writers may write it with a fraction of zero.
  std::size_t natural(const json& map, const char* key,
                      std::optional<std::size_t> otherwise = std::nullopt) const {
    constexpr double kLargestExact = 9007199254740992.0;  // 2^53
    if (otherwise && !map.contains(key)) return *otherwise;
    const json& value = map.at(key);
    if (value.is_number_unsigned()) return value.get<std::size_t>();
    const double number = value.is_number_float() ? value.get<double>() : -1.0;
    if (!(number >= 0.0 && number < kLargestExact && std::floor(number) == number)) {
      fail(fmt::format("{} is {}; accepted: whole numbers from 0", key, value.dump()));
    }
    return static_cast<std::size_t>(number);
  }

  [[noreturn]] void fail(const std::string& message) const {
    throw base::InputError(fmt::format("{}: {}{}", path_.string(), where_, message));
  }

  const std::filesystem::path& path_;
  std::optional<std::string_view> binary_chunk_;
  json document_;
  std::string where_;
  std::map<std::size_t, std::string> buffers_;
};

void check_document(std::string_view text, std::optional<std::string_view> binary_chunk,
                    const std::filesystem::path& path, std::vector<std::string>& warnings) {
  try {
    const std::set<std::string> extensions = GltfCheck(text, binary_chunk, path).run();
    if (extensions.empty()) return;
    warnings.push_back(fmt::format("{}: passed over the glTF extension{} {}; supported: none",
                                   path.filename().string(), extensions.size() > 1 ? "s" : "",
                                   fmt::join(extensions, ", ")));
  } catch (const json::exception& error) {
    throw base::InputError(fmt::format("{}: not glTF 2.0: {}", path.string(), error.what()));
  }
}

}  // namespace

void check_gltf(std::string_view data, const std::filesystem::path& path,
                std::vector<std::string>& warnings) {
  check_document(data, std::nullopt, path, warnings);
}

void check_glb(std::string_view data, const std::filesystem::path& path,
               std::vector<std::string>& warnings) {
  const std::string file = path.string();
  if (data.size() < kGlbHeaderBytes || data.substr(0, 4) != "glTF") {
    throw base::InputError(fmt::format("{}: not a GLB file: it must begin with glTF", file));
  }
  const std::size_t length = value_at<std::uint32_t>(data, 8);
  if (length > data.size()) fail_truncated(file, length, data.size());
  std::optional<std::string_view> text;
  std::optional<std::string_view> binary_chunk;
  for (std::size_t at = kGlbHeaderBytes; at < length;) {
    if (length - at < kGlbChunkHeaderBytes) fail_truncated(file, at + kGlbChunkHeaderBytes, length);
    const std::size_t first = at + kGlbChunkHeaderBytes;
    const std::size_t end = first + value_at<std::uint32_t>(data, at);
    if (end > length) fail_truncated(file, end, length);
    const std::string_view kind = data.substr(at + 4, 4);
    if (kind == "JSON" && !text) text = data.substr(first, end - first);
    if (kind == std::string_view("BIN\0", 4) && !binary_chunk) {
      binary_chunk = data.substr(first, end - first);
    }
    at = end;
  }
  if (!text) throw base::InputError(fmt::format("{}: has no JSON chunk", file));
  check_document(*text, binary_chunk, path, warnings);
}

}  // namespace renderers::scene
