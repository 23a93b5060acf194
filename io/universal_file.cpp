#include "io/universal_file.hpp"

#include <array>
#include <cmath>
#include <fmt/format.h>
#include <iterator>
#include <utility>

namespace grandamp {
namespace {

constexpr int node = 1;

/// A record of up to 80 characters; never blank, and never one that could end the dataset.
std::string id_line(const std::string& text) {
  std::string line;
  for (const char c : text) {
    const bool printable = c >= ' ' && c <= '~';
    if (line.empty() && (c == ' ' || !printable)) continue;
    line += printable ? c : '?';
    if (line.size() == 80) break;
  }
  while (!line.empty() && line.back() == ' ') line.pop_back();
  return line.empty() || line == "-1" ? "NONE" : line;
}

struct Date {
  std::string day, time;
};

Date date_of(std::time_t written) {
  static constexpr std::array months{"JAN", "FEB", "MAR", "APR", "MAY", "JUN",
                                     "JUL", "AUG", "SEP", "OCT", "NOV", "DEC"};
  std::tm utc{};
  gmtime_r(&written, &utc);
  return {
      fmt::format("{:02d}-{}-{:02d}", utc.tm_mday, months.at(static_cast<std::size_t>(utc.tm_mon)), utc.tm_year % 100),
      fmt::format("{:02d}:{:02d}:{:02d}", utc.tm_hour, utc.tm_min, utc.tm_sec)};
}

class Writer {
public:
  template <class... Values> void line(fmt::format_string<Values...> format, Values&&... values) {
    fmt::format_to(std::back_inserter(text_), format, std::forward<Values>(values)...);
    text_ += '\n';
  }
  void begin(int dataset) {
    line("{:6d}", -1);
    line("{:6d}", dataset);
  }
  void end() { line("{:6d}", -1); }
  /// Records 8 to 11 of dataset 58.
  void axis(int type, int length, int force, const char* label, const char* units) {
    line("{:10d}{:5d}{:5d}{:5d} {:<20} {:<20}", type, length, force, 0, label, units);
  }
  std::string take() { return std::move(text_); }

private:
  std::string text_;
};

enum FunctionType { frequency_response = 4, coherence = 6 };
enum OrdinateType { real_double = 4, complex_double = 6 };
enum AxisType { unknown = 0, displacement = 8, excitation_force = 13, frequency = 18 };

void write_header(Writer& writer, const UniversalHeader& header) {
  const Date date = date_of(header.written);
  writer.begin(151);
  writer.line("{}", id_line(header.title));
  writer.line("{}", id_line("Frequency response of a structure with a granular damper"));
  writer.line("{}", id_line(header.program));
  writer.line("{:<10}{:<10}{:10d}{:10d}{:10d}", date.day, date.time, 0, 0, 0);
  writer.line("{:<10}{:<10}", date.day, date.time);
  writer.line("{}", id_line(header.program));
  writer.line("{:<10}{:<10}", date.day, date.time);
  writer.end();
  writer.begin(164);
  writer.line("{:10d}{:<20}{:10d}", 1, "SI: Meter (newton)", 2);
  writer.line("{0:>25}{0:>25}{0:>25}", "1.00000000000000000D+00");
  writer.line("{:>25}", "2.73149999999999977D+02");
  writer.end();
  writer.begin(15);
  writer.line("{:10d}{:10d}{:10d}{:10d}{:13.5E}{:13.5E}{:13.5E}", node, 0, 0, 1, 0.0, 0.0, 0.0);
  writer.end();
}

void write_function(Writer& writer, const FrequencyResponse& response, const UniversalHeader& header,
                    FunctionType type) {
  const bool is_response = type == frequency_response;
  const Date date = date_of(header.written);
  const int direction = universal_direction(header.direction);
  const Spectra& spectra = response.spectra;
  const std::size_t lines = spectra.frequency.size();
  const bool even = response.even();
  writer.begin(58);
  writer.line("{}",
              is_response ? "Frequency response, displacement over force" : "Coherence of displacement and force");
  writer.line("{}", id_line(header.title));
  writer.line("{:<9} {:<8}", date.day, date.time);
  writer.line("{}", id_line(fmt::format("{}: {} averages, segment {:g} s, settling {:g} s", name(response.method),
                                        spectra.segments, response.segment, response.settling)));
  writer.line("{}", id_line(header.program));
  writer.line("{:5d}{:10d}{:5d}{:10d} {:<10}{:10d}{:4d} {:<10}{:10d}{:4d}", static_cast<int>(type), 1, 0, 0, "NONE",
              node, direction, "NONE", node, direction);
  writer.line("{:10d}{:10d}{:10d}{:13.5E}{:13.5E}{:13.5E}",
              static_cast<int>(is_response ? complex_double : real_double), lines, even ? 1 : 0,
              even ? spectra.frequency.front() : 0.0, even ? spectra.resolution : 0.0, 0.0);
  writer.axis(frequency, 0, 0, "Frequency", "Hz");
  if (is_response) {
    writer.axis(displacement, 1, 0, "Displacement", "m");
    writer.axis(excitation_force, 0, 1, "Force", "N");
  } else {
    writer.axis(unknown, 0, 0, "Coherence", "NONE");
    writer.axis(unknown, 0, 0, "NONE", "NONE");
  }
  writer.axis(unknown, 0, 0, "NONE", "NONE");

  // 4E20.12 at even distances, E13.5,2E20.12 or 2(E13.5,E20.12) at others.
  std::string record;
  for (std::size_t k = 0; k < lines; ++k) {
    if (!even) record += fmt::format("{:13.5E}", spectra.frequency[k]);
    if (is_response)
      record += fmt::format("{:20.12E}{:20.12E}", response.response[k].real(), response.response[k].imag());
    else
      record += fmt::format("{:20.12E}", spectra.coherence(k));
    const std::size_t per_record = is_response ? (even ? 2 : 1) : (even ? 4 : 2);
    if ((k + 1) % per_record != 0 && k + 1 < lines) continue;
    writer.line("{}", record);
    record.clear();
  }
  writer.end();
}

} // namespace

int universal_direction(const Vector3& direction) {
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (std::abs(std::abs(direction[axis]) - 1.0) < 1e-9)
      return direction[axis] > 0.0 ? static_cast<int>(axis) + 1 : -static_cast<int>(axis) - 1;
  return 0;
}

std::string universal_file(const FrequencyResponse& response, const UniversalHeader& header) {
  Writer writer;
  write_header(writer, header);
  write_function(writer, response, header, frequency_response);
  if (response.has_coherence()) write_function(writer, response, header, coherence);
  return writer.take();
}

} // namespace grandamp
