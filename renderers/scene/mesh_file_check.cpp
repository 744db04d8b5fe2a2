#include "renderers/scene/mesh_file_check.h"

#include "perception/base/atomic_file.h"
#include "perception/base/errors.h"
#include "perception/base/names.h"
#include "renderers/scene/obj_check.h"
#include "renderers/scene/ply_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

namespace renderers::scene {
namespace {

/// 3D Studio chunks that hold chunks: the whole file, the editor, its objects (after their name),
/// an object's triangle mesh. (3D-Studio File Format, M. van Velsen and R. Fercoq, 1994)
constexpr std::uint16_t k3dsMain = 0x4D4D;
constexpr std::uint16_t k3dsEditor = 0x3D3D;
constexpr std::uint16_t k3dsObject = 0x4000;
constexpr std::uint16_t k3dsTriangleMesh = 0x4100;
constexpr std::size_t k3dsHeaderBytes = 6;

/// glTF 2.0 specification, "GLB File Format Specification".
constexpr std::size_t kGlbHeaderBytes = 12;
constexpr std::size_t kGlbChunkHeaderBytes = 8;

/// Little-endian value at a place that lies inside the data.
template <typename T>
T value_at(std::string_view data, std::size_t offset) {
  T value;
  std::memcpy(&value, data.data() + offset, sizeof(T));
  return value;
}

[[noreturn]] void fail_truncated(const std::string& file, std::size_t needed, std::size_t present) {
  throw base::InputError(
      fmt::format("{}: truncated: needs {} bytes, has {}", file, needed, present));
}

/// True for the chunks on the way from the file to its triangles.
bool holds_chunks(std::uint16_t parent, std::uint16_t kind) {
  return (parent == k3dsMain && kind == k3dsEditor) ||
         (parent == k3dsEditor && kind == k3dsObject) ||
         (parent == k3dsObject && kind == k3dsTriangleMesh);
}

/// Walks the chunks in [begin, end) of a parent chunk.
void check_3ds_chunks(std::string_view data, std::size_t begin, std::size_t end,
                      std::uint16_t parent, const std::string& file) {
  for (std::size_t at = begin; at < end;) {
    if (end - at < k3dsHeaderBytes) fail_truncated(file, at + k3dsHeaderBytes, end);
    const auto kind = value_at<std::uint16_t>(data, at);
    const std::size_t length = value_at<std::uint32_t>(data, at + 2);
    if (length < k3dsHeaderBytes) {
      throw base::InputError(fmt::format("{}: chunk {:04x} at byte {} has length {}; at least {}",
                                         file, kind, at, length, k3dsHeaderBytes));
    }
    if (length > end - at) fail_truncated(file, at + length, end);
    if (holds_chunks(parent, kind)) {
      std::size_t first = at + k3dsHeaderBytes;
      if (kind == k3dsObject) first = std::min(data.find('\0', first), at + length - 1) + 1;
      check_3ds_chunks(data, first, at + length, kind, file);
    }
    at += length;
  }
}

void check_3ds(std::string_view data, const std::string& file) {
  if (data.size() < k3dsHeaderBytes || value_at<std::uint16_t>(data, 0) != k3dsMain) {
    throw base::InputError(fmt::format("{}: not a 3DS file: it must begin with 4d4d", file));
  }
  const std::size_t length = value_at<std::uint32_t>(data, 2);
  if (length > data.size()) fail_truncated(file, length, data.size());
  check_3ds_chunks(data, k3dsHeaderBytes, length, k3dsMain, file);
}

void check_glb(std::string_view data, const std::string& file) {
  if (data.size() < kGlbHeaderBytes || data.substr(0, 4) != "glTF") {
    throw base::InputError(fmt::format("{}: not a GLB file: it must begin with glTF", file));
  }
  const std::size_t length = value_at<std::uint32_t>(data, 8);
  if (length > data.size()) fail_truncated(file, length, data.size());
  for (std::size_t at = kGlbHeaderBytes; at < length;) {
    if (length - at < kGlbChunkHeaderBytes) fail_truncated(file, at + kGlbChunkHeaderBytes, length);
    const std::size_t end = at + kGlbChunkHeaderBytes + value_at<std::uint32_t>(data, at);
    if (end > length) fail_truncated(file, end, length);
    at = end;
  }
}

}  // namespace

std::optional<MeshFileCounts> check_mesh_file(const std::filesystem::path& path) {
  const std::string kind = base::kebab_case(path.extension().string());
  const std::string file = path.string();
  const std::string data = base::read_text_file(path);
  if (data.empty()) throw base::InputError(fmt::format("{}: the file is empty", file));
  if (kind == ".obj") return check_obj(data, file);
  if (kind == ".ply") return check_ply(data, file);
  if (kind == ".3ds") check_3ds(data, file);
  if (kind == ".glb") check_glb(data, file);
  return std::nullopt;
}

}  // namespace renderers::scene
