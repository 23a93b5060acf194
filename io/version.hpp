// What this library calls itself in the files that it writes and on the command line.
#pragma once

#include <string>

namespace grandamp {

/// "1.2.3".
std::string version();
/// Several lines: version, compiler, instruction sets of this binary and of this machine, libraries.
std::string version_report();

} // namespace grandamp
