#include "solver/piecewise_polynomial.hpp"

#include <algorithm>

namespace grandamp {

namespace {

/// Slopes of the spline at the knots: tridiagonal equations, of which the first and the last say that the third
/// derivative does not jump at the knots next to the ends.
std::vector<double> spline_slopes(const std::vector<double>& t, const std::vector<double>& y) {
  const std::size_t n = t.size();
  std::vector<double> step(n - 1), secant(n - 1);
  for (std::size_t k = 0; k + 1 < n; ++k) {
    step[k] = t[k + 1] - t[k];
    secant[k] = (y[k + 1] - y[k]) / step[k];
  }
  if (n == 2) return {secant[0], secant[0]};
  if (n == 3) {
    const double bend = (secant[1] - secant[0]) / (step[0] + step[1]);
    return {secant[0] - bend * step[0], secant[0] + bend * step[0], secant[1] + bend * step[1]};
  }
  std::vector<double> below(n), middle(n), above(n), right(n);
  const auto end = [](double near, double far, double near_secant, double far_secant) {
    return ((near + 2.0 * (near + far)) * far * near_secant + near * near * far_secant) / (near + far);
  };
  middle[0] = step[1];
  above[0] = step[0] + step[1];
  right[0] = end(step[0], step[1], secant[0], secant[1]);
  for (std::size_t k = 1; k + 1 < n; ++k) {
    below[k] = step[k];
    middle[k] = 2.0 * (step[k - 1] + step[k]);
    above[k] = step[k - 1];
    right[k] = 3.0 * (step[k] * secant[k - 1] + step[k - 1] * secant[k]);
  }
  middle[n - 1] = step[n - 3];
  below[n - 1] = step[n - 3] + step[n - 2];
  right[n - 1] = end(step[n - 2], step[n - 3], secant[n - 2], secant[n - 3]);
  for (std::size_t k = 1; k < n; ++k) {
    const double factor = below[k] / middle[k - 1];
    middle[k] -= factor * above[k - 1];
    right[k] -= factor * right[k - 1];
  }
  std::vector<double> slope(n);
  slope[n - 1] = right[n - 1] / middle[n - 1];
  for (std::size_t k = n - 1; k-- > 0;) slope[k] = (right[k] - above[k] * slope[k + 1]) / middle[k];
  return slope;
}

} // namespace

PiecewisePolynomial PiecewisePolynomial::cubic_spline(const std::vector<double>& times,
                                                      const std::vector<double>& values) {
  PiecewisePolynomial spline;
  spline.knots_ = times;
  const std::vector<double> slope = spline_slopes(times, values);
  for (std::size_t k = 0; k + 1 < times.size(); ++k) {
    const double h = times[k + 1] - times[k], secant = (values[k + 1] - values[k]) / h;
    spline.pieces_.push_back({values[k], slope[k], (3.0 * secant - 2.0 * slope[k] - slope[k + 1]) / h,
                              (slope[k] + slope[k + 1] - 2.0 * secant) / (h * h), 0.0, 0.0});
  }
  return spline;
}

PiecewisePolynomial PiecewisePolynomial::lines(const std::vector<double>& times, const std::vector<double>& values) {
  PiecewisePolynomial result;
  result.knots_ = times;
  for (std::size_t k = 0; k + 1 < times.size(); ++k)
    result.pieces_.push_back({values[k], (values[k + 1] - values[k]) / (times[k + 1] - times[k]), 0.0, 0.0, 0.0, 0.0});
  return result;
}

PiecewisePolynomial PiecewisePolynomial::integral_from(double time) const {
  PiecewisePolynomial result = *this;
  double sum = 0.0;
  for (std::size_t k = 0; k < pieces_.size(); ++k) {
    auto& piece = result.pieces_[k];
    for (std::size_t power = coefficients - 1; power > 0; --power)
      piece[power] = pieces_[k][power - 1] / static_cast<double>(power);
    piece[0] = sum;
    double length = knots_[k + 1] - knots_[k], value = 0.0;
    for (std::size_t power = coefficients; power-- > 0;) value = value * length + piece[power];
    sum = value;
  }
  const double there = result.at({time, 0.0}).value;
  for (auto& piece : result.pieces_) piece[0] -= there;
  return result;
}

std::size_t PiecewisePolynomial::piece_at(double time) const {
  const auto after = std::upper_bound(knots_.begin() + 1, knots_.end() - 1, time);
  return static_cast<std::size_t>(after - knots_.begin()) - 1;
}

Jet PiecewisePolynomial::at(Instant instant) const {
  const std::size_t k = piece_at(instant.time + instant.rest);
  const auto& c = pieces_[k];
  const double s = (instant.time - knots_[k]) + instant.rest;
  Jet jet;
  for (std::size_t power = coefficients; power-- > 0;) {
    jet.acceleration = jet.acceleration * s + 2.0 * jet.rate;
    jet.rate = jet.rate * s + jet.value;
    jet.value = jet.value * s + c[power];
  }
  return jet;
}

} // namespace grandamp
