#include "solver/team.hpp"

#ifdef GRANDAMP_PLAIN_THREADS
#include <atomic>
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
#ifdef GRANDAMP_PLAIN_THREADS
  // For the thread sanitizer, which cannot see into a TBB that was not built with it.
  std::atomic<std::size_t> next{0};
  std::vector<std::thread> team;
  for (int t = 0; t < threads_; ++t)
    team.emplace_back([&] {
      for (std::size_t piece = next++; piece < pieces; piece = next++) work(piece);
    });
  for (std::thread& thread : team) thread.join();
#else
  // The static partitioner gives a thread the same pieces every time, and those side by side: its rows stay in its
  // caches, and in its memory. A bed's lower half has more contacts than its upper one, so pieces are dealt out from
  // both ends: first, last, second, last but one, ...
  const auto dealt = [&](std::size_t k) { work(k % 2 == 0 ? k / 2 : pieces - 1 - k / 2); };
  arena_->arena.execute([&] { tbb::parallel_for(std::size_t{0}, pieces, dealt, tbb::static_partitioner{}); });
#endif
}

int usable_processors() {
  return tbb::this_task_arena::max_concurrency();
}

} // namespace grandamp
