#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <type_traits>
#include <vector>

#include "renderers/opengl/context.h"

namespace renderers::opengl {

/// A storage buffer on the device. Element types mirror std430 layouts.
class Buffer {
 public:
  Buffer() = default;
  /// Contents are undefined.
  /// @throws UnsupportedError beyond the device's storage block size; base::DeviceError if memory
  ///   runs out
  Buffer(std::shared_ptr<Context> context, std::size_t size_bytes);
  ~Buffer();
  Buffer(Buffer&& other) noexcept;
  Buffer& operator=(Buffer&& other) noexcept;

  template <typename T>
  static Buffer of(std::shared_ptr<Context> context, std::span<const T> elements) {
    Buffer buffer(std::move(context), std::max<std::size_t>(elements.size_bytes(), sizeof(T)));
    buffer.write(elements);
    return buffer;
  }

  /// Makes it at least this large; contents are lost if it grows.
  void reserve(std::shared_ptr<Context> context, std::size_t size_bytes);

  template <typename T>
  void write(std::span<const T> elements, std::size_t offset_bytes = 0) {
    static_assert(std::is_trivially_copyable_v<T>);
    write_bytes(elements.data(), elements.size_bytes(), offset_bytes);
  }
  /// Waits for the device.
  template <typename T>
  std::vector<T> read(std::size_t count, std::size_t offset_bytes = 0) const {
    static_assert(std::is_trivially_copyable_v<T>);
    std::vector<T> elements(count);
    read_bytes(elements.data(), count * sizeof(T), offset_bytes);
    return elements;
  }
  /// Sets every 32-bit word.
  void fill(std::uint32_t word);

  std::size_t size_bytes() const { return size_bytes_; }
  std::uint32_t id() const { return id_; }

 private:
  void write_bytes(const void* data, std::size_t size_bytes, std::size_t offset_bytes);
  void read_bytes(void* data, std::size_t size_bytes, std::size_t offset_bytes) const;

  std::shared_ptr<Context> context_;
  std::uint32_t id_ = 0;
  std::size_t size_bytes_ = 0;
};

}  // namespace renderers::opengl
