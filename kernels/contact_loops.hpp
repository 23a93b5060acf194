// What the loops over contacts have in common, whoever the partners are: laws, memories and shares of a vector of
// contacts, and the way from a list to the rows of force.
#pragma once

#include "kernels/arguments.hpp"

namespace grandamp::kernels {

/// A law's constants by population, transposed to lanes.
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

/// The share of a slip's momentum that friction may take: the last of the row that `turn` gives for each lane.
template <class S, class Turn> GRANDAMP_INLINE typename S::Vector friction_shares(Turn turn) {
  typename S::Row rows[S::width];
  for (int lane = 0; lane < S::width; ++lane) rows[lane] = turn(lane);
  typename S::Vector share, unused, neither, nor_this;
  S::columns(rows, unused, neither, nor_this, share);
  return share;
}

/// Adds the lanes' energy in list order, whatever the lane count.
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

/// Marks of 64 entries of a list: bit k for entry k.
using Marks = std::uint64_t;
inline constexpr std::size_t marked_at_once = 64;

/// Appends those marked of the entries from `first` on to the n that stand in `touching`, and with a memory their
/// places to `slots`; returns how many there are now. Few marks are gone through one by one; where there are more,
/// vectors of entries are moved together.
template <class S, bool remembers, class Entry>
GRANDAMP_INLINE std::size_t take_marked(const Entry* list, std::size_t first, Marks marks, Entry* touching,
                                        std::uint32_t* slots, std::size_t n) {
  if (__builtin_popcountll(marks) <= S::few_marks) {
    for (; marks != 0; marks &= marks - 1) {
      const std::size_t entry = first + static_cast<unsigned>(__builtin_ctzll(marks));
      if constexpr (remembers) slots[n] = static_cast<std::uint32_t>(entry);
      touching[n++] = list[entry];
    }
    return n;
  }
  for (std::size_t entry = first; marks != 0; entry += S::width, marks >>= S::width) {
    const unsigned mask = marks & ((1U << S::width) - 1U);
    if constexpr (remembers) select_slots<S>(entry, mask, slots + n);
    n += S::select(list + entry, mask, touching + n);
  }
  return n;
}

/// The first loop: which of a chunk of the list touch. loop.marks(entry) tells it of list_padding entries. First all
/// marks, then what is marked: where an entry is stored depends on the marks before it, and a processor that lets no
/// load overtake a store of unknown address would wait with the next entries' rows for each of them.
template <class S, bool remembers, class Loop, class Entry>
GRANDAMP_INLINE std::size_t find_touching(Loop& loop, const Entry* list, std::size_t begin, std::size_t end,
                                          Entry* touching, std::uint32_t* slots) {
  static_assert(contact_chunk % marked_at_once == 0 && marked_at_once % list_padding == 0);
  Marks marks[contact_chunk / marked_at_once];
  Marks* word = marks;
  for (std::size_t first = begin; first < end; first += marked_at_once) {
    const std::size_t last = end - first < marked_at_once ? end : first + marked_at_once;
    Marks bits = 0;
    unsigned shift = 0;
    for (std::size_t entry = first; entry < last; entry += list_padding, shift += list_padding)
      bits |= static_cast<Marks>(loop.marks(entry)) << shift;
    *word++ = bits;
  }
  std::size_t n = 0;
  word = marks;
  for (std::size_t first = begin; first < end; first += marked_at_once)
    n = take_marked<S, remembers>(list, first, *word++, touching, slots, n);
  return n;
}

/// Without rotation a law is so short that it is worked out where its rows are added.
constexpr bool short_law(ContactEffects effects) {
  return !effects.rotates();
}

/// Works off `count` contacts: loop.geometry, loop.forces and loop.add_rows, each of a vector of entries, the last two
/// of how many of its lanes are used, and what is kept of it between them; loop.note_depth is shown all geometry. In
/// three loops: the way of one contact through its roots and divisions is so long, and has so many instructions, that a
/// processor cannot look beyond it to the next. Of a short law (Loop::law_with_rows) in two.
/// Without vector registers to hold a contact in, all in one loop: what is kept would cost more
/// than it gains.
template <class S, class Loop, class Entry>
GRANDAMP_INLINE void work_off(Loop& loop, const Entry* entries, std::size_t count) {
  static_assert(contact_batch % S::width == 0 && contact_padding >= S::width);
  const Entry* const end = entries + count;
  const auto lanes = [end](const Entry* from) __attribute__((always_inline)) {
    return static_cast<unsigned>(end - from < S::width ? end - from : S::width);
  };
  if constexpr (S::stages_apart) {
    ContactGeometry<S> geometry[contact_batch / S::width];
    ContactGeometry<S>* c = geometry;
    for (const Entry* here = entries; here < end; here += S::width) loop.geometry(here, *c++);
    loop.note_depth(entries, count, geometry);
    c = geometry;
    if constexpr (Loop::law_with_rows) {
      for (const Entry* here = entries; here < end; here += S::width) {
        ContactForces<S> f;
        loop.forces(here, lanes(here), *c, f);
        loop.add_rows(here, lanes(here), *c++, f);
      }
    } else {
      ContactForces<S> forces[contact_batch / S::width];
      ContactForces<S>* f = forces;
      for (const Entry* here = entries; here < end; here += S::width) loop.forces(here, lanes(here), *c++, *f++);
      c = geometry;
      f = forces;
      for (const Entry* here = entries; here < end; here += S::width) loop.add_rows(here, lanes(here), *c++, *f++);
    }
  } else {
    for (const Entry* here = entries; here < end; here += S::width) {
      ContactGeometry<S> c;
      ContactForces<S> f;
      loop.geometry(here, c);
      loop.note_depth(here, lanes(here), &c);
      loop.forces(here, lanes(here), c, f);
      loop.add_rows(here, lanes(here), c, f);
    }
  }
}

/// All contacts of a list of `count` entries, padded to list_padding. loop.expect is told how many vectors of contacts
/// come, of how many of the entries that are left.
template <class S, bool remembers, class Loop, class Entry>
GRANDAMP_INLINE void work_off_list(Loop& loop, const Entry* list, std::size_t count, Entry* touching,
                                   std::uint32_t* slots) {
  for (std::size_t begin = 0; begin < count; begin += contact_chunk) {
    const std::size_t end = count - begin < contact_chunk ? count : begin + contact_chunk;
    const std::size_t n = find_touching<typename S::Double, remembers>(loop, list, begin, end, touching, slots);
    loop.expect((n + S::width - 1) / S::width, end - begin, count - begin);
    // The last, partly filled vector repeats its last contact in the lanes that are not used.
    for (std::size_t k = n; k % S::width != 0; ++k) {
      touching[k] = touching[n - 1];
      if constexpr (remembers) slots[k] = slots[n - 1];
    }
    for (std::size_t first = 0; first < n; first += contact_batch)
      work_off<S>(loop, touching + first, n - first < contact_batch ? n - first : contact_batch);
  }
}

} // namespace grandamp::kernels
