// A digest of bytes: tells damaged files from whole ones. Against accidents, not against forgers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace grandamp {

/// XXH3, 64 bits, of all at once.
std::uint64_t digest_of(const void* data, std::size_t bytes) noexcept;

/// XXH3, 128 bits, piece by piece.
class Digest {
public:
  Digest();
  ~Digest();
  Digest(const Digest&) = delete;
  Digest& operator=(const Digest&) = delete;

  void add(const void* data, std::size_t bytes) noexcept;
  /// 32 hexadecimal digits, of what was added so far.
  std::string text() const;

private:
  void* state_;
};

} // namespace grandamp
