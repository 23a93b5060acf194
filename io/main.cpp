#include "io/commands/commands.hpp"

#include <cstdlib>
#ifdef __GLIBC__
#include <malloc.h>
#endif

int main(int argc, char** argv) {
#ifdef __GLIBC__
  // Left to itself the first rises to the largest block ever freed, and what a file took to read is never given back.
  // Lower, and every snapshot asks the system for its room anew.
  mallopt(M_MMAP_THRESHOLD, 8 << 20);
  mallopt(M_TRIM_THRESHOLD, 64 << 20);
#endif
  return grandamp::command_line(argc, argv);
}
