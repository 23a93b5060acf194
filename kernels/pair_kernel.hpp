// Granule against granule: test the candidates, gather those that touch, work the law off on full lanes, add the
// forces row by row. Rows i and j are subtracted before they are transposed: two loads and one transpose per row.
#pragma once

#include "kernels/contact_loops.hpp"
#include "kernels/lines.hpp"
#include "kernels/rows_ahead.hpp"

namespace grandamp::kernels {

/// p_j - p_i of `width` pairs, and the sum of their radii. `position(lane, second)`: a granule's.
template <class S, bool alike, class Position>
GRANDAMP_INLINE void difference(Position position, typename S::Vector twice, typename S::Vector& x,
                                typename S::Vector& y, typename S::Vector& z, typename S::Vector& radii) {
  using Row = typename S::Row;
  const Row last_flipped = S::row_set(1.0, 1.0, 1.0, -1.0);
  Row rows[S::width];
  for (int lane = 0; lane < S::width; ++lane) {
    const Row i = S::row_load(&position(lane, false).x);
    const Row j = S::row_load(&position(lane, true).x);
    if constexpr (alike)
      rows[lane] = j - i;
    else
      rows[lane] = S::row_fnma(last_flipped, i, j);
  }
  S::columns(rows, x, y, z, radii);
  if constexpr (alike) radii = twice;
}

GRANDAMP_INLINE auto positions(const PositionRow* position, const RowPair* pairs) {
  return [=](int lane, bool second) __attribute__((always_inline))->const PositionRow& {
    return row_at(position, second ? pairs[lane].second_offset : pairs[lane].first_offset);
  };
}

/// The same, where loads are what a loop waits for: both offsets by one. A pair's first granule is asked for first.
struct PositionsByOneLoad {
  const PositionRow* position;
  const RowPair* pairs;
  std::uint64_t both = 0;

  [[gnu::always_inline]] const PositionRow& operator()(int lane, bool second) {
    if (!second) {
      __builtin_memcpy(&both, pairs + lane, sizeof both);
      asm("" : "+r"(both)); // or the compiler makes two loads of it
    }
    return row_at(position, static_cast<std::uint32_t>(second ? both >> 32 : both));
  }
};

template <class S, ContactEffects E> struct PairLoop {
  using D = typename S::Double;
  using Vector = typename S::Vector;
  using Row = typename S::Row;
  using L = Lines<S>;
  static constexpr int width = S::width;
  static constexpr bool alike = E.variety == Variety::alike;
  static constexpr bool law_with_rows = short_law(E);

  const PairArguments a; // a copy, where no row that is stored can be a part of it
  ContactResult& result;
  RowsAhead<S, E.ledger()> ahead{a};
  const Row last_flipped = S::row_set(1.0, 1.0, 1.0, -1.0);
  /// For velocities: those of the second granule are taken off, its spin and the inverses added.
  const typename L::Line opposed = L::of(S::row_set(-1.0, -1.0, -1.0, 1.0), S::row_set(1.0, 1.0, 1.0, 1.0));
  const Vector least_inverse_radius = S::broadcast(1.0 / a.radius);
  Vector max_overlap = S::broadcast(alike ? 0.0 : result.max_overlap); ///< alike: m; else over the smaller radius
  Vector max_closing = S::broadcast(0.0);
  /// No contact of this batch is deeper, over its smaller radius, but for rounding.
  Vector possible_overlap = S::broadcast(0.0);

  /// Which of the pairs from `entry` on touch.
  [[gnu::always_inline]] unsigned marks(std::size_t entry) {
    const RowPair* const pairs = a.pairs + entry;
    const typename D::Vector twice = D::broadcast(2.0 * a.radius);
    unsigned marks = 0;
    for (unsigned k = 0; k < list_padding; k += D::width) {
      typename D::Vector x, y, z, radii;
      if constexpr (D::pairs_by_one_load)
        difference<D, alike>(PositionsByOneLoad{a.granules.position, pairs + k}, twice, x, y, z, radii);
      else
        difference<D, alike>(positions(a.granules.position, pairs + k), twice, x, y, z, radii);
      marks |= D::less(D::fma(z, z, D::fma(y, y, x * x)), radii * radii) << k;
    }
    __builtin_prefetch(pairs + list_ahead, 0, 2);
    return marks;
  }

  /// So many vectors, of `tested` of the pairs that are `left`: each asks for rows ahead once in each of its loops.
  void expect(std::size_t vectors, std::size_t tested, std::size_t left) {
    ahead.spread((law_with_rows ? 2 : 3) * vectors, tested, left);
  }

  /// From i to j, the distance and its square, the sum of the radii, and by how much they exceed it.
  void approach(const RowPair* pairs, Vector& x, Vector& y, Vector& z, Vector& square, Vector& distance, Vector& radii,
                Vector& overlap) const {
    if constexpr (E.precision == Precision::mixed) {
      // An overlap is the small difference of two lengths: float could not tell it. (radii^2 - distance^2) is taken in
      // double, and divided by (radii + distance).
      typename D::Vector px[2], py[2], pz[2], sum[2], squares[2], gap[2];
      for (int half = 0; half < 2; ++half) {
        difference<D, alike>(positions(a.granules.position, pairs + half * D::width), D::broadcast(2.0 * a.radius),
                             px[half], py[half], pz[half], sum[half]);
        squares[half] = D::fma(pz[half], pz[half], D::fma(py[half], py[half], px[half] * px[half]));
        gap[half] = sum[half] * sum[half] - squares[half];
      }
      x = S::narrow(px);
      y = S::narrow(py);
      z = S::narrow(pz);
      radii = alike ? S::broadcast(2.0 * a.radius) : S::narrow(sum);
      square = S::narrow(squares);
      distance = S::sqrt(square);
      overlap = S::max(S::narrow(gap) / (radii + distance), S::broadcast(0.0));
    } else {
      difference<S, alike>(positions(a.granules.position, pairs), S::broadcast(2.0 * a.radius), x, y, z, radii);
      square = S::fma(z, z, S::fma(y, y, x * x));
      distance = S::sqrt(square);
      overlap = radii - distance; // not negative: these touch, and the root of a rounded square is what was squared
    }
  }

  [[gnu::always_inline]] void geometry(const RowPair* pairs, ContactGeometry<S>& c) {
    Vector x, y, z, square, distance, radii;
    approach(pairs, x, y, z, square, distance, radii, c.overlap);

    // The compiler may not remember the offsets that it has read: for want of other registers it would keep them in
    // vectors, whose units are what this loop waits for.
    asm("" : "+r"(pairs));
    const MotionRow* motion = a.granules.predicted;
    Vector inverse_mass, inverse_radius;
    Vector vx, vy, vz, sx, sy, sz;
    if constexpr (E.rotates() || !alike) {
      typename L::Line lines[width];
      for (int lane = 0; lane < width; ++lane)
        lines[lane] = L::fma(opposed, L::load(row_at(motion, pairs[lane].second_offset).velocity),
                             L::load(row_at(motion, pairs[lane].first_offset).velocity));
      Vector columns[8];
      L::columns(lines, columns);
      vx = columns[0], vy = columns[1], vz = columns[2];
      sx = columns[4], sy = columns[5], sz = columns[6];
      inverse_mass = columns[3];
      inverse_radius = columns[7];
    } else {
      Row rows[width];
      for (int lane = 0; lane < width; ++lane)
        rows[lane] = S::row_load(row_at(motion, pairs[lane].first_offset).velocity) -
                     S::row_load(row_at(motion, pairs[lane].second_offset).velocity);
      S::columns(rows, vx, vy, vz, inverse_mass);
    }
    Vector inverse; // of the distance, by its square: the division need not wait for the root
    if constexpr (alike) {
      inverse = S::broadcast(1.0) / square * distance;
      if constexpr (E.rotates()) c.lever = distance * S::broadcast(0.5 / a.radius);
      c.root = hertz_root<S>(S::broadcast(0.5 * a.radius), c.overlap);
      max_overlap = S::max(max_overlap, c.overlap);
    } else {
      // One division does for four: the inverse of a product, times all but one of its factors.
      const Vector lengths = square * radii, inverses = inverse_mass * inverse_radius;
      const Vector of_all = S::broadcast(1.0) / (lengths * inverses);
      const Vector of_lengths = of_all * inverses, of_inverses = of_all * lengths;
      inverse = of_lengths * radii * distance;
      c.lever = of_lengths * square * distance;
      c.root = hertz_root<S>(of_inverses * inverse_mass, c.overlap);
      c.mass = of_inverses * inverse_radius;
      // The larger inverse radius is at most the sum less the least of all.
      possible_overlap = S::max(possible_overlap, c.overlap * (inverse_radius - least_inverse_radius));
    }
    c.nx = x * inverse;
    c.ny = y * inverse;
    c.nz = z * inverse;
    closing_and_slip<S, E>(c, vx, vy, vz, sx, sy, sz);
    max_closing = S::max(c.closing, max_closing); // a NaN leaves it as it was
    ahead.ask();
  }

  /// Of a batch: the exact ratio is worked out only where it could be a record, rounded as the bound may be in float.
  [[gnu::always_inline]] void note_depth(const RowPair* pairs, std::size_t count, const ContactGeometry<S>* geometry) {
    if constexpr (!alike) {
      if (S::less(max_overlap * S::broadcast(1.0 - 1e-6), possible_overlap) != 0)
        max_overlap = deepest(a.granules.position, pairs, count, geometry, max_overlap);
      possible_overlap = S::broadcast(0.0);
    }
  }

  /// With what is the same for all contacts and is not kept with each. Member by member: as a whole it would be copied.
  [[gnu::always_inline]] ContactGeometry<S> completed(const ContactGeometry<S>& kept) const {
    ContactGeometry<S> c;
    c.overlap = kept.overlap;
    c.nx = kept.nx, c.ny = kept.ny, c.nz = kept.nz;
    c.closing = kept.closing;
    if constexpr (E.rubs()) c.ux = kept.ux, c.uy = kept.uy, c.uz = kept.uz;
    if constexpr (E.rotates()) c.lever = kept.lever;
    c.root = kept.root;
    c.mass = S::broadcast(0.5 * a.mass);
    return c;
  }

  [[gnu::always_inline]] void forces(const RowPair* pairs, unsigned lanes, const ContactGeometry<S>& kept,
                                     ContactForces<S>& f) {
    if constexpr (alike)
      forces_of(pairs, lanes, completed(kept), f);
    else
      forces_of(pairs, lanes, kept, f);
  }

  [[gnu::always_inline]] void forces_of(const RowPair* pairs, unsigned lanes, const ContactGeometry<S>& c,
                                        ContactForces<S>& f) {
    LawVectors<S> law;
    if constexpr (E.variety == Variety::materials)
      law = gathered_laws<S>(a.laws, [&](int lane) {
        return a.granules.population[pairs[lane].first()] * a.populations + a.granules.population[pairs[lane].second()];
      });
    else
      law = common_law<S>(a.law);

    if constexpr (E.remembers()) {
      const std::uint32_t* slots = a.springs.slots + (pairs - a.touching);
      ContactMemory<S> memory = recall(pairs, slots);
      contact_forces<S, E>(c, law, S::broadcast(0.0), f, &memory);
      remember<S>(a.springs, slots, lanes, memory.spring);
      if constexpr (E.energies()) add_in_order<S>(f.spring, lanes, result.spring);
    } else if constexpr (E.counts()) {
      const ForceRow* force = a.granules.force;
      const Vector share = friction_shares<S>([&](int lane) {
        return D::row_min(D::row_load(row_at(force, pairs[lane].first_offset).turn),
                          D::row_load(row_at(force, pairs[lane].second_offset).turn));
      });
      contact_forces<S, E>(c, law, S::broadcast(a.friction_cap) * share * c.mass, f);
    } else
      contact_forces<S, E>(c, law, S::broadcast(0.0), f);
    if constexpr (!law_with_rows) ahead.ask();
    if constexpr (E.energies()) {
      add_in_order<S>(f.elastic, lanes, result.elastic);
      result.contacts += lanes;
    }
  }

  ContactMemory<S> recall(const RowPair* pairs, const std::uint32_t* slots) const {
    ContactMemory<S> memory;
    memory.spring = remembered<S>(a.springs, slots);
    memory.time_step = S::broadcast(a.springs.time_step);
    if constexpr (E.variety == Variety::materials)
      memory.law = gathered_laws<S>(a.springs.laws, [&](int lane) {
        return a.granules.population[pairs[lane].first()] * a.populations + a.granules.population[pairs[lane].second()];
      });
    else
      memory.law = common_law<S>(a.springs.law);
    const MotionRow* motion = a.granules.motion;
    memory.moved_otherwise = motion != a.granules.predicted;
    if (memory.moved_otherwise) {
      Row rows[width], spins[width];
      for (int lane = 0; lane < width; ++lane) {
        const MotionRow &i = row_at(motion, pairs[lane].first_offset), &j = row_at(motion, pairs[lane].second_offset);
        rows[lane] = S::row_load(i.velocity) - S::row_load(j.velocity);
        spins[lane] = S::row_load(i.surface_spin) + S::row_load(j.surface_spin);
      }
      Vector unused;
      S::columns(rows, memory.mx, memory.my, memory.mz, unused);
      S::columns(spins, memory.wx, memory.wy, memory.wz, unused);
    }
    return memory;
  }

  [[gnu::always_inline]] void add_rows(const RowPair* pairs, unsigned lanes, const ContactGeometry<S>& c,
                                       const ContactForces<S>& f) {
    ahead.ask();
    const Vector zero = S::broadcast(0.0);
    Row forces[width], turns[width];
    S::rows(f.fx, f.fy, f.fz, E.counts() ? S::broadcast(1.0) : zero, forces);
    if constexpr (E.rotates()) S::rows(f.tx, f.ty, f.tz, zero, turns);
    ForceRow* force = a.granules.force;
    // With places known in advance the rows stay in registers.
#pragma GCC unroll 16
    for (unsigned lane = 0; lane < width; ++lane) {
      if (lane >= lanes) break;
      ForceRow& i = row_at(force, pairs[lane].first_offset);
      ForceRow& j = row_at(force, pairs[lane].second_offset);
      S::row_store(i.force, S::row_load(i.force) + forces[lane]);
      if constexpr (E.counts()) // both count it
        S::row_store(j.force, S::row_fnma(last_flipped, forces[lane], S::row_load(j.force)));
      else
        S::row_store(j.force, S::row_load(j.force) - forces[lane]);
      if constexpr (E.rotates()) {
        S::row_store(i.turn, S::row_load(i.turn) + turns[lane]);
        S::row_store(j.turn, S::row_load(j.turn) + turns[lane]);
      }
    }
    if constexpr (E.ledger() && (E.damped() || E.rubs())) add_losses(pairs, lanes, c, f);
  }

  [[gnu::always_inline]] void add_losses(const RowPair* pairs, unsigned lanes, const ContactGeometry<S>& c,
                                         const ContactForces<S>& f) {
    using Floats = typename D::Eight;
    const Vector zero = S::broadcast(0.0);
    Row damping[width], rubbing[width];
    for (int lane = 0; lane < width; ++lane) damping[lane] = rubbing[lane] = D::row_broadcast(0.0);
    if constexpr (E.damped())
      S::rows((zero - f.damping) * c.nx, (zero - f.damping) * c.ny, (zero - f.damping) * c.nz, zero, damping);
    if constexpr (E.rubs()) S::rows(f.rx, f.ry, f.rz, zero, rubbing);
    LossRow* loss = a.granules.loss;
#pragma GCC unroll 16
    for (unsigned lane = 0; lane < width; ++lane) {
      if (lane >= lanes) break;
      const typename Floats::Vector both = Floats::of_rows(damping[lane], rubbing[lane]);
      float* const i = row_at(loss, pairs[lane].first_offset).damping;
      float* const j = row_at(loss, pairs[lane].second_offset).damping;
      Floats::store(i, Floats::load(i) + both);
      Floats::store(j, Floats::load(j) - both);
    }
  }

  [[gnu::noinline]] static Vector deepest(const PositionRow* position, const RowPair* pairs, std::size_t count,
                                          const ContactGeometry<S>* geometry, Vector so_far) {
    // Lanes past the last contact repeat it.
    for (const RowPair* const end = pairs + count; pairs < end; pairs += width, ++geometry) {
      Row rows[width];
      for (int lane = 0; lane < width; ++lane)
        rows[lane] = D::row_min(D::row_load(&row_at(position, pairs[lane].first_offset).x),
                                D::row_load(&row_at(position, pairs[lane].second_offset).x));
      Vector x, y, z, smaller;
      S::columns(rows, x, y, z, smaller);
      so_far = S::max(so_far, geometry->overlap / smaller);
    }
    return so_far;
  }
};

/// Adds the contact forces of the candidate pairs to the force rows (and the ledger's rows).
template <class S, ContactEffects E> void pair_kernel(const PairArguments& a, ContactResult& result) {
  PairLoop<S, E> loop{.a = a, .result = result};
  work_off_list<S, E.remembers()>(loop, loop.a.pairs, loop.a.count, loop.a.touching, loop.a.springs.slots);
  loop.ahead.ask_all();
  if constexpr (loop.alike) loop.max_overlap = loop.max_overlap * S::broadcast(1.0 / loop.a.radius);
  result.max_overlap = largest<S>(loop.max_overlap, result.max_overlap);
  result.max_closing = largest<S>(loop.max_closing, result.max_closing);
}

} // namespace grandamp::kernels
