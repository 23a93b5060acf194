#include "solver/several_modes.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

namespace grandamp {

namespace {

using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

Eigen::MatrixXd matrix_of(const std::vector<double>& values, std::size_t rows, std::size_t columns) {
  return Eigen::Map<const RowMatrix>(values.data(), static_cast<Eigen::Index>(rows),
                                     static_cast<Eigen::Index>(columns));
}

double frequency_of(double square) {
  return std::sqrt(std::max(0.0, square)) / (2.0 * std::numbers::pi);
}

} // namespace

LinearStructure linear_structure(const SeveralModes& modes) {
  const std::size_t n = modes.size;
  return {matrix_of(modes.mass, n, n), matrix_of(modes.damping, n, n), matrix_of(modes.stiffness, n, n),
          matrix_of(modes.attachment, 3, n), matrix_of(modes.force, n, 1)};
}

ModalNumbers modal_numbers(const SeveralModes& modes, double added_mass) {
  using Solver = Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>;
  const LinearStructure s = linear_structure(modes);
  ModalNumbers numbers;
  const Solver own(s.stiffness, s.mass);
  for (Eigen::Index k = 0; k < s.mass.rows(); ++k) {
    const double square = own.eigenvalues()(k);
    const Eigen::VectorXd shape = own.eigenvectors().col(k);
    const double decay = shape.dot(s.damping * shape);
    numbers.frequency.push_back(frequency_of(square));
    numbers.damping_ratio.push_back(square > 0.0 ? 0.5 * decay / std::sqrt(square) : 0.0);
  }
  numbers.fastest_decay = std::max(0.0, Solver(s.damping, s.mass, Eigen::EigenvaluesOnly).eigenvalues().maxCoeff());
  const Eigen::Matrix3d mobility = s.attachment * s.mass.llt().solve(s.attachment.transpose());
  for (Eigen::Index i = 0; i < 3; ++i)
    for (Eigen::Index k = 0; k < 3; ++k)
      numbers.mobility[static_cast<std::size_t>(3 * i + k)] = 0.5 * (mobility(i, k) + mobility(k, i));
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> shown(0.5 * (mobility + mobility.transpose()));
  numbers.enclosure_mass = 1.0 / shown.eigenvalues().maxCoeff();
  const Eigen::MatrixXd loaded = s.mass + added_mass * s.attachment.transpose() * s.attachment;
  numbers.loaded_frequency = frequency_of(Solver(s.stiffness, loaded, Eigen::EigenvaluesOnly).eigenvalues()(0));
  return numbers;
}

Oscillator fastest_oscillator(const Structure& structure) {
  if (structure.modes.size == 0) return {structure.mass, structure.stiffness, structure.damping};
  const ModalNumbers numbers = modal_numbers(structure.modes);
  const double mass = numbers.enclosure_mass, fastest = 2.0 * std::numbers::pi * numbers.frequency.back();
  return {mass, mass * fastest * fastest, mass * numbers.fastest_decay};
}

std::vector<MatrixFault> faults_of(const SeveralModes& modes) {
  std::vector<MatrixFault> faults;
  const std::size_t n = modes.size;
  if (n > static_cast<std::size_t>(DrivenStructure::most))
    return {{"size", fmt::format("{} degrees of freedom", n), fmt::format("at most {}", DrivenStructure::most)}};
  const auto lengths = [&](const char* key, const std::vector<double>& values, std::size_t wanted) {
    if (values.size() != wanted)
      faults.push_back({key, fmt::format("{} numbers", values.size()), fmt::format("{}", wanted)});
    else if (!std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); }))
      faults.push_back({key, "not finite", "finite numbers"});
  };
  lengths("mass", modes.mass, n * n);
  lengths("damping", modes.damping, n * n);
  lengths("stiffness", modes.stiffness, n * n);
  lengths("attachment", modes.attachment, 3 * n);
  lengths("force", modes.force, n);
  lengths("displacement", modes.displacement, n);
  lengths("velocity", modes.velocity, n);
  if (!faults.empty()) return faults;
  const LinearStructure s = linear_structure(modes);
  const auto check = [&](const char* key, const Eigen::MatrixXd& matrix, bool positive) {
    const double size = matrix.cwiseAbs().maxCoeff();
    if ((matrix - matrix.transpose()).cwiseAbs().maxCoeff() > 1.0e-9 * size) {
      faults.push_back({key, "not symmetric", "a symmetric matrix"});
      return;
    }
    const double least =
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(matrix, Eigen::EigenvaluesOnly).eigenvalues()(0);
    if (positive && !(least > 1.0e-13 * size))
      faults.push_back({key, "some motion has no mass", "a positive definite matrix"});
    if (!positive && least < -1.0e-9 * size)
      faults.push_back({key, "some motion would gain energy", "a matrix without negative eigenvalues"});
  };
  check("mass", s.mass, true);
  check("damping", s.damping, false);
  check("stiffness", s.stiffness, false);
  if (s.attachment.cwiseAbs().maxCoeff() == 0.0)
    faults.push_back({"attachment", "the enclosure does not move", "a shape that is not zero at the enclosure"});
  return faults;
}

} // namespace grandamp
