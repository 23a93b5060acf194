#include "io/table_file.hpp"

#include "io/csv_text.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <string_view>

namespace grandamp {

namespace {

constexpr std::array<std::string_view, 3> quantities{"force", "displacement", "acceleration"};

class TableParser {
public:
  explicit TableParser(TableFile& result) : result_(result) {}

  void parse(std::string_view content) {
    skip_byte_order_mark(content);
    ++line_;
    if (!read_header(next_line(content))) return;
    while (!content.empty() && result_.faults.size() < most_faults) {
      ++line_;
      const std::string_view line = trimmed(next_line(content));
      if (!line.empty()) read_row(line);
    }
    if (result_.faults.empty() && result_.times.size() < 2)
      fault(
          fmt::format("{} below the header; allowed: two or more", result_.times.empty() ? "no rows" : "a single row"));
  }

private:
  void fault(const std::string& message) { result_.faults.push_back(fmt::format("line {}: {}", line_, message)); }

  bool read_header(std::string_view header) {
    bool more = true;
    std::vector<std::string_view> names;
    while (more && names.size() < 3) names.push_back(next_field(header, more));
    const auto time = std::find(names.begin(), names.end(), "time");
    const std::string_view other = names.size() == 2 && time != names.end() ? names[time == names.begin() ? 1 : 0] : "";
    const auto quantity = std::find(quantities.begin(), quantities.end(), other);
    if (quantity == quantities.end()) {
      fault(fmt::format("no header of two columns, 'time' and one of {}", fmt::join(quantities, ", ")));
      return false;
    }
    time_first_ = time == names.begin();
    result_.quantity = static_cast<TableQuantity>(quantity - quantities.begin());
    return true;
  }

  void read_row(std::string_view line) {
    std::array<double, 2> numbers{};
    bool more = true;
    for (double& number : numbers) {
      if (!more) return fault("one field where the header has 2");
      const std::string_view field = next_field(line, more);
      if (!read_number(field, number)) return fault(fmt::format("'{}': not a finite number", field.substr(0, 40)));
    }
    if (more) return fault("more fields than the 2 of the header");
    const double time = numbers[time_first_ ? 0 : 1];
    if (!result_.times.empty() && !(time > result_.times.back()))
      return fault(fmt::format("time = {}: not after the row before, {} s", time, result_.times.back()));
    result_.times.push_back(time);
    result_.values.push_back(numbers[time_first_ ? 1 : 0]);
  }

  TableFile& result_;
  std::size_t line_ = 0;
  bool time_first_ = true;
};

} // namespace

TableFile parse_table(const std::string& content) {
  TableFile result;
  TableParser(result).parse(content);
  return result;
}

TableFile read_table_file(const std::filesystem::path& file) {
  const CsvContent content = read_csv(file);
  if (content.fault.empty()) return parse_table(content.text);
  TableFile result;
  result.faults.push_back(content.fault);
  result.unreadable = true;
  return result;
}

} // namespace grandamp
