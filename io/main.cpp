#include "io/commands/commands.hpp"

int main(int argc, char** argv) {
  return grandamp::command_line(argc, argv);
}
