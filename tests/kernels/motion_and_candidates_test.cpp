// The motion and candidate kernels of every instruction set that this machine runs against the oracle.
#include "tests/support/kernel_bed.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

using namespace grandamp;
using namespace grandamp::test;

TEST_CASE("motion kernels: every instruction set and set of effects against the oracle") {
  for (const InstructionSet machine : machines())
    for (const auto integration : {Integration::leapfrog, Integration::verlet})
      for (const auto rubbing : {Rubbing::none, Rubbing::without_rotation, Rubbing::with_rotation})
        for (const bool accelerated : {true, false})
          for (const auto observation :
               {Observation::none, Observation::energies, Observation::ledger, Observation::ledger_and_energies})
            for (const std::uint32_t last : {4U, 5U, 10U, 27U, 48U}) {
              const bool rotates = rubbing == Rubbing::with_rotation, counts = rubbing != Rubbing::none;
              const std::string which = std::string(name(machine)) +
                                        (integration == Integration::verlet ? ", verlet" : ", leapfrog") +
                                        (rotates  ? ", rotates"
                                         : counts ? ", counts"
                                                  : "") +
                                        (accelerated ? ", accelerated" : "") + ", observation " +
                                        std::to_string(static_cast<int>(observation));
              CAPTURE(which);
              CAPTURE(last);
              const ContactEffects spins{kernels::Damping::tsuji, Friction::coulomb, Variety::sizes, observation};
              Bed bed = make_bed(spins, 23);
              Random random{std::mt19937_64(5)};
              const std::uint32_t first = 3;
              std::vector<MotionRow> predicted = bed.motion;
              const auto fill = [&](auto& rows, double size, bool turns) {
                for (auto& row : rows)
                  for (int k = 0; k < 3; ++k) {
                    row.force[k] = random(-size, size);
                    if constexpr (requires { row.turn; })
                      if (turns) row.turn[k] = random(-size, size);
                  }
              };
              fill(bed.force, 3.0, rotates);
              for (ForceRow& row : bed.force)
                if (counts) row.touching = static_cast<double>(random.engine() % 40);
              fill(bed.damping_wall, 0.4, false);
              fill(bed.damping_wall_before, 0.45, false);
              fill(bed.friction_wall, 0.6, rotates);
              fill(bed.friction_wall_before, 0.65, rotates);
              for (std::size_t i = 0; i < bed.loss.size(); ++i)
                for (int k = 0; k < 3; ++k) {
                  LastStepRow& then = bed.last_step[i];
                  const auto number = [&](double size) { return static_cast<float>(random(-size, size)); };
                  bed.loss[i].damping[k] = number(0.3);
                  bed.loss[i].friction[k] = number(0.5);
                  then.loss.damping[k] = number(0.35);
                  then.loss.friction[k] = number(0.55);
                  then.velocity_rate[k] = number(1.0e4);
                  then.surface_spin_rate[k] = number(1.0e4);
                }
              for (std::uint32_t i = 0; i < bed.count(); ++i) { // at a wall now, before, both, or neither
                bed.touches_wall[i] = i % 2;
                bed.touched_wall_before[i] = i / 2 % 2;
                if (bed.touches_wall[i] == 0) bed.damping_wall[i] = {}, bed.friction_wall[i] = {};
                if (bed.touched_wall_before[i] == 0) bed.damping_wall_before[i] = {}, bed.friction_wall_before[i] = {};
              }
              const reference::Vector gravity = accelerated ? reference::Vector{1.0, -3.0, -9.81} : reference::Vector{};
              const reference::Vector frame_kick =
                  accelerated ? reference::Vector{0.01, 0.0, 0.02} : reference::Vector{};
              const reference::Vector frame{0.3, 0.0, -0.7};
              std::vector<reference::Granule> moved = bed.granules;
              MotionResult expected;
              for (std::uint32_t i = first; i < last; ++i) {
                reference::Granule& g = moved[i];
                const reference::Granule before = g;
                const auto of = [](const double* v) { return reference::Vector{v[0], v[1], v[2]}; };
                reference::Vector torque = of(bed.force[i].turn);
                for (double& component : torque) component *= g.radius;
                reference::move(g, of(bed.force[i].force), torque, gravity, frame_kick, step);
                reference::Granule mean = before;
                for (std::size_t k = 0; k < 3; ++k) {
                  mean.velocity[k] = 0.5 * (before.velocity[k] + g.velocity[k]);
                  mean.spin[k] = 0.5 * (before.spin[k] + g.spin[k]);
                  expected.mass_moment[k] += g.mass * before.position[k];
                  const double gained = g.velocity[k] - before.velocity[k];
                  const double spun = g.radius * (g.spin[k] - before.spin[k]);
                  const LastStepRow& then = bed.last_step[i];
                  const double v = mean.velocity[k] + step * then.velocity_rate[k] / 12.0;
                  const double s = g.radius * mean.spin[k] + step * then.surface_spin_rate[k] / 12.0;
                  Losses &lost = expected.lost, &early = expected.early;
                  const auto work = [&](double force, double then_force, double at, double kick, double& all,
                                        double& first_half) {
                    all -= step * (force * at - then_force * kick / 12.0);
                    first_half -= step * (0.5 * force * (at - 0.25 * kick) - then_force * kick / 12.0);
                  };
                  work(bed.loss[i].damping[k], then.loss.damping[k], v, gained, lost.normal_granule,
                       early.normal_granule);
                  work(bed.damping_wall[i].force[k], bed.damping_wall_before[i].force[k], v, gained, lost.normal_wall,
                       early.normal_wall);
                  work(bed.loss[i].friction[k], then.loss.friction[k], v, gained, lost.friction_granule,
                       early.friction_granule);
                  const ForceRow &wall = bed.friction_wall[i], &wall_before = bed.friction_wall_before[i];
                  work(wall.force[k], wall_before.force[k], v, gained, lost.friction_wall, early.friction_wall);
                  work(wall.turn[k], wall_before.turn[k], s, spun, lost.friction_wall, early.friction_wall);
                  // What of the turn is not the walls' is the other granules', and was in the step before, which the
                  // change of spin in it tells.
                  if (rotates)
                    work(bed.force[i].turn[k] - wall.turn[k],
                         0.4 * g.mass * then.surface_spin_rate[k] - wall_before.turn[k], s, spun, lost.friction_granule,
                         early.friction_granule);
                }
                double square = 0.0;
                for (std::size_t k = 0; k < 3; ++k) square += g.velocity[k] * g.velocity[k];
                expected.max_speed_squared = std::max(expected.max_speed_squared, square);
                expected.sum_speed_squared += square;
                for (std::size_t k = 0; k < 3; ++k) mean.velocity[k] += frame[k];
                if (!rotates) mean.spin = {};
                expected.kinetic += reference::kinetic_energy(mean);
              }

              const Bed untouched = bed;
              const std::vector<MotionRow> untouched_prediction = predicted;
              MotionArguments arguments;
              arguments.granules = bed.arrays();
              if (integration == Integration::verlet) arguments.granules.predicted = predicted.data();
              arguments.first = first;
              arguments.last = last;
              arguments.time_step = step;
              for (std::size_t k = 0; k < 3; ++k) {
                arguments.kick[k] = gravity[k] * step - frame_kick[k];
                arguments.frame_velocity[k] = frame[k];
              }
              MotionResult result;
              const MotionEffects effects{integration, rubbing, accelerated, observation};
              motion_kernel_for(machine, effects)(arguments, result);

              double position = 0.0, velocity = 0.0, prediction = 0.0, left = 0.0;
              for (std::uint32_t i = first; i < last; ++i) {
                const auto& before = bed.granules[i];
                for (std::size_t k = 0; k < 3; ++k) {
                  const double radius = before.radius;
                  position = std::max(position, std::abs((&bed.position[i].x)[k] - moved[i].position[k]));
                  velocity = std::max({velocity, std::abs(bed.motion[i].velocity[k] - moved[i].velocity[k]),
                                       std::abs(bed.motion[i].surface_spin[k] - radius * moved[i].spin[k])});
                  if (integration == Integration::verlet) {
                    const double v = 1.5 * moved[i].velocity[k] - 0.5 * before.velocity[k];
                    const double s = radius * (1.5 * moved[i].spin[k] - 0.5 * before.spin[k]);
                    prediction = std::max({prediction, std::abs(predicted[i].velocity[k] - v),
                                           std::abs(predicted[i].surface_spin[k] - s)});
                  }
                  left += std::abs(bed.force[i].force[k]) + std::abs(bed.force[i].turn[k]);
                  if (effects.ledger())
                    left += std::abs(bed.loss[i].damping[k]) + std::abs(bed.loss[i].friction[k]) +
                            std::abs(bed.damping_wall_before[i].force[k]) +
                            std::abs(bed.friction_wall_before[i].force[k]) +
                            std::abs(bed.friction_wall_before[i].turn[k]);
                }
                if (effects.ledger()) {
                  CHECK(bed.touched_wall_before[i] == 0);
                  CHECK(bed.touches_wall[i] == untouched.touches_wall[i]);
                }
                if (effects.ledger())
                  for (std::size_t k = 0; k < 3; ++k) {
                    const double gained = moved[i].velocity[k] - before.velocity[k];
                    const double spun = before.radius * (moved[i].spin[k] - before.spin[k]);
                    const LastStepRow& then = bed.last_step[i];
                    const auto remembered = [](float value, double wanted) {
                      CHECK(std::abs(value - wanted) <= 1.0e-7 * std::abs(wanted) + 1.0e-9);
                    };
                    remembered(then.velocity_rate[k], gained / step);
                    if (rotates) remembered(then.surface_spin_rate[k], spun / step);
                    CHECK(then.loss.damping[k] == untouched.loss[i].damping[k]);
                    CHECK(then.loss.friction[k] == untouched.loss[i].friction[k]);
                  }
                if (counts) {
                  CHECK(bed.force[i].touching == 0.0);
                  CHECK(bed.force[i].friction_share == 1.0 / (1.0 + std::max(untouched.force[i].touching, 1.0)));
                }
                CHECK(bed.motion[i].inverse_mass == untouched.motion[i].inverse_mass);
                CHECK(bed.motion[i].inverse_radius == untouched.motion[i].inverse_radius);
                CHECK(bed.position[i].radius == untouched.position[i].radius);
              }
              CHECK(position < 1.0e-17);
              CHECK(velocity < 1.0e-14);
              CHECK(prediction < 1.0e-14);
              CHECK(left == 0.0);
              for (std::uint32_t i = 0; i < bed.count() + 2; ++i) {
                if (i >= first && i < last) continue;
                for (int k = 0; k < 3; ++k) {
                  CHECK((&bed.position[i].x)[k] == (&untouched.position[i].x)[k]);
                  CHECK(bed.motion[i].velocity[k] == untouched.motion[i].velocity[k]);
                  CHECK(bed.force[i].force[k] == untouched.force[i].force[k]);
                  CHECK(predicted[i].velocity[k] == untouched_prediction[i].velocity[k]);
                }
              }
              CHECK(result.max_speed_squared == doctest::Approx(expected.max_speed_squared).epsilon(1.0e-13));
              CHECK(result.sum_speed_squared == doctest::Approx(expected.sum_speed_squared).epsilon(1.0e-13));
              if (effects.energies()) {
                CHECK(result.kinetic == doctest::Approx(expected.kinetic).epsilon(1.0e-13));
                for (int k = 0; k < 3; ++k)
                  CHECK(result.mass_moment[k] == doctest::Approx(expected.mass_moment[k]).epsilon(1.0e-13));
              }
              if (effects.ledger()) {
                const double size = step * 3.0 * last * 2.0;
                const auto check = [&](const Losses& found, const Losses& wanted) {
                  CHECK(std::abs(found.normal_granule - wanted.normal_granule) < 1.0e-13 * size);
                  CHECK(std::abs(found.normal_wall - wanted.normal_wall) < 1.0e-13 * size);
                  CHECK(std::abs(found.friction_granule - wanted.friction_granule) < 1.0e-13 * size);
                  CHECK(std::abs(found.friction_wall - wanted.friction_wall) < 1.0e-13 * size);
                };
                check(result.lost, expected.lost);
                if (effects.energies()) check(result.early, expected.early);
              }
            }
}

TEST_CASE("candidate kernels: every instruction set finds exactly the pairs within reach") {
  Random random{std::mt19937_64(77)};
  const std::uint32_t count = 203;
  // A vector load at the end of a range may look past it: what stands there must not matter.
  std::vector<double> x(count + 16, std::nan("")), y = x, z = x, radius = x;
  for (std::uint32_t i = 0; i < count; ++i) {
    x[i] = random(0.0, 0.01);
    y[i] = random(0.0, 0.01);
    z[i] = random(0.0, 0.01);
    radius[i] = random(0.5e-3, 2.0e-3);
  }
  const double skin = 0.2e-3, common = 1.2e-3;
  for (const InstructionSet machine : machines())
    for (const bool alike : {true, false})
      for (int trial = 0; trial < 50; ++trial) {
        CAPTURE(std::string(name(machine)));
        CAPTURE(alike);
        const auto pick = [&](std::uint32_t low, std::uint32_t high) {
          return low + static_cast<std::uint32_t>(random.engine() % (high - low + 1));
        };
        const IndexRange own{pick(0, 60), pick(60, 75)};
        const std::uint32_t own_end = pick(own.last, 80);
        std::vector<IndexRange> ranges;
        for (std::uint32_t from = own_end; from < count;) {
          const std::uint32_t first = pick(from, std::min(from + 30, count)),
                              last = pick(first, std::min(first + 25, count));
          ranges.push_back({first, last});
          from = last + 1;
        }
        std::multiset<std::pair<std::uint32_t, std::uint32_t>> expected, found;
        for (std::uint32_t i = own.first; i < own.last; ++i) {
          const auto test = [&](std::uint32_t j) {
            const double reach = alike ? 2.0 * common + skin : radius[i] + radius[j] + skin;
            if (std::hypot(x[i] - x[j], y[i] - y[j], z[i] - z[j]) < reach) expected.insert({i, j});
          };
          for (std::uint32_t j = i + 1; j < own_end; ++j) test(j);
          for (const IndexRange& range : ranges)
            for (std::uint32_t j = range.first; j < range.last; ++j) test(j);
        }
        CandidateArguments arguments;
        arguments.x = x.data();
        arguments.y = y.data();
        arguments.z = z.data();
        arguments.radius = alike ? nullptr : radius.data();
        arguments.reach = alike ? 2.0 * common + skin : skin;
        std::vector<RowPair> room(count * count + list_padding);
        RowPair* end = candidate_kernel_for(machine, alike)(arguments, own, own_end, ranges.data(),
                                                            static_cast<int>(ranges.size()), room.data());
        for (const RowPair* pair = room.data(); pair != end; ++pair) found.insert({pair->first(), pair->second()});
        CHECK(found == expected);
      }
}

TEST_CASE("coarse kernels: every instruction set finds all pairs within reach of rows of cells, and hardly any other") {
  Random random{std::mt19937_64(78)};
  const std::uint32_t count = 420;
  const double skin = 0.2e-3, common = 1.2e-3, margin = 1.0e-8;
  std::array<std::vector<double>, 4> metres;
  for (auto& column : metres) column.resize(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    for (std::size_t k = 0; k < 3; ++k) metres[k][i] = random(0.0, 0.01);
    metres[3][i] = random(0.5e-3, 2.0e-3);
  }
  // In millimetres. What stands behind the last granule must not matter, though it is near everybody.
  std::array<std::vector<float>, 4> column;
  for (std::size_t k = 0; k < 4; ++k) {
    for (const double value : metres[k]) column[k].push_back(static_cast<float>(1.0e3 * value));
    column[k].resize(count + list_padding, k < 3 ? 5.0F : 100.0F);
  }
  std::size_t tested = 0;
  for (const InstructionSet machine : machines())
    for (const bool alike : {true, false})
      for (int trial = 0; trial < 60; ++trial) {
        CAPTURE(std::string(name(machine)));
        CAPTURE(alike);
        CAPTURE(trial);
        // Cells of up to `most` granules: none, a vector's fill and more; every row begins where the one before ends.
        const std::uint32_t cells = 1 + static_cast<std::uint32_t>(trial / 5 % 5), most = trial % 3 == 0 ? 14 : 5;
        std::array<std::vector<std::uint32_t>, 1 + most_rows_beside> starts;
        std::uint32_t next = 0;
        for (auto& row : starts) {
          for (std::uint32_t cell = 0; cell < cells; ++cell) {
            row.push_back(next);
            next += static_cast<std::uint32_t>(random.engine() % (most + 1));
          }
          row.push_back(next);
        }
        REQUIRE(next <= count);
        for (auto& row : starts)
          for (std::uint32_t& start : row) start += count - next; // the last row's last cell ends where all do
        CellRows rows;
        rows.cells = cells;
        rows.last = trial % 7 == 0 ? (cells + 1) / 2 : cells;
        rows.first = trial % 7 == 1 ? cells / 2 : 0;
        rows.own = starts[0].data();
        rows.count = trial % (1 + most_rows_beside);
        rows.within = rows.count == 0 || trial % 4 != 0;
        for (int k = 0; k < rows.count; ++k) rows.beside[k] = starts[static_cast<std::size_t>(k) + 1].data();

        CoarseArguments arguments;
        arguments.x = column[0].data();
        arguments.y = column[1].data();
        arguments.z = column[2].data();
        arguments.radius = alike ? nullptr : column[3].data();
        const double reach = alike ? 2.0 * common + skin : skin;
        arguments.reach = static_cast<float>(1.0e3 * (reach + margin));
        std::size_t tests = 0;
        for (std::uint32_t cell = rows.first; cell < rows.last; ++cell) {
          const std::uint32_t before = cell > 0 ? cell - 1 : 0, after = std::min(cell + 2, cells);
          const std::size_t own = rows.own[cell + 1] - rows.own[cell];
          if (rows.within) tests += own * (rows.own[after] - rows.own[cell]);
          for (int k = 0; k < rows.count; ++k) tests += own * (rows.beside[k][after] - rows.beside[k][before]);
        }
        const RowPair canary = RowPair::of(7, 7);
        std::vector<RowPair> room(tests + list_padding + 1, canary);
        const RowPair* const end = coarse_kernel_for(machine, alike)(arguments, rows, room.data());
        CHECK(room.back().first_offset == canary.first_offset);
        CHECK(room.back().second_offset == canary.second_offset);
        std::multiset<std::pair<std::uint32_t, std::uint32_t>> found;
        for (const RowPair* pair = room.data(); pair != end; ++pair) found.insert({pair->first(), pair->second()});

        std::size_t right = 0;
        for (std::uint32_t cell = rows.first; cell < rows.last; ++cell)
          for (std::uint32_t i = rows.own[cell]; i < rows.own[cell + 1]; ++i) {
            const std::uint32_t before = cell > 0 ? cell - 1 : 0, after = std::min(cell + 2, cells);
            const auto test = [&](std::uint32_t j) {
              const double gap =
                  std::hypot(metres[0][i] - metres[0][j], metres[1][i] - metres[1][j], metres[2][i] - metres[2][j]) -
                  (alike ? 0.0 : metres[3][i] + metres[3][j]);
              const auto times = found.count({i, j});
              if (gap < reach) CHECK(times == 1);
              CHECK(times <= (gap < reach + 2.0 * margin ? 1U : 0U));
              right += times;
              ++tested;
            };
            if (rows.within)
              for (std::uint32_t j = i + 1; j < rows.own[after]; ++j) test(j);
            for (int k = 0; k < rows.count; ++k)
              for (std::uint32_t j = rows.beside[k][before]; j < rows.beside[k][after]; ++j) test(j);
          }
        CHECK(right == found.size()); // and none from beyond those cells
      }
  CHECK(tested > 50000);
}
