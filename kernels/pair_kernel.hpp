// Granule against granule: test the candidates, gather those that touch, work the law off on full lanes, add the
// forces row by row. Rows i and j are subtracted before they are transposed: two loads and one transpose per quantity.
#pragma once

#include "kernels/arguments.hpp"

namespace grandamp::kernels {

/// Sum of a law's constants by population, transposed to lanes.
template <class S, class Index> GRANDAMP_INLINE LawVectors<S> gathered_laws(const LawRow* laws, Index index) {
  typename S::Row rows[S::width];
  for (int lane = 0; lane < S::width; ++lane) rows[lane] = S::row_load(&laws[index(lane)].stiffness);
  LawVectors<S> law;
  typename S::Vector unused;
  S::columns(rows, law.stiffness, law.damping, law.friction, unused);
  return law;
}

template <class S> GRANDAMP_INLINE LawVectors<S> common_law(const LawRow& law) {
  return {S::broadcast(law.stiffness), S::broadcast(law.damping), S::broadcast(law.friction)};
}

template <class S, class Index>
GRANDAMP_INLINE SpringLawVectors<S> gathered_laws(const SpringLawRow* laws, Index index) {
  typename S::Row rows[S::width];
  for (int lane = 0; lane < S::width; ++lane) rows[lane] = S::row_load(&laws[index(lane)].stiffness);
  SpringLawVectors<S> law;
  typename S::Vector unused, neither;
  S::columns(rows, law.stiffness, law.damping, unused, neither);
  return law;
}

template <class S> GRANDAMP_INLINE SpringLawVectors<S> common_law(const SpringLawRow& law) {
  return {S::broadcast(law.stiffness), S::broadcast(law.damping)};
}

/// The springs of these slots; zero where there was no touch in the step before.
template <class S> GRANDAMP_INLINE Spring<S> remembered(const SpringArguments& a, const std::uint32_t* slots) {
  typename S::Row rows[S::width];
  for (int lane = 0; lane < S::width; ++lane) {
    const std::uint32_t slot = slots[lane];
    rows[lane] = a.touched[slot] == a.before ? S::row_load(a.rows[slot].force) : S::row_broadcast(0.0);
  }
  Spring<S> spring;
  S::columns(rows, spring.fx, spring.fy, spring.fz, spring.root);
  return spring;
}

template <class S>
GRANDAMP_INLINE void remember(const SpringArguments& a, const std::uint32_t* slots, unsigned lanes,
                              const Spring<S>& spring) {
  typename S::Row rows[S::width];
  S::rows(spring.fx, spring.fy, spring.fz, spring.root, rows);
  for (unsigned lane = 0; lane < lanes; ++lane) {
    S::row_store(a.rows[slots[lane]].force, rows[lane]);
    a.touched[slots[lane]] = a.now;
  }
}

/// Moves the marked ones of the places first ... first + width - 1 together.
template <class S> GRANDAMP_INLINE void select_slots(std::size_t first, unsigned mask, std::uint32_t* to) {
  std::uint32_t here[S::width];
  for (std::uint32_t lane = 0; lane < S::width; ++lane) here[lane] = static_cast<std::uint32_t>(first) + lane;
  S::select(here, mask, to);
}

/// The share of a slip's momentum that friction may take at contacts of these rows.
template <class S, class Row> GRANDAMP_INLINE typename S::Vector friction_shares(Row row) {
  typename S::Row rows[S::width];
  for (int lane = 0; lane < S::width; ++lane) rows[lane] = S::row_load(row(lane).turn);
  typename S::Vector share, unused, neither, nor_this;
  S::columns(rows, unused, neither, nor_this, share);
  return share;
}

/// Adds the lanes' elastic energy in list order, whatever the lane count.
template <class S> GRANDAMP_INLINE void add_in_order(typename S::Vector v, unsigned lanes, double& sum) {
  double values[S::width];
  S::store(values, v);
  for (unsigned lane = 0; lane < lanes; ++lane) sum += values[lane];
}

template <class S> GRANDAMP_INLINE double largest(typename S::Vector v, double so_far) {
  double values[S::width];
  S::store(values, v);
  for (int lane = 0; lane < S::width; ++lane) so_far = values[lane] > so_far ? values[lane] : so_far;
  return so_far;
}

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

/// Asks memory for rows, two at a time.
template <class S, bool ledger> class RowsAhead {
public:
  explicit RowsAhead(const PairArguments& a)
      : granules_(a.granules), next_(a.ahead[0].first), last_(a.ahead[0].last), then_(a.ahead[1]) {}

  /// False when there are no more.
  [[gnu::always_inline]] bool ask() {
    if (next_ >= last_) {
      if (then_.first >= then_.last) return false;
      next_ = then_.first;
      last_ = then_.last;
      then_.last = 0;
    }
    __builtin_prefetch(granules_.position + next_, 1);
    for (std::uint32_t row = next_; row < next_ + 2; ++row) {
      __builtin_prefetch(granules_.motion + row, 1);
      __builtin_prefetch(granules_.force + row, 1);
      if constexpr (ledger) __builtin_prefetch(granules_.kinds.friction_granule + row, 1);
    }
    if constexpr (ledger) __builtin_prefetch(granules_.kinds.damping_granule + next_, 1);
    next_ += 2;
    return true;
  }

private:
  GranuleArrays granules_;
  std::uint32_t next_, last_;
  IndexRange then_;
};

/// Marks of 64 pairs: bit k for pair k.
using PairMarks = std::uint64_t;
inline constexpr std::size_t marked_at_once = 64;
/// Marks to be gone through one by one; where there are more, vectors of pairs are moved together.
inline constexpr int few_marks = 20;

/// Appends the marked pairs of those from `pairs` on; returns the new end.
template <class S, ContactEffects E>
GRANDAMP_INLINE RowPair* take_marked(const PairArguments& a, const RowPair* pairs, PairMarks marks, RowPair* to) {
  const auto first = static_cast<std::size_t>(pairs - a.pairs);
  if (__builtin_popcountll(marks) <= few_marks) {
    for (; marks != 0; marks &= marks - 1) {
      const auto k = static_cast<unsigned>(__builtin_ctzll(marks));
      if constexpr (E.remembers()) a.springs.slots[to - a.touching] = static_cast<std::uint32_t>(first) + k;
      *to++ = pairs[k];
    }
    return to;
  }
  for (std::size_t k = 0; marks != 0; k += S::width, marks >>= S::width) {
    const unsigned mask = marks & ((1U << S::width) - 1U);
    if constexpr (E.remembers()) select_slots<S>(first + k, mask, a.springs.slots + (to - a.touching));
    to += S::select(pairs + k, mask, to);
  }
  return to;
}

/// Moves the pairs that touch to the scratch list; returns their number. `a` must be the caller's own copy: what is
/// written here could otherwise be a part of it. First all marks, then what is marked: where a pair is stored depends
/// on the marks before it, and a processor that does not let loads overtake stores of unknown address would wait with
/// the next pairs' rows for each of them.
template <class S, ContactEffects E>
GRANDAMP_INLINE std::size_t touching(const PairArguments& a, const RowPair* pairs, std::size_t count,
                                     RowsAhead<S, E.ledger()>& ahead) {
  using Vector = typename S::Vector;
  constexpr bool alike = E.variety == Variety::alike;
  constexpr std::size_t at_once = list_padding;
  const PositionRow* position = a.granules.position;
  const Vector twice = S::broadcast(2.0 * a.radius);
  PairMarks marks[pair_chunk / marked_at_once];
  for (std::size_t first = 0; first < count; first += marked_at_once) {
    const std::size_t last = count - first < marked_at_once ? count : first + marked_at_once;
    PairMarks bits = 0;
    unsigned shift = 0;
    for (std::size_t k = first; k < last; k += at_once) {
      for (std::size_t part = k; part < k + at_once; part += S::width, shift += S::width) {
        Vector x, y, z, radii;
        difference<S, alike>(positions(position, pairs + part), twice, x, y, z, radii);
        const Vector square = S::fma(z, z, S::fma(y, y, x * x));
        bits |= static_cast<PairMarks>(S::less(square, radii * radii)) << shift;
      }
      ahead.ask();
      __builtin_prefetch(pairs + k + list_ahead);
    }
    marks[first / marked_at_once] = bits;
  }
  RowPair* to = a.touching;
  for (std::size_t first = 0; first < count; first += marked_at_once)
    to = take_marked<S, E>(a, pairs + first, marks[first / marked_at_once], to);
  return static_cast<std::size_t>(to - a.touching);
}

template <class S, ContactEffects E> struct PairLoop {
  using Vector = typename S::Vector;
  using Row = typename S::Row;
  static constexpr int width = S::width;
  static constexpr bool alike = E.variety == Variety::alike;

  const PairArguments& a;
  const Row last_flipped = S::row_set(1.0, 1.0, 1.0, -1.0);
  Vector max_overlap;
  Vector max_closing = S::broadcast(0.0);

  /// From i to j, the distance and its square, the sum of the radii, and by how much they exceed it.
  void approach(const RowPair* pairs, Vector& x, Vector& y, Vector& z, Vector& square, Vector& distance, Vector& radii,
                Vector& overlap) const {
    if constexpr (E.precision == Precision::mixed) {
      // An overlap is the small difference of two lengths: float could not tell it. (radii^2 - distance^2) is taken in
      // double, and divided by (radii + distance).
      using D = typename S::Double;
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
      overlap = S::max(radii - distance, S::broadcast(0.0));
    }
  }

  void geometry(const RowPair* pairs, unsigned lanes, ContactGeometry<S>& c) {
    Vector x, y, z, square, distance, radii;
    approach(pairs, x, y, z, square, distance, radii, c.overlap);

    const MotionRow* motion = a.granules.predicted;
    Row rows[width];
    Vector inverse_mass, inverse_radius;
    for (int lane = 0; lane < width; ++lane) {
      const Row i = S::row_load(row_at(motion, pairs[lane].first_offset).velocity);
      const Row j = S::row_load(row_at(motion, pairs[lane].second_offset).velocity);
      if constexpr (alike)
        rows[lane] = i - j;
      else
        rows[lane] = S::row_fnma(last_flipped, j, i);
    }
    S::columns(rows, c.vx, c.vy, c.vz, inverse_mass);
    if constexpr (E.rotates() || !alike) {
      for (int lane = 0; lane < width; ++lane)
        rows[lane] = S::row_load(row_at(motion, pairs[lane].first_offset).surface_spin) +
                     S::row_load(row_at(motion, pairs[lane].second_offset).surface_spin);
      S::columns(rows, c.sx, c.sy, c.sz, inverse_radius);
    }
    Vector inverse; // of the distance, by its square: the division need not wait for the root
    if constexpr (alike) {
      inverse = S::broadcast(1.0) / square * distance;
      c.lever = distance * S::broadcast(0.5 / a.radius);
      max_overlap = S::max(max_overlap, c.overlap * S::broadcast(1.0 / a.radius));
    } else {
      // One division does for four: the inverse of a product, times all but one of its factors.
      const Vector lengths = square * radii, inverses = inverse_mass * inverse_radius;
      const Vector of_all = S::broadcast(1.0) / (lengths * inverses);
      const Vector of_lengths = of_all * inverses, of_inverses = of_all * lengths;
      inverse = of_lengths * radii * distance;
      c.lever = of_lengths * square * distance;
      c.radius = of_inverses * inverse_mass;
      c.mass = of_inverses * inverse_radius;
      // The larger inverse radius is at most the sum: the exact ratio is worked out only where it could be a record.
      if (S::less(max_overlap, c.overlap * inverse_radius))
        max_overlap = deepest(a.granules.position, pairs, lanes, c.overlap, max_overlap);
    }
    c.nx = x * inverse;
    c.ny = y * inverse;
    c.nz = z * inverse;
    if constexpr (!alike) c.friction_mass = c.mass;
  }

  /// With what is the same for all contacts and is not kept with each. Member by member: as a whole it would be copied.
  [[gnu::always_inline]] ContactGeometry<S> completed(const ContactGeometry<S>& kept) const {
    ContactGeometry<S> c;
    c.overlap = kept.overlap;
    c.nx = kept.nx, c.ny = kept.ny, c.nz = kept.nz;
    c.vx = kept.vx, c.vy = kept.vy, c.vz = kept.vz;
    if constexpr (E.rotates()) c.sx = kept.sx, c.sy = kept.sy, c.sz = kept.sz;
    c.lever = kept.lever;
    c.radius = S::broadcast(0.5 * a.radius);
    c.mass = c.friction_mass = S::broadcast(0.5 * a.mass);
    return c;
  }

  void forces(const RowPair* pairs, unsigned lanes, const ContactGeometry<S>& kept, ContactForces<S>& f,
              ContactResult& result) {
    if constexpr (alike)
      forces_of(pairs, lanes, completed(kept), f, result);
    else
      forces_of(pairs, lanes, kept, f, result);
  }

  [[gnu::always_inline]] void forces_of(const RowPair* pairs, unsigned lanes, const ContactGeometry<S>& c,
                                        ContactForces<S>& f, ContactResult& result) {
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
      const Vector share = S::min(
          friction_shares<S>([&](int lane) -> const ForceRow& { return row_at(force, pairs[lane].first_offset); }),
          friction_shares<S>([&](int lane) -> const ForceRow& { return row_at(force, pairs[lane].second_offset); }));
      contact_forces<S, E>(c, law, S::broadcast(a.friction_cap) * share, f);
    } else
      contact_forces<S, E>(c, law, S::broadcast(0.0), f);
    max_closing = S::max(max_closing, f.closing);
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

  void add_rows(const RowPair* pairs, unsigned lanes, const ContactGeometry<S>& c, const ContactForces<S>& f) {
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
    if constexpr (E.ledger() && E.damped()) {
      Row damping[width];
      S::rows((zero - f.damping) * c.nx, (zero - f.damping) * c.ny, (zero - f.damping) * c.nz, zero, damping);
      for (unsigned lane = 0; lane < lanes; ++lane) {
        double* i = row_at(a.granules.kinds.damping_granule, pairs[lane].first_offset).force;
        double* j = row_at(a.granules.kinds.damping_granule, pairs[lane].second_offset).force;
        S::row_store(i, S::row_load(i) + damping[lane]);
        S::row_store(j, S::row_load(j) - damping[lane]);
      }
    }
    if constexpr (E.ledger() && E.rubs()) {
      Row rubbing[width];
      S::rows(f.rx, f.ry, f.rz, zero, rubbing);
      for (unsigned lane = 0; lane < lanes; ++lane) {
        ForceRow& i = row_at(a.granules.kinds.friction_granule, pairs[lane].first_offset);
        ForceRow& j = row_at(a.granules.kinds.friction_granule, pairs[lane].second_offset);
        S::row_store(i.force, S::row_load(i.force) + rubbing[lane]);
        S::row_store(j.force, S::row_load(j.force) - rubbing[lane]);
        if constexpr (E.rotates()) {
          S::row_store(i.turn, S::row_load(i.turn) + turns[lane]);
          S::row_store(j.turn, S::row_load(j.turn) + turns[lane]);
        }
      }
    }
  }

  [[gnu::noinline]] static Vector deepest(const PositionRow* position, const RowPair* pairs, unsigned lanes,
                                          Vector overlap, Vector so_far) {
    double overlaps[width];
    S::store(overlaps, overlap);
    double record = largest<S>(so_far, 0.0);
    for (unsigned lane = 0; lane < lanes; ++lane) {
      const double i = row_at(position, pairs[lane].first_offset).radius;
      const double j = row_at(position, pairs[lane].second_offset).radius;
      const double ratio = overlaps[lane] / (i < j ? i : j);
      record = ratio > record ? ratio : record;
    }
    return S::broadcast(record);
  }
};

/// Vector by vector of `count` contacts: work(entries of the list, how many of the lanes are used, geometry, forces).
template <class S, class Entry, class Work>
GRANDAMP_INLINE void each_vector(const Entry* entries, std::size_t count, ContactGeometry<S>* geometry,
                                 ContactForces<S>* forces, Work work) {
  for (const Entry* const end = entries + count; entries < end; entries += S::width, ++geometry, ++forces) {
    const std::ptrdiff_t left = end - entries;
    work(entries, static_cast<unsigned>(left < S::width ? left : S::width), *geometry, *forces);
  }
}

/// Adds the contact forces of the candidate pairs to the force rows (and the ledger's rows).
template <class S, ContactEffects E> void pair_kernel(const PairArguments& arguments, ContactResult& result) {
  const PairArguments a = arguments; // where no row that is stored can be a part of it
  PairLoop<S, E> loop{.a = a, .max_overlap = S::broadcast(result.max_overlap)};
  RowsAhead<typename S::Double, E.ledger()> ahead(a);
  using Geometry = ContactGeometry<S>;
  using Forces = ContactForces<S>;
  const auto find_geometry = [&](const RowPair* pairs, unsigned lanes, Geometry& c, Forces&)
      __attribute__((always_inline)) {
    loop.geometry(pairs, lanes, c);
    ahead.ask();
  };
  const auto find_forces = [&](const RowPair* pairs, unsigned lanes, Geometry& c, Forces& f)
      __attribute__((always_inline)) {
    loop.forces(pairs, lanes, c, f, result);
  };
  const auto add_rows = [&](const RowPair* pairs, unsigned lanes, Geometry& c, Forces& f)
      __attribute__((always_inline)) {
    loop.add_rows(pairs, lanes, c, f);
  };
  for (std::size_t begin = 0; begin < a.count; begin += pair_chunk) {
    const std::size_t left = a.count - begin;
    const std::size_t n =
        touching<typename S::Double, E>(a, a.pairs + begin, left < pair_chunk ? left : pair_chunk, ahead);
    if (n == 0) continue;
    // The last, partly filled vector repeats its last contact in the lanes that are not used.
    for (std::size_t k = n; k % contact_padding != 0; ++k) a.touching[k] = a.touching[n - 1];
    if constexpr (E.remembers())
      for (std::size_t k = n; k % contact_padding != 0; ++k) a.springs.slots[k] = a.springs.slots[n - 1];
    // In three loops: the way of one contact through its roots and divisions is so long, and has so many
    // instructions, that a processor cannot look beyond it to the next.
    Geometry geometry[contact_batch / S::width];
    Forces forces[contact_batch / S::width];
    for (std::size_t first = 0; first < n; first += contact_batch) {
      const RowPair* const batch = a.touching + first;
      const std::size_t count = n - first < contact_batch ? n - first : contact_batch;
      each_vector<S>(batch, count, geometry, forces, find_geometry);
      each_vector<S>(batch, count, geometry, forces, find_forces);
      each_vector<S>(batch, count, geometry, forces, add_rows);
    }
  }
  while (ahead.ask()) {
  }
  result.max_overlap = largest<S>(loop.max_overlap, result.max_overlap);
  result.max_closing = largest<S>(loop.max_closing, result.max_closing);
}

} // namespace grandamp::kernels
