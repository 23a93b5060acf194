// The Verlet list: pairs closer than their radii and the skin, found on the half-shell grid, and the granules near each
// wall. The rows are cut into segments, so thick that no pair reaches further than into the next one, each into blocks;
// how they are cut depends on the granules' places alone. Pairs across two segments stand apart, so that segments can
// be swept at the same time.
#pragma once

#include "kernels/arguments.hpp"
#include "kernels/dispatch.hpp"
#include "solver/cell_grid.hpp"
#include "solver/large_granules.hpp"
#include "solver/profile.hpp"
#include "solver/walls.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace grandamp {

/// A growing list of pairs, padded at the end of each block.
class PairList {
public:
  void clear() noexcept { count_ = 0; }
  std::size_t count() const noexcept { return count_; }
  kernels::RowPair* data() noexcept { return pairs_.data(); }
  const kernels::RowPair* data() const noexcept { return pairs_.data(); }
  /// How many there is memory for.
  std::size_t room() const noexcept { return pairs_.size(); }
  /// Room for `more` pairs at the end; where they go.
  kernels::RowPair* room_for(std::size_t more);
  void set_end(const kernels::RowPair* end) noexcept { count_ = static_cast<std::size_t>(end - pairs_.data()); }
  void append(const kernels::RowPair& pair);
  /// Fills up to a multiple of list_padding; returns how many pairs were added.
  std::size_t pad(std::uint32_t ghost);

private:
  RowArray<kernels::RowPair> pairs_;
  std::size_t count_ = 0;
};

/// Granules near one wall.
struct WallList {
  std::vector<std::uint32_t> granules; ///< padded
  std::size_t count = 0;
};

using kernels::gap_classes;

struct PairRange {
  std::size_t first = 0;                      ///< in the list
  std::array<std::size_t, gap_classes> end{}; ///< one past the last pair of each class; the last one with padding

  /// Pairs to test when granules may have come nearer by `share` of the skin: a multiple of list_padding.
  std::size_t to_test(double share) const;
};

/// How many of a bed's granules are swept at a time, pairs first, then motion: fewer where the bed exceeds a
/// second-level cache, out of which they are not to fall in between.
std::uint32_t block_granules(std::uint32_t granules) noexcept;

struct Block {
  std::uint32_t first = 0, last = 0; ///< rows
  PairRange inner, boundary;         ///< in the segment's lists
  /// What its pairs reach besides. No part of a list's state: one restored finds them anew.
  /// One past the last row in the segment, or some rows more: pairs of these rows with the next segment come before a
  /// sweep of this block.
  std::uint32_t front = 0;
  /// To be asked of memory ahead: rows up to this one, and these of the next segment. What large granules reach
  /// besides, here and there in many layers, is not among them.
  std::uint32_t ahead = 0;
  kernels::IndexRange beyond;
};

struct Segment {
  std::uint32_t first = 0, last = 0;
  std::vector<Block> blocks;
  PairList inner;
  PairList boundary; ///< pairs whose second granule is in the next segment
  std::vector<WallList> walls;
  std::vector<std::uint32_t> outside;     ///< granules whose centre is beyond a wall, or not finite
  std::size_t candidates = 0;             ///< without padding
  std::vector<kernels::RowPair> touching; ///< scratch of the sweep
  PairList far_pairs;                     ///< scratch of the build
  std::vector<std::uint32_t> large_rows;  ///< scratch of the build: large granules
  std::vector<kernels::RowPair> large;    ///< scratch of the build: pairs with one of them, sorted
  std::vector<std::uint32_t> touching_wall;
};

class VerletList {
public:
  struct Search {
    kernels::CandidateKernel* kernel = nullptr; ///< for all pairs
    kernels::CoarseKernel* coarse = nullptr;    ///< for the grid
    kernels::SplitKernel* split = nullptr;
    bool alike = true;
    double largest_radius = 0.0; ///< m
    /// Granules up to this radius are in cells of their size; larger ones are looked for one by one (not if alike), m.
    double small_radius = 0.0;
    double skin = 0.0;        ///< m
    double cell_length = 0.0; ///< at least 2 small_radius + skin, m

    bool two_levels() const noexcept { return small_radius < largest_radius; }

    /// With the kernels of an instruction set; skin and cells are still to be said.
    static Search with(kernels::InstructionSet set, bool alike, double largest_radius) {
      return {kernels::candidate_kernel_for(set, alike),
              kernels::coarse_kernel_for(set, alike),
              kernels::split_kernel_for(set, alike),
              alike,
              largest_radius,
              largest_radius,
              0.0,
              0.0};
    }
  };

  /// Sorts the granules and lists the pairs and wall candidates. Force rows come out cleared.
  void build(Granules& granules, const Vector3& size, const std::vector<Wall>& walls, const Search& search,
             const Team& team, Profile* profile = nullptr);
  /// Lists from a search of all pairs, without a grid; the rows keep their order.
  void build_from_all_pairs(Granules& granules, const std::vector<Wall>& walls, const Search& search);

  std::vector<Segment>& segments() noexcept { return segments_; }
  const std::vector<Segment>& segments() const noexcept { return segments_; }
  std::size_t candidates() const;
  const CellGrid& grid() const noexcept { return grid_; }

private:
  void cut_into_segments(std::uint32_t granules, const Search& search);
  void search_all(Granules& granules, const Vector3& size, const std::vector<Wall>& walls, const Search& search,
                  const Team& team);
  void search_segment(Segment& segment, int first_layer, int last_layer, const kernels::CoarseArguments& arguments,
                      const Search& search, const Granules& granules);

  CellGrid grid_;
  LargeGranules large_;
  std::vector<Segment> segments_;
  std::vector<int> segment_layers_; ///< first layer of each segment, and the end
};

} // namespace grandamp
