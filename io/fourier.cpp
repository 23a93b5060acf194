#include "io/fourier.hpp"

#include <unsupported/Eigen/FFT>

namespace grandamp {

std::size_t transform_length(std::size_t at_least) {
  for (std::size_t quarter = (at_least + 3) / 4;; ++quarter) {
    std::size_t left = quarter > 0 ? quarter : ++quarter;
    for (const std::size_t factor : {std::size_t{2}, std::size_t{3}, std::size_t{5}})
      while (left % factor == 0) left /= factor;
    if (left == 1) return 4 * quarter;
  }
}

std::vector<std::complex<double>> half_spectrum(const std::vector<double>& values) {
  Eigen::FFT<double> transform; // kissfft, Eigen's own
  transform.SetFlag(Eigen::FFT<double>::HalfSpectrum);
  std::vector<std::complex<double>> spectrum;
  transform.fwd(spectrum, values);
  return spectrum;
}

} // namespace grandamp
