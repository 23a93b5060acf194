// What a run is: the scene as plain values, SI units throughout. Read by io/scene_file, or filled in by a program of
// one's own; checked by make_plan (solver/plan.hpp). The keys are those of a scene file, table by table.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace grandamp {

using Vector3 = std::array<double, 3>;

enum class EnclosureShape { box, cylinder };

/// [enclosure]: the rigid container. Its corner (box), or the corner of the lower rim's bounding box, is the origin.
struct Enclosure {
  EnclosureShape shape = EnclosureShape::box;
  Vector3 size{0.0, 0.0, 0.0}; ///< inner lengths of a box, m
  double diameter = 0.0;       ///< of a cylinder, m
  double height = 0.0;         ///< of a cylinder, along its axis, m
  int axis = 2;                ///< of a cylinder: 0, 1, 2 for x, y, z
};

/// [[granules]]: one population. Either placed by the packing (`positions` empty, `count` granules of `radius` and
/// `mass`), or with explicit positions (`count` of them; `radii` and `masses` either empty or one per granule).
struct Population {
  std::string name;
  std::size_t count = 0;
  double radius = 0.0;           ///< m
  double mass = 0.0;             ///< of one granule, kg
  std::optional<double> young;   ///< Pa
  std::optional<double> poisson; ///< -
  double speed = 0.0;            ///< initial, directions at random, m/s

  bool placed = false;             ///< positions were given, by `positions` or `file`
  std::vector<Vector3> positions;  ///< m, in the enclosure's frame
  std::vector<Vector3> velocities; ///< m/s, in the laboratory's frame; empty: at rest (or `speed`)
  std::vector<Vector3> spins;      ///< rad/s; empty: none
  std::vector<double> radii;       ///< m; empty: all `radius`
  std::vector<double> masses;      ///< kg; empty: all `mass`
};

enum class PackingKind { settled, random };

enum class NormalDamping { none, tsuji, linear };
enum class FrictionLaw { none, coulomb, spring };

/// [contact.granule] and [contact.wall]: what holds between two granules, or a granule and the enclosure.
/// Stiffness is either given for `reference_radius`, or comes from `young` and `poisson`.
struct ContactConstants {
  std::optional<double> stiffness;            ///< k_n of reference_radius, N/m^1.5
  std::optional<double> reference_radius;     ///< m
  std::optional<double> restitution;          ///< (0, 1], Tsuji damping
  std::optional<double> alpha;                ///< Tsuji's constant instead of restitution
  std::optional<double> normal_damping;       ///< linear damping, N s/m
  std::optional<double> friction;             ///< mu
  std::optional<double> tangential_stiffness; ///< k_t of reference_radius, N/m^1.5, spring friction; with stiffness
  std::optional<double> tangential_damping;   ///< N s/m, spring friction; left out: none
  std::optional<double> young;                ///< of the wall, Pa
  std::optional<double> poisson;              ///< of the wall
};

/// [[contact.pair]]: between two populations by name, or a population and "wall", instead of the above.
struct PairContact {
  std::array<std::string, 2> between;
  ContactConstants constants;
};

struct Contact {
  NormalDamping damping = NormalDamping::tsuji;
  FrictionLaw friction = FrictionLaw::coulomb;
  bool tension = true; ///< the damping may pull at the end of a contact
  bool rotation = true;
  ContactConstants granule;
  std::optional<ContactConstants> wall; ///< left out: as the granules', the wall of their material
  std::vector<PairContact> pairs;
};

/// [structure]: one degree of freedom along `direction`, M x'' + c x' + K x = F + R; x from the equilibrium without
/// granules.
struct Structure {
  double mass = 0.0;                ///< without granules, kg
  double stiffness = 0.0;           ///< N/m
  double damping = 0.0;             ///< N s/m
  Vector3 direction{0.0, 0.0, 1.0}; ///< unit vector (the reader normalises)
  double displacement = 0.0;        ///< at t = 0, m
  double velocity = 0.0;            ///< at t = 0, m/s
};

enum class ExcitationKind { none, harmonic, prescribed };

/// [excitation]. harmonic: F = force sin(2 pi f t) on the structure. prescribed: the enclosure moves as
/// x = amplitude sin(2 pi f t), or at the constant `velocity`, along `direction`; without a structure.
struct Excitation {
  ExcitationKind kind = ExcitationKind::none;
  std::optional<double> static_deflection; ///< harmonic: force = structure.stiffness * static_deflection, m
  std::optional<double> force;             ///< harmonic: amplitude, N
  double frequency = 0.0;                  ///< Hz
  double amplitude = 0.0;                  ///< prescribed, m
  std::optional<double> velocity;          ///< prescribed, constant, m/s
  Vector3 direction{1.0, 0.0, 0.0};        ///< prescribed; unit vector
};

enum class Integrator { leapfrog, verlet };
/// mixed: positions, velocities and sums in double, the law of contact between granules in float. Not with spring
/// friction, nor without tension.
enum class Precision { full, mixed };

struct TimeControl {
  double duration = 0.0;              ///< s
  double steps_per_contact = 8.0;     ///< k in T_c / k
  std::optional<double> step;         ///< s, instead of steps_per_contact
  std::optional<double> error;        ///< of a contact, instead of steps_per_contact (solver/contact_error.hpp)
  std::optional<double> impact_speed; ///< closing speed for T_c, m/s; left out: estimated
  Integrator integrator = Integrator::leapfrog;
  bool integrator_free = false; ///< with `error`: the integrator is chosen, too
  Precision precision = Precision::full;
};

enum class ListPolicy { guarded, predicted, displacement, fixed, none, all_pairs };

struct VerletControl {
  ListPolicy policy = ListPolicy::guarded;
  std::optional<double> skin; ///< over the largest diameter; left out: tuned as the run goes
  std::optional<double> cell; ///< cell length over the largest diameter; left out: chosen
  double safety = 1.5;        ///< beta of the paper's predicted interval
  int max_interval = 150;     ///< U_L of the paper's predicted interval
  int interval = 16;          ///< of the fixed policy
  std::int64_t audit = 0;     ///< compare with all pairs every so many steps; 0: never
};

struct OutputControl {
  double history_interval = 1.0e-4;            ///< s
  double snapshot_interval = 0.0;              ///< s; 0: none
  double checkpoint_interval = 60.0;           ///< wall-clock seconds; 0: none
  std::optional<std::array<double, 2>> window; ///< for the statistics, s; left out: the last half
  bool energy = true;                          ///< the ledger by mechanism
};

struct Scene {
  std::string title;
  std::uint64_t seed = 1;
  Vector3 gravity{0.0, 0.0, 0.0}; ///< m/s^2
  Enclosure enclosure;
  std::vector<Population> populations;
  PackingKind packing = PackingKind::settled;
  Contact contact;
  std::optional<Structure> structure;
  Excitation excitation;
  TimeControl time;
  VerletControl verlet;
  OutputControl output;
};

} // namespace grandamp
