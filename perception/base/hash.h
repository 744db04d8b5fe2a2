#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace base {

/// 128-bit content hash (XXH3-128): equal bytes give equal hashes on every machine.
struct Hash {
  std::uint64_t high = 0;
  std::uint64_t low = 0;
  std::string hex() const;        ///< 32 lower-case hexadecimal digits
  std::string short_hex() const;  ///< the first 8 of them
  friend bool operator==(const Hash&, const Hash&) = default;
};

/// Hash of a byte sequence fed in pieces. Text and spans are length-prefixed, so ("a","bc") and
/// ("ab","c") differ.
class Hasher {
 public:
  Hasher();
  ~Hasher();
  Hasher(const Hasher&) = delete;
  Hasher& operator=(const Hasher&) = delete;

  void add(std::string_view text);
  void add(std::int64_t value);
  void add(double value);
  void add(std::span<const float> values);
  void add_bytes(std::span<const std::byte> bytes);
  Hash finish() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

Hash hash_of(std::string_view text);

}  // namespace base
