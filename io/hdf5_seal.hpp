// The seal of a file: what tells damage before HDF5 opens it, for HDF5 1.10 may crash on what is damaged.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace grandamp::hdf5 {

/// The seal takes the first bytes of a file (HDF5's "user block", which its readers skip): text that tells the file's
/// size, and the digests of up to 64 parts of it, so that damage is known and roughly where.
inline constexpr std::size_t seal_bytes = 2048;

/// Over the first seal_bytes of an open file that is otherwise complete. False with errno if it cannot be done.
bool write_seal(int file);

/// What a file's seal says of it.
struct SealReport {
  enum class State { whole, damaged, unsealed };
  State state = State::unsealed;
  std::string what; ///< for a person: what is wrong and where; empty when whole
};

/// Reads the whole file, but not through HDF5. Throws FileError if it cannot be read.
SealReport check_seal(const std::filesystem::path& path);

} // namespace grandamp::hdf5
