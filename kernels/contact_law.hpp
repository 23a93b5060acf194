// One contact, whatever its partners: what the pair and the wall kernels have in common.
#pragma once

#include "kernels/damping.hpp"
#include "kernels/effects.hpp"
#include "kernels/friction.hpp"
#include "kernels/hertz.hpp"
#include "kernels/spring.hpp"

namespace grandamp::kernels {

/// Constants of one kind of contact, as a row.
struct alignas(32) LawRow {
  double stiffness; ///< C in k_n = C sqrt(R), N/m^2
  double damping;   ///< alpha (Tsuji), or c_n (linear), N s/m
  double friction;  ///< mu
  double unused;
};

template <class S> struct LawVectors { typename S::Vector stiffness, damping, friction; };
template <class S> struct SpringLawVectors { typename S::Vector stiffness, damping; };

/// From granule i to its partner: n points from i to the partner.
template <class S> struct ContactGeometry {
  using Vector = typename S::Vector;
  Vector overlap;
  Vector nx, ny, nz;
  Vector closing;       ///< d'
  Vector ux, uy, uz;    ///< slip: the velocity of the contact point across the normal (friction)
  Vector lever;         ///< a/r: contact point's distance over the radius
  Vector root;          ///< sqrt(R overlap), R of Hertz
  Vector mass;          ///< effective
  Vector friction_mass; ///< walls: effective, for the friction's cap
};

/// What a contact with a memory has besides: last step's spring, which becomes this step's.
template <class S> struct ContactMemory {
  using Vector = typename S::Vector;
  Spring<S> spring;
  SpringLawVectors<S> law;
  Vector time_step;
  bool moved_otherwise = false; ///< the velocities that forces see are not those that brought the granules here
  Vector mx, my, mz;            ///< if so, those: v_i - v_j
  Vector wx, wy, wz;            ///< and s_i + s_j
};

/// On granule i; the partner feels -f and the same turn.
template <class S> struct ContactForces {
  using Vector = typename S::Vector;
  Vector fx, fy, fz;
  Vector tx, ty, tz; ///< lever n x f_t
  Vector damping;    ///< D_n d', along -n on i
  Vector rx, ry, rz; ///< f_t
  Vector elastic;    ///< energy of the overlap
  Vector spring;     ///< energy of the tangential spring
};

/// The lever times the normal: crossed with it, spins become velocities of the contact point, and forces there torques.
template <class S> struct Arm {
  typename S::Vector x, y, z;
  [[gnu::always_inline]] explicit Arm(const ContactGeometry<S>& c)
      : x(c.lever * c.nx), y(c.lever * c.ny), z(c.lever * c.nz) {}
};

/// v - (v.n) n + s x a n: the velocity of the contact point across the normal, in place of v.
template <class S, bool rotates>
GRANDAMP_INLINE void slip_of(const ContactGeometry<S>& c, typename S::Vector closing, const typename S::Vector& sx,
                             const typename S::Vector& sy, const typename S::Vector& sz, typename S::Vector& ux,
                             typename S::Vector& uy, typename S::Vector& uz) {
  ux = S::fnma(closing, c.nx, ux);
  uy = S::fnma(closing, c.ny, uy);
  uz = S::fnma(closing, c.nz, uz);
  if constexpr (rotates) {
    const Arm<S> arm(c);
    ux = S::fnma(sz, arm.y, S::fma(sy, arm.z, ux));
    uy = S::fnma(sx, arm.z, S::fma(sz, arm.x, uy));
    uz = S::fnma(sy, arm.x, S::fma(sx, arm.y, uz));
  }
}

/// Closing speed, and with friction the slip, of v = v_i - v_j and s = s_i + s_j (surface spins); after the normal and
/// the lever.
template <class S, ContactEffects E>
GRANDAMP_INLINE void closing_and_slip(ContactGeometry<S>& c, typename S::Vector vx, typename S::Vector vy,
                                      typename S::Vector vz, const typename S::Vector& sx, const typename S::Vector& sy,
                                      const typename S::Vector& sz) {
  c.closing = S::fma(vz, c.nz, S::fma(vy, c.ny, vx * c.nx));
  if constexpr (E.rubs()) {
    slip_of<S, E.rotates()>(c, c.closing, sx, sy, sz, vx, vy, vz);
    c.ux = vx, c.uy = vy, c.uz = vz;
  }
}

/// -f_t of spring, dashpot and slider; the memory moves on by a step.
template <class S, ContactEffects E>
GRANDAMP_INLINE void spring_friction(const ContactGeometry<S>& c, ContactMemory<S>& memory, typename S::Vector most,
                                     typename S::Vector& rx, typename S::Vector& ry, typename S::Vector& rz) {
  using Vector = typename S::Vector;
  Vector mx = c.ux, my = c.uy, mz = c.uz;
  if (memory.moved_otherwise) {
    mx = memory.mx, my = memory.my, mz = memory.mz;
    const Vector along = S::fma(mz, c.nz, S::fma(my, c.ny, mx * c.nx));
    slip_of<S, E.rotates()>(c, along, memory.wx, memory.wy, memory.wz, mx, my, mz);
  }
  Spring<S>& spring = memory.spring;
  const Vector time = loading_time<S>(spring.root, c.overlap, c.closing, memory.time_step);
  turn_and_ease<S>(spring, c.nx, c.ny, c.nz, c.root);
  const Vector k = memory.law.stiffness * c.root * time;
  spring.fx = S::fnma(k, mx, spring.fx);
  spring.fy = S::fnma(k, my, spring.fy);
  spring.fz = S::fnma(k, mz, spring.fz);
  const Vector held =
      held_at<S>(most, S::fma(spring.fz, spring.fz, S::fma(spring.fy, spring.fy, spring.fx * spring.fx)));
  spring.fx = held * spring.fx;
  spring.fy = held * spring.fy;
  spring.fz = held * spring.fz;
  spring.root = c.root;
  rx = S::fma(memory.law.damping, c.ux, S::broadcast(0.0) - spring.fx);
  ry = S::fma(memory.law.damping, c.uy, S::broadcast(0.0) - spring.fy);
  rz = S::fma(memory.law.damping, c.uz, S::broadcast(0.0) - spring.fz);
  const Vector all = held_at<S>(most, S::fma(rz, rz, S::fma(ry, ry, rx * rx)));
  rx = all * rx;
  ry = all * ry;
  rz = all * rz;
}

/// friction_cap: on g, kg/s (kernels/friction.hpp). `memory` only with effects that remember.
template <class S, ContactEffects E>
GRANDAMP_INLINE void contact_forces(const ContactGeometry<S>& c, const LawVectors<S>& law,
                                    typename S::Vector friction_cap, ContactForces<S>& out,
                                    ContactMemory<S>* memory = nullptr) {
  using Vector = typename S::Vector;
  const Vector spring = hertz_force<S>(law.stiffness, c.root, c.overlap);
  if constexpr (E.energies()) out.elastic = hertz_energy<S>(spring, c.overlap);

  Vector normal = spring;
  if constexpr (E.damped()) {
    const Vector coefficient = damping_coefficient<S, E.damping>(law.damping, c.mass, law.stiffness, c.root);
    normal = S::fma(coefficient, c.closing, spring);
    if constexpr (E.only_pushes()) {
      normal = S::max(normal, S::broadcast(0.0));
      if constexpr (E.ledger()) out.damping = normal - spring;
    } else if constexpr (E.ledger())
      out.damping = coefficient * c.closing;
  }

  const Vector zero = S::broadcast(0.0);
  Vector rx = zero, ry = zero, rz = zero; // -f_t
  if constexpr (E.remembers()) {
    spring_friction<S, E>(c, *memory, law.friction * S::abs(normal), rx, ry, rz);
    if constexpr (E.energies()) out.spring = spring_energy<S>(memory->spring, memory->law.stiffness);
  } else if constexpr (E.rubs()) {
    const Vector slip_squared = S::fma(c.uz, c.uz, S::fma(c.uy, c.uy, c.ux * c.ux));
    const Vector g = coulomb_coefficient<S>(law.friction, normal, slip_squared, friction_cap);
    rx = g * c.ux;
    ry = g * c.uy;
    rz = g * c.uz;
  }
  out.fx = S::fnms(normal, c.nx, rx);
  out.fy = S::fnms(normal, c.ny, ry);
  out.fz = S::fnms(normal, c.nz, rz);
  if constexpr (E.ledger() && E.rubs()) {
    out.rx = zero - rx;
    out.ry = zero - ry;
    out.rz = zero - rz;
  }
  if constexpr (E.rotates()) {
    const Arm<S> arm(c);
    out.tx = S::fnma(arm.y, rz, arm.z * ry);
    out.ty = S::fnma(arm.z, rx, arm.x * rz);
    out.tz = S::fnma(arm.x, ry, arm.y * rx);
  }
}

} // namespace grandamp::kernels
