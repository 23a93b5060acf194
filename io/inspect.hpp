// What an HDF5 file of this program holds, and whether it is whole.
#pragma once

#include <filesystem>
#include <string>

namespace grandamp {

struct Inspection {
  bool whole = false;
  std::string text; ///< for a person, several lines
};

/// Safe on damaged files: the seal is checked first, and HDF5 reads in a process of its own, which may crash or hang.
/// Throws FileError if the file cannot be read at all.
Inspection inspect(const std::filesystem::path& path);

} // namespace grandamp
