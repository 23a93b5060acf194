// The list held against an all-pairs search: contacts that it does not hold are counted.
#pragma once

#include "solver/granules.hpp"
#include "solver/verlet_list.hpp"

#include <cstdint>
#include <set>
#include <utility>

namespace grandamp {

class Audit {
public:
  /// Compares the contacts at the present positions; `interval` steps have passed since the last comparison.
  void compare(const Granules& granules, const VerletList& list, const std::vector<Wall>& walls, std::int64_t interval);

  std::int64_t audited = 0;
  std::int64_t missed = 0;            ///< contacts that began unlisted, each once
  std::int64_t missed_pair_steps = 0; ///< steps that they lasted, to the resolution of the interval

  using Contacts = std::set<std::pair<std::uint32_t, std::uint32_t>>;
  /// Contacts unlisted at the last comparison, by ids (walls: id and count + wall).
  const Contacts& unlisted() const noexcept { return unlisted_; }
  void restore_unlisted(Contacts contacts) { unlisted_ = std::move(contacts); }

private:
  Contacts unlisted_;
};

} // namespace grandamp
