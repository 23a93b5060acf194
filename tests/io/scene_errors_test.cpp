// Bad scenes, each with what its message must say.
#include "io/scene_file.hpp"
#include "tests/support/scene_texts.hpp"

#include <doctest/doctest.h>
#include <string>
#include <vector>

using namespace grandamp;
using test::good_scene;
using test::replaced;

namespace {

std::string message_of(const std::string& text, const std::vector<std::string>& overrides = {}) {
  try {
    read_scene_text(text, "bad.toml", overrides);
  } catch (const SceneError& error) {
    return format_problems("bad.toml", error.problems());
  } catch (const FileError& error) {
    return std::string("file error: ") + error.what();
  }
  return "(no error)";
}

/// The good scene with `from` replaced by `to`; the message must have all of `expected`.
struct BadScene {
  std::string from;
  std::string to;
  std::vector<std::string> expected;
};

const std::vector<BadScene> bad_scenes{
    // Unknown and misplaced keys.
    {"seed = 7", "sead = 7", {"bad.toml:2: sead = 7", "unknown key, perhaps seed", "allowed: title, seed"}},
    {"[verlet]", "[verlot]", {"bad.toml:39: verlot", "perhaps verlet"}},
    {"count = 317",
     "cuont = 317",
     {"bad.toml:9: granules.0.cuont = 317", "perhaps count", "missing: how many granules"}},
    {"seed = 7", "duration = 7", {"bad.toml:2: duration = 7", "it belongs to [time]"}},
    {"duration = 7.0",
     "duration = 7.0\nmass = 1",
     {"bad.toml:38: time.mass", "belongs to [[granules]] or [structure]"}},
    {"name = \"acrylic\"", "\"a.b\" = 1", {"granules.0.a.b = 1: unknown key"}},
    {"shape = \"box\"",
     "shape = \"box\"\ndiameter = 1e-2",
     {"bad.toml:6: enclosure.diameter = 0.01: does not apply", "allowed: size"}},
    {"shape = \"box\"",
     "shape = \"box\"\naxis = \"z\"",
     {"bad.toml:6: enclosure.axis", "does not apply: a box has a size"}},
    {"restitution = 0.89",
     "restitution = 0.89\nyoung = 3e9",
     {"bad.toml:21: contact.granule.young", "belongs to [[granules]] or [contact.wall]"}},
    // The enclosure.
    {"shape = \"box\"",
     "shape = \"ball\"",
     {"bad.toml:5: enclosure.shape = 'ball': unknown word", "allowed: \"box\", \"cylinder\""}},
    {"shape = \"box\"", "shape = \"bax\"", {"perhaps \"box\""}},
    {"shape = \"box\"", "shape = 3", {"wrong type: an integer", "allowed: \"box\", \"cylinder\""}},
    {"shape = \"box\"\n", "", {"bad.toml:4: enclosure.shape: missing", "\"box\", \"cylinder\""}},
    {"size = [0.025, 0.025, 0.0359]\n", "", {"bad.toml:4: enclosure.size: missing"}},
    {"size = [0.025, 0.025, 0.0359]",
     "size = [0.025, 0.025]",
     {"bad.toml:6: enclosure.size = [0.025, 0.025]: not three numbers", "allowed: three numbers"}},
    {"size = [0.025, 0.025, 0.0359]", "size = [0.025, 0.0, 0.0359]", {"0.0 is out of range", "above 0"}},
    {"size = [0.025, 0.025, 0.0359]", "size = [0.025, \"a\", 0.0359]", {"not three numbers"}},
    {"size = [0.025, 0.025, 0.0359]", "size = [0.025, nan, 0.0359]", {"nan is not a finite number"}},
    {"size = [0.025, 0.025, 0.0359]",
     "size = [0.003, 0.025, 0.0359]",
     {"bad.toml:10: granules.0.radius = 0.00185", "does not fit", "a radius of at most 0.0015 m"}},
    {"shape = \"box\"",
     "shape = \"cylinder\"",
     {"enclosure.diameter: missing", "enclosure.height: missing", "enclosure.size",
      "a cylinder has a diameter and a height"}},
    {"shape = \"box\"\nsize = [0.025, 0.025, 0.0359]",
     "shape = \"cylinder\"\ndiameter = 0.02\nheight = 0.03\naxis = \"w\"",
     {"bad.toml:8: enclosure.axis = 'w'", "\"x\", \"y\", \"z\""}},
    {"[enclosure]\nshape = \"box\"\nsize = [0.025, 0.025, 0.0359]\n", "", {"bad.toml: enclosure: missing"}},
    {"[enclosure]\nshape = \"box\"\nsize = [0.025, 0.025, 0.0359]\n",
     "enclosure = 5\n",
     {"bad.toml:4: enclosure = 5: wrong type: an integer", "a table, [enclosure]"}},
    // The top of the file.
    {"seed = 7", "seed = -1", {"bad.toml:2: seed = -1: out of range", "an integer from 0"}},
    {"seed = 7", "seed = 1.5", {"bad.toml:2: seed = 1.5: wrong type: a floating-point number"}},
    {"title = \"good\"", "title = 3", {"bad.toml:1: title = 3: wrong type: an integer; allowed: a string"}},
    {"gravity = [0, 0, -9.81]", "gravity = -9.81", {"bad.toml:3: gravity = -9.81: not three numbers"}},
    {"gravity = [0, 0, -9.81]", "gravity = [0, 0, -inf]", {"-inf is not a finite number"}},
    {"gravity = [0, 0, -9.81]",
     "gravity = [0, 0, 0]",
     {"bad.toml:13: packing.kind = 'settled'", "needs gravity", "kind = \"random\""}},
    // Granules.
    {"count = 317", "count = -1", {"bad.toml:9: granules.0.count = -1: out of range", "from 0 to 134217664"}},
    {"count = 317", "count = 3.0", {"granules.0.count = 3.0: wrong type: a floating-point number"}},
    {"count = 317", "count = \"many\"", {"granules.0.count = 'many': wrong type: a string"}},
    {"count = 317", "count = 99999999999", {"granules.0.count = 99999999999: out of range"}},
    {"count = 317",
     "count = 100000000",
     {"bad.toml:9: granules.0.count = 100000000", "solid volume", "at most 0.7405"}},
    {"count = 317",
     "count = 317\ntotal_mass = 0.01",
     {"bad.toml:10: granules.0.total_mass = 0.01: does not apply: count is given as well", "one of count, total_mass"}},
    {"count = 317", "total_mass = 1e-9", {"granules.0.total_mass", "granules of", "from one granule"}},
    {"count = 317", "total_mass = 0", {"granules.0.total_mass = 0: out of range", "above 0"}},
    {"count = 317\n", "", {"bad.toml:7: granules.0.count: missing", "one of count, total_mass, positions, file"}},
    {"radius = 1.85e-3\n", "", {"bad.toml:7: granules.0.radius: missing"}},
    {"radius = 1.85e-3", "radius = 0", {"bad.toml:10: granules.0.radius = 0: out of range", "above 0"}},
    {"radius = 1.85e-3", "radius = -1e-3", {"granules.0.radius = -0.001: out of range"}},
    {"radius = 1.85e-3", "radius = inf", {"granules.0.radius = inf: not a finite number"}},
    {"radius = 1.85e-3", "radius = true", {"granules.0.radius = true: wrong type: a boolean"}},
    {"radius = 1.85e-3", "radius = 1e-200", {"gives a granule of 0 kg"}},
    {"density = 1190\n", "", {"bad.toml:7: granules.0.density: missing", "density in kg/m^3, or mass in kg"}},
    {"density = 1190", "density = 1190\nmass = 1e-5", {"bad.toml:12: granules.0.mass", "density is given as well"}},
    {"density = 1190", "density = nan", {"granules.0.density = nan: not a finite number"}},
    {"density = 1190", "density = 1190\nspeed = 1.0", {"granules.0.speed = 1.0: does not apply", "settled"}},
    {"density = 1190", "density = 1190\nspeed = -1.0", {"granules.0.speed = -1.0"}},
    {"density = 1190", "density = 1190\nvelocities = [[0, 0, 0]]", {"granules.0.velocities", "it goes with positions"}},
    {"density = 1190",
     "density = 1190\nyoung = 3e9",
     {"granules.0.young", "does not apply: the contacts' stiffnesses are given"}},
    {"count = 317", "positions = []", {"granules.0.positions = []: no positions"}},
    {"count = 317",
     "positions = [[0.01, 0.01, 0.01], [0.01, 0.01]]",
     {"bad.toml:9: granules.0.positions", "item 1: not three numbers"}},
    {"count = 317",
     "positions = [[0.01, 0.01, 0.01]]\nspins = [[0, 0, 0], [1, 1, 1]]",
     {"bad.toml:10: granules.0.spins", "2 items for 1 positions"}},
    {"count = 317",
     "positions = [[0.01, 0.01, 0.01]]\nvelocities = [[0, 0, 0]]\nspeed = 1",
     {"granules.0.speed", "one of speed and velocities"}},
    {"count = 317", "file = 3", {"granules.0.file = 3: wrong type: an integer"}},
    {"count = 317", "file = \"\"", {"granules.0.file", "not a file name"}},
    {"count = 317",
     "file = \"no such.csv\"",
     {"file error: bad.toml:9: granules.0.file = 'no such.csv'", "no such file"}},
    {"count = 317", "file = \"/dev/zero\"", {"not a regular file"}},
    {"name = \"acrylic\"", "name = \"wall\"", {"granules.0.name = 'wall'", "any other name"}},
    {"[packing]",
     "[[granules]]\nname = \"acrylic\"\ncount = 1\nradius = 1e-3\ndensity = 1\n[packing]",
     {"bad.toml:13: granules.1.name = 'acrylic': another population has this name"}},
    {"[[granules]]", "[granules]", {"bad.toml:7: granules", "wrong type: a table", "[[granules]]"}},
    {"kind = \"settled\"",
     "kind = \"poured\"",
     {"bad.toml:13: packing.kind = 'poured': unknown word", "\"settled\", \"random\""}},
    // Contacts.
    {"damping = \"tsuji\"", "damping = \"tsuij\"", {"bad.toml:15: contact.damping = 'tsuij'", "perhaps \"tsuji\""}},
    {"damping = \"tsuji\"",
     "damping = \"linear\"",
     {"bad.toml:20: contact.granule.restitution", "does not apply", "contact.granule.normal_damping: missing",
      "contact.wall.normal_damping: missing"}},
    {"damping = \"tsuji\"",
     "damping = \"none\"",
     {"contact.wall.restitution = 0.9: does not apply: contact.damping is \"none\": a contact gives back all its "
      "energy"}},
    {"friction = \"coulomb\"",
     "friction = \"none\"",
     {"bad.toml:21: contact.granule.friction = 0.52: does not apply: contact.friction is \"none\""}},
    {"friction = \"coulomb\"",
     "friction = \"spring\"",
     {"bad.toml:17: contact.granule.tangential_stiffness: missing", "contact.wall.tangential_stiffness: missing"}},
    {"friction = \"coulomb\"", "friction = \"springs\"", {"perhaps \"spring\"", "\"coulomb\", \"spring\", \"none\""}},
    {"friction = \"coulomb\"",
     "friction = \"coulomb\"\ntension = 0",
     {"bad.toml:17: contact.tension = 0: wrong type: an integer"}},
    {"friction = \"coulomb\"",
     "friction = \"coulomb\"\nrotation = 1",
     {"contact.rotation = 1: wrong type: an integer; allowed: true or false"}},
    {"[structure]",
     "[[contact.pair]]\nbetween = [\"a\", \"wall\"]\n[structure]",
     {"bad.toml:28: contact.pair.0.between = ['a', 'wall']: no population has the name \"a\"",
      "allowed: \"acrylic\", \"wall\"", "bad.toml:27: contact.pair.0.restitution: missing",
      "contact.pair.0.young: missing"}},
    {"[structure]", "[[contact.pair]]\n[structure]", {"bad.toml:27: contact.pair.0.between: missing"}},
    {"[structure]",
     "[[contact.pair]]\nbetween = \"acrylic\"\n[structure]",
     {"contact.pair.0.between = 'acrylic': wrong type: a string", "two names"}},
    {"[structure]",
     "[[contact.pair]]\nbetween = [\"wall\", \"wall\"]\n[structure]",
     {"bad.toml:28: contact.pair.0.between", "the wall does not touch itself"}},
    {"[structure]",
     "[[contact.pair]]\nbetween = [\"acrylic\", \"wall\"]\n[[contact.pair]]\nbetween = [\"wall\", "
     "\"acrylic\"]\n[structure]",
     {"bad.toml:30: contact.pair.1.between", "contact.pair.0 is between the same two"}},
    {"[structure]",
     "[[contact.pair]]\nbetween = [\"acrylic\", \"acrylic\"]\nyoung = 1e9\nrestitution = 2\nfirction = "
     "0.1\n[structure]",
     {"bad.toml:29: contact.pair.0.young", "two populations have their own",
      "bad.toml:30: contact.pair.0.restitution = 2", "bad.toml:31: contact.pair.0.firction", "perhaps friction",
      "contact.pair.0.friction: missing"}},
    {"[structure]",
     "[contact.pair]\nbetween = [\"acrylic\", \"wall\"]\n[structure]",
     {"contact.pair", "wrong type: a table", "[[contact.pair]]"}},
    {"restitution = 0.89",
     "restitution = 0",
     {"bad.toml:20: contact.granule.restitution = 0: out of range", "above 0 and at most 1"}},
    {"restitution = 0.89", "restitution = 1.01", {"contact.granule.restitution = 1.01: out of range"}},
    {"restitution = 0.89",
     "restitution = 0.89\nalpha = 0.08",
     {"bad.toml:21: contact.granule.alpha = 0.08: does not apply: restitution is given as well"}},
    {"restitution = 0.89", "alpha = 2.5", {"contact.granule.alpha = 2.5: out of range", "below 2.236"}},
    {"restitution = 0.89\n", "", {"bad.toml:17: contact.granule.restitution: missing"}},
    {"restitution = 0.89",
     "restitution = 0.89\nnormal_damping = 0.1",
     {"contact.granule.normal_damping", "contact.damping is \"tsuji\""}},
    {"restitution = 0.89",
     "restitution = 0.89\ntangential_stiffness = 3.3e5",
     {"contact.granule.tangential_stiffness", "only friction = \"spring\" has it"}},
    {"friction = 0.52",
     "friction = -0.1",
     {"bad.toml:21: contact.granule.friction = -0.1: out of range", "at least 0"}},
    {"friction = 0.5\n", "\n", {"bad.toml:22: contact.wall.friction: missing"}},
    {"stiffness = 1.0e7\nreference_radius = 3.0e-3",
     "stiffness = 1.0e7",
     {"bad.toml:17: contact.granule.reference_radius: missing"}},
    {"stiffness = 1.0e7\nreference_radius = 3.0e-3",
     "reference_radius = 3.0e-3",
     {"contact.granule.reference_radius", "there is none", "granules.0.young: missing", "granules.0.poisson: missing"}},
    {"stiffness = 1.3e7\nreference_radius = 3.0e-3",
     "young = 2e11",
     {"contact.wall.poisson: missing", "granules.0.young: missing"}},
    {"stiffness = 1.3e7", "stiffness = 1.3e7\nyoung = 2e11", {"contact.wall.young", "a stiffness is given"}},
    {"stiffness = 1.3e7\nreference_radius = 3.0e-3",
     "young = 2e11\npoisson = 0.6",
     {"contact.wall.poisson = 0.6: out of range", "above -1 and at most 0.5"}},
    {"[contact.granule]\nstiffness = 1.0e7\nreference_radius = 3.0e-3\nrestitution = 0.89\nfriction = 0.52\n",
     "",
     {"bad.toml:14: contact.granule: missing"}},
    // Structure and excitation.
    {"mass = 0.1", "mass = 0", {"bad.toml:28: structure.mass = 0: out of range", "above 0"}},
    {"mass = 0.1\n", "", {"bad.toml:27: structure.mass: missing"}},
    {"stiffness = 1000.0", "stiffness = -1", {"structure.stiffness = -1: out of range", "at least 0"}},
    {"stiffness = 1000.0", "stiffness = 0", {"excitation.static_deflection", "no stiffness", "force, in N"}},
    {"damping = 0.2", "damping = -0.2", {"structure.damping = -0.2: out of range"}},
    {"direction = [0, 0, 2]",
     "direction = [0, 0, 0]",
     {"bad.toml:31: structure.direction = [0, 0, 0]: the zero vector has no direction"}},
    {"direction = [0, 0, 2]", "direction = \"z\"", {"structure.direction = 'z': not three numbers"}},
    {"[structure]\nmass = 0.1\nstiffness = 1000.0\ndamping = 0.2\ndirection = [0, 0, 2]\n",
     "",
     {"excitation.static_deflection = 0.0005: does not apply: there is no [structure]",
      "excitation.kind = 'harmonic': a force needs a [structure]"}},
    // With the good scene's own keys each kind finds what does not apply to it, and what it lacks.
    {"kind = \"harmonic\"",
     "kind = \"chirp\"",
     {"bad.toml:35: excitation.frequency = 15.91: does not apply: the kind is \"chirp\"",
      "excitation.start_frequency: missing", "excitation.end_frequency: missing: where the sweep ends"}},
    {"kind = \"harmonic\"",
     "kind = \"base\"",
     {"bad.toml:34: excitation.static_deflection = 0.0005: does not apply: the kind is \"base\"",
      "excitation.amplitude: missing: how far the foundation moves", "acceleration (its amplitude) in m/s^2"}},
    {"kind = \"harmonic\"",
     "kind = \"random\"",
     {"excitation.frequency = 15.91: does not apply: the kind is \"random\"; allowed: force_rms, band, seed, period",
      "excitation.band: missing", "excitation.force_rms: missing"}},
    {"kind = \"harmonic\"",
     "kind = \"impulse\"",
     {"does not apply: the kind is \"impulse\"; allowed: force, start, pulse_duration", "excitation.force: missing",
      "excitation.pulse_duration: missing"}},
    {"kind = \"harmonic\"",
     "kind = \"table\"",
     {"does not apply: the kind is \"table\"; allowed: file, interpolation, direction", "excitation.file: missing"}},
    {"kind = \"harmonic\"\nstatic_deflection = 0.5e-3\nfrequency = 15.91",
     "kind = \"chirp\"\nforce = 1\nstart_frequency = 0\nend_frequency = 20\nsweep = \"exponential\"",
     {"excitation.start_frequency = 0: out of range", "bad.toml:37: excitation.sweep = 'exponential'",
      "\"linear\", \"logarithmic\""}},
    {"kind = \"harmonic\"\nstatic_deflection = 0.5e-3\nfrequency = 15.91",
     "kind = \"chirp\"\nforce = 1\nstatic_deflection = 1e-3\nstart_frequency = 10\nend_frequency = 20\nsweep_duration "
     "= 0",
     {"excitation.sweep_duration = 0: out of range", "force = 1: does not apply: static_deflection is given as well"}},
    {"kind = \"harmonic\"\nstatic_deflection = 0.5e-3\nfrequency = 15.91",
     "kind = \"random\"\nforce_rms = -1\nband = [20, 10]\nseed = -1",
     {"bad.toml:34: excitation.force_rms = -1: out of range", "excitation.band = [20, 10]: out of range",
      "0 <= from < to", "excitation.seed = -1: out of range"}},
    {"kind = \"harmonic\"\nstatic_deflection = 0.5e-3\nfrequency = 15.91",
     "kind = \"random\"\nforce_rms = 1\nband = [10, 10.000001]",
     {"excitation.band = [10, 10.000001]: out of range"}},
    {"kind = \"harmonic\"\nstatic_deflection = 0.5e-3\nfrequency = 15.91",
     "kind = \"impulse\"\nforce = 1\nstart = -1\npulse_duration = 0",
     {"excitation.start = -1: out of range", "excitation.pulse_duration = 0: out of range"}},
    {"kind = \"harmonic\"\nstatic_deflection = 0.5e-3\nfrequency = 15.91",
     "kind = \"base\"\namplitude = 1e-3\nacceleration = 1\nfrequency = 10",
     {"excitation.acceleration = 1: does not apply: amplitude is given as well"}},
    {"kind = \"harmonic\"\nstatic_deflection = 0.5e-3\nfrequency = 15.91",
     "kind = \"table\"\nfile = \"\"\ninterpolation = \"spline\"",
     {"excitation.file = '': not a file name", "interpolation = 'spline'", "\"cubic\", \"linear\""}},
    {"[structure]\nmass = 0.1\nstiffness = 1000.0\ndamping = 0.2\ndirection = [0, 0, 2]\n[excitation]\nkind = "
     "\"harmonic\"\nstatic_deflection = 0.5e-3\nfrequency = 15.91",
     "[excitation]\nkind = \"base\"\namplitude = 1e-3\nfrequency = 10",
     {"excitation.kind = 'base': a foundation needs a [structure]"}},
    {"[structure]\nmass = 0.1\nstiffness = 1000.0\ndamping = 0.2\ndirection = [0, 0, 2]\n[excitation]\nkind = "
     "\"harmonic\"\nstatic_deflection = 0.5e-3\nfrequency = 15.91",
     "[excitation]\nkind = \"random\"\nforce_rms = 1\nband = [1, 2]",
     {"excitation.kind = 'random': a force needs a [structure]", "excitation.force_rms = 1: does not apply"}},
    {"kind = \"harmonic\"", "kind = \"harmonics\"", {"unknown word, perhaps \"harmonic\""}},
    {"kind = \"harmonic\"\n", "", {"bad.toml:32: excitation.kind: missing"}},
    {"kind = \"harmonic\"",
     "kind = \"prescribed\"",
     {"excitation.static_deflection", "structure = {...}: does not apply", "excitation.amplitude: missing"}},
    {"kind = \"harmonic\"\nstatic_deflection = 0.5e-3",
     "kind = \"prescribed\"\nvelocity = 3.0",
     {"excitation.frequency = 15.91: does not apply: the velocity is constant"}},
    {"static_deflection = 0.5e-3\n", "", {"excitation.force: missing"}},
    {"static_deflection = 0.5e-3",
     "static_deflection = 0.5e-3\nforce = 1",
     {"bad.toml:35: excitation.force = 1: does not apply: static_deflection is given as well"}},
    {"static_deflection = 0.5e-3",
     "static_deflection = 0.5e-3\namplitude = 1",
     {"excitation.amplitude = 1: does not apply: the kind is \"harmonic\""}},
    {"frequency = 15.91", "frequency = 0", {"bad.toml:35: excitation.frequency = 0: out of range"}},
    {"frequency = 15.91\n", "", {"excitation.frequency: missing"}},
    // Structures of several modes.
    {"mass = 0.1\nstiffness = 1000.0\ndamping = 0.2\n",
     "mass = 0.1\nmodes = [{mass = 1, frequency = 10, shape = [0, 0, 1]}, {mass = 2, frequency = 20, shape = [1, 0, "
     "0]}]\n",
     {"bad.toml:28: structure.mass = 0.1: does not apply: modes are given",
      "excitation.static_deflection = 0.0005: a structure of several modes has no one stiffness; allowed: force, in "
      "N"}},
    {"mass = 0.1\nstiffness = 1000.0\ndamping = 0.2\n",
     "modes = [{mass = 0, damping_ratio = -1}, {mass = 1, stiffness = 2, frequency = 1, shape = [0, 0]}]\n",
     {"structure.modes.0.mass = 0: out of range", "structure.modes.0.frequency: missing",
      "structure.modes.0.damping_ratio = -1: out of range", "structure.modes.0.shape: missing: how the enclosure moves",
      "structure.modes.1.stiffness = 2: does not apply: frequency is given as well",
      "structure.modes.1.shape = [0, 0]: not three numbers"}},
    {"mass = 0.1\nstiffness = 1000.0\ndamping = 0.2\n",
     "modes = [{mass = 1, frequency = 10, shape = [0, 0, 0]}]\n",
     {"structure.modes", "the enclosure does not move"}},
    {"mass = 0.1\nstiffness = 1000.0\ndamping = 0.2\n", "modes = []\n", {"structure.modes = []: no modes"}},
    {"mass = 0.1\nstiffness = 1000.0\ndamping = 0.2\n",
     "modes = [{mass = 1, frequency = 10, shape = [0, 0, 1], colour = 3}]\n",
     {"structure.modes.0.colour = 3: unknown key"}},
    // Time.
    {"duration = 7.0", "duration = -7.0", {"bad.toml:37: time.duration = -7.0: out of range", "above 0"}},
    {"duration = 7.0", "duration = nan", {"time.duration = nan: not a finite number"}},
    {"duration = 7.0", "duration = 1979-05-27", {"time.duration = 1979-05-27: wrong type: a date or time"}},
    {"duration = 7.0\n", "", {"bad.toml:36: time.duration: missing"}},
    {"[time]\nduration = 7.0\nsteps_per_contact = 8\n", "", {"bad.toml: time: missing"}},
    {"steps_per_contact = 8",
     "steps_per_contact = 0",
     {"bad.toml:38: time.steps_per_contact = 0: out of range", "at least 1"}},
    {"steps_per_contact = 8",
     "steps_per_contact = 8\nstep = 1e-6",
     {"time.steps_per_contact = 8: does not apply: step is given as well"}},
    {"steps_per_contact = 8", "step = 8", {"time.step = 8: longer than the run", "at most the duration, 7 s"}},
    {"steps_per_contact = 8", "step = 1e-300", {"time.step = 1e-300: that is", "steps"}},
    {"steps_per_contact = 8", "step = \"small\"", {"time.step = 'small': wrong type: a string", "or \"adaptive\""}},
    {"steps_per_contact = 8",
     "steps_per_contact = 8\nstep = \"adaptive\"",
     {"time.steps_per_contact = 8: does not apply: step is given as well"}},
    {"steps_per_contact = 8", "error = 0", {"time.error = 0", "above 0 and at most 0.5"}},
    {"steps_per_contact = 8", "error = 1", {"time.error = 1", "above 0 and at most 0.5"}},
    {"steps_per_contact = 8", "error = \"1%\"", {"time.error", "a number"}},
    {"steps_per_contact = 8", "steps_per_contact = 8\nerror = 0.01", {"time.error", "steps_per_contact"}},
    {"steps_per_contact = 8", "step = 1e-6\nerror = 0.01", {"time.error", "step"}},
    {"steps_per_contact = 8", "precision = \"half\"", {"time.precision = 'half'", "\"double\", \"mixed\""}},
    {"steps_per_contact = 8", "integrator = \"euler\"", {"time.integrator = 'euler'", "\"leapfrog\", \"verlet\""}},
    {"steps_per_contact = 8", "impact_speed = 0", {"time.impact_speed = 0: out of range"}},
    // Lists.
    {"policy = \"guarded\"",
     "policy = \"gaurded\"",
     {"bad.toml:40: verlet.policy = 'gaurded'", "perhaps \"guarded\"", "\"all-pairs\""}},
    {"policy = \"guarded\"",
     "policy = \"guarded\"\nsafety = 1.5",
     {"verlet.safety = 1.5: does not apply: only policy \"predicted\" has it"}},
    {"policy = \"guarded\"",
     "policy = \"predicted\"\ninterval = 16",
     {"verlet.interval = 16: does not apply: only policy \"fixed\" has it"}},
    {"policy = \"guarded\"", "policy = \"none\"\nskin = 0.1", {"verlet.skin = 0.1: does not apply"}},
    {"policy = \"guarded\"", "policy = \"all-pairs\"\ncell = 1.2", {"verlet.cell = 1.2: does not apply"}},
    {"policy = \"guarded\"", "policy = \"fixed\"\ninterval = 0", {"verlet.interval = 0: out of range"}},
    {"policy = \"guarded\"", "skin = 0", {"verlet.skin = 0: out of range"}},
    {"policy = \"guarded\"", "cell = 0.5", {"verlet.cell = 0.5: out of range", "at least 1"}},
    {"policy = \"guarded\"", "audit = -5", {"verlet.audit = -5: out of range"}},
    // Output.
    {"window = [3.5, 7.0]",
     "window = [3.5, 8.0]",
     {"bad.toml:42: output.window = [3.5, 8.0]: ends after the run", "the duration, 7"}},
    {"window = [3.5, 7.0]", "window = [3.5, 3.5]", {"output.window = [3.5, 3.5]: out of range", "from < to"}},
    {"window = [3.5, 7.0]", "window = [-1, 3]", {"output.window = [-1, 3]: out of range"}},
    {"window = [3.5, 7.0]", "window = [1]", {"output.window = [1]: not two finite numbers"}},
    {"window = [3.5, 7.0]", "history_interval = 0", {"output.history_interval = 0: out of range"}},
    {"window = [3.5, 7.0]", "history_interval = 1e-12", {"output.history_interval = 1e-12: that is 7e+12 rows"}},
    {"window = [3.5, 7.0]",
     "snapshot_interval = 1e-7",
     {"output.snapshot_interval = 1e-07: that is 7e+07 snapshots", "at least 7e-06 s"}},
    {"window = [3.5, 7.0]", "checkpoint_interval = -1", {"output.checkpoint_interval = -1: out of range"}},
    {"window = [3.5, 7.0]",
     "energy = \"yes\"",
     {"output.energy = 'yes': wrong type: a string; allowed: true or false"}},
    // No TOML at all.
    {"seed = 7", "seed = = 7", {"bad.toml:2: column", "allowed: TOML"}},
    {"seed = 7", "seed = 7\nseed = 8", {"bad.toml:3: column"}},
    {"[verlet]", "[verlet", {"bad.toml:39: column"}},
    {"size = [0.025, 0.025, 0.0359]", "size = {a = [1, }", {"bad.toml:6: column"}},
    {"seed = 7", "s\u00e9ed = 7", {"bad.toml:2: a character outside ASCII", "within \"strings\""}},
    {"title = \"good\"", std::string("title = \"go\0d\"", 14), {"bad.toml:1: column"}},
    {"title = \"good\"", "title = \"\xff\xfe\"", {"bad.toml:1: column"}},
};

} // namespace

TEST_CASE("bad scenes name file, line, key, what is wrong and what is allowed") {
  for (const BadScene& bad : bad_scenes) {
    REQUIRE_FALSE(bad.expected.empty());
    CAPTURE(bad.to);
    const std::string message = message_of(replaced(good_scene, bad.from, bad.to));
    CAPTURE(message);
    for (const std::string& expected : bad.expected) {
      CAPTURE(expected);
      CHECK(message.find(expected) != std::string::npos);
    }
  }
}

TEST_CASE("all faults of a scene are told at once, in the order of its lines") {
  std::string text = replaced(good_scene, "seed = 7", "seed = -7");
  text = replaced(text, "radius = 1.85e-3", "radius = 0");
  text = replaced(text, "restitution = 0.9\n", "restitution = 9\n");
  text = replaced(text, "policy", "polici");
  try {
    read_scene_text(text, "bad.toml");
    FAIL("no error");
  } catch (const SceneError& error) {
    REQUIRE(error.problems().size() == 4);
    const std::vector<std::string> keys{"seed", "granules.0.radius", "contact.wall.restitution", "verlet.polici"};
    const std::vector<int> lines{2, 10, 25, 40};
    for (std::size_t i = 0; i < 4; ++i) {
      CHECK(error.problems()[i].key == keys[i]);
      CHECK(error.problems()[i].line == lines[i]);
      CHECK_FALSE(error.problems()[i].note);
    }
  }
}

TEST_CASE("what is hardly a scene is refused, never a crash") {
  CHECK(message_of("").find("enclosure: missing") != std::string::npos);
  CHECK(message_of("\n\n# nothing\n").find("time: missing") != std::string::npos);
  CHECK(message_of(std::string(5000, '\0')).find("bad.toml:1:") != std::string::npos);
  std::string rubbish;
  for (unsigned i = 0, x = 1; i < 100000; ++i) rubbish += static_cast<char>((x = x * 1664525U + 1013904223U) >> 24);
  CHECK(message_of(rubbish).find("bad.toml:1: ") != std::string::npos);
  CHECK(message_of("a = " + std::string(100000, '[')).find("bad.toml:1:") != std::string::npos);
  std::string key = "a";
  for (int i = 0; i < 100000; ++i) key += ".a";
  CHECK(message_of(key + " = 1").find("a key of too many parts") != std::string::npos);
  CHECK(message_of("[" + key + "]").find("a key of too many parts") != std::string::npos);
  CHECK(message_of("x = {" + key + " = 1}").find("a key of too many parts") != std::string::npos);
  CHECK(message_of("a = \"" + key + "\"\n" + key + " = 1").find("bad.toml:2: a key of too many parts") !=
        std::string::npos);
  CHECK(message_of(std::string((std::size_t{64} << 20) + 1, '\n')).find("at most 64 MiB") != std::string::npos);
  std::string many;
  for (int i = 0; i < 20000; ++i) many += "key" + std::to_string(i) + " = 1\n";
  CHECK(message_of(many).find("unknown key") != std::string::npos);
}

TEST_CASE("messages are printable whatever the scene holds") {
  const std::string message = message_of(replaced(good_scene, "seed = 7", "\"\\u001b[31m\\n\" = \"\\u0007\""));
  for (const char c : message) CHECK((static_cast<unsigned char>(c) >= 0x20 || c == '\n'));
  CHECK(message.find("\\x1b[31m\\n") != std::string::npos);
}

TEST_CASE("bad overrides are named") {
  const auto one = [](const std::string& text) { return message_of(good_scene, {text}); };
  const auto says = [](const std::string& message, const std::string& part) {
    INFO(message, " should have ", part);
    CHECK(message.find(part) != std::string::npos);
  };
  says(one("granules.0.cuont=3"),
       "granules.0.cuont = 3: unknown key, perhaps count (given by --set granules.0.cuont=3)");
  says(one("structre.mass=3"), "unknown key, perhaps structure (given by --set structre.mass=3)");
  says(one("structure.mass=-3"), "bad.toml: structure.mass = -3: out of range (given by --set structure.mass=-3)");
  says(one("structure.mass"), "not KEY=VALUE");
  says(one("=3"), "not KEY=VALUE");
  says(one("structure..mass=3"), "an empty part in the key");
  says(one("granules.1.count=3"), "no item 1 in a list of 1");
  says(one("granules.x.count=3"), "no item x in a list of 1");
  says(one("structure.direction.3=1"), "no item 3 in a list of 3");
  says(one("seed.x=1"), "within a single value");
  says(one("seed=word"), "seed = 'word': wrong type: a string");
  says(one("title=\xff"), "neither a TOML value nor a word");
  says(one("verlet.safety=2"), "verlet.safety = 2: does not apply");
  says(message_of(good_scene, {"granules.0.count=3", "granules.0.total_mass=1e-3"}), "count is given as well");
  says(message_of(good_scene, {"output.window=[1,9]", "time.duration=3"}), "output.window = [1, 9]");
  std::string deep = "a";
  for (int i = 0; i < 100000; ++i) deep += ".a";
  says(one(deep + "=1"), "a key of too many parts");
  says(one("title=" + std::string(100000, '[')), "(no error)"); // a bare word, and a strange title
}
