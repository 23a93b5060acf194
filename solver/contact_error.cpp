#include "solver/contact_error.hpp"

#include "kernels/reference.hpp"
#include "solver/time_step.hpp"

#include <algorithm>
#include <cmath>

namespace grandamp {

namespace {

using reference::Granule;

constexpr int phases = 16;
constexpr double fine_steps = 2000.0;     ///< in T_c, of what counts as converged
constexpr double longest_contact = 100.0; ///< in T_c: an overdamped contact may never end

reference::Law law_of(const Contact& contact, const ContactLaw& constants) {
  reference::Law law;
  law.stiffness_coefficient = constants.stiffness_coefficient;
  law.alpha = constants.alpha;
  law.normal_damping = constants.normal_damping;
  law.friction = constants.friction;
  law.tangential_stiffness_coefficient = constants.tangential_stiffness_coefficient;
  law.tangential_damping = constants.tangential_damping;
  law.tension = contact.tension;
  law.rotation = contact.rotation && contact.friction != FrictionLaw::none;
  law.coulomb = contact.friction == FrictionLaw::coulomb;
  law.spring = contact.friction == FrictionLaw::spring;
  law.damping = contact.damping == NormalDamping::tsuji    ? reference::Damping::tsuji
                : contact.damping == NormalDamping::linear ? reference::Damping::linear
                                                           : reference::Damping::none;
  return law;
}

double square(const std::array<double, 3>& a) {
  return a[0] * a[0] + a[1] * a[1] + a[2] * a[2];
}

/// A granule that meets a wall at x = 0, or its mirror image coming from there.
class SingleContact {
public:
  SingleContact(const ContactKind& kind, const reference::Law& law, double step, Integrator integrator)
      : law_(law), wall_(kind.wall), step_(step), verlet_(integrator == Integrator::verlet), mass_(kind.mass) {
    for (Granule* one : {&i_, &j_}) {
      one->radius = wall_ ? kind.radius : 2.0 * kind.radius;
      one->mass = wall_ ? kind.mass : 2.0 * kind.mass;
    }
  }

  /// `share`: of a step, between the step's start and the touch.
  void start(double normal_speed, double slip_speed, double spin_slip, double share) {
    const double half = wall_ ? 1.0 : 0.5;
    i_.velocity = {half * normal_speed, half * slip_speed, 0.0};
    i_.spin = {0.0, 0.0, half * spin_slip / i_.radius};
    const double back = share * step_;
    i_.position = {-i_.radius - back * i_.velocity[0], -back * i_.velocity[1], 0.0};
    mirror();
    seen_i_ = i_;
    seen_j_ = j_;
  }

  /// Until the granules part, or for `steps`.
  void follow(std::int64_t steps) {
    bool touched = false;
    for (std::int64_t n = 0; n < steps; ++n) {
      const reference::Contact contact = contact_now();
      if (touched && !contact.touching) return;
      touched = contact.touching;
      const int touching = touched ? 1 : 0;
      spring_ = contact.memory;
      const Granule before = i_;
      reference::move(i_, contact.force_i, contact.torque_i, {}, {}, step_);
      mirror();
      i_.touching = j_.touching = touching;
      seen_i_ = i_;
      if (verlet_)
        for (std::size_t k = 0; k < 3; ++k) {
          seen_i_.velocity[k] += 0.5 * (i_.velocity[k] - before.velocity[k]);
          seen_i_.spin[k] += 0.5 * (i_.spin[k] - before.spin[k]);
        }
      seen_j_ = j_;
      for (std::size_t k = 0; k < 3; ++k) seen_j_.velocity[k] = -seen_i_.velocity[k];
      seen_j_.spin = seen_i_.spin;
    }
  }

  const Granule& granule() const { return i_; }

private:
  reference::Contact contact_now() const {
    const reference::Arrival arrival{i_.velocity, i_.spin, j_.velocity, j_.spin};
    if (wall_)
      return reference::wall_contact(seen_i_, -seen_i_.position[0], {1.0, 0.0, 0.0}, law_, step_, mass_, mass_, spring_,
                                     &arrival);
    return reference::pair_contact(seen_i_, seen_j_, law_, step_, spring_, &arrival);
  }

  void mirror() {
    for (std::size_t k = 0; k < 3; ++k) {
      j_.position[k] = -i_.position[k];
      j_.velocity[k] = -i_.velocity[k];
    }
    j_.spin = i_.spin;
  }

  reference::Law law_;
  bool wall_;
  double step_;
  bool verlet_;
  double mass_;
  Granule i_, j_;
  Granule seen_i_, seen_j_; ///< with the velocities that forces see
  reference::Spring spring_;
};

} // namespace

ContactCalibration::ContactCalibration(const Contact& contact, const std::vector<ContactKind>& kinds,
                                       double impact_speed)
    : laws_(contact) {
  impacts_ = {{0.0, 0.0, "head on"}};
  if (contact.friction != FrictionLaw::none) {
    for (const Impact& impact : {Impact{0.5, 0.0, "at 30 degrees"}, Impact{std::sqrt(0.5), 0.0, "at 45 degrees"},
                                 Impact{std::sqrt(0.75), 0.0, "at 60 degrees"}})
      impacts_.push_back(impact);
    if (contact.rotation) impacts_.push_back({0.0, 1.0, "head on with spin"});
  }
  const bool scale_free = contact.damping != NormalDamping::linear && contact.friction != FrictionLaw::spring;
  for (const ContactKind& kind : kinds)
    for (const double share : {1.0, 0.125}) {
      if (share < 1.0 && scale_free) continue;
      Followed& one = followed_.emplace_back(Followed{kind, share * impact_speed, {}});
      const double fine = contact_duration_at(kind.duration, 1.0, one.speed) / fine_steps;
      for (const Impact& impact : impacts_)
        one.converged.push_back(follow(one, impact, fine, 0.5, Integrator::leapfrog));
    }
}

ContactCalibration::Outcome ContactCalibration::follow(const Followed& contact, const Impact& impact, double step,
                                                       double phase, Integrator integrator) const {
  SingleContact single(contact.kind, law_of(laws_, contact.kind.law), step, integrator);
  const double normal = contact.speed * std::sqrt(1.0 - impact.along * impact.along);
  single.start(normal, contact.speed * impact.along, contact.speed * impact.spin, phase);
  const double duration = contact_duration_at(contact.kind.duration, 1.0, normal);
  single.follow(static_cast<std::int64_t>(longest_contact * duration / step) + 2);
  const Granule& end = single.granule();
  Outcome outcome{end.velocity, end.spin};
  for (double& component : outcome.turn) component *= end.radius;
  return outcome;
}

ContactError ContactCalibration::error_at(double step, Integrator integrator) const {
  constexpr double inertia = 0.4; // of a solid sphere, over m r^2
  ContactError worst;
  for (const Followed& contact : followed_)
    for (std::size_t k = 0; k < impacts_.size(); ++k) {
      const Impact& impact = impacts_[k];
      double sum = 0.0;
      for (int p = 0; p < phases; ++p) {
        const Outcome met = follow(contact, impact, step, (p + 0.5) / phases, integrator);
        const Outcome& right = contact.converged[k];
        Vector velocity, turn;
        for (std::size_t c = 0; c < 3; ++c) {
          velocity[c] = met.velocity[c] - right.velocity[c];
          turn[c] = met.turn[c] - right.turn[c];
        }
        sum += square(velocity) + inertia * square(turn);
      }
      const double speed = (contact.kind.wall ? 1.0 : 0.5) * contact.speed;
      const double energy = speed * speed * (1.0 + inertia * impact.spin * impact.spin);
      const double error = std::sqrt(sum / phases / energy);
      if (error <= worst.error) continue;
      worst.error = error;
      worst.contact = contact.kind.name + ", " + impact.name;
    }
  return worst;
}

RestitutionMet ContactCalibration::restitution_at(double step, Integrator integrator) const {
  const auto shortest = std::min_element(followed_.begin(), followed_.end(), [](const auto& a, const auto& b) {
    return contact_duration_at(a.kind.duration, 1.0, a.speed) < contact_duration_at(b.kind.duration, 1.0, b.speed);
  });
  RestitutionMet met;
  if (shortest == followed_.end()) return met;
  const double speed = (shortest->kind.wall ? 1.0 : 0.5) * shortest->speed;
  met.exact = -shortest->converged.front().velocity[0] / speed;
  double squares = 0.0;
  for (int p = 0; p < phases; ++p) {
    const Outcome outcome = follow(*shortest, impacts_.front(), step, (p + 0.5) / phases, integrator);
    const double restitution = -outcome.velocity[0] / speed;
    met.mean += restitution / phases;
    squares += restitution * restitution / phases;
  }
  met.deviation = std::sqrt(std::max(0.0, squares - met.mean * met.mean));
  return met;
}

} // namespace grandamp
