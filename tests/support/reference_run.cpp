#include "tests/support/reference_run.hpp"

#include "solver/material.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace grandamp::test {

namespace {

using reference::Granule;
using reference::Law;
using reference::Vector;

void add(Vector& a, double s, const Vector& b) {
  for (std::size_t k = 0; k < 3; ++k) a[k] += s * b[k];
}

double dot(const Vector& a, const Vector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

Law laws_of(const Contact& contact) {
  Law law;
  law.damping = contact.damping == NormalDamping::tsuji    ? reference::Damping::tsuji
                : contact.damping == NormalDamping::linear ? reference::Damping::linear
                                                           : reference::Damping::none;
  law.coulomb = contact.friction == FrictionLaw::coulomb;
  law.spring = contact.friction == FrictionLaw::spring;
  law.rotation = contact.rotation && contact.friction != FrictionLaw::none;
  law.tension = contact.tension;
  return law;
}

void set_constants(Law& law, const ContactConstants& constants) {
  if (constants.restitution) {
    const double logarithm = std::log(*constants.restitution);
    law.alpha = law.tension ? -std::sqrt(5.0) * logarithm / std::hypot(logarithm, std::numbers::pi)
                            : tsuji_alpha_without_tension(*constants.restitution);
  }
  if (constants.alpha) law.alpha = *constants.alpha;
  law.normal_damping = constants.normal_damping.value_or(0.0);
  law.friction = constants.friction.value_or(0.0);
  law.tangential_damping = constants.tangential_damping.value_or(0.0);
}

/// 4/3 E*, Eq. (4) as corrected.
double elastic_coefficient(double young_a, double poisson_a, double young_b, double poisson_b) {
  return 4.0 / 3.0 / ((1.0 - poisson_a * poisson_a) / young_a + (1.0 - poisson_b * poisson_b) / young_b);
}

} // namespace

ReferenceEnclosure::ReferenceEnclosure(const Scene& scene, double step)
    : structure_(scene.structure), excitation_(scene.excitation), step_(step) {
  if (structure_)
    direction_ = structure_->direction;
  else if (excitation_.kind == ExcitationKind::prescribed)
    direction_ = excitation_.direction;
}

double ReferenceEnclosure::prescribed_displacement(double time) const {
  if (structure_ || excitation_.kind != ExcitationKind::prescribed) return 0.0;
  if (excitation_.velocity) return *excitation_.velocity * time;
  return excitation_.amplitude * std::sin(2.0 * std::numbers::pi * excitation_.frequency * time);
}

double ReferenceEnclosure::prescribed_velocity(double time) const {
  if (structure_ || excitation_.kind != ExcitationKind::prescribed) return 0.0;
  if (excitation_.velocity) return *excitation_.velocity;
  const double circular = 2.0 * std::numbers::pi * excitation_.frequency;
  return circular * excitation_.amplitude * std::cos(circular * time);
}

double ReferenceEnclosure::initial_velocity() const {
  return structure_ ? structure_->velocity : prescribed_velocity(0.0);
}

double ReferenceEnclosure::force(double time) const {
  if (!structure_ || excitation_.kind != ExcitationKind::harmonic) return 0.0;
  const double amplitude =
      excitation_.force ? *excitation_.force : structure_->stiffness * excitation_.static_deflection.value();
  return amplitude * std::sin(2.0 * std::numbers::pi * excitation_.frequency * time);
}

double ReferenceEnclosure::stored(const ReferenceHost& host) const {
  if (!structure_) return 0.0;
  return 0.5 * structure_->mass * host.velocity * host.velocity +
         0.5 * structure_->stiffness * host.displacement * host.displacement;
}

ReferenceHost ReferenceEnclosure::advance_structure(ReferenceHost host, double from, double to, double reaction) const {
  const double span = to - from;
  const double fastest =
      std::max({std::sqrt(structure_->stiffness / structure_->mass), structure_->damping / structure_->mass,
                2.0 * std::numbers::pi * excitation_.frequency});
  const int substeps = std::max(4, static_cast<int>(std::ceil(std::abs(span) * fastest / 2.0e-3)));
  const double h = span / substeps;
  const auto rate = [&](const ReferenceHost& at, double time) {
    const double f = force(time);
    ReferenceHost change;
    change.displacement = at.velocity;
    change.velocity =
        (f + reaction - structure_->damping * at.velocity - structure_->stiffness * at.displacement) / structure_->mass;
    change.work_in = f * at.velocity;
    change.loss = structure_->damping * at.velocity * at.velocity;
    return change;
  };
  const auto plus = [](const ReferenceHost& a, double s, const ReferenceHost& b) {
    return ReferenceHost{a.displacement + s * b.displacement, a.velocity + s * b.velocity, a.work_in + s * b.work_in,
                         a.loss + s * b.loss};
  };
  for (int n = 0; n < substeps; ++n) {
    const double time = from + n * h;
    const ReferenceHost k1 = rate(host, time);
    const ReferenceHost k2 = rate(plus(host, 0.5 * h, k1), time + 0.5 * h);
    const ReferenceHost k3 = rate(plus(host, 0.5 * h, k2), time + 0.5 * h);
    const ReferenceHost k4 = rate(plus(host, h, k3), time + h);
    host = plus(plus(plus(plus(host, h / 6.0, k1), h / 3.0, k2), h / 3.0, k3), h / 6.0, k4);
  }
  return host;
}

ReferenceHost ReferenceEnclosure::start(double reaction) const {
  ReferenceHost host;
  if (structure_) {
    host.displacement = structure_->displacement;
    host.velocity = structure_->velocity;
    host = advance_structure(host, 0.0, -0.5 * step_, reaction);
    host.work_in = host.loss = 0.0;
  } else {
    host.velocity = (prescribed_displacement(0.0) - prescribed_displacement(-step_)) / step_;
  }
  return host;
}

ReferenceRun::ReferenceRun(const Scene& scene, double step)
    : scene_(scene), step_(step), enclosure_(scene, step), populations_(scene.populations.size()) {
  Law common = laws_of(scene.contact);
  if (scene.time.integrator == Integrator::verlet) common.cap = 0.5;
  rotation_ = common.rotation;
  const ContactConstants& granule = scene.contact.granule;
  for (const Population& a : scene.populations) {
    for (const Population& b : scene.populations) {
      Law law = common;
      set_constants(law, granule);
      if (granule.tangential_stiffness)
        law.tangential_stiffness_coefficient =
            *granule.tangential_stiffness * std::sqrt(2.0 / granule.reference_radius.value());
      // stiffness * sqrt(2 R / reference) = C sqrt(R)
      law.stiffness_coefficient =
          granule.stiffness
              ? *granule.stiffness * std::sqrt(2.0 / granule.reference_radius.value())
              : elastic_coefficient(a.young.value(), a.poisson.value(), b.young.value(), b.poisson.value());
      pair_laws_.push_back(law);
    }
    Law law = common;
    if (!scene.contact.wall) {
      law = pair_laws_[wall_laws_.size() * (populations_ + 1)];
    } else {
      const ContactConstants& wall = *scene.contact.wall;
      set_constants(law, wall);
      if (wall.tangential_stiffness)
        law.tangential_stiffness_coefficient = *wall.tangential_stiffness / std::sqrt(wall.reference_radius.value());
      // stiffness * sqrt(r / reference) = C sqrt(r)
      law.stiffness_coefficient = wall.stiffness ? *wall.stiffness / std::sqrt(wall.reference_radius.value())
                                                 : elastic_coefficient(a.young.value(), a.poisson.value(),
                                                                       wall.young.value(), wall.poisson.value());
    }
    wall_laws_.push_back(law);
  }

  const double enclosure_velocity = enclosure_.initial_velocity();
  for (std::size_t p = 0; p < populations_; ++p) {
    const Population& population = scene.populations[p];
    if (!population.placed) throw std::invalid_argument("reference run: granules must be placed");
    for (std::size_t g = 0; g < population.positions.size(); ++g) {
      Granule one;
      one.position = population.positions[g];
      if (!population.velocities.empty()) one.velocity = population.velocities[g];
      add(one.velocity, -enclosure_velocity, enclosure_.direction());
      if (!population.spins.empty()) one.spin = population.spins[g];
      one.radius = population.radii.empty() ? population.radius : population.radii[g];
      one.mass = population.masses.empty() ? population.mass : population.masses[g];
      initial_.push_back(one);
      population_.push_back(static_cast<std::int32_t>(p));
    }
  }

  // Friction at many walls' contacts brakes the same structure at once. Each contact's cap takes as the structure's
  // part the mass over the number of granules that can lean on the walls: all of them, or what fits on the walls side
  // by side in hexagons.
  if (enclosure_.structure() && !initial_.empty()) {
    const Enclosure& e = scene.enclosure;
    Vector3 l = e.size;
    if (e.shape == EnclosureShape::cylinder) {
      l = {e.diameter, e.diameter, e.diameter};
      l[static_cast<std::size_t>(e.axis)] = e.height;
    }
    double smallest = initial_.front().radius;
    for (const Granule& one : initial_) smallest = std::min(smallest, one.radius);
    const double area = 2.0 * (l[0] * l[1] + l[1] * l[2] + l[2] * l[0]);
    const double fit = area / (2.0 * std::sqrt(3.0) * smallest * smallest);
    wall_slip_inverse_mass_ = std::max(1.0, std::min(fit, static_cast<double>(initial_.size()))) / enclosure_.mass();
  }

  // Contacts share a slip: those of t = 0 are counted before their forces are used.
  for (const Touch& touch : forces(initial_, initial_, {}, true).touches) count_touch(touch, initial_);

  // Half a step back: u(-1/2) = v0 - dt/2 (F/m + g) in the laboratory, less the enclosure's V(-1/2).
  const Forces at_start = forces(initial_, initial_, {}, true);
  state_.host = enclosure_.start(at_start.reaction);
  state_.granules = initial_;
  state_.kick.resize(initial_.size());
  state_.spin_kick.resize(initial_.size());
  for (std::size_t i = 0; i < initial_.size(); ++i) {
    Granule& one = state_.granules[i];
    add(one.velocity, enclosure_velocity - state_.host.velocity, enclosure_.direction());
    add(one.velocity, -0.5 * step_ / one.mass, at_start.force[i]);
    add(one.velocity, -0.5 * step_, scene_.gravity);
    add(one.spin, -0.5 * step_ / reference::moment_of_inertia(one), at_start.torque[i]);
    for (std::size_t k = 0; k < 3; ++k) {
      state_.kick[i][k] = 2.0 * (initial_[i].velocity[k] - one.velocity[k]);
      state_.spin_kick[i][k] = 2.0 * (initial_[i].spin[k] - one.spin[k]);
    }
  }
}

const Law& ReferenceRun::pair_law(std::size_t i, std::size_t j) const {
  return pair_laws_[static_cast<std::size_t>(population_[i]) * populations_ + static_cast<std::size_t>(population_[j])];
}

const Law& ReferenceRun::wall_law(std::size_t i) const {
  return wall_laws_[static_cast<std::size_t>(population_[i])];
}

void ReferenceRun::count_touch(const Touch& touch, std::vector<Granule>& granules) {
  ++granules[touch.i].touching;
  if (touch.j != touch.i) ++granules[touch.j].touching;
}

ReferenceRun::Forces ReferenceRun::forces(const std::vector<Granule>& moving, const std::vector<Granule>& arrived,
                                          const Springs& springs, bool at_start) const {
  Forces all;
  const auto spring_of = [&](std::size_t a, std::size_t b) {
    const auto found = springs.find({a, b});
    return found == springs.end() ? reference::Spring{} : found->second;
  };
  const auto arrival_of = [&](const Granule& a, const Granule& b) {
    return at_start ? reference::Arrival{} : reference::Arrival{a.velocity, a.spin, b.velocity, b.spin};
  };
  const std::size_t count = moving.size();
  all.force.resize(count);
  all.torque.resize(count);
  const Enclosure& box = scene_.enclosure;
  for (std::size_t i = 0; i < count; ++i) {
    const Granule& one = moving[i];
    const auto walls = box.shape == EnclosureShape::box
                           ? reference::box_walls(box.size, one.position)
                           : reference::cylinder_walls(box.diameter, box.height, box.axis, one.position);
    for (std::size_t w = 0; w < walls.size(); ++w) {
      const reference::WallPoint& wall = walls[w];
      // A granule on a cylinder's axis is told of its ends alone.
      const std::size_t number = count + w + (box.shape == EnclosureShape::cylinder ? 3 - walls.size() : 0);
      if (wall.distance >= one.radius) continue;
      const double damping_mass =
          enclosure_.structure()
              ? reference::wall_effective_mass(one.mass, wall.outward, enclosure_.direction(), enclosure_.mass())
              : one.mass;
      const double slip_mass = 1.0 / (1.0 / one.mass + wall_slip_inverse_mass_);
      const reference::Arrival arrival = arrival_of(arrived[i], {});
      const reference::Contact contact =
          reference::wall_contact(one, wall.distance, wall.outward, wall_law(i), step_, damping_mass, slip_mass,
                                  spring_of(i, number), &arrival);
      if (!contact.touching) continue;
      add(all.force[i], 1.0, contact.force_i);
      add(all.torque[i], 1.0, contact.torque_i);
      all.reaction -= dot(contact.force_i, enclosure_.direction());
      add(all.wall_force, -1.0, contact.force_i);
      all.elastic += contact.elastic_energy + contact.spring_energy;
      all.spring_wall += contact.spring_energy;
      all.touches.push_back({i, i, number, contact});
    }
  }
  // Every pair is tried; the distances alone first, in plain arrays, which costs a tenth.
  std::vector<double> x(count), y(count), z(count), r(count), apart(count);
  for (std::size_t i = 0; i < count; ++i) {
    x[i] = moving[i].position[0];
    y[i] = moving[i].position[1];
    z[i] = moving[i].position[2];
    r[i] = moving[i].radius;
  }
  for (std::size_t i = 0; i < count; ++i) {
    const Granule& a = moving[i];
    for (std::size_t j = i + 1; j < count; ++j) {
      const double dx = x[j] - x[i], dy = y[j] - y[i], dz = z[j] - z[i], reach = r[i] + r[j];
      apart[j] = dx * dx + dy * dy + dz * dz - 1.000001 * reach * reach;
    }
    for (std::size_t j = i + 1; j < count; ++j) {
      if (apart[j] >= 0.0) continue;
      const Granule& b = moving[j];
      const reference::Arrival arrival = arrival_of(arrived[i], arrived[j]);
      const reference::Contact contact =
          reference::pair_contact(a, b, pair_law(i, j), step_, spring_of(i, j), &arrival);
      if (!contact.touching) continue;
      add(all.force[i], 1.0, contact.force_i);
      add(all.force[j], -1.0, contact.force_i);
      add(all.torque[i], 1.0, contact.torque_i);
      add(all.torque[j], 1.0, contact.torque_j);
      all.elastic += contact.elastic_energy + contact.spring_energy;
      all.spring_granule += contact.spring_energy;
      all.touches.push_back({i, j, 0, contact});
    }
  }
  return all;
}

void ReferenceRun::advance(State& state, Sample* sample, std::vector<Granule>* synchronised) const {
  const std::size_t count = state.granules.size();
  const double now = static_cast<double>(state.step_number) * step_;

  std::vector<Granule> moving = state.granules;
  if (scene_.time.integrator == Integrator::verlet) {
    for (std::size_t i = 0; i < count; ++i) {
      if (state.step_number == 0) {
        moving[i].velocity = initial_[i].velocity;
        moving[i].spin = initial_[i].spin;
      } else {
        add(moving[i].velocity, 0.5, state.kick[i]);
        add(moving[i].spin, 0.5, state.spin_kick[i]);
      }
    }
  }
  const Forces acting = forces(moving, state.granules, state.springs, state.step_number == 0);
  state.springs.clear();
  for (const Touch& touch : acting.touches)
    state.springs[{touch.i, touch.j == touch.i ? touch.wall : touch.j}] = touch.contact.memory;

  // The enclosure over the interval about t_n.
  ReferenceHost before = state.host, middle = state.host, after = state.host;
  before.work_in = before.loss = 0.0;
  if (enclosure_.structure()) {
    middle = enclosure_.advance_structure(before, now - 0.5 * step_, now, acting.reaction);
    after = enclosure_.advance_structure(middle, now, now + 0.5 * step_, acting.reaction);
  } else {
    after.velocity =
        (enclosure_.prescribed_displacement(now + step_) - enclosure_.prescribed_displacement(now)) / step_;
    middle.displacement = enclosure_.prescribed_displacement(now);
    middle.velocity = enclosure_.prescribed_velocity(now);
    middle.work_in = -acting.reaction * 0.5 * (before.velocity + after.velocity) * 0.5 * step_;
    after.work_in = 2.0 * middle.work_in;
  }
  Vector frame_kick{};
  add(frame_kick, after.velocity - before.velocity, enclosure_.direction());

  std::vector<Granule> mean = state.granules, velocity = state.granules, last = state.granules, early = state.granules;
  for (std::size_t i = 0; i < count; ++i) {
    Granule& one = state.granules[i];
    const Granule old = one;
    reference::move(one, acting.force[i], acting.torque[i], scene_.gravity, frame_kick, step_);
    for (std::size_t k = 0; k < 3; ++k) {
      const double kick = one.velocity[k] - old.velocity[k], spin_kick = one.spin[k] - old.spin[k];
      mean[i].velocity[k] = 0.5 * (old.velocity[k] + one.velocity[k]);
      mean[i].spin[k] = 0.5 * (old.spin[k] + one.spin[k]);
      velocity[i].velocity[k] = mean[i].velocity[k] + state.kick[i][k] / 12.0;
      velocity[i].spin[k] = mean[i].spin[k] + state.spin_kick[i][k] / 12.0;
      early[i].velocity[k] = 0.5 * (velocity[i].velocity[k] - 0.25 * kick); // half of the kick comes after t_n
      early[i].spin[k] = 0.5 * (velocity[i].spin[k] - 0.25 * spin_kick);
      last[i].velocity[k] = -kick / 12.0;
      last[i].spin[k] = -spin_kick / 12.0;
      state.kick[i][k] = kick;
      state.spin_kick[i][k] = spin_kick;
    }
  }

  for (Granule& one : state.granules) one.touching = 0;
  for (const Touch& touch : acting.touches) count_touch(touch, state.granules);

  // The ledger, with the velocities at t_n of the path that the positions lie on, v - (kick after - kick before) / 12:
  // a contact's last part is known when the next step's kick is.
  Ledger lost, lost_before; // in the whole step, and before t_n
  const auto lose = [&](Ledger& sum, const std::vector<Touch>& touches, const std::vector<Granule>& moving_at) {
    for (const Touch& touch : touches) {
      if (touch.j == touch.i) {
        const auto power = reference::wall_dissipation(touch.contact, moving_at[touch.i], wall_law(touch.i));
        sum.normal_wall += power.normal * step_;
        sum.friction_wall += power.friction * step_;
      } else {
        const auto power = reference::pair_dissipation(touch.contact, moving_at[touch.i], moving_at[touch.j],
                                                       pair_law(touch.i, touch.j));
        sum.normal_granule += power.normal * step_;
        sum.friction_granule += power.friction * step_;
      }
    }
  };
  lose(lost, acting.touches, velocity);
  lose(lost_before, acting.touches, early);
  for (Ledger* sum : {&lost, &lost_before}) lose(*sum, state.touches_before, last);
  for (const Touch& touch : acting.touches) {
    const double smaller = std::min(mean[touch.i].radius, mean[touch.j].radius);
    state.max_overlap = std::max(state.max_overlap, touch.contact.overlap / smaller);
  }
  state.touches_before = acting.touches;
  const auto book = [&](double share, const Ledger& losses, const ReferenceHost& host) {
    state.ledger.normal_granule += share * losses.normal_granule;
    state.ledger.normal_wall += share * losses.normal_wall;
    state.ledger.friction_granule += share * losses.friction_granule;
    state.ledger.friction_wall += share * losses.friction_wall;
    state.ledger.work_in += host.work_in;
    state.ledger.structural_damping += host.loss;
  };

  // Laboratory velocities at t_n: the mean of the half-step ones, so that a free granule's does not change at all.
  if (sample || synchronised)
    for (Granule& one : mean) add(one.velocity, 0.5 * (before.velocity + after.velocity), enclosure_.direction());
  if (synchronised) *synchronised = mean;
  if (sample) {
    const Ledger start_of_step = state.ledger;
    // At the very start nothing has been lost yet: the half step before t = 0 is not part of the run.
    if (state.step_number > 0) book(1.0, lost_before, middle);
    sample->time = now;
    sample->displacement = middle.displacement;
    sample->velocity = middle.velocity;
    sample->excitation = enclosure_.force(now);
    sample->reaction = acting.reaction;
    sample->wall_force = acting.wall_force;
    sample->contacts = static_cast<std::int64_t>(acting.touches.size());
    sample->ledger = state.ledger;
    sample->ledger.friction_granule -= acting.spring_granule;
    sample->ledger.friction_wall -= acting.spring_wall;
    sample->stored.elastic = acting.elastic;
    sample->stored.structure = enclosure_.stored(middle);
    for (std::size_t i = 0; i < count; ++i) {
      Vector laboratory = mean[i].position;
      add(laboratory, middle.displacement, enclosure_.direction());
      Granule counted = mean[i];
      if (!rotation_) counted.spin = {}; // spins that nothing can change are no part of the balance
      sample->stored.kinetic += reference::kinetic_energy(counted);
      sample->stored.gravitational -= mean[i].mass * dot(scene_.gravity, laboratory);
    }
    state.ledger = start_of_step;
  }
  if (state.step_number > 0) {
    book(1.0, lost, after);
  } else {
    after.work_in -= middle.work_in;
    after.loss -= middle.loss;
    book(0.5, lost, after);
  }
  after.work_in = after.loss = 0.0;
  state.host = after;
  ++state.step_number;
}

Sample ReferenceRun::sample() const {
  State copy = state_;
  Sample result;
  advance(copy, &result);
  return result;
}

GranuleTable ReferenceRun::granules() const {
  State copy = state_;
  std::vector<Granule> now;
  advance(copy, nullptr, &now);
  GranuleTable table;
  for (std::size_t i = 0; i < now.size(); ++i) {
    table.position.push_back(now[i].position);
    table.velocity.push_back(now[i].velocity);
    table.spin.push_back(now[i].spin);
    table.radius.push_back(now[i].radius);
    table.population.push_back(population_[i]);
  }
  return table;
}

} // namespace grandamp::test
