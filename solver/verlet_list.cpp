#include "solver/verlet_list.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace grandamp {

namespace {

using kernels::RowPair;

/// Below this many granules one segment is faster than any division of the work.
constexpr std::uint32_t single_segment = 20000;
constexpr int most_segments = 16;
/// The rows on both sides of a segment's end are read and written once more in a step, which costs the more the fewer
/// layers a segment has.
constexpr int least_layers = 8;

/// Positions as four arrays in units of `unit`, laid over the force rows: 64 bytes a granule, of which those in float
/// take 16 and those in double 32.
template <class Real> struct Coordinates {
  Real *x, *y, *z, *radius;
  double scale;

  /// behind: bytes per granule that others use before these.
  explicit Coordinates(Granules& granules, double unit, std::size_t behind = 0) : scale(1.0 / unit) {
    const std::size_t rows = granules.force.size();
    x = reinterpret_cast<Real*>(reinterpret_cast<char*>(granules.force.data()) + behind * rows);
    y = x + rows;
    z = y + rows;
    radius = z + rows; // vectors may read past it: the last 16 bytes a granule are free
  }

  kernels::SearchArguments<Real> arguments(double reach) const {
    return {x, y, z, radius, static_cast<Real>(reach * scale)};
  }

  /// Granules beyond `largest` go where no other finds them, nor they another.
  void fill(const Granules& granules, std::uint32_t first, std::uint32_t last,
            double largest = std::numeric_limits<double>::infinity()) const {
    for (std::uint32_t i = first; i < last; ++i) {
      const kernels::PositionRow& row = granules.position[i];
      x[i] = static_cast<Real>(row.x * scale);
      y[i] = static_cast<Real>(row.y * scale);
      z[i] = static_cast<Real>(row.z * scale);
      radius[i] = static_cast<Real>(row.radius * scale);
      if (row.radius > largest) x[i] = std::numeric_limits<Real>::quiet_NaN();
    }
  }
};

double reach_of(const VerletList::Search& search, double share = 1.0) {
  return share * search.skin + (search.alike ? 2.0 * search.largest_radius : 0.0);
}

/// What a coarse search must reach further to find every pair: float turns each coordinate by up to 2^-24 of itself, so
/// a distance by 2 sqrt(3) times that of the box, and rounds its square, the radii and their sum a few times more.
double coarse_margin(const VerletList::Search& search, const Vector3& size) {
  constexpr double rounding = 0x1p-24;
  return 8.0 * rounding * std::max({size[0], size[1], size[2]}) +
         16.0 * rounding * (2.0 * search.largest_radius + search.skin);
}

/// Sorts the pairs from `first` to the list's end by gap, without those beyond the skin, and pads. Returns the classes'
/// ends; adds the pairs to the segment's candidates.
PairRange classed(PairList& list, std::size_t first, const VerletList::Search& search, const Granules& granules,
                  Segment& segment) {
  PairRange range;
  range.first = first;
  kernels::SplitArguments a;
  a.position = granules.position.data();
  a.count = list.count() - first;
  list.room_for(kernels::list_padding);
  a.pairs = list.data() + first;
  const std::size_t room = a.count + kernels::list_padding;
  segment.far_pairs.clear();
  RowPair* const scratch = segment.far_pairs.room_for(room * (gap_classes - 1));
  for (std::size_t c = 1; c < gap_classes; ++c) a.scratch[c - 1] = scratch + (c - 1) * room;
  for (std::size_t c = 0; c < gap_classes; ++c)
    a.reach[c] = reach_of(search, static_cast<double>(c + 1) / static_cast<double>(gap_classes));
  std::size_t sizes[gap_classes];
  search.split(a, sizes);
  RowPair* end = a.pairs + sizes[0];
  range.end[0] = first + sizes[0];
  for (std::size_t c = 1; c < gap_classes; ++c) {
    end = std::copy_n(a.scratch[c - 1], sizes[c], end);
    range.end[c] = range.end[c - 1] + sizes[c];
  }
  list.set_end(end);
  segment.candidates += list.count() - first;
  list.pad(granules.count());
  range.end.back() = list.count();
  return range;
}

/// The segment's granules near each wall. `places(wall, look)` calls look(first, last) for the rows where they can be,
/// in rising order.
template <class Places>
void list_walls(Segment& segment, const Granules& granules, const std::vector<Wall>& walls, double skin,
                const Places& places) {
  segment.walls.resize(walls.size());
  segment.outside.clear();
  for (std::size_t w = 0; w < walls.size(); ++w) {
    WallList& list = segment.walls[w];
    list.granules.clear();
    places(walls[w], [&](std::uint32_t first, std::uint32_t last) {
      for (std::uint32_t i = first; i < last; ++i) {
        const double inside = distance_inside(walls[w], granules.position[i]);
        if (!(inside >= 0.0)) segment.outside.push_back(i);
        // Half the skin: the wall itself does not move in the enclosure's frame.
        if (inside < granules.position[i].radius + 0.5 * skin) list.granules.push_back(i);
      }
    });
    list.count = list.granules.size();
    while (list.granules.size() % kernels::list_padding != 0) list.granules.push_back(granules.count());
  }
  segment.touching.resize(kernels::contact_scratch);
  segment.touching_wall.resize(kernels::contact_scratch);
}

/// How many cells along the grid's axis k a length takes up, where granules stand anywhere in a cell.
int cells_for(double length, const GridShape& shape, std::size_t k) {
  return static_cast<int>(
      std::min(std::ceil(1.000001 * length * shape.inverse_length[k]), static_cast<double>(shape.cells[k])));
}

/// Calls look(first, last) for the rows in layers [first_layer, last_layer) that can be near the wall: at a plane those
/// of the cells along it, as many of them as a granule that is `near` the wall can be away from it.
template <class Look>
void look_along(const Wall& wall, const CellGrid& grid, double near, int first_layer, int last_layer,
                const Look& look) {
  const GridShape& shape = grid.shape();
  std::size_t across = 0;
  while (across < 3 && wall.surface.normal[shape.axis[across]] == 0.0) ++across;
  if (wall.side || across == 3) return look(grid.layer_start(first_layer), grid.layer_start(last_layer));
  const bool at_end = wall.surface.normal[shape.axis[across]] > 0.0;
  const int deep = std::max(1, cells_for(near, shape, across));
  const int from = at_end ? shape.cells[across] - deep : 0, to = at_end ? shape.cells[across] - 1 : deep - 1;
  const int end_of_row = shape.cells[0] - 1;
  // Cells of rows that follow one another.
  const auto rows = [&](int first, int first_middle, int last, int last_middle, int slow) {
    look(grid.cell_start(first, first_middle, slow), grid.start()[grid.index(last, last_middle, slow) + 1]);
  };
  for (int slow = first_layer; slow < last_layer; ++slow) {
    if (across == 2) {
      if (from <= slow && slow <= to) look(grid.layer_start(slow), grid.layer_start(slow + 1));
    } else if (across == 1)
      rows(0, from, end_of_row, to, slow);
    else
      for (int middle = 0; middle < shape.cells[1]; ++middle) rows(from, middle, to, middle, slow);
  }
}

/// Pairs that a coarse search may find from one granule of the cell.
std::size_t pairs_from_one(const kernels::CellRows& rows, std::uint32_t cell) {
  const std::uint32_t before = rows.before(cell), after = rows.after(cell);
  std::size_t tests = rows.within ? rows.own[after] - rows.own[cell] : 0;
  for (int k = 0; k < rows.count; ++k) tests += rows.beside[k][after] - rows.beside[k][before];
  return tests;
}

/// And from all of them.
std::size_t pairs_from(const kernels::CellRows& rows, std::uint32_t cell) {
  return pairs_from_one(rows, cell) * (rows.own[cell + 1] - rows.own[cell]);
}

/// What one search is given room for, if a single granule needs no more.
constexpr std::size_t most_pairs_at_once = 1U << 16;

/// A coarse search from one crowded cell, some of its granules at a time: the room that all of them could need grows
/// with the square of their number, however few pairs they make.
void append_crowded(PairList& list, const kernels::CellRows& rows, std::uint32_t cell,
                    const kernels::CoarseArguments& arguments, kernels::CoarseKernel* search) {
  const std::size_t each = pairs_from_one(rows, cell);
  const auto at_once = static_cast<std::uint32_t>(std::max<std::size_t>(1, most_pairs_at_once / each));
  const std::uint32_t before = rows.before(cell), after = rows.after(cell), end = rows.own[cell + 1];
  // Two cells that stand for all: the granules at work, and what comes after them.
  std::uint32_t beside[kernels::most_rows_beside][3];
  kernels::CellRows part = rows;
  part.cells = 2;
  part.first = 0;
  part.last = 1;
  for (int k = 0; k < rows.count; ++k) {
    beside[k][0] = beside[k][1] = rows.beside[k][before];
    beside[k][2] = rows.beside[k][after];
    part.beside[k] = beside[k];
  }
  for (std::uint32_t first = rows.own[cell]; first < end;) {
    const std::uint32_t last = std::min(first + at_once, end);
    const std::uint32_t own[3] = {first, last, rows.own[after]};
    part.own = own;
    list.set_end(search(arguments, part, list.room_for((last - first) * each + kernels::list_padding)));
    first = last;
  }
}

/// A coarse search from the cells [first, last) of the row, as many at a time as need no more room than so many pairs.
void append(PairList& list, kernels::CellRows rows, std::uint32_t first, std::uint32_t last,
            const kernels::CoarseArguments& arguments, kernels::CoarseKernel* search) {
  for (rows.last = first; rows.last < last;) {
    rows.first = rows.last;
    std::size_t room = pairs_from(rows, rows.last++);
    if (room > most_pairs_at_once) {
      append_crowded(list, rows, rows.first, arguments, search);
      continue;
    }
    for (; rows.last < last; ++rows.last) {
      const std::size_t more = pairs_from(rows, rows.last);
      if (room + more > most_pairs_at_once) break;
      room += more;
    }
    list.set_end(search(arguments, rows, list.room_for(room + kernels::list_padding)));
  }
}

} // namespace

std::uint32_t block_granules(std::uint32_t granules) noexcept {
  return granules < single_segment ? 1024 : 512;
}

std::size_t PairRange::to_test(double share) const {
  std::size_t classes = 1;
  while (classes < gap_classes && share >= static_cast<double>(classes) / static_cast<double>(gap_classes)) ++classes;
  const std::size_t padded = (end[classes - 1] - first + kernels::list_padding - 1) / kernels::list_padding;
  return std::min(padded * kernels::list_padding, end[gap_classes - 1] - first);
}

RowPair* PairList::room_for(std::size_t more) {
  const std::size_t needed = count_ + more;
  if (needed > pairs_.size()) pairs_.grow(needed + needed / 2 + 64, count_);
  return pairs_.data() + count_;
}

void PairList::append(const RowPair& pair) {
  *room_for(1) = pair;
  ++count_;
}

std::size_t PairList::pad(std::uint32_t ghost) {
  std::size_t added = 0;
  RowPair* end = room_for(kernels::list_padding);
  for (; (count_ + added) % kernels::list_padding != 0; ++added) end[added] = RowPair::of(ghost, ghost + 1);
  count_ += added;
  return added;
}

std::size_t VerletList::candidates() const {
  std::size_t sum = 0;
  for (const Segment& segment : segments_) sum += segment.candidates;
  return sum;
}

void VerletList::cut_into_segments(std::uint32_t granules, const Search& search) {
  const int layers = grid_.shape().cells[2];
  // No pair reaches further than from a segment into the next.
  const int reached = search.two_levels() ? cells_for(2.0 * search.largest_radius + search.skin, grid_.shape(), 2) : 1;
  const int least = 2 * std::max(1, reached);
  // A power of two: as many for each of two, four or eight threads.
  std::uint32_t wanted = 1;
  if (granules >= single_segment)
    for (int segments = 2; segments <= std::min(most_segments, layers / std::max(least, least_layers)); segments *= 2)
      wanted *= 2;
  segment_layers_.assign(1, 0);
  for (std::uint32_t s = 1; s < wanted; ++s) {
    const auto share = static_cast<std::uint32_t>(static_cast<std::uint64_t>(granules) * s / wanted);
    int layer = segment_layers_.back() + least;
    while (layer < layers - least && grid_.layer_start(layer) < share) ++layer;
    if (layer > layers - least) break;
    segment_layers_.push_back(layer);
  }
  segment_layers_.push_back(layers);
  segments_.resize(segment_layers_.size() - 1);
}

void VerletList::search_segment(Segment& segment, int first_layer, int last_layer,
                                const kernels::CoarseArguments& arguments, const Search& search,
                                const Granules& granules) {
  const GridShape& shape = grid_.shape();
  segment.first = grid_.layer_start(first_layer);
  segment.last = grid_.layer_start(last_layer);
  segment.blocks.clear();
  segment.inner.clear();
  segment.boundary.clear();
  segment.candidates = 0;
  const std::uint32_t block_size = block_granules(granules.count());
  Block block;
  block.first = segment.first;
  block.front = block.ahead = segment.first;
  std::size_t first_inner = 0, first_boundary = 0;
  auto large = segment.large.begin();

  const auto finish_block = [&](std::uint32_t last) {
    block.last = last;
    for (; large != segment.large.end() && large->first() < last; ++large) {
      const std::uint32_t row = large->second();
      (row < segment.last ? segment.inner : segment.boundary).append(*large);
      if (row < segment.last) block.front = std::max(block.front, row + 1);
    }
    block.inner = classed(segment.inner, first_inner, search, granules, segment);
    block.boundary = classed(segment.boundary, first_boundary, search, granules, segment);
    first_inner = segment.inner.count();
    first_boundary = segment.boundary.count();
    segment.blocks.push_back(block);
    block.first = last;
    block.beyond = {};
  };
  for (int slow = first_layer; slow < last_layer; ++slow)
    for (int middle = 0; middle < shape.cells[1]; ++middle) {
      // 13 of the 26 neighbours of a cell: the next one of the row, the next row, and three rows of the next layer.
      kernels::CellRows inner;
      inner.cells = static_cast<std::uint32_t>(shape.cells[0]);
      inner.own = grid_.row_start(middle, slow);
      kernels::CellRows across = inner; // into the next segment
      across.within = false;
      const auto look_at = [&](kernels::CellRows& rows, int m, int s) {
        rows.beside[rows.count++] = grid_.row_start(m, s);
      };
      if (middle + 1 < shape.cells[1]) look_at(inner, middle + 1, slow);
      if (slow + 1 < shape.cells[2])
        for (int m = std::max(middle - 1, 0); m <= std::min(middle + 1, shape.cells[1] - 1); ++m)
          look_at(slow + 1 < last_layer ? inner : across, m, slow + 1);

      const std::uint32_t end = inner.own[inner.cells];
      const auto reached = [&](const kernels::CellRows& rows) { return rows.beside[rows.count - 1][rows.cells]; };
      for (std::uint32_t first = 0, last = 0; inner.own[last] < end; first = last) {
        if (inner.own[first] - block.first >= block_size) finish_block(inner.own[first]);
        do ++last;
        while (last < inner.cells && inner.own[last] - block.first < block_size);
        append(segment.inner, inner, first, last, arguments, search.coarse);
        block.ahead = std::max(block.ahead, inner.count > 0 ? reached(inner) : end);
        block.front = std::max(block.front, block.ahead);
        if (across.count == 0) continue;
        append(segment.boundary, across, first, last, arguments, search.coarse);
        block.beyond = {block.beyond.last > 0 ? block.beyond.first : across.beside[0][0], reached(across)};
      }
    }
  finish_block(segment.last);
}

void VerletList::build(Granules& granules, const Vector3& size, const std::vector<Wall>& walls, const Search& search,
                       const Team& team, Profile* profile) {
  timed(profile, Phase::sort, 0,
        [&] { grid_.sort(granules, make_grid_shape(size, search.cell_length, granules.count()), team); });
  timed(profile, Phase::build, 0, [&] { search_all(granules, size, walls, search, team); });
}

void VerletList::search_all(Granules& granules, const Vector3& size, const std::vector<Wall>& walls,
                            const Search& search, const Team& team) {
  cut_into_segments(granules.count(), search);
  const Coordinates<float> coordinates(granules, search.cell_length);
  const kernels::CoarseArguments arguments = coordinates.arguments(reach_of(search) + coarse_margin(search, size));
  const Coordinates<double> exact(granules, 1.0, 4 * sizeof(float));
  const LargeSearch large{search.kernel, exact.arguments(search.skin), search.small_radius, search.largest_radius,
                          search.skin};
  const auto first_row = [&](std::size_t s) { return grid_.layer_start(segment_layers_[s]); };
  team.each(segments_.size(), [&](std::size_t s) {
    coordinates.fill(granules, first_row(s), first_row(s + 1), search.small_radius);
    segments_[s].large_rows.clear();
    if (!search.two_levels()) return;
    exact.fill(granules, first_row(s), first_row(s + 1));
    for (std::uint32_t i = first_row(s); i < first_row(s + 1); ++i)
      if (granules.position[i].radius > search.small_radius) segments_[s].large_rows.push_back(i);
  });
  large_.clear();
  for (const Segment& segment : segments_) large_.add(segment.large_rows);
  if (large_.any()) large_.sort(granules, size, large);
  team.each(segments_.size(), [&](std::size_t s) {
    segments_[s].large.clear();
    if (large_.any())
      large_.list_pairs(large, grid_, granules, {first_row(s), first_row(s + 1)},
                        first_row(std::min(s + 2, segments_.size())), segments_[s].large);
    search_segment(segments_[s], segment_layers_[s], segment_layers_[s + 1], arguments, search, granules);
    list_walls(segments_[s], granules, walls, search.skin, [&](const Wall& wall, const auto& look) {
      look_along(wall, grid_, search.largest_radius + 0.5 * search.skin, segment_layers_[s], segment_layers_[s + 1],
                 look);
    });
  });
  team.each(segments_.size(), [&](std::size_t s) { granules.clear_forces(segments_[s].first, segments_[s].last); });
}

void VerletList::build_from_all_pairs(Granules& granules, const std::vector<Wall>& walls, const Search& search) {
  granules.keep_shares(0, granules.count());
  const Coordinates<double> coordinates(granules, 1.0);
  coordinates.fill(granules, 0, granules.count());
  const kernels::CandidateArguments arguments = coordinates.arguments(reach_of(search));

  segments_.resize(1);
  Segment& segment = segments_.front();
  segment.first = 0;
  segment.last = granules.count();
  segment.blocks.clear();
  segment.inner.clear();
  segment.boundary.clear();
  segment.candidates = 0;
  const std::uint32_t block_size = block_granules(granules.count());
  for (std::uint32_t first = 0; first < segment.last || first == 0; first += block_size) {
    Block block;
    block.first = first;
    block.last = std::min(first + block_size, segment.last);
    const std::size_t first_pair = segment.inner.count();
    for (std::uint32_t i = block.first; i < block.last; ++i) {
      RowPair* to = segment.inner.room_for(segment.last - i + 2 * kernels::list_padding);
      segment.inner.set_end(search.kernel(arguments, {i, i + 1}, segment.last, nullptr, 0, to));
    }
    block.inner = classed(segment.inner, first_pair, search, granules, segment);
    block.front = block.ahead = segment.last;
    segment.blocks.push_back(block);
  }
  list_walls(segment, granules, walls, search.skin,
             [&](const Wall&, const auto& look) { look(segment.first, segment.last); });
  granules.clear_forces(0, granules.count());
}

} // namespace grandamp
