// The discrete Fourier transform of real records.
#pragma once

#include <complex>
#include <cstddef>
#include <vector>

namespace grandamp {

/// The smallest length that is no less, a multiple of 4 and has no prime factor above 5: other lengths cost far more.
std::size_t transform_length(std::size_t at_least);

/// sum_n values[n] exp(-2 pi i k n / N) for k = 0 ... N/2.
std::vector<std::complex<double>> half_spectrum(const std::vector<double>& values);

} // namespace grandamp
