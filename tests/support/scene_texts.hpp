// Scene texts for tests of the reader: one whole scene, and ways to spoil it.
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>

namespace grandamp::test {

/// A whole, good scene. Tests name lines of it: keep them.
inline const std::string good_scene = R"(title = "good"
seed = 7
gravity = [0, 0, -9.81]
[enclosure]
shape = "box"
size = [0.025, 0.025, 0.0359]
[[granules]]
name = "acrylic"
count = 317
radius = 1.85e-3
density = 1190
[packing]
kind = "settled"
[contact]
damping = "tsuji"
friction = "coulomb"
[contact.granule]
stiffness = 1.0e7
reference_radius = 3.0e-3
restitution = 0.89
friction = 0.52
[contact.wall]
stiffness = 1.3e7
reference_radius = 3.0e-3
restitution = 0.9
friction = 0.5
[structure]
mass = 0.1
stiffness = 1000.0
damping = 0.2
direction = [0, 0, 2]
[excitation]
kind = "harmonic"
static_deflection = 0.5e-3
frequency = 15.91
[time]
duration = 7.0
steps_per_contact = 8
[verlet]
policy = "guarded"
[output]
window = [3.5, 7.0]
)";

/// The scene with each `from` replaced by `to`; `from` must be there.
inline std::string replaced(std::string text, std::string_view from, std::string_view to) {
  std::size_t at = text.find(from);
  if (at == std::string::npos) throw std::logic_error("the scene has no " + std::string(from));
  for (; at != std::string::npos; at = text.find(from, at + to.size())) text.replace(at, from.size(), to);
  return text;
}

} // namespace grandamp::test
