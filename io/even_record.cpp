#include "io/even_record.hpp"

#include <algorithm>

namespace grandamp {
namespace {

double hermite(const ResponseHistory& rows, std::size_t k, double time) {
  const double length = rows.time[k + 1] - rows.time[k], s = (time - rows.time[k]) / length;
  const double there = (1.0 + 2.0 * s) * (1.0 - s) * (1.0 - s), here = s * s * (3.0 - 2.0 * s);
  return there * rows.displacement[k] + here * rows.displacement[k + 1] +
         length * s * (1.0 - s) * ((1.0 - s) * rows.velocity[k] - s * rows.velocity[k + 1]);
}

double lagrange(const std::vector<double>& times, const std::vector<double>& values, std::size_t k, double time) {
  const std::size_t points = std::min<std::size_t>(4, times.size());
  const std::size_t first = std::min(k > 0 ? k - 1 : 0, times.size() - points);
  double sum = 0.0;
  for (std::size_t i = first; i < first + points; ++i) {
    double weight = 1.0;
    for (std::size_t j = first; j < first + points; ++j)
      if (j != i) weight *= (time - times[j]) / (times[i] - times[j]);
    sum += weight * values[i];
  }
  return sum;
}

} // namespace

EvenRecord even_record(const ResponseHistory& rows, double start, double interval, std::size_t count) {
  EvenRecord record;
  record.interval = interval;
  record.displacement.reserve(count);
  record.force.reserve(count);
  std::size_t k = 0;
  for (std::size_t n = 0; n < count; ++n) {
    const double time = std::clamp(start + static_cast<double>(n) * interval, rows.time.front(), rows.time.back());
    while (k + 2 < rows.time.size() && rows.time[k + 1] <= time) ++k;
    record.displacement.push_back(hermite(rows, k, time));
    record.force.push_back(lagrange(rows.time, rows.force, k, time));
  }
  return record;
}

} // namespace grandamp
