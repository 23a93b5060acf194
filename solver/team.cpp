#include "solver/team.hpp"

#include <tbb/parallel_for.h>
#include <tbb/partitioner.h>
#include <tbb/task_arena.h>

namespace grandamp {

struct Team::Arena {
  explicit Arena(int threads) : arena(threads) {}
  tbb::task_arena arena;
};

Team::Team(int threads) : threads_(threads), arena_(threads > 1 ? std::make_unique<Arena>(threads) : nullptr) {}
Team::~Team() = default;
Team::Team(Team&&) noexcept = default;
Team& Team::operator=(Team&&) noexcept = default;

void Team::in_parallel(std::size_t pieces, const std::function<void(std::size_t)>& work) const {
  // The static partitioner gives a thread the same pieces every time: its rows stay in its caches, and in its memory.
  arena_->arena.execute([&] { tbb::parallel_for(std::size_t{0}, pieces, work, tbb::static_partitioner{}); });
}

int usable_processors() {
  return tbb::this_task_arena::max_concurrency();
}

} // namespace grandamp
