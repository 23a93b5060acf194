// Random numbers that are the same on every machine and with every standard library.
#pragma once

#include "solver/scene.hpp"

#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace grandamp {

/// xoshiro256** (Blackman and Vigna), seeded through splitmix64. `stream` tells apart the uses of one scene's seed.
class RandomNumbers {
public:
  RandomNumbers(std::uint64_t seed, std::uint64_t stream) {
    std::uint64_t mixed = seed ^ (stream * 0xd1342543de82ef95ULL);
    for (std::uint64_t& word : state_) {
      mixed += 0x9e3779b97f4a7c15ULL;
      std::uint64_t z = mixed;
      z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
      z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
      word = z ^ (z >> 31);
    }
  }

  std::uint64_t bits() {
    const std::uint64_t result = rotated(state_[1] * 5, 7) * 9;
    const std::uint64_t shifted = state_[1] << 17;
    state_[2] ^= state_[0];
    state_[3] ^= state_[1];
    state_[1] ^= state_[2];
    state_[0] ^= state_[3];
    state_[2] ^= shifted;
    state_[3] = rotated(state_[3], 45);
    return result;
  }

  /// In [0, 1).
  double uniform() { return static_cast<double>(bits() >> 11) * 0x1.0p-53; }
  double uniform(double least, double most) { return least + (most - least) * uniform(); }

  /// 0 to count - 1; the bias, below 2^-21 for any number of granules, is nothing here.
  std::size_t below(std::size_t count) { return static_cast<std::size_t>(uniform() * static_cast<double>(count)); }

  /// Evenly on the unit sphere (Marsaglia): no sine, which would differ between machines.
  Vector3 direction() {
    for (;;) {
      const double a = uniform(-1.0, 1.0), b = uniform(-1.0, 1.0), square = a * a + b * b;
      if (square >= 1.0) continue;
      const double factor = 2.0 * std::sqrt(1.0 - square);
      return {a * factor, b * factor, 1.0 - 2.0 * square};
    }
  }

  template <class T> void shuffle(std::vector<T>& values) {
    for (std::size_t k = values.size(); k > 1; --k) std::swap(values[k - 1], values[below(k)]);
  }

private:
  static std::uint64_t rotated(std::uint64_t value, int by) { return (value << by) | (value >> (64 - by)); }

  std::uint64_t state_[4];
};

} // namespace grandamp
