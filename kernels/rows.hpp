// The rows that a step works on: one array per quantity, in cell-sorted order, everything in the enclosure's frame.
// Spin is kept as s = r omega (m/s), so that a contact adds the rows of its two granules and needs no radius; the
// inverses of mass and radius ride along because a pair needs 1/m_i + 1/m_j and 1/r_i + 1/r_j.
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace grandamp::kernels {

struct alignas(32) PositionRow {
  double x, y, z;
  double radius;
};

struct alignas(64) MotionRow {
  double velocity[3];
  double inverse_mass;
  double surface_spin[3]; ///< radius times angular velocity, m/s
  double inverse_radius;
};

/// Forces and lever-weighted friction: `turn` is (a/r) n x f_t, N, the torque over the radius. Under Coulomb friction
/// contacts are counted as their forces are added, and the motion makes the next step's friction_share of the count.
struct alignas(64) ForceRow {
  double force[3];
  double touching; ///< contacts so far in this step
  double turn[3];
  double friction_share; ///< of a slip's momentum that one contact may take (kernels/friction.hpp)
};

/// Normal damping forces alone, for the ledger.
struct alignas(32) DampingRow {
  double force[3];
  double unused;
};

/// Forces of other granules that take energy, for the ledger; what turns the granule is not among them. In float: the
/// ledger holds to 1e-4 at eight steps in a contact, to 1e-7 at 64, and what costs its time is memory.
struct alignas(32) LossRow {
  float damping[4];  ///< N, three components
  float friction[4]; ///< N
};

/// What the ledger remembers of the step before; a correction of some per cent is made of it.
struct alignas(64) LastStepRow {
  LossRow loss;
  float velocity_rate[4];     ///< m/s^2, three components
  float surface_spin_rate[4]; ///< m/s^2
};

/// The tangential spring of a contact in touch: its force on the first granule (N), and sqrt(R overlap) (m) at the
/// step of `touched`.
struct alignas(32) SpringRow {
  double force[3];
  double root;
};

struct IndexRange {
  std::uint32_t first = 0;
  std::uint32_t last = 0; ///< one past
};

inline constexpr int offset_bits = 5; ///< a row's index shifted by these: bytes from the first position
static_assert(sizeof(PositionRow) == 1U << offset_bits);
inline constexpr std::uint32_t most_rows = 1U << (32 - offset_bits);

/// Two granules, as the places of their rows in bytes from the first position; rows of 64 bytes stand twice as far from
/// their first. So an address is one instruction's operand, wherever a pair needs its rows. In a Verlet list: two
/// closer than their radii and the skin, the first row before the second.
struct alignas(8) RowPair {
  std::uint32_t first_offset;
  std::uint32_t second_offset;

  static constexpr RowPair of(std::uint32_t first, std::uint32_t second) {
    return {first << offset_bits, second << offset_bits};
  }
  constexpr std::uint32_t first() const { return first_offset >> offset_bits; }
  constexpr std::uint32_t second() const { return second_offset >> offset_bits; }
};

template <class Row> [[gnu::always_inline]] static inline Row& row_at(Row* rows, std::uint32_t offset) {
  using Byte = std::conditional_t<std::is_const_v<Row>, const char, char>;
  constexpr std::size_t scale = sizeof(Row) >> offset_bits;
  static_assert(scale << offset_bits == sizeof(Row));
  return *reinterpret_cast<Row*>(reinterpret_cast<Byte*>(rows) + offset * scale);
}

/// Lists are padded to this many entries, whatever the lane count, so that every instruction set walks the same list.
inline constexpr std::uint32_t list_padding = 8;
/// Pairs found touching are padded to this many: lanes of the widest law, in float.
inline constexpr std::uint32_t contact_padding = 16;

} // namespace grandamp::kernels
