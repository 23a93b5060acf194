#include "io/commands/commands.hpp"

#include <cstdlib> // tells which C library it is
#ifdef __GLIBC__
#include <malloc.h>
#endif

int main(int argc, char** argv) {
#ifdef __GLIBC__
  // The first, left to itself, rises to the largest block freed so far: what a file took to read would never be given
  // back. Were both lower, every snapshot would ask the system for its room anew; were the first higher, arrays of a
  // few large pages (solver/row_array.hpp) would leave gaps between them that nothing fills.
  mallopt(M_MMAP_THRESHOLD, 4 << 20);
  mallopt(M_TRIM_THRESHOLD, 64 << 20);
#endif
  return grandamp::command_line(argc, argv);
}
