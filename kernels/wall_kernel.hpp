// Granule against a wall of the enclosure, which stands still in its own frame: a plane, or the side of a cylinder.
#pragma once

#include "kernels/contact_loops.hpp"
#include "kernels/lines.hpp"

namespace grandamp::kernels {

enum class Surface { plane, side };

template <class S, ContactEffects E, Surface shape> struct WallLoop {
  using Vector = typename S::Vector;
  using Row = typename S::Row;
  static constexpr int width = S::width;
  static constexpr bool law_with_rows = short_law(E);

  const WallArguments& a; // no copy, with which the portable kernel was slower
  WallResult& result;
  Vector max_overlap = S::broadcast(0.0);
  Vector max_closing = S::broadcast(0.0);
  Row total_force = S::row_broadcast(0.0);

  void positions(const std::uint32_t* list, Vector& x, Vector& y, Vector& z, Vector& radius) const {
    Row rows[width];
    for (int lane = 0; lane < width; ++lane) rows[lane] = S::row_load(&a.granules.position[list[lane]].x);
    S::columns(rows, x, y, z, radius);
  }

  /// Overlap with the wall; n towards it.
  Vector overlap(const std::uint32_t* list, Vector& nx, Vector& ny, Vector& nz, Vector& radius) const {
    Vector x, y, z;
    positions(list, x, y, z, radius);
    const WallSurface& s = a.surface;
    if constexpr (shape == Surface::plane) {
      nx = S::broadcast(s.normal[0]);
      ny = S::broadcast(s.normal[1]);
      nz = S::broadcast(s.normal[2]);
      return S::fma(z, nz, S::fma(y, ny, x * nx)) - S::broadcast(s.offset) + radius;
    } else {
      const Vector px = (x - S::broadcast(s.centre[0])) * S::broadcast(s.across[0]);
      const Vector py = (y - S::broadcast(s.centre[1])) * S::broadcast(s.across[1]);
      const Vector pz = (z - S::broadcast(s.centre[2])) * S::broadcast(s.across[2]);
      const Vector off_axis = S::sqrt(S::fma(pz, pz, S::fma(py, py, px * px)));
      const Vector inverse = S::broadcast(1.0) / off_axis;
      nx = px * inverse;
      ny = py * inverse;
      nz = pz * inverse;
      return off_axis - S::broadcast(s.radius) + radius;
    }
  }

  /// Which of the entries from `entry` on touch.
  [[gnu::always_inline]] unsigned marks(std::size_t entry) const {
    unsigned marks = 0;
    for (unsigned k = 0; k < list_padding; k += width) {
      Vector nx, ny, nz, radius;
      marks |= S::less(S::broadcast(0.0), overlap(a.list + entry + k, nx, ny, nz, radius)) << k;
    }
    const std::size_t left = a.count - entry;
    return left < list_padding ? marks & ((1U << left) - 1U) : marks; // the padding touches nothing
  }

  [[gnu::always_inline]] void geometry(const std::uint32_t* list, ContactGeometry<S>& c) {
    Vector radius;
    c.overlap = S::max(overlap(list, c.nx, c.ny, c.nz, radius), S::broadcast(0.0));
    c.root = hertz_root<S>(radius, c.overlap);

    const MotionRow* motion = a.granules.predicted;
    using L = Lines<S>;
    typename L::Line lines[width];
    for (int lane = 0; lane < width; ++lane) lines[lane] = L::load(motion[list[lane]].velocity);
    Vector columns[8];
    L::columns(lines, columns);
    const Vector inverse_mass = columns[3], inverse_radius = columns[7];

    const Vector one = S::broadcast(1.0);
    c.lever = S::fnma(c.overlap, inverse_radius, one);
    const Vector along = S::fma(c.nz, S::broadcast(a.direction[2]),
                                S::fma(c.ny, S::broadcast(a.direction[1]), c.nx * S::broadcast(a.direction[0])));
    closing_and_slip<S, E>(c, columns[0], columns[1], columns[2], columns[4], columns[5], columns[6]);
    c.mass = one / S::fma(along * along, S::broadcast(a.enclosure_inverse_mass), inverse_mass);
    c.friction_mass = one / (inverse_mass + S::broadcast(a.friction_inverse_mass));
    max_overlap = S::max(max_overlap, c.overlap * inverse_radius);
  }

  void note_depth(const std::uint32_t*, std::size_t, const ContactGeometry<S>*) const {} // done by geometry
  void expect(std::size_t, std::size_t, std::size_t) const {}                            // nothing is asked ahead

  [[gnu::always_inline]] void forces(const std::uint32_t* list, unsigned lanes, const ContactGeometry<S>& c,
                                     ContactForces<S>& f) {
    LawVectors<S> law;
    if constexpr (E.variety == Variety::materials)
      law = gathered_laws<S>(a.laws, [&](int lane) { return a.granules.population[list[lane]]; });
    else
      law = common_law<S>(a.law);

    if constexpr (E.remembers()) {
      const std::uint32_t* slots = a.springs.slots + (list - a.touching);
      ContactMemory<S> memory = recall(list, slots);
      contact_forces<S, E>(c, law, S::broadcast(0.0), f, &memory);
      remember<S>(a.springs, slots, lanes, memory.spring);
      if constexpr (E.energies()) add_in_order<S>(f.spring, lanes, result.spring);
    } else if constexpr (E.counts()) {
      const Vector share = friction_shares<S>([&](int lane) { return S::row_load(a.granules.force[list[lane]].turn); });
      contact_forces<S, E>(c, law, S::broadcast(a.friction_cap) * share * c.friction_mass, f);
    } else
      contact_forces<S, E>(c, law, S::broadcast(0.0), f);
    max_closing = S::max(c.closing, max_closing); // a NaN leaves it as it was
    if constexpr (E.energies()) {
      add_in_order<S>(f.elastic, lanes, result.elastic);
      result.contacts += lanes;
    }
  }

  ContactMemory<S> recall(const std::uint32_t* list, const std::uint32_t* slots) const {
    ContactMemory<S> memory;
    memory.spring = remembered<S>(a.springs, slots);
    memory.time_step = S::broadcast(a.springs.time_step);
    if constexpr (E.variety == Variety::materials)
      memory.law = gathered_laws<S>(a.springs.laws, [&](int lane) { return a.granules.population[list[lane]]; });
    else
      memory.law = common_law<S>(a.springs.law);
    const MotionRow* motion = a.granules.motion;
    memory.moved_otherwise = motion != a.granules.predicted;
    if (memory.moved_otherwise) {
      Row rows[width], spins[width];
      for (int lane = 0; lane < width; ++lane) {
        rows[lane] = S::row_load(motion[list[lane]].velocity);
        spins[lane] = S::row_load(motion[list[lane]].surface_spin);
      }
      Vector unused;
      S::columns(rows, memory.mx, memory.my, memory.mz, unused);
      S::columns(spins, memory.wx, memory.wy, memory.wz, unused);
    }
    return memory;
  }

  [[gnu::always_inline]] void add_rows(const std::uint32_t* list, unsigned lanes, const ContactGeometry<S>& c,
                                       const ContactForces<S>& f) {
    const Vector zero = S::broadcast(0.0);
    Row forces[width], turns[width];
    S::rows(f.fx, f.fy, f.fz, E.counts() ? S::broadcast(1.0) : zero, forces);
    if constexpr (E.rotates()) S::rows(f.tx, f.ty, f.tz, zero, turns);
    for (unsigned lane = 0; lane < lanes; ++lane) {
      ForceRow& i = a.granules.force[list[lane]];
      S::row_store(i.force, S::row_load(i.force) + forces[lane]);
      total_force = total_force + forces[lane];
      if constexpr (E.rotates()) S::row_store(i.turn, S::row_load(i.turn) + turns[lane]);
    }
    if constexpr (E.ledger() && E.damped()) {
      Row damping[width];
      S::rows((zero - f.damping) * c.nx, (zero - f.damping) * c.ny, (zero - f.damping) * c.nz, zero, damping);
      for (unsigned lane = 0; lane < lanes; ++lane) {
        double* i = a.granules.wall_loss.damping[list[lane]].force;
        S::row_store(i, S::row_load(i) + damping[lane]);
        a.granules.wall_loss.touches[list[lane]] = 1;
      }
    }
    if constexpr (E.ledger() && E.rubs()) {
      Row rubbing[width];
      S::rows(f.rx, f.ry, f.rz, zero, rubbing);
      for (unsigned lane = 0; lane < lanes; ++lane) {
        ForceRow& i = a.granules.wall_loss.friction[list[lane]];
        S::row_store(i.force, S::row_load(i.force) + rubbing[lane]);
        if constexpr (E.rotates()) S::row_store(i.turn, S::row_load(i.turn) + turns[lane]);
        a.granules.wall_loss.touches[list[lane]] = 1;
      }
    }
  }
};

/// Adds one wall's contact forces to the force rows, and sums them.
template <class S, ContactEffects E, Surface shape> void wall_kernel(const WallArguments& a, WallResult& result) {
  WallLoop<S, E, shape> loop{.a = a, .result = result};
  work_off_list<S, E.remembers()>(loop, a.list, a.count, a.touching, a.springs.slots);
  result.max_overlap = largest<S>(loop.max_overlap, result.max_overlap);
  result.max_closing = largest<S>(loop.max_closing, result.max_closing);
  alignas(32) double total[4];
  S::row_store(total, loop.total_force);
  for (int k = 0; k < 3; ++k) result.force[k] += total[k];
}

} // namespace grandamp::kernels
