// What a report's page carries, made small enough to be carried: rows thinned without losing a peak, numbers in units
// that read well, bytes as text. Internal to io.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace grandamp::report {

/// Columns of one length over a time that only grows.
struct Rows {
  std::vector<double> time; ///< s
  std::vector<std::vector<double>> columns;
};

/// At most `most` rows. Every so many rows of the many become two, at the times of the first and the last of them, that
/// hold the smallest and the largest value of each column, in the order in which they came. So no peak is lost, and
/// none is moved by more than that. Few rows stay as they are. `most` is at least 2.
Rows thinned(const Rows& rows, std::size_t most);

/// RFC 4648.
std::string base64(std::span<const std::byte> bytes);

/// The bytes of numbers as they lie in memory: little-endian on every machine this runs on.
template <class T> std::span<const std::byte> bytes_of(const std::vector<T>& values) {
  return std::as_bytes(std::span<const T>(values));
}

std::vector<float> as_floats(const std::vector<double>& values);

/// `value` in [low, high] to 0 ... most; beyond it is held at the ends. A range of no length gives 0.
std::uint16_t quantised(double value, double low, double high, std::uint16_t most);

/// An SI unit with the prefix that puts `largest` between 1 and 1000, and what to multiply by.
struct ReadableUnit {
  double factor = 1.0;
  std::string name;
};
ReadableUnit readable_unit(double largest, std::string_view unit);
/// "4.66 mm". Not a number: "not known".
std::string readable(double value, std::string_view unit, int digits = 4);

} // namespace grandamp::report
