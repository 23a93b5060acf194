#include "solver/packing_parts.hpp"

#include "solver/measures.hpp"

#include <numeric>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

namespace grandamp::packing {

namespace {

double dot(const Vector3& a, const Vector3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// Largest of value(i) over all i, on all threads: a maximum does not depend on the order.
template <class Value> double largest_of(std::size_t count, Value&& value) {
  return tbb::parallel_reduce(
      tbb::blocked_range<std::size_t>(0, count, 512), 0.0,
      [&](const tbb::blocked_range<std::size_t>& range, double largest) {
        for (std::size_t i = range.begin(); i != range.end(); ++i) largest = std::max(largest, value(i));
        return largest;
      },
      [](double a, double b) { return std::max(a, b); });
}

template <class Body> void for_all(std::size_t count, Body&& body) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, 512), [&](const tbb::blocked_range<std::size_t>& range) {
    for (std::size_t i = range.begin(); i != range.end(); ++i) body(i);
  });
}

/// Pushes overlapping spheres apart until none overlaps: a descent with momentum on the overlaps of slightly swollen
/// spheres. Each sphere sums over its own neighbours, so that the outcome is the same on any number of threads.
class OverlapRemoval {
public:
  OverlapRemoval(const Room& room, Spheres& spheres, double swelling)
      : room_(room), spheres_(spheres), swelling_(swelling), count_(spheres.radius.size()), push_(count_),
        move_(count_), listed_at_(count_), neighbours_(count_) {
    const double smallest = *std::min_element(spheres.radius.begin(), spheres.radius.end());
    skin_ = 0.6 * smallest;
    longest_move_ = 0.3 * smallest;
  }

  bool run(int sweeps, const std::function<void()>& pulse) {
    double moved = skin_; // the first sweep lists the neighbours
    for (int sweep = 0; sweep < sweeps; ++sweep) {
      if (pulse) pulse();
      if (2.0 * moved >= skin_) list_neighbours();
      if (push_apart() <= 0.0) return true;
      moved = move();
      // Swollen, they come to rest clear of one another; the less room there is, the less swelling that allows.
      if (sweep % patience == patience - 1) swelling_ = std::max(0.5 * swelling_, 3.0e-4);
    }
    return false;
  }

private:
  void list_neighbours() {
    SphereGrid grid(room_.box(), spheres_.position, spheres_.radius);
    for (std::size_t i = 0; i < count_; ++i) grid.insert(i);
    listed_at_ = spheres_.position;
    for_all(count_, [&](std::size_t i) {
      std::vector<std::uint32_t>& own = neighbours_[i];
      own.clear();
      const double gap = skin_ + 2.0 * swelling_ * spheres_.radius[i];
      grid.visit_near(spheres_.position[i], spheres_.radius[i], gap, [&](std::size_t j, double) {
        if (j != i) own.push_back(static_cast<std::uint32_t>(j));
        return true;
      });
    });
  }

  /// Returns the largest overlap of the spheres as they are, m.
  double push_apart() {
    return largest_of(count_, [&](std::size_t i) {
      Vector3 push{0.0, 0.0, 0.0};
      double deepest = 0.0;
      const Vector3& p = spheres_.position[i];
      for (const std::uint32_t j : neighbours_[i]) {
        const Vector3& q = spheres_.position[j];
        const double sum = spheres_.radius[i] + spheres_.radius[j], wanted = sum * (1.0 + swelling_);
        Vector3 away{p[0] - q[0], p[1] - q[1], p[2] - q[2]};
        double distance = std::sqrt(dot(away, away));
        if (distance >= wanted) continue;
        deepest = std::max(deepest, sum * (1.0 + 1.0e-9) - distance);
        if (distance == 0.0) { // two at one point part along x, the first of them backwards
          away = {i < j ? -1.0 : 1.0, 0.0, 0.0};
          distance = 1.0;
        }
        // Where one of the two stays where it is, the other goes all the way.
        const double share = (spheres_.placed[j] ? 2.0 : 1.0) * (wanted - std::min(distance, wanted)) / distance;
        for (std::size_t k = 0; k < 3; ++k) push[k] += share * away[k];
      }
      push_[i] = push;
      return deepest;
    });
  }

  /// Returns how far the spheres are at most from where their neighbours were listed, m.
  double move() {
    constexpr double step = 0.25, momentum = 0.9;
    return largest_of(count_, [&](std::size_t i) {
      if (spheres_.placed[i]) return 0.0;
      Vector3& move = move_[i];
      const bool against = dot(move, push_[i]) < 0.0;
      for (std::size_t k = 0; k < 3; ++k) move[k] = (against ? 0.0 : momentum * move[k]) + step * push_[i][k];
      const double length = std::sqrt(dot(move, move));
      if (length > longest_move_)
        for (double& component : move) component *= longest_move_ / length;
      Vector3& p = spheres_.position[i];
      p = room_.confined({p[0] + move[0], p[1] + move[1], p[2] + move[2]}, spheres_.radius[i]);
      const Vector3& q = listed_at_[i];
      return std::sqrt((p[0] - q[0]) * (p[0] - q[0]) + (p[1] - q[1]) * (p[1] - q[1]) + (p[2] - q[2]) * (p[2] - q[2]));
    });
  }

  static constexpr int patience = 250; ///< sweeps

  const Room& room_;
  Spheres& spheres_;
  double swelling_;
  std::size_t count_;
  double skin_;
  double longest_move_;
  std::vector<Vector3> push_;
  std::vector<Vector3> move_;
  std::vector<Vector3> listed_at_;
  std::vector<std::vector<std::uint32_t>> neighbours_;
};

constexpr double random_close_packing = 0.64;

double solid_fraction(const Room& room, const Spheres& spheres) {
  double solid = 0.0;
  for (const double radius : spheres.radius) solid += sphere_volume(radius);
  return solid / room.volume();
}

} // namespace

bool place_at_random(const Room& room, Spheres& spheres, RandomNumbers& random, const std::function<void()>& pulse) {
  const std::size_t count = spheres.radius.size();
  SphereGrid grid(room.box(), spheres.position, spheres.radius);
  for (std::size_t i = 0; i < count; ++i)
    if (spheres.placed[i]) grid.insert(i);
  // The large ones first: they find no room between the small.
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return spheres.radius[a] > spheres.radius[b]; });
  constexpr int tries = 60;
  constexpr std::size_t between_pulses = 256;
  bool all = true;
  std::size_t next_pulse = between_pulses;
  for (const std::size_t i : order) {
    if (pulse && --next_pulse == 0) {
      pulse();
      next_pulse = between_pulses;
    }
    if (spheres.placed[i]) continue;
    bool found = false;
    for (int k = 0; k < tries && !found; ++k) {
      spheres.position[i] = room.random_place(random, spheres.radius[i]);
      found = grid.is_free(spheres.position[i], spheres.radius[i]);
    }
    if (found) grid.insert(i);
    all = all && found;
  }
  if (all) return true;
  const double swelling =
      std::clamp(0.4 * (std::cbrt(random_close_packing / solid_fraction(room, spheres)) - 1.0), 1.0e-3, 0.03);
  return OverlapRemoval(room, spheres, swelling).run(2000, pulse);
}

} // namespace grandamp::packing
