// Reads universal files by the columns of the format's description; knows nothing of what wrote them.
#pragma once

#include <complex>
#include <stdexcept>
#include <string>
#include <vector>

namespace grandamp::test {

struct UniversalDataset {
  int number = 0;
  std::vector<std::string> records;
};

/// A function at a nodal degree of freedom: dataset 58.
struct UniversalFunction {
  std::vector<std::string> id;
  int type = 0, response_node = 0, response_direction = 0, reference_node = 0, reference_direction = 0;
  std::string response_entity, reference_entity;
  int ordinate_type = 0, points = 0, spacing = 0;
  struct Axis {
    int type = 0, length = 0, force = 0, temperature = 0;
    std::string label, units;
  };
  Axis abscissa, ordinate, denominator, z;
  std::vector<double> x;
  std::vector<std::complex<double>> y;
};

/// Columns from `begin`, `width` of them; what a Fortran read would see beyond the end of a record is blank.
inline std::string columns(const std::string& record, std::size_t begin, std::size_t width) {
  std::string field = begin < record.size() ? record.substr(begin, width) : "";
  const auto first = field.find_first_not_of(' ');
  return first == std::string::npos ? "" : field.substr(first, field.find_last_not_of(' ') - first + 1);
}

inline int whole(const std::string& record, std::size_t begin, std::size_t width) {
  const std::string field = columns(record, begin, width);
  std::size_t used = 0;
  const int value = std::stoi(field, &used);
  if (used != field.size()) throw std::runtime_error("no integer: " + field);
  return value;
}

inline double real(const std::string& record, std::size_t begin, std::size_t width) {
  std::string field = columns(record, begin, width);
  for (char& c : field)
    if (c == 'D' || c == 'd') c = 'E';
  std::size_t used = 0;
  const double value = std::stod(field, &used);
  if (used != field.size()) throw std::runtime_error("no real number: " + field);
  return value;
}

inline std::vector<UniversalDataset> universal_datasets(const std::vector<std::string>& lines) {
  std::vector<UniversalDataset> datasets;
  bool inside = false;
  for (std::size_t n = 0; n < lines.size(); ++n) {
    if (lines[n] == "    -1") {
      inside = !inside;
      if (inside) datasets.push_back({whole(lines.at(++n), 0, 6), {}});
    } else if (inside) {
      datasets.back().records.push_back(lines[n]);
    } else {
      throw std::runtime_error("a record outside any dataset: " + lines[n]);
    }
  }
  if (inside) throw std::runtime_error("the last dataset does not end");
  return datasets;
}

inline UniversalFunction::Axis universal_axis(const std::string& record) {
  return {whole(record, 0, 10), whole(record, 10, 5),    whole(record, 15, 5),
          whole(record, 20, 5), columns(record, 26, 20), columns(record, 47, 20)};
}

inline UniversalFunction universal_function(const UniversalDataset& dataset) {
  const std::vector<std::string>& r = dataset.records;
  UniversalFunction f;
  f.id.assign(r.begin(), r.begin() + 5);
  f.type = whole(r.at(5), 0, 5);
  f.response_entity = columns(r[5], 31, 10);
  f.response_node = whole(r[5], 41, 10);
  f.response_direction = whole(r[5], 51, 4);
  f.reference_entity = columns(r[5], 56, 10);
  f.reference_node = whole(r[5], 66, 10);
  f.reference_direction = whole(r[5], 76, 4);
  f.ordinate_type = whole(r.at(6), 0, 10);
  f.points = whole(r[6], 10, 10);
  f.spacing = whole(r[6], 20, 10);
  const double minimum = real(r[6], 30, 13), increment = real(r[6], 43, 13);
  f.abscissa = universal_axis(r.at(7));
  f.ordinate = universal_axis(r.at(8));
  f.denominator = universal_axis(r.at(9));
  f.z = universal_axis(r.at(10));
  const bool complex = f.ordinate_type == 6, even = f.spacing == 1;
  std::size_t record = 11, column = 0;
  const auto next = [&](std::size_t width) {
    if (column + width > 80 || column >= r.at(record).size()) {
      ++record;
      column = 0;
    }
    const double value = real(r.at(record), column, width);
    column += width;
    return value;
  };
  for (int n = 0; n < f.points; ++n) {
    if (!even && complex && n > 0) { // E13.5,2E20.12: a point per record
      ++record;
      column = 0;
    }
    f.x.push_back(even ? minimum + n * increment : next(13));
    const double re = next(20);
    f.y.emplace_back(re, complex ? next(20) : 0.0);
  }
  if (record + 1 != r.size()) throw std::runtime_error("records beyond the last point");
  return f;
}

} // namespace grandamp::test
