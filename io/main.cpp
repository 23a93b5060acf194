#include "io/commands/commands.hpp"

#include <cstdlib>
#ifdef __GLIBC__
#include <malloc.h>
#endif

int main(int argc, char** argv) {
#ifdef __GLIBC__
  // Left to itself the limit rises with the blocks that are freed, and the room of a file once read is never given back.
  mallopt(M_MMAP_THRESHOLD, 1 << 20);
#endif
  return grandamp::command_line(argc, argv);
}
