// A granule's step: kick by force, gravity and the enclosure's own velocity increment, then drift. The rows of force
// are cleared on the way. Rows stay rows; only the largest speed needs a transpose.
#pragma once

#include "kernels/arguments.hpp"
#include "kernels/friction.hpp"
#include "kernels/lines.hpp"

namespace grandamp::kernels {

template <class S, MotionEffects E> struct MotionLoop {
  using Row = typename S::Row;
  using L = Lines<S>;
  using Line = typename L::Line;

  const MotionArguments a; // a copy, where no row that is stored can be a part of it
  const Row zero = S::row_broadcast(0.0);
  const Row half = S::row_broadcast(0.5);
  const Row kick = S::row_set(a.kick[0], a.kick[1], a.kick[2], 0.0);
  const Row frame = S::row_set(a.frame_velocity[0], a.frame_velocity[1], a.frame_velocity[2], 0.0);
  // Products, not row_set: no compiler needs an instruction for them that valgrind does not know.
  const Row drift = S::row_broadcast(a.time_step) * S::row_set(1.0, 1.0, 1.0, 0.0);
  const Row per_second = S::row_broadcast(1.0 / a.time_step);
  const Row twelfth = S::row_broadcast(1.0 / 12.0);
  const Row share_of_step = S::row_broadcast(a.time_step / 12.0);
  /// T/I = (5/2) turn / (m r), and s = r omega.
  const Line drift_and_turn = L::of(drift, S::row_broadcast(2.5) * drift);
  Row kinetic = zero, spinning = zero, moment = zero;
  struct RowLosses {
    Row normal_granule, normal_wall, friction_granule, friction_wall;
  };
  RowLosses lost{zero, zero, zero, zero}, early{zero, zero, zero, zero};

  /// Kicks granule first + lane. Its new velocity, and in the fourth component its contacts in this step, if counted.
  [[gnu::always_inline]] Row kicked(std::size_t first, std::uint32_t lane) {
    // Rows as places after the first one's: a constant each, not an address to be worked out.
    MotionRow& motion = (a.granules.motion + first)[lane];
    ForceRow& force = (a.granules.force + first)[lane];
    const double inverse_mass = motion.inverse_mass;
    Row before, after, spin_before = zero, spin_after = zero, turned = zero, pushed;
    // The fourth component of the forces counts contacts, and must not get into the inverse mass.
    if constexpr (E.rotates()) {
      const Line line_before = L::load(motion.velocity), line_pushed = L::load(force.force);
      Line line_after = L::fma(line_pushed, L::scaled(inverse_mass, drift_and_turn), line_before);
      if constexpr (E.accelerated) line_after = L::with_low_plus(line_after, kick);
      L::store(motion.velocity, line_after);
      before = L::low(line_before);
      after = L::low(line_after);
      pushed = L::low(line_pushed);
      spin_before = L::high(line_before);
      spin_after = L::high(line_after);
      turned = L::high(line_pushed);
    } else {
      before = S::row_load(motion.velocity);
      pushed = S::row_load(force.force);
      after = S::row_fma(pushed, S::row_broadcast(inverse_mass) * drift, before);
      if constexpr (E.accelerated) after = after + kick;
      S::row_store(motion.velocity, after);
      if constexpr (!E.counts()) S::row_store(force.force, zero);
    }
    if constexpr (E.energies() || E.ledger()) {
      const Row mean = half * (before + after);
      const Row mean_spin = half * (spin_before + spin_after);
      if constexpr (E.energies())
        observe(inverse_mass, mean, mean_spin, S::row_load(&(a.granules.position + first)[lane].x));
      if constexpr (E.ledger())
        dissipate(first + lane, mean, after - before, mean_spin, spin_after - spin_before, turned);
    }
    if constexpr (E.integration == Integration::verlet) {
      MotionRow& predicted = (a.granules.predicted + first)[lane];
      S::row_store(predicted.velocity, S::row_fma(half, after - before, after));
      if constexpr (E.rotates())
        S::row_store(predicted.surface_spin, S::row_fma(half, spin_after - spin_before, spin_after));
    }
    if constexpr (E.counts())
      return S::row_with_last(after, pushed);
    else
      return after;
  }

  /// Two positions share a line of memory, which takes one turn of the processor's stores if nothing stands between
  /// them.
  [[gnu::always_inline]] void drifted(std::size_t first, std::uint32_t count, const Row (&velocities)[S::width]) {
    for (std::uint32_t lane = 0; lane < count; ++lane) {
      double* const position = &(a.granules.position + first)[lane].x;
      S::row_store(position, S::row_fma(drift, velocities[lane], S::row_load(position)));
    }
  }

  /// Clears the forces of the granules from `first` on, and leaves what each contact may take in the step to come.
  [[gnu::always_inline]] void clear_counted(std::size_t first, std::uint32_t count, typename S::Vector touching) {
    Line cleared[S::width];
    L::last_of_lines(friction_share<S>(touching), cleared);
    for (std::uint32_t lane = 0; lane < count; ++lane) L::store((a.granules.force + first)[lane].force, cleared[lane]);
  }

  void observe(double inverse_mass, Row mean, Row mean_spin, Row here) {
    const Row mass = S::row_broadcast(1.0 / inverse_mass);
    const Row laboratory = mean + frame;
    kinetic = S::row_fma(mass * laboratory, laboratory, kinetic);
    if constexpr (E.rotates()) spinning = S::row_fma(mass * mean_spin, mean_spin, spinning);
    moment = S::row_fma(mass, here, moment);
  }

  /// Velocities that a step's forces, and those of the step before, are multiplied by.
  struct Motion {
    Row now;   ///< all that this step can tell of the one at t_n
    Row then;  ///< what it adds to that of the step before, negative
    Row early; ///< for the half step before t_n: the kick up to t_n is half of the whole
  };

  /// Work that each kind of force took from the granule over the step, per unit of time. It is linear in the force:
  /// summing forces by kind and multiplying by the granule's velocity gives the sum over its contacts.
  ///
  /// The velocity is that of the path x(t) on which the positions lie, x' at t_n. The mean of the half-step velocities,
  /// (x_(n+1) - x_(n-1)) / (2 dt), exceeds it by x''' dt^2 / 6, while the path's own balance of energy, x' times
  /// m x'' + m x'''' dt^2 / 12 = force, has no term of that order but at its ends: with the mean, the ledger of any
  /// contact at eight steps is 2.8 % of its damping short (perf/ACCURACY.md). x''' dt^2 is half the change of velocity
  /// in the next step less that in the step before, so the next step finishes what this one begins.
  void dissipate(std::size_t i, Row mean, Row gained, Row mean_spin, Row spun, Row turned) {
    using Floats = typename S::Eight;
    LossRow& loss = a.granules.loss[i];
    LastStepRow& last = a.granules.last_step[i];
    const Motion moved = at_once(mean, gained, S::row_of_floats(last.velocity_rate));
    take(lost.normal_granule, early.normal_granule, S::row_of_floats(loss.damping), S::row_of_floats(last.loss.damping),
         moved);
    take(lost.friction_granule, early.friction_granule, S::row_of_floats(loss.friction),
         S::row_of_floats(last.loss.friction), moved);
    if constexpr (E.rotates()) dissipate_turning(turned, mean_spin, spun, last);
    if ((a.granules.wall_loss.touches[i] | a.granules.wall_loss_before.touches[i]) != 0)
      dissipate_at_walls(i, moved, mean_spin, spun, last);
    Floats::store(last.loss.damping, Floats::load(loss.damping)); // and friction, each time
    Floats::store(loss.damping, Floats::broadcast(0.0F));
    Floats::store(last.velocity_rate, Floats::of_rows(gained * per_second, spun * per_second));
  }

  /// All that turns a granule is friction, so that the change of spin in a step is the step's turn, and what this step
  /// and the one before add to each other's velocities cancels. What of it walls do is told by dissipate_at_walls.
  void dissipate_turning(Row turned, Row mean_spin, Row spun, const LastStepRow& last) {
    lost.friction_granule = S::row_fnma(turned, mean_spin, lost.friction_granule);
    if constexpr (E.energies()) {
      const Row before_kick = S::row_fnma(S::row_broadcast(0.125), spun, half * mean_spin);
      const Row spin = S::row_fnma(half * share_of_step, S::row_of_floats(last.surface_spin_rate), before_kick);
      early.friction_granule = S::row_fnma(turned, spin, early.friction_granule);
    }
  }

  void dissipate_at_walls(std::size_t i, const Motion& moved, Row mean_spin, Row spun, const LastStepRow& last) {
    const WallLossRows &walls = a.granules.wall_loss, &walls_before = a.granules.wall_loss_before;
    ForceRow &now = walls.friction[i], &then = walls_before.friction[i];
    take_cleared(lost.normal_wall, early.normal_wall, walls.damping[i].force, walls_before.damping[i].force, moved);
    take_cleared(lost.friction_wall, early.friction_wall, now.force, then.force, moved);
    if constexpr (E.rotates()) {
      Row at_walls = zero, early_at_walls = zero;
      take_cleared(at_walls, early_at_walls, now.turn, then.turn,
                   at_once(mean_spin, spun, S::row_of_floats(last.surface_spin_rate)));
      lost.friction_wall = lost.friction_wall + at_walls;
      lost.friction_granule = lost.friction_granule - at_walls;
      early.friction_wall = early.friction_wall + early_at_walls;
      early.friction_granule = early.friction_granule - early_at_walls;
    }
    walls_before.touches[i] = 0;
  }

  Motion at_once(Row mean, Row gained, Row last_rate) {
    Motion motion;
    motion.now = S::row_fma(share_of_step, last_rate, mean);
    motion.then = twelfth * gained;
    if constexpr (E.energies()) motion.early = half * S::row_fnma(S::row_broadcast(0.25), gained, motion.now);
    return motion;
  }

  void take(Row& sum, Row& before, Row force, Row last_force, const Motion& motion) {
    sum = S::row_fnma(force, motion.now, sum);
    sum = S::row_fma(last_force, motion.then, sum);
    if constexpr (E.energies()) {
      before = S::row_fnma(force, motion.early, before);
      before = S::row_fma(last_force, motion.then, before);
    }
  }
  /// The rows of the step before come out cleared: they are the next step's.
  void take_cleared(Row& sum, Row& before, const double* now, double* then, const Motion& motion) {
    take(sum, before, S::row_load(now), S::row_load(then), motion);
    S::row_store(then, zero);
  }

  void tell(const RowLosses& rows, Losses& to) {
    to.normal_granule += a.time_step * sum(rows.normal_granule);
    to.normal_wall += a.time_step * sum(rows.normal_wall);
    to.friction_granule += a.time_step * sum(rows.friction_granule);
    to.friction_wall += a.time_step * sum(rows.friction_wall);
  }

  GRANDAMP_INLINE double sum(Row row) {
    alignas(32) double v[4];
    S::row_store(v, row);
    return v[0] + v[1] + v[2]; // the fourth component holds an inverse mass or radius, never energy
  }
};

/// Steps the granules first <= i < last.
template <class S, MotionEffects E> void motion_kernel(const MotionArguments& arguments, MotionResult& result) {
  using Vector = typename S::Vector;
  using Row = typename S::Row;
  constexpr std::uint32_t width = S::width;
  MotionLoop<S, E> loop{.a = arguments};
  const std::size_t last = arguments.last;
  Vector fastest = S::broadcast(result.max_speed_squared);
  Vector total = S::broadcast(0.0);
  const auto finish = [&](const Row(&rows)[width], std::size_t first, std::uint32_t count)
      __attribute__((always_inline)) {
    loop.drifted(first, count, rows);
    Vector x, y, z, touching;
    S::columns(rows, x, y, z, touching);
    const Vector square = S::fma(z, z, S::fma(y, y, x * x));
    fastest = S::max(fastest, square);
    total = total + square;
    if constexpr (E.counts()) loop.clear_counted(first, count, touching);
  };
  std::size_t i = arguments.first;
  for (; i + width <= last; i += width) {
    Row rows[width];
    for (std::uint32_t lane = 0; lane < width; ++lane) rows[lane] = loop.kicked(i, lane);
    finish(rows, i, width);
  }
  if (i < last) {
    const auto left = static_cast<std::uint32_t>(last - i);
    Row rows[width];
    for (std::uint32_t lane = 0; lane < width; ++lane) rows[lane] = lane < left ? loop.kicked(i, lane) : loop.zero;
    finish(rows, i, left);
  }
  double fast[width], all[width];
  S::store(fast, fastest);
  S::store(all, total);
  for (std::uint32_t lane = 0; lane < width; ++lane) {
    if (fast[lane] > result.max_speed_squared) result.max_speed_squared = fast[lane];
    result.sum_speed_squared += all[lane];
  }
  if constexpr (E.energies()) {
    result.kinetic += 0.5 * loop.sum(loop.kinetic) + 0.2 * loop.sum(loop.spinning); // I omega^2 / 2 = m s^2 / 5
    alignas(32) double moment[4];
    S::row_store(moment, loop.moment);
    for (int k = 0; k < 3; ++k) result.mass_moment[k] += moment[k];
  }
  if constexpr (E.ledger()) {
    loop.tell(loop.lost, result.lost);
    if constexpr (E.energies()) loop.tell(loop.early, result.early);
  }
}

} // namespace grandamp::kernels
