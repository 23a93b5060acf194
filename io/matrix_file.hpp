// A structure's matrices from a CSV file.
#pragma once

#include "solver/scene.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace grandamp {

struct MatrixFile {
  SeveralModes modes; ///< displacement and velocity zero

  std::vector<std::string> faults; ///< "line 17: ...": what is wrong; the rest means nothing then
  bool unreadable = false;         ///< the file could not be opened or read
};

/// Rows of a word and n numbers: n rows each of mass, damping (or none) and stiffness; one row each of x, y and z
/// (those left out are zero): what the enclosure moves by, in m, when a coordinate moves by one; and one row force:
/// what a force of one does to the equations (left out: it acts on the enclosure, along `direction`).
MatrixFile read_matrix_file(const std::filesystem::path& file, const Vector3& direction);

/// The same for the file's content.
MatrixFile parse_matrices(const std::string& content, const Vector3& direction);

} // namespace grandamp
