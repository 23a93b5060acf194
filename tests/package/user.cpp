// A program of somebody who has grandamp installed: runs the scene it is given, prints the rms displacement.
#include "io/scene_file.hpp"
#include "solver/simulation.hpp"

#include <cstdio>

int main(int, char** arguments) {
  grandamp::Simulation simulation(grandamp::read_scene(arguments[1]).scene);
  while (!simulation.finished()) simulation.step();
  std::printf("%.17g\n", simulation.response().rms_displacement);
}
