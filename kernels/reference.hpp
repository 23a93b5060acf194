// The oracle: one pair, one wall contact, one granule, scalar and plain, written from the equations and from nothing
// else. Every vector kernel is held to it. Slow on purpose; no thresholds, no tables, no tricks.
#pragma once

#include <array>
#include <vector>

namespace grandamp::reference {

using Vector = std::array<double, 3>;

enum class Damping { none, tsuji, linear };

/// The constants of one kind of contact and the laws in force.
struct Law {
  double stiffness_coefficient = 0.0; ///< C in k_n = C sqrt(R), N/m^2
  double alpha = 0.0;                 ///< Tsuji's constant
  double normal_damping = 0.0;        ///< linear damping, N s/m
  double friction = 0.0;              ///< mu
  double cap = 1.0;                   ///< of friction's share; half where forces see velocities half a step ahead
  Damping damping = Damping::none;
  bool tension = true;                           ///< the damping may pull at the end of a contact
  bool coulomb = false;                          ///< Coulomb friction, capped
  bool spring = false;                           ///< friction of spring, dashpot and slider
  bool rotation = false;                         ///< spins take part in the slip and receive torques
  double tangential_stiffness_coefficient = 0.0; ///< C_t in k_t = C_t sqrt(R), N/m^2
  double tangential_damping = 0.0;               ///< c_t, N s/m
};

/// What a contact remembers of its tangential spring; as it is here, a fresh contact.
struct Spring {
  Vector force{};       ///< on i, N
  double overlap = 0.0; ///< when it had that force, m
};

/// Velocities (m/s) and spins (rad/s) that brought two granules to where they are, if they are not the granules' own.
struct Arrival {
  Vector velocity_i{}, spin_i{}, velocity_j{}, spin_j{};
};

/// A granule; a sphere with the moment of inertia 2/5 m r^2.
struct Granule {
  Vector position{};   ///< m
  Vector velocity{};   ///< m/s
  Vector spin{};       ///< rad/s
  double radius = 0.0; ///< m
  double mass = 0.0;   ///< kg
  int touching =
      0; ///< contacts that it had a step ago: friction takes at most 1/(1 + touching) of a slip in a step, or half
};

/// What a contact does. All zeros when nothing touches. `normal` points from i to j, or from the granule to the wall.
struct Contact {
  bool touching = false;
  double overlap = 0.0;        ///< d, m
  Vector normal{};             ///< unit vector
  double approach = 0.0;       ///< d', m/s
  Vector slip{};               ///< v_t, m/s
  double arm_i = 0.0;          ///< centre of i to the contact point, m
  double arm_j = 0.0;          ///< m; 0 at a wall
  double spring = 0.0;         ///< k_n d^1.5, N
  double damping = 0.0;        ///< D_n, N
  Vector friction{};           ///< f_t on i, N
  Spring memory;               ///< of the tangential spring, for the next step
  double spring_energy = 0.0;  ///< in the tangential spring, J
  Vector force_i{};            ///< on i, N; j (or the wall) gets the opposite
  Vector torque_i{};           ///< N m
  Vector torque_j{};           ///< N m
  double elastic_energy = 0.0; ///< 2/5 k_n d^2.5, J
};

/// Power lost in a contact, W, losses positive.
struct Dissipation {
  double normal = 0.0;   ///< D_n d'
  double friction = 0.0; ///< -f_t . v_t; what a tangential spring stores included
};

/// Fang et al. 2007, Eqs. (2), (4), (6), (7). `step` (s) bounds the friction: it cannot reverse the slip. `before` is
/// what the contact remembered a step ago.
Contact pair_contact(const Granule& i, const Granule& j, const Law& law, double step, const Spring& before = {},
                     const Arrival* arrival = nullptr);

/// A plane (or the tangent plane of a curved wall) at `distance` from the granule's centre, `outward` pointing from the
/// granule to it. The granule's velocity is relative to the wall. `damping_mass` and `slip_mass` are the effective
/// masses (kg) along and across the normal: the granule's own at a wall that does not give way.
Contact wall_contact(const Granule& granule, double distance, const Vector& outward, const Law& law, double step,
                     double damping_mass, double slip_mass, const Spring& before = {},
                     const Arrival* arrival = nullptr);

/// Losses of a contact's damping and friction at velocities other than those that gave the forces (the mean over the
/// step, for a ledger that closes).
Dissipation pair_dissipation(const Contact& contact, const Granule& i, const Granule& j, const Law& law);
Dissipation wall_dissipation(const Contact& contact, const Granule& granule, const Law& law);

/// Where a wall is, seen from a point inside.
struct WallPoint {
  double distance = 0.0;
  Vector outward{};
};

/// The six faces of a box with a corner at the origin: -x, +x, -y, +y, -z, +z.
std::vector<WallPoint> box_walls(const Vector& size, const Vector& point);

/// Side, lower end, upper end of a cylinder along `axis` (0, 1, 2), its bounding box's corner at the origin. A point on
/// the axis has no nearest point of the side: it gets no side wall.
std::vector<WallPoint> cylinder_walls(double diameter, double height, int axis, const Vector& point);

/// 1 / (1/m + (outward . direction)^2 / M): a granule of mass m against a wall carried by a structure of mass M.
double wall_effective_mass(double mass, const Vector& outward, const Vector& direction, double structure_mass);

/// Half-step velocity and spin after the kick of `step`, position after the drift; `frame_kick` is the enclosure's own
/// velocity increment in this step, m/s.
void move(Granule& granule, const Vector& force, const Vector& torque, const Vector& gravity, const Vector& frame_kick,
          double step);

double moment_of_inertia(const Granule& granule); ///< kg m^2
double kinetic_energy(const Granule& granule);    ///< translation and rotation, J

} // namespace grandamp::reference
