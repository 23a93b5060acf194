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

/// In all: their rows are told by 32 bits (kernels/rows.hpp).
inline constexpr std::size_t most_granules = (std::size_t{1} << 27) - 64;

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

/// A structure of several degrees of freedom q: M q'' + C q' + K q = force F + attachment^T R, and the enclosure's
/// displacement is attachment q, in three directions. Modes are the diagonal case.
struct SeveralModes {
  std::size_t size = 0;          ///< n; 0: none, the structure has one degree of freedom
  std::vector<double> mass;      ///< n x n by rows, symmetric, kg (modes scaled otherwise: what goes with their shapes)
  std::vector<double> damping;   ///< n x n, N s/m
  std::vector<double> stiffness; ///< n x n, N/m
  std::vector<double> attachment;   ///< 3 x n by rows
  std::vector<double> force;        ///< n
  std::vector<double> displacement; ///< n, q at t = 0
  std::vector<double> velocity;     ///< n, q' at t = 0
};

/// [structure]: one degree of freedom along `direction`, M x'' + c x' + K x = F + R; x from the equilibrium without
/// granules. Of several modes `direction` is the one that is told of, and mass, stiffness and damping are unused.
struct Structure {
  double mass = 0.0;                ///< without granules, kg
  double stiffness = 0.0;           ///< N/m
  double damping = 0.0;             ///< N s/m
  Vector3 direction{0.0, 0.0, 1.0}; ///< unit vector (the reader normalises)
  double displacement = 0.0;        ///< at t = 0, m
  double velocity = 0.0;            ///< at t = 0, m/s
  SeveralModes modes{};
};

enum class ExcitationKind { none, harmonic, prescribed, base, chirp, random, impulse, table };

/// How a chirp's frequency goes from start to end: by as many Hz, or by as many octaves, in equal times.
enum class Sweep { linear, logarithmic };

/// What a table holds beside time: a force on the structure, N, or a motion: of the foundation that the structure
/// stands on, or without a structure the enclosure's own, as displacement in m or acceleration in m/s^2.
enum class TableQuantity { force, displacement, acceleration };
/// Between the rows of a table: a cubic spline, or straight lines (not for displacements).
enum class Interpolation { cubic, linear };

/// [excitation]. Forces act on the structure along its direction:
/// harmonic: F = force sin(2 pi f t).
/// chirp: F = force sin(phase), the frequency going from start_frequency to end_frequency; nothing afterwards.
/// random: evenly distributed over `band`, zero outside of it; a function of time, Scene::seed and `seed` alone.
/// impulse: half a sine, force sin(pi (t - start) / pulse_duration).
/// table: `values` over `times`, interpolated; a force is zero before the first and after the last.
/// Motions:
/// base: the structure's foundation moves as y = amplitude sin(2 pi f t), or amplitude = acceleration / (2 pi f)^2.
/// prescribed: the enclosure moves as x = amplitude sin(2 pi f t), or at the constant `velocity`, along `direction`;
/// without a structure.
/// table of a displacement or acceleration: see TableQuantity.
struct Excitation {
  ExcitationKind kind = ExcitationKind::none;
  std::optional<double> static_deflection; ///< harmonic, chirp: force = structure.stiffness * static_deflection, m
  std::optional<double> force;             ///< harmonic, chirp, impulse: amplitude, N
  double frequency = 0.0;                  ///< harmonic, prescribed, base: Hz
  double amplitude = 0.0;                  ///< prescribed, base: m
  std::optional<double> acceleration;      ///< base, instead of amplitude: m/s^2
  std::optional<double> velocity;          ///< prescribed, constant, m/s
  Vector3 direction{1.0, 0.0, 0.0};        ///< prescribed, or a table without a structure; unit vector

  double start_frequency = 0.0;         ///< chirp, Hz
  double end_frequency = 0.0;           ///< chirp, Hz
  Sweep sweep = Sweep::linear;          ///< chirp
  std::optional<double> sweep_duration; ///< chirp, s; left out: the whole run (make_plan fills it in)

  double force_rms = 0.0;               ///< random, N
  std::optional<double> period;         ///< chirp, random: the force repeats itself after so long, s; left out: never
  std::array<double, 2> band{0.0, 0.0}; ///< random, Hz
  std::uint64_t seed = 0;               ///< random: another number, another signal of the same scene

  double start = 0.0;          ///< impulse, s
  double pulse_duration = 0.0; ///< impulse, s

  TableQuantity quantity = TableQuantity::force;      ///< table
  Interpolation interpolation = Interpolation::cubic; ///< table
  std::vector<double> times;                          ///< table, s, increasing
  std::vector<double> values;                         ///< table, one for each time
};

enum class Integrator { leapfrog, verlet };
/// mixed: positions, velocities and sums in double, the law of contact between granules in float. Not with spring
/// friction, nor without tension.
enum class Precision { full, mixed };

struct TimeControl {
  double duration = 0.0;              ///< s
  double steps_per_contact = 8.0;     ///< k in T_c / k
  std::optional<double> step;         ///< s, instead of steps_per_contact
  bool adaptive = false;              ///< step = "adaptive": in parts, where contacts are faster than expected
  std::optional<double> error;        ///< of a contact, instead of steps_per_contact (solver/contact_error.hpp)
  std::optional<double> impact_speed; ///< closing speed for T_c, m/s; left out: estimated
  Integrator integrator = Integrator::leapfrog;
  bool integrator_free = false; ///< with `error`: the integrator is chosen, too
  Precision precision = Precision::full;
};

enum class ListPolicy { guarded, predicted, displacement, fixed, none, all_pairs };

struct VerletControl {
  ListPolicy policy = ListPolicy::guarded;
  /// Over the largest diameter; left out: tuned as the run goes, beginning with a share of the mean diameter.
  std::optional<double> skin;
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
