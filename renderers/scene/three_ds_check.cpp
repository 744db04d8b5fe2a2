#include "renderers/scene/three_ds_check.h"

#include "perception/base/errors.h"
#include "renderers/scene/mesh_bytes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

// M. van Velsen and R. Fercoq, 3D-Studio File Format, 1994.

namespace renderers::scene {
namespace {

/// Chunks that hold chunks: the whole file, the editor, its objects (after their name), an object's
/// triangle mesh.
constexpr std::uint16_t kMain = 0x4D4D;
constexpr std::uint16_t kEditor = 0x3D3D;
constexpr std::uint16_t kObject = 0x4000;
constexpr std::uint16_t kTriangleMesh = 0x4100;
/// A count of 16 bits, then three floats each.
constexpr std::uint16_t kVertices = 0x4110;
/// A count of 16 bits, then three indices and a flag of 16 bits each, then chunks.
constexpr std::uint16_t kFaces = 0x4120;
/// In the faces' chunk: a name, a count of 16 bits, then that many face numbers of 16 bits.
constexpr std::uint16_t kMaterialFaces = 0x4130;

constexpr std::size_t kHeaderBytes = 6;
constexpr std::size_t kCountBytes = 2;
constexpr std::size_t kVertexBytes = 12;
constexpr std::size_t kFaceBytes = 8;

/// True for the chunks on the way from the file to its triangles.
bool holds_chunks(std::uint16_t parent, std::uint16_t kind) {
  return (parent == kMain && kind == kEditor) || (parent == kEditor && kind == kObject) ||
         (parent == kObject && kind == kTriangleMesh) ||
         (parent == kTriangleMesh && kind == kFaces);
}

class ThreeDsCheck {
 public:
  ThreeDsCheck(std::string_view data, const std::string& file) : data_(data), file_(file) {}

  void run() {
    if (data_.size() < kHeaderBytes || value_at<std::uint16_t>(data_, 0) != kMain) {
      throw base::InputError(fmt::format("{}: not a 3DS file: it must begin with 4d4d", file_));
    }
    const std::size_t length = value_at<std::uint32_t>(data_, 2);
    if (length > data_.size()) fail_truncated(file_, length, data_.size());
    walk(kHeaderBytes, length, kMain);
  }

 private:
  /// Records of an object: where they start, how many there are.
  struct Records {
    std::size_t first = 0;
    std::size_t count = 0;
  };

  /// Walks the chunks in [begin, end) of a parent chunk.
  void walk(std::size_t begin, std::size_t end, std::uint16_t parent) {
    for (std::size_t at = begin; at < end;) {
      if (end - at < kHeaderBytes) fail_truncated(file_, at + kHeaderBytes, end);
      const auto kind = value_at<std::uint16_t>(data_, at);
      const std::size_t length = value_at<std::uint32_t>(data_, at + 2);
      if (length < kHeaderBytes) {
        throw base::InputError(fmt::format("{}: chunk {:04x} at byte {} has length {}; at least {}",
                                           file_, kind, at, length, kHeaderBytes));
      }
      if (length > end - at) fail_truncated(file_, at + length, end);
      enter(at, at + length, parent);
      at += length;
    }
  }

  /// Looks into one chunk, [begin, end) with its header.
  void enter(std::size_t begin, std::size_t end, std::uint16_t parent) {
    const auto kind = value_at<std::uint16_t>(data_, begin);
    std::size_t first = begin + kHeaderBytes;
    if (parent == kTriangleMesh && kind == kVertices) vertices_ = records(first, end, kVertexBytes);
    if (parent == kFaces && kind == kMaterialFaces) check_material(after_name(first, end), end);
    if (!holds_chunks(parent, kind)) return;
    if (kind == kObject) {
      const std::size_t name_begin = first;
      first = after_name(first, end);
      object_ = data_.substr(name_begin, first - name_begin);
      object_ = object_.substr(0, object_.find('\0'));
    }
    if (kind == kTriangleMesh) vertices_ = faces_ = {};
    if (kind == kFaces) {
      faces_ = records(first, end, kFaceBytes);
      first = faces_.first + faces_.count * kFaceBytes;
    }
    walk(first, end, kind);
    if (kind == kTriangleMesh) check_mesh_values();
  }

  /// Where a chunk goes on after the zero that ends its name.
  std::size_t after_name(std::size_t first, std::size_t end) const {
    return std::min(std::min(data_.find('\0', first), end) + 1, end);
  }

  void check_material(std::size_t first, std::size_t end) const {
    const Records numbers = records(first, end, sizeof(std::uint16_t));
    for (std::size_t i = 0; i < numbers.count; ++i) {
      const auto face = value_at<std::uint16_t>(data_, numbers.first + i * sizeof(std::uint16_t));
      if (face < faces_.count) continue;
      throw base::InputError(
          fmt::format("{}: object \"{}\": a material names face {}; the object has {}", file_,
                      object_, face, faces_.count));
    }
  }

  Records records(std::size_t first, std::size_t end, std::size_t record_bytes) const {
    if (end - first < kCountBytes) fail_truncated(file_, first + kCountBytes, end);
    const std::size_t count = value_at<std::uint16_t>(data_, first);
    const std::size_t needed = first + kCountBytes + count * record_bytes;
    if (needed > end) fail_truncated(file_, needed, end);
    return {first + kCountBytes, count};
  }

  /// Faces may come before the vertices, so both are looked at when the mesh has been walked.
  void check_mesh_values() const {
    for (std::size_t i = 0; i < 3 * vertices_.count; ++i) {
      if (std::isfinite(value_at<float>(data_, vertices_.first + i * sizeof(float)))) continue;
      throw base::InputError(fmt::format(
          "{}: object \"{}\": vertex {} has a value that is not finite", file_, object_, i / 3));
    }
    for (std::size_t face = 0; face < faces_.count; ++face) {
      for (std::size_t corner = 0; corner < 3; ++corner) {
        const auto index =
            value_at<std::uint16_t>(data_, faces_.first + face * kFaceBytes + 2 * corner);
        if (index < vertices_.count) continue;
        throw base::InputError(
            fmt::format("{}: object \"{}\": face {} names vertex {}; the object has {}", file_,
                        object_, face, index, vertices_.count));
      }
    }
  }

  std::string_view data_;
  const std::string& file_;
  std::string_view object_;
  Records vertices_;
  Records faces_;
};

}  // namespace

void check_3ds(std::string_view data, const std::string& file) { ThreeDsCheck(data, file).run(); }

}  // namespace renderers::scene
