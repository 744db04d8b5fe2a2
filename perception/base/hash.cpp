#include "perception/base/hash.h"

#include <bit>

#include <fmt/format.h>

#define XXH_INLINE_ALL
#include <xxhash.h>

namespace base {

struct Hasher::State {
  XXH3_state_t state;
};

std::string Hash::hex() const { return fmt::format("{:016x}{:016x}", high, low); }

std::string Hash::short_hex() const { return hex().substr(0, 8); }

Hasher::Hasher() : state_(std::make_unique<State>()) { XXH3_128bits_reset(&state_->state); }

Hasher::~Hasher() = default;

void Hasher::add(std::string_view text) {
  add(static_cast<std::int64_t>(text.size()));
  add_bytes(std::as_bytes(std::span(text)));
}

void Hasher::add(std::int64_t value) { add_bytes(std::as_bytes(std::span(&value, 1))); }

void Hasher::add(double value) {
  // +0 and -0 are the same number and must hash alike.
  add(std::bit_cast<std::int64_t>(value == 0.0 ? 0.0 : value));
}

void Hasher::add(std::span<const float> values) {
  add(static_cast<std::int64_t>(values.size()));
  add_bytes(std::as_bytes(values));
}

void Hasher::add_bytes(std::span<const std::byte> bytes) {
  XXH3_128bits_update(&state_->state, bytes.data(), bytes.size());
}

Hash Hasher::finish() const {
  const XXH128_hash_t hash = XXH3_128bits_digest(&state_->state);
  return {hash.high64, hash.low64};
}

Hash hash_of(std::string_view text) {
  Hasher hasher;
  hasher.add(text);
  return hasher.finish();
}

}  // namespace base
