// Rows that are asked of memory before they are needed.
#pragma once

#include "kernels/arguments.hpp"

namespace grandamp::kernels {

/// Asks memory for rows, evenly: a processor keeps some two dozen questions open, and one that has to wait for its turn
/// keeps all that comes after it waiting. Rows go to the second-level cache, since many are not wanted soon.
template <class S, bool ledger> class RowsAhead {
public:
  explicit RowsAhead(const PairArguments& a)
      : granules_(a.granules), next_(a.ahead[0].first), last_(a.ahead[0].last), then_(a.ahead[1]) {}

  /// Of what is left, part / whole is to be asked for in `times` calls of ask().
  void spread(std::size_t times, std::size_t part, std::size_t whole) {
    const std::size_t left =
        (next_ < last_ ? last_ - next_ : 0) + (then_.first < then_.last ? then_.last - then_.first : 0);
    rate_ = left > 0 && times > 0 ? static_cast<std::uint32_t>(one * left * part / (whole * times)) + 1 : 0;
  }
  [[gnu::always_inline]] void ask() {
    due_ += rate_;
    // Seldom; told so, the asking stands apart from the loops that it is a part of.
    while (__builtin_expect(due_ >= 2 * one, 0)) {
      due_ -= 2 * one;
      ask_two();
    }
  }
  void ask_all() {
    while (ask_two()) {
    }
  }

private:
  /// False when there are no more.
  [[gnu::always_inline]] bool ask_two() {
    if (next_ >= last_) {
      if (then_.first >= then_.last) return false;
      next_ = then_.first;
      last_ = then_.last;
      then_ = {};
      to_be_moved_ = true;
    }
    prefetch(granules_.position + next_);
    if constexpr (ledger) prefetch(granules_.loss + next_);
    for (std::uint32_t row = next_; row < next_ + 2; ++row) {
      prefetch(granules_.motion + row);
      prefetch(granules_.force + row);
      if constexpr (ledger) {
        if (to_be_moved_) prefetch(granules_.last_step + row); // no pair reads it
      }
    }
    next_ += 2;
    return true;
  }
  template <class Row> GRANDAMP_INLINE void prefetch(const Row* row) { __builtin_prefetch(row, 0, 2); }

  GranuleArrays granules_;
  std::uint32_t next_, last_;
  IndexRange then_;
  bool to_be_moved_ = false; ///< those asked for are of the next block, which is moved once its pairs are done
  static constexpr std::uint32_t one = 256;
  std::uint32_t rate_ = 0, due_ = 0; ///< rows per call, and not yet asked for; a row counts `one`
};

} // namespace grandamp::kernels
