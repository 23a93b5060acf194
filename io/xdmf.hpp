// XDMF: what tells ParaView how to see the snapshots in a results file as points over time.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace grandamp {

/// Of snapshots of `granules` granules at `times`, s, in the HDF5 file of that name (as seen from the XDMF file).
/// Replaces the file as a whole. Throws FileError.
void write_xdmf(const std::filesystem::path& path, const std::string& results_name, const std::vector<double>& times,
                std::size_t granules);

} // namespace grandamp
