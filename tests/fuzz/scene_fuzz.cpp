// Any bytes are either a scene, whose text as run gives the same scene again, or a SceneError that says why not.
// Lines "#--set KEY=VALUE" of the input are overrides.
#include "io/scene_file.hpp"
#include "solver/several_modes.hpp"
#include "tests/support/same_scene.hpp"

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

using namespace grandamp;

namespace {

void demand(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "broken: %s\n", what);
  std::abort();
}

bool is_positive(double value) {
  return std::isfinite(value) && value > 0.0;
}

/// What the solver may rely on.
void check_scene(const Scene& scene) {
  demand(is_positive(scene.time.duration), "the duration is positive");
  demand(!scene.time.step || is_positive(*scene.time.step), "the step is positive");
  demand(is_positive(scene.output.history_interval), "the interval is positive");
  const Enclosure& enclosure = scene.enclosure;
  if (enclosure.shape == EnclosureShape::box)
    for (const double length : enclosure.size) demand(is_positive(length), "the box has a size");
  else
    demand(is_positive(enclosure.diameter) && is_positive(enclosure.height), "the cylinder has a size");
  for (const Population& population : scene.populations) {
    demand(is_positive(population.radius) && is_positive(population.mass), "granules have a radius and a mass");
    demand(population.placed == !population.positions.empty(), "positions are there where they were given");
    if (population.placed) demand(population.positions.size() == population.count, "a position for each");
    demand(population.velocities.empty() || population.velocities.size() == population.count, "a velocity for each");
    demand(population.spins.empty() || population.spins.size() == population.count, "a spin for each");
    if (population.count > 0)
      demand(scene.contact.granule.stiffness || (population.young && population.poisson), "contacts have a stiffness");
  }
  if (scene.structure) {
    const Vector3& n = scene.structure->direction;
    demand(std::abs(n[0] * n[0] + n[1] * n[1] + n[2] * n[2] - 1.0) < 1e-12, "the direction is a unit vector");
    demand(scene.structure->modes.size > 0 || is_positive(scene.structure->mass), "the structure has a mass");
    demand(scene.structure->modes.size == 0 || faults_of(scene.structure->modes).empty(), "its matrices are sound");
  }
  if (scene.output.window)
    demand((*scene.output.window)[0] >= 0.0 && (*scene.output.window)[0] < (*scene.output.window)[1] &&
               (*scene.output.window)[1] <= scene.time.duration,
           "the window is within the run");
}

void check_message(const std::string& message) {
  demand(!message.empty(), "there is a message");
  for (const char c : message) {
    const auto byte = static_cast<unsigned char>(c);
    demand((byte >= 0x20 && byte != 0x7f) || c == '\n', "the message is printable");
  }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  const std::string mark = "#--set ";
  std::vector<std::string> overrides;
  for (std::size_t at = text.find(mark); at != std::string::npos; at = text.find(mark, at + 1)) {
    const std::size_t begin = at + mark.size();
    overrides.push_back(text.substr(begin, text.find('\n', begin) - begin));
  }
  try {
    const SceneDocument document = read_scene_text(text, "fuzz.toml", overrides);
    check_scene(document.scene);
    for (const Problem& note : document.notes) demand(note.note, "a note is marked as one");
    check_message("notes: " + format_problems("fuzz.toml", document.notes));
    try {
      const SceneDocument again = read_scene_text(document.text, "again.toml");
      demand(again.notes.empty(), "the text as run leaves nothing to note");
      demand(test::same_scene(document.scene, again.scene), "the text as run gives the same scene");
      demand(again.text == document.text, "the text as run stays as it is");
    } catch (const SceneError& error) {
      demand(false, error.what());
    }
  } catch (const SceneError& error) {
    demand(!error.problems().empty(), "an error has a problem");
    for (const Problem& problem : error.problems()) {
      demand(!problem.message.empty(), "a problem says what is wrong");
      demand(!problem.note, "an error is no note");
    }
    check_message(format_problems("fuzz.toml", error.problems()));
  } catch (const FileError& error) {
    check_message(error.what());
    demand(text.find("file") != std::string::npos || text.find("matrices") != std::string::npos, "a file is named");
  }
  return 0;
}
