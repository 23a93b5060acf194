// A function of time made of polynomials between knots.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace grandamp {

/// An instant, `time` + `rest` in s: `rest` holds what `time` was rounded by, so that a phase keeps its digits.
struct Instant {
  double time = 0.0;
  double rest = 0.0;
};

/// A value and its first two derivatives by time.
struct Jet {
  double value = 0.0;
  double rate = 0.0;
  double acceleration = 0.0;
};

/// Before the first knot and after the last the outermost polynomials go on.
class PiecewisePolynomial {
public:
  PiecewisePolynomial() = default;
  /// Through the points: the cubic spline that is smooth to its second derivative, third included at the second knot
  /// and the last but one. Two points: a line; three: a parabola. Times increase; at least two.
  static PiecewisePolynomial cubic_spline(const std::vector<double>& times, const std::vector<double>& values);
  static PiecewisePolynomial lines(const std::vector<double>& times, const std::vector<double>& values);

  /// The integral that is zero at `time`.
  PiecewisePolynomial integral_from(double time) const;

  Jet at(Instant instant) const;
  const std::vector<double>& knots() const noexcept { return knots_; }

private:
  static constexpr std::size_t coefficients = 6; ///< up to the fifth degree
  std::size_t piece_at(double time) const;

  std::vector<double> knots_;
  std::vector<std::array<double, coefficients>> pieces_; ///< in powers of the time since their first knot
};

} // namespace grandamp
