#include "solver/team.hpp"

#ifdef GRANDAMP_PLAIN_THREADS
#include <thread>
#include <vector>
#endif

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/partitioner.h>
#include <tbb/task_arena.h>

namespace grandamp {

struct Team::Arena {
  explicit Arena(int threads)
      : allowed(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads)), arena(threads) {}
  tbb::global_control allowed; ///< more threads than processors, if so many were asked for
  tbb::task_arena arena;
};

Team::Team(int threads) : threads_(threads), arena_(threads > 1 ? std::make_unique<Arena>(threads) : nullptr) {}
Team::~Team() = default;
Team::Team(Team&&) noexcept = default;
Team& Team::operator=(Team&&) noexcept = default;

void Team::in_parallel(std::size_t pieces, const std::function<void(std::size_t)>& work) const {
  const auto group = [&](std::size_t g) {
    for (std::size_t piece = 0; piece < pieces; ++piece)
      if (group_of(piece, pieces) == g) work(piece);
  };
#ifdef GRANDAMP_PLAIN_THREADS
  // For the thread sanitizer, which cannot see into a TBB that was not built with it.
  std::vector<std::thread> team;
  for (std::size_t g = 0; g < groups(pieces); ++g) team.emplace_back([&group, g] { group(g); });
  for (std::thread& thread : team) thread.join();
#else
  // The static partitioner gives a thread the same group every time: its rows stay in its caches, and in its memory.
  arena_->arena.execute([&] { tbb::parallel_for(std::size_t{0}, groups(pieces), group, tbb::static_partitioner{}); });
#endif
}

int usable_processors() {
  return tbb::this_task_arena::max_concurrency();
}

} // namespace grandamp
