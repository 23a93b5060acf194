// Rows that are asked of memory before they are needed.
#pragma once

#include "kernels/arguments.hpp"

namespace grandamp::kernels {

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

} // namespace grandamp::kernels
