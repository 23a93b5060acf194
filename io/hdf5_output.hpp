// HDF5's own writing, taken over: into a file beside the one meant, sealed with digests, then put in its place.
#pragma once

#include <hdf5.h>

#include <filesystem>

namespace grandamp::hdf5 {

/// Where HDF5 writes to. HDF5 1.10 does not survive a write that fails (it ends the program when the file is closed),
/// so it is never told of one: the first failure is kept, and told by finish().
class Output {
public:
  /// Writes to `path` with ".new" at its end. Throws FileError.
  explicit Output(const std::filesystem::path& path);
  Output(Output&& other) noexcept;
  Output& operator=(Output&& other) noexcept;
  /// Removes what was not finished.
  ~Output();

  const std::filesystem::path& beside() const noexcept { return beside_; }
  /// A property list that makes H5Fcreate write here; must not outlive this.
  hid_t access();
  /// After H5Fclose: seals, syncs and renames. Throws FileError with the path and the reason.
  void finish();

  struct Sink {
    int file = -1;
    int error = 0; ///< errno of the first failure
  };

private:
  [[noreturn]] void fail(const char* what, int reason) const;

  std::filesystem::path path_, beside_;
  Sink* sink_ = nullptr; ///< at an address that stays
};

} // namespace grandamp::hdf5
