#include "solver/excitation_signal.hpp"

#include "solver/measures.hpp"
#include "solver/periodic_random_force.hpp"
#include "solver/random_force.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace grandamp {

namespace {

using std::numbers::pi;
constexpr double infinity = std::numeric_limits<double>::infinity();

/// `factor` times the instant without its whole part: as good after 10^9 cycles as in the first.
double fraction_of(double factor, Instant instant) {
  const double product = factor * instant.time;
  const double error = std::fma(factor, instant.time, -product);
  return (product - std::floor(product)) + (error + factor * instant.rest);
}

class Chirp : public ForceSignal {
public:
  Chirp(const Excitation& e, double amplitude, double duration)
      : amplitude_(amplitude), start_(e.start_frequency), duration_(duration), period_(e.period.value_or(infinity)),
        logarithm_(e.sweep == Sweep::logarithmic ? std::log(e.end_frequency / e.start_frequency) : 0.0),
        rate_(logarithm_ == 0.0 ? (e.end_frequency - e.start_frequency) / duration : 0.0) {}

  double at(Instant instant) const override {
    if (instant.time + instant.rest < 0.0) return 0.0;
    if (const double sweeps = begun(instant.time + instant.rest); sweeps > 0.0)
      instant.time = std::fma(-sweeps, period_, instant.time);
    const double time = instant.time + instant.rest;
    if (time > duration_) return 0.0;
    double cycles = 0.0;
    if (logarithm_ != 0.0) {
      // The frequency grows as start exp(logarithm t / duration).
      cycles = start_ * duration_ / logarithm_ * std::expm1(logarithm_ * time / duration_);
      cycles -= std::floor(cycles);
    } else {
      // start t + rate t^2 / 2, both with their rounding errors.
      const double half_rate = 0.5 * rate_ * instant.time;
      const double error = std::fma(0.5 * rate_, instant.time, -half_rate);
      cycles = fraction_of(start_, instant) + fraction_of(half_rate, instant) +
               (error * instant.time + (half_rate + 0.5 * rate_ * instant.rest) * instant.rest);
    }
    return amplitude_ * std::sin(2.0 * pi * cycles);
  }

  double next_break(double time) const override {
    if (time < 0.0) return 0.0;
    if (std::isinf(period_)) return time < duration_ ? duration_ : infinity;
    for (double sweep = begun(time);; ++sweep)
      for (const double jump : {sweep * period_ + duration_, (sweep + 1.0) * period_})
        if (jump > time) return jump;
  }

private:
  /// Sweeps that were over before the one of that time.
  double begun(double time) const { return std::isinf(period_) ? 0.0 : std::floor(time / period_); }

  double amplitude_, start_, duration_;
  double period_;    ///< s from one sweep to the next; infinite: there is one
  double logarithm_; ///< of end over start; 0: linear
  double rate_;      ///< Hz/s, linear
};

class Impulse : public ForceSignal {
public:
  explicit Impulse(const Excitation& e) : amplitude_(*e.force), start_(e.start), duration_(e.pulse_duration) {}

  double at(Instant instant) const override {
    const double place = ((instant.time - start_) + instant.rest) / duration_;
    return place > 0.0 && place < 1.0 ? amplitude_ * std::sin(pi * place) : 0.0;
  }

  /// Besides start and end, parts short enough for a few points each, however long a step.
  double next_break(double time) const override {
    constexpr double parts = 8.0;
    if (time < start_) return start_;
    const double part = std::floor((time - start_) / duration_ * parts) + 1.0;
    if (part > parts) return infinity;
    const double found = part < parts ? start_ + part / parts * duration_ : start_ + duration_;
    return found > time ? found : std::nextafter(time, infinity);
  }

private:
  double amplitude_, start_, duration_;
};

class TableForce : public ForceSignal {
public:
  explicit TableForce(const Excitation& e)
      : force_(e.interpolation == Interpolation::linear ? PiecewisePolynomial::lines(e.times, e.values)
                                                        : PiecewisePolynomial::cubic_spline(e.times, e.values)) {}

  double at(Instant instant) const override {
    const double time = instant.time + instant.rest;
    return time < force_.knots().front() || time > force_.knots().back() ? 0.0 : force_.at(instant).value;
  }

  double next_break(double time) const override {
    const auto found = std::upper_bound(force_.knots().begin(), force_.knots().end(), time);
    return found == force_.knots().end() ? infinity : *found;
  }

private:
  PiecewisePolynomial force_;
};

} // namespace

std::unique_ptr<ForceSignal> make_force_signal(const Scene& scene) {
  const Excitation& e = scene.excitation;
  switch (e.kind) {
  case ExcitationKind::chirp:
    return std::make_unique<Chirp>(e, driving_force(scene),
                                   e.sweep_duration.value_or(e.period.value_or(scene.time.duration)));
  case ExcitationKind::random:
    if (e.period) return std::make_unique<PeriodicRandomForce>(e.force_rms, e.band, *e.period, scene.seed, e.seed);
    return std::make_unique<RandomForce>(e.force_rms, e.band, scene.seed, e.seed);
  case ExcitationKind::impulse:
    return std::make_unique<Impulse>(e);
  case ExcitationKind::table:
    if (e.quantity == TableQuantity::force) return std::make_unique<TableForce>(e);
    break;
  case ExcitationKind::none:
  case ExcitationKind::harmonic:
  case ExcitationKind::prescribed:
  case ExcitationKind::base:
    break;
  }
  return nullptr;
}

PiecewisePolynomial make_motion(const Excitation& e) {
  if (e.quantity == TableQuantity::displacement) return PiecewisePolynomial::cubic_spline(e.times, e.values);
  const PiecewisePolynomial acceleration = e.interpolation == Interpolation::linear
                                               ? PiecewisePolynomial::lines(e.times, e.values)
                                               : PiecewisePolynomial::cubic_spline(e.times, e.values);
  return acceleration.integral_from(0.0).integral_from(0.0);
}

bool is_motion_table(const Excitation& e) noexcept {
  return e.kind == ExcitationKind::table && e.quantity != TableQuantity::force;
}

double largest_force(const Scene& scene) {
  const Excitation& e = scene.excitation;
  switch (e.kind) {
  case ExcitationKind::harmonic:
  case ExcitationKind::chirp:
  case ExcitationKind::impulse:
    return std::abs(driving_force(scene));
  case ExcitationKind::random:
    return 4.5 * e.force_rms;
  case ExcitationKind::base:
    return base_force(scene);
  case ExcitationKind::table: {
    if (e.quantity != TableQuantity::force) return 0.0;
    double largest = 0.0;
    for (const double value : e.values) largest = std::max(largest, std::abs(value));
    return largest;
  }
  case ExcitationKind::none:
  case ExcitationKind::prescribed:
    break;
  }
  return 0.0;
}

double highest_frequency(const Excitation& e) noexcept {
  if (e.kind == ExcitationKind::chirp) return std::max(e.start_frequency, e.end_frequency);
  return e.kind == ExcitationKind::random ? e.band[1] : 0.0;
}

} // namespace grandamp
