#include "solver/list_state.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace grandamp {

namespace {

using kernels::RowPair;

/// Appends the pairs of one range, class by class, without the padding at its end.
void take_range(ListState& state, const PairList& list, const PairRange& range, std::uint32_t ghost) {
  std::size_t begin = range.first;
  for (std::size_t c = 0; c < gap_classes; ++c) {
    std::size_t end = range.end[c];
    while (end > begin && list.data()[end - 1].first() >= ghost) --end;
    state.class_pairs.push_back(static_cast<std::uint32_t>(end - begin));
    for (std::size_t k = begin; k < end; ++k) {
      state.pairs.push_back(list.data()[k].first());
      state.pairs.push_back(list.data()[k].second());
    }
    begin = range.end[c];
  }
}

/// Reads arrays one after the other; what is missing or too large is a StateError.
class Reader {
public:
  Reader(const std::vector<std::uint32_t>& values, const char* name) : values_(values), name_(name) {}
  std::uint32_t next(std::uint32_t least, std::uint32_t most) {
    if (at_ >= values_.size()) fail("is too short");
    const std::uint32_t value = values_[at_++];
    if (value < least || value > most)
      fail(fmt::format("holds {} where {} to {} are allowed", value, least, most).c_str());
    return value;
  }
  std::size_t left() const noexcept { return values_.size() - at_; }
  void finish() const {
    if (at_ != values_.size()) fail("is too long");
  }
  [[noreturn]] void fail(const char* what) const { throw StateError(fmt::format("list/{} {}", name_, what)); }

private:
  const std::vector<std::uint32_t>& values_;
  const char* name_;
  std::size_t at_ = 0;
};

/// The segments' arrays, walked together.
struct Readers {
  explicit Readers(const ListState& state)
      : segment_rows(state.segment_rows, "segment_rows"), segment_blocks(state.segment_blocks, "segment_blocks"),
        block_rows(state.block_rows, "block_rows"), class_pairs(state.class_pairs, "class_pairs"),
        pairs(state.pairs, "pairs"), wall_counts(state.wall_counts, "wall_counts"),
        wall_rows(state.wall_rows, "wall_rows") {}
  void finish() const {
    for (const Reader* reader :
         {&segment_rows, &segment_blocks, &block_rows, &class_pairs, &pairs, &wall_counts, &wall_rows})
      reader->finish();
  }

  Reader segment_rows, segment_blocks, block_rows, class_pairs, pairs, wall_counts, wall_rows;
};

/// Appends a range to one of the segment's lists. Its pairs start at rows [first, last) and go on to a later row below
/// `end`.
PairRange put_range(Readers& from, Segment& segment, PairList& list, std::uint32_t first, std::uint32_t last,
                    std::uint32_t end, std::uint32_t ghost) {
  PairRange range;
  range.first = list.count();
  for (std::size_t& class_end : range.end) {
    const std::size_t most = first < last ? from.pairs.left() / 2 : 0;
    const std::uint32_t count = from.class_pairs.next(0, static_cast<std::uint32_t>(most));
    RowPair* const to = list.room_for(count);
    for (std::uint32_t k = 0; k < count; ++k) {
      const std::uint32_t row = from.pairs.next(first, last - 1);
      to[k] = RowPair::of(row, from.pairs.next(row + 1, end - 1));
    }
    list.set_end(to + count);
    segment.candidates += count;
    class_end = list.count();
  }
  list.pad(ghost);
  range.end.back() = list.count();
  return range;
}

/// From the first to one past the last of the pairs' second rows; none if there are no pairs.
kernels::IndexRange rows_reached(const PairList& list, const PairRange& range, std::uint32_t ghost) {
  kernels::IndexRange reached{ghost, 0};
  for (std::size_t k = range.first; k < range.end.back(); ++k) {
    const std::uint32_t row = list.data()[k].second();
    if (row >= ghost) continue; // padding
    reached.first = std::min(reached.first, row);
    reached.last = std::max(reached.last, row + 1);
  }
  return reached.last > 0 ? reached : kernels::IndexRange{};
}

void put_walls(Readers& from, Segment& segment, std::size_t walls, std::uint32_t ghost) {
  segment.walls.resize(walls);
  for (WallList& wall : segment.walls) {
    wall.count = from.wall_counts.next(0, segment.last - segment.first);
    for (std::size_t k = 0; k < wall.count; ++k)
      wall.granules.push_back(from.wall_rows.next(segment.first, segment.last - 1));
    wall.granules.resize((wall.count + kernels::list_padding - 1) / kernels::list_padding * kernels::list_padding,
                         ghost);
  }
}

} // namespace

ListState state_of(const VerletList& list, std::uint32_t ghost) {
  ListState state;
  for (const Segment& segment : list.segments()) {
    state.segment_rows.insert(state.segment_rows.end(), {segment.first, segment.last});
    state.segment_blocks.push_back(static_cast<std::uint32_t>(segment.blocks.size()));
    state.pairs.reserve(state.pairs.size() + 2 * segment.candidates);
    for (const Block& block : segment.blocks) {
      state.block_rows.insert(state.block_rows.end(), {block.first, block.last});
      take_range(state, segment.inner, block.inner, ghost);
      take_range(state, segment.boundary, block.boundary, ghost);
    }
    for (const WallList& wall : segment.walls) {
      state.wall_counts.push_back(static_cast<std::uint32_t>(wall.count));
      state.wall_rows.insert(state.wall_rows.end(), wall.granules.begin(),
                             wall.granules.begin() + static_cast<std::ptrdiff_t>(wall.count));
    }
  }
  return state;
}

void restore(VerletList& list, const ListState& state, std::uint32_t granules, std::size_t walls) {
  Readers from(state);
  std::vector<Segment> segments(state.segment_blocks.size());
  std::uint32_t row = 0;
  for (Segment& segment : segments) {
    segment.first = from.segment_rows.next(row, row);
    segment.last = row = from.segment_rows.next(segment.first, granules);
    const std::uint32_t blocks = from.segment_blocks.next(1, static_cast<std::uint32_t>(state.block_rows.size()));
    std::uint32_t block_row = segment.first;
    for (std::uint32_t b = 0; b < blocks; ++b) {
      Block block;
      block.first = from.block_rows.next(block_row, block_row);
      block.last = block_row = from.block_rows.next(block.first, segment.last);
      block.inner = put_range(from, segment, segment.inner, block.first, block.last, segment.last, granules);
      block.boundary = put_range(from, segment, segment.boundary, block.first, block.last, granules, granules);
      block.front = block.ahead = std::max(block.last, rows_reached(segment.inner, block.inner, granules).last);
      block.beyond = rows_reached(segment.boundary, block.boundary, granules);
      segment.blocks.push_back(block);
    }
    if (block_row != segment.last) from.block_rows.fail("leaves rows of a segment out");
    put_walls(from, segment, walls, granules);
    segment.touching.resize(kernels::contact_scratch);
    segment.touching_wall.resize(kernels::contact_scratch);
  }
  if (row != granules) from.segment_rows.fail("leaves rows out");
  from.finish();
  list.segments() = std::move(segments);
}

} // namespace grandamp
