// What the kernels are handed, and what they hand back. Plain pointers into arrays that the solver owns.
#pragma once

#include "kernels/contact_law.hpp"
#include "kernels/rows.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

namespace grandamp::kernels {

/// Walls' forces that take energy, for the ledger. Few granules touch a wall: rows that are not marked are zero, and
/// are neither read nor cleared.
struct WallLossRows {
  DampingRow* damping = nullptr;
  ForceRow* friction = nullptr;
  std::uint8_t* touches = nullptr;
};

/// The arrays of a region's granules. `ghost` and ghost + 1 are two rows past the last granule, far from everything
/// and from each other: lists are padded with them.
struct GranuleArrays {
  PositionRow* position = nullptr;
  MotionRow* motion = nullptr;    ///< half-step velocities
  MotionRow* predicted = nullptr; ///< the velocities that forces see; the same array as motion under leapfrog
  ForceRow* force = nullptr;
  std::uint8_t* population = nullptr;
  LossRow* loss = nullptr;          ///< ledger only
  LastStepRow* last_step = nullptr; ///< ledger only
  WallLossRows wall_loss;           ///< ledger only: of this step
  WallLossRows wall_loss_before;    ///< and of the one before
  std::uint32_t ghost = 0;          ///< number of granules
};

/// The memory of contacts (springs only): rows parallel to a list, entry by entry.
struct SpringArguments {
  SpringRow* rows = nullptr;
  std::uint32_t* touched = nullptr; ///< the step of the last touch
  std::uint32_t* slots = nullptr;   ///< scratch: where in the list the touching ones stand; as many as `touching`
  std::uint32_t now = 0;            ///< this step's number
  std::uint32_t before = 0;         ///< and that of the one before
  double time_step = 0.0;           ///< s
  SpringLawRow law{};
  const SpringLawRow* laws = nullptr; ///< as PairArguments::laws, WallArguments::laws
};

/// What contacts told. max_overlap and max_closing go in as the largest so far.
struct ContactResult {
  double max_overlap = 0.0;  ///< over the smaller radius
  double max_closing = 0.0;  ///< m/s
  double elastic = 0.0;      ///< of overlaps, J; only with energies
  double spring = 0.0;       ///< of tangential springs, J; only with energies
  std::int64_t contacts = 0; ///< only with energies
};

struct PairArguments {
  GranuleArrays granules;
  const RowPair* pairs = nullptr;
  std::size_t count = 0;        ///< a multiple of list_padding
  RowPair* touching = nullptr;  ///< scratch of contact_scratch entries
  LawRow law{};                 ///< of all pairs (not with Variety::materials)
  const LawRow* laws = nullptr; ///< populations x populations (Variety::materials)
  std::size_t populations = 1;
  double radius = 0.0;       ///< the largest (which bounds overlaps), every granule's with Variety::alike, m
  double mass = 0.0;         ///< of every granule (Variety::alike), kg
  double friction_cap = 0.0; ///< (2/7, or 1 without rotation) / dt, 1/s; Verlet: half of it
  SpringArguments springs;   ///< rows of `pairs`
  /// Rows that the pairs after these will reach, asked of memory a few at a time between contacts: asked for all at
  /// once, the processor would wait for them.
  std::array<IndexRange, 2> ahead{};
};

/// Entries of a list that are tested before their contacts are worked off.
inline constexpr std::size_t contact_chunk = 1024;
/// Room for those of a chunk that touch, padded to a vector.
inline constexpr std::size_t contact_scratch = contact_chunk + contact_padding;

/// Pairs of the list that are asked of memory, into the second-level cache, before they are tested: candidates are
/// tested faster than memory answers, and each block of the list is a new beginning, which takes a processor that
/// watches for streams some time to see.
inline constexpr std::size_t list_ahead = 512;

/// Contacts that are worked off together.
inline constexpr std::size_t contact_batch = 64;

/// A wall: a plane n.x = offset with n pointing out of the enclosure, or the side of a cylinder.
struct WallSurface {
  double normal[3] = {0.0, 0.0, 0.0}; ///< plane
  double offset = 0.0;                ///< plane, m
  double across[3] = {1.0, 1.0, 0.0}; ///< side: 1 across the axis, 0 along it
  double centre[3] = {0.0, 0.0, 0.0}; ///< side: a point of the axis, m
  double radius = 0.0;                ///< side, m
};

struct WallArguments {
  GranuleArrays granules;
  WallSurface surface;
  const std::uint32_t* list = nullptr; ///< padded with `ghost` to a multiple of list_padding
  std::size_t count = 0;               ///< without the padding
  std::uint32_t* touching = nullptr;   ///< scratch of contact_scratch entries
  LawRow law{};
  const LawRow* laws = nullptr;          ///< by population (Variety::materials)
  double direction[3] = {0.0, 0.0, 0.0}; ///< of the enclosure's motion
  double enclosure_inverse_mass = 0.0;   ///< of a structure, 1/kg; else 0
  double friction_inverse_mass = 0.0;    ///< share of the structure in the friction's cap, 1/kg
  double friction_cap = 0.0;             ///< as in PairArguments
  SpringArguments springs;               ///< rows of `list`
};

struct WallResult : ContactResult {
  double force[3] = {0.0, 0.0, 0.0}; ///< on the granules, N
};

struct MotionArguments {
  GranuleArrays granules;
  std::uint32_t first = 0;
  std::uint32_t last = 0;                     ///< one past
  double time_step = 0.0;                     ///< s
  double kick[3] = {0.0, 0.0, 0.0};           ///< g dt minus the enclosure's velocity increment, m/s
  double frame_velocity[3] = {0.0, 0.0, 0.0}; ///< of the enclosure at t_n, m/s (energies)
};

/// By kind of force, J.
struct Losses {
  double normal_granule = 0.0;
  double normal_wall = 0.0;
  double friction_granule = 0.0;
  double friction_wall = 0.0;
};

/// Sums are in granule order; max_speed_squared goes in as the largest so far.
struct MotionResult {
  double max_speed_squared = 0.0;
  double sum_speed_squared = 0.0;          ///< of all, so that a NaN or an infinity shows
  double kinetic = 0.0;                    ///< laboratory frame, at t_n, J (energies)
  double mass_moment[3] = {0.0, 0.0, 0.0}; ///< sum of m x, enclosure's frame, at t_n, kg m (energies)
  Losses lost;                             ///< in this step (ledger)
  Losses early;                            ///< as much of them as is lost before t_n (ledger and energies)
};

using PairKernel = void(const PairArguments&, ContactResult&);
using WallKernel = void(const WallArguments&, WallResult&);
using MotionKernel = void(const MotionArguments&, MotionResult&);

} // namespace grandamp::kernels
