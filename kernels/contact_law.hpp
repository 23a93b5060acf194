// One contact, whatever its partners: what the pair and the wall kernels have in common.
#pragma once

#include "kernels/damping.hpp"
#include "kernels/effects.hpp"
#include "kernels/friction.hpp"
#include "kernels/hertz.hpp"

namespace grandamp::kernels {

/// Constants of one kind of contact, as a row.
struct alignas(32) LawRow {
  double stiffness; ///< C in k_n = C sqrt(R), N/m^2
  double damping;   ///< alpha (Tsuji), or c_n (linear), N s/m
  double friction;  ///< mu
  double unused;
};

template <class S> struct LawVectors { typename S::Vector stiffness, damping, friction; };

/// From granule i to its partner: n points from i to the partner.
template <class S> struct ContactGeometry {
  using Vector = typename S::Vector;
  Vector overlap;
  Vector nx, ny, nz;
  Vector vx, vy, vz;    ///< v_i - v_j
  Vector sx, sy, sz;    ///< s_i + s_j, surface spins
  Vector lever;         ///< a/r: contact point's distance over the radius
  Vector radius;        ///< R of Hertz
  Vector mass;          ///< effective
  Vector friction_mass; ///< effective, for the friction's cap
};

/// On granule i; the partner feels -f and the same turn.
template <class S> struct ContactForces {
  using Vector = typename S::Vector;
  Vector fx, fy, fz;
  Vector tx, ty, tz; ///< lever n x f_t
  Vector damping;    ///< D_n d', along -n on i
  Vector rx, ry, rz; ///< f_t
  Vector elastic;    ///< energy of the spring
  Vector closing;    ///< d'
};

template <class S, ContactEffects E>
GRANDAMP_INLINE ContactForces<S> contact_forces(const ContactGeometry<S>& c, const LawVectors<S>& law,
                                                typename S::Vector friction_cap) {
  using Vector = typename S::Vector;
  ContactForces<S> out;
  const Vector root = hertz_root<S>(c.radius, c.overlap);
  const Vector spring = hertz_force<S>(law.stiffness, root, c.overlap);
  if constexpr (E.energies()) out.elastic = hertz_energy<S>(spring, c.overlap);

  out.closing = S::fma(c.vz, c.nz, S::fma(c.vy, c.ny, c.vx * c.nx));
  Vector normal = spring;
  if constexpr (E.damped()) {
    const Vector coefficient = damping_coefficient<S, E.damping>(law.damping, c.mass, law.stiffness, root);
    if constexpr (E.ledger()) out.damping = coefficient * out.closing;
    normal = S::fma(coefficient, out.closing, spring);
  }

  if constexpr (!E.rubs()) {
    const Vector minus = S::broadcast(0.0) - normal;
    out.fx = minus * c.nx;
    out.fy = minus * c.ny;
    out.fz = minus * c.nz;
  } else {
    Vector ux = S::fnma(out.closing, c.nx, c.vx);
    Vector uy = S::fnma(out.closing, c.ny, c.vy);
    Vector uz = S::fnma(out.closing, c.nz, c.vz);
    if constexpr (E.rotates()) {
      const Vector wx = c.lever * c.sx, wy = c.lever * c.sy, wz = c.lever * c.sz;
      ux = S::fnma(wz, c.ny, S::fma(wy, c.nz, ux));
      uy = S::fnma(wx, c.nz, S::fma(wz, c.nx, uy));
      uz = S::fnma(wy, c.nx, S::fma(wx, c.ny, uz));
    }
    const Vector slip_squared = S::fma(uz, uz, S::fma(uy, uy, ux * ux));
    const Vector g = coulomb_coefficient<S>(law.friction, normal, slip_squared, friction_cap * c.friction_mass);
    const Vector rx = g * ux, ry = g * uy, rz = g * uz; // -f_t
    const Vector zero = S::broadcast(0.0);
    out.fx = S::fnma(normal, c.nx, zero - rx);
    out.fy = S::fnma(normal, c.ny, zero - ry);
    out.fz = S::fnma(normal, c.nz, zero - rz);
    if constexpr (E.ledger()) {
      out.rx = zero - rx;
      out.ry = zero - ry;
      out.rz = zero - rz;
    }
    if constexpr (E.rotates()) {
      out.tx = c.lever * S::fnma(c.ny, rz, c.nz * ry);
      out.ty = c.lever * S::fnma(c.nz, rx, c.nx * rz);
      out.tz = c.lever * S::fnma(c.nx, ry, c.ny * rx);
    }
  }
  return out;
}

} // namespace grandamp::kernels
