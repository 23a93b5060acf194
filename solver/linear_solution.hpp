// The exact solution of y' = A y over an interval, and integrals of quadratic forms along the way.
#pragma once

#include <Eigen/Core>
#include <unsupported/Eigen/MatrixFunctions>

#include <array>
#include <cmath>
#include <cstddef>

namespace grandamp {

/// y goes to y + growth y over the interval; y^T work y and y^T loss y of the first y are the integrals of the forms.
template <class Matrix> struct LinearSolution {
  Matrix growth; ///< exp(A) - I: kept without the I, which would cost the small entries their digits
  Matrix work;
  Matrix loss;
};

namespace linear_solution {

template <class Matrix> constexpr bool is_fixed = Matrix::RowsAtCompileTime != Eigen::Dynamic;

/// exp(A) - I = A phi(A), phi being the upper right block of exp([[A, I], [0, 0]]). Every entry is then good to
/// rounding of its own size: over millions of short steps, exp(A) itself would lose the phase.
template <class Matrix> Matrix exponential_less_one(const Matrix& matrix) {
  constexpr int size = Matrix::RowsAtCompileTime;
  if constexpr (is_fixed<Matrix>) {
    using Block = Eigen::Matrix<double, 2 * size, 2 * size>;
    Block block = Block::Zero();
    block.template topLeftCorner<size, size>() = matrix;
    block.template topRightCorner<size, size>().setIdentity();
    const Block exponential = block.exp();
    return matrix * exponential.template topRightCorner<size, size>();
  } else {
    const Eigen::Index n = matrix.rows();
    Matrix block = Matrix::Zero(2 * n, 2 * n);
    block.topLeftCorner(n, n) = matrix;
    block.topRightCorner(n, n).setIdentity();
    const Matrix exponential = block.exp();
    return matrix * exponential.topRightCorner(n, n);
  }
}

/// Integral over [0, 1] of exp(A s)^T form exp(A s), for small A: six-point Gauss-Legendre, exact to rounding.
template <class Matrix> Matrix integral_of(const Matrix& form, const Matrix& matrix) {
  constexpr std::array<double, 3> node{0.2386191860831969, 0.6612093864662645, 0.9324695142031521};
  constexpr std::array<double, 3> weight{0.4679139345726910, 0.3607615730481386, 0.1713244923791704};
  Matrix sum = Matrix::Zero(form.rows(), form.cols());
  for (std::size_t k = 0; k < node.size(); ++k)
    for (const double sign : {-1.0, 1.0}) {
      const Matrix there = Matrix(0.5 * (1.0 + sign * node[k]) * matrix).exp();
      sum += 0.5 * weight[k] * there.transpose() * form * there;
    }
  return sum;
}

template <class Matrix> double size_of(const Matrix& matrix) {
  if constexpr (is_fixed<Matrix>)
    return matrix.template lpNorm<Eigen::Infinity>();
  else
    return matrix.cwiseAbs().rowwise().sum().maxCoeff();
}

} // namespace linear_solution

template <class Matrix> void twice_as_long(LinearSolution<Matrix>& solution) {
  const Matrix whole = Matrix::Identity(solution.growth.rows(), solution.growth.cols()) + solution.growth;
  solution.work = (solution.work + whole.transpose() * solution.work * whole).eval();
  solution.loss = (solution.loss + whole.transpose() * solution.loss * whole).eval();
  solution.growth = (2.0 * solution.growth + solution.growth * solution.growth).eval();
}

/// Over the interval from 0 to 1, `work` and `loss` being the forms to integrate. Starts from a piece so short that the
/// matrix is small, and doubles it: no frequency and no damping is too large.
template <class Matrix>
LinearSolution<Matrix> solve_linear(const Matrix& matrix, const Matrix& work, const Matrix& loss) {
  using namespace linear_solution;
  int doublings = 0;
  for (double norm = size_of(matrix); norm > 0.25 && doublings < 60; norm *= 0.5) ++doublings;
  const double share = std::ldexp(1.0, -doublings);
  const Matrix piece = share * matrix;
  LinearSolution<Matrix> solution{exponential_less_one(piece), share * integral_of(work, piece),
                                  share * integral_of(loss, piece)};
  for (int k = 0; k < doublings; ++k) twice_as_long(solution);
  return solution;
}

} // namespace grandamp
