#include "io/digest.hpp"

#include <fmt/format.h>

#include <new>

// The header alone: nothing to link.
#define XXH_INLINE_ALL
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wsign-conversion"
#include <xxhash.h>
#pragma GCC diagnostic pop

namespace grandamp {

std::uint64_t digest_of(const void* data, std::size_t bytes) noexcept {
  return XXH3_64bits(data, bytes);
}

Digest::Digest() : state_(XXH3_createState()) {
  if (state_ == nullptr) throw std::bad_alloc();
  XXH3_128bits_reset(static_cast<XXH3_state_t*>(state_));
}

Digest::~Digest() {
  XXH3_freeState(static_cast<XXH3_state_t*>(state_));
}

void Digest::add(const void* data, std::size_t bytes) noexcept {
  XXH3_128bits_update(static_cast<XXH3_state_t*>(state_), data, bytes);
}

std::string Digest::text() const {
  const XXH128_hash_t hash = XXH3_128bits_digest(static_cast<const XXH3_state_t*>(state_));
  return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
}

} // namespace grandamp
