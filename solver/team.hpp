// Who does the work: the calling thread alone, or a TBB arena. Work whose results could depend on how it is cut is
// always cut into the same pieces, whatever the number of threads, and each piece has its own results, so that the bits
// do not.
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <memory>

namespace grandamp {

class Team {
public:
  /// threads >= 1; 1 never enters TBB.
  explicit Team(int threads);
  ~Team();
  Team(Team&&) noexcept;
  Team& operator=(Team&&) noexcept;

  int threads() const noexcept { return threads_; }

  /// Calls work(0) ... work(pieces - 1), each once: pieces of one group one after the other as they rise, groups at the
  /// same time.
  template <class Work> void each(std::size_t pieces, const Work& work) const {
    if (threads_ == 1 || pieces < 2)
      for (std::size_t piece = 0; piece < pieces; ++piece) work(piece);
    else
      in_parallel(pieces, [&work](std::size_t piece) { work(piece); });
  }

  /// Which of up to threads() groups a piece belongs to. A bed's lower half has more contacts than its upper one, so
  /// pieces are dealt out from both ends: first, last, second, last but one, ...
  std::size_t group_of(std::size_t piece, std::size_t pieces) const noexcept {
    const std::size_t dealt = 2 * piece < pieces ? 2 * piece : 2 * (pieces - 1 - piece) + 1;
    return dealt * groups(pieces) / pieces;
  }

private:
  std::size_t groups(std::size_t pieces) const noexcept { return std::min(pieces, static_cast<std::size_t>(threads_)); }
  void in_parallel(std::size_t pieces, const std::function<void(std::size_t)>& work) const;

  struct Arena;
  int threads_;
  std::unique_ptr<Arena> arena_;
};

/// Processors that this process may use.
int usable_processors();

} // namespace grandamp
