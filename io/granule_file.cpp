#include "io/granule_file.hpp"

#include "io/csv_text.hpp"
#include "io/nearest_name.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <numeric>
#include <string_view>

namespace grandamp {

namespace {

constexpr std::array<std::string_view, 12> names{"id", "x",  "y",  "z",  "radius", "density",
                                                 "vx", "vy", "vz", "wx", "wy",     "wz"};

class GranuleParser {
  enum Column : std::size_t { id, x, y, z, radius, density, vx, vy, vz, wx, wy, wz };

public:
  explicit GranuleParser(GranuleFile& result) : result_(result) {}

  void parse(std::string_view content) {
    skip_byte_order_mark(content);
    ++line_;
    if (!read_header(next_line(content))) return;
    reserve(static_cast<std::size_t>(std::count(content.begin(), content.end(), '\n')) + 1);
    while (!content.empty() && result_.faults.size() < most_faults) {
      ++line_;
      const std::string_view line = trimmed(next_line(content));
      if (!line.empty()) read_row(line);
    }
    if (result_.faults.empty() && result_.positions.empty()) fault("no granules below the header");
    if (result_.faults.empty() && has(id)) sort_by_id();
  }

private:
  bool has(Column column) const { return present_[column]; }

  void fault(const std::string& message) { result_.faults.push_back(fmt::format("line {}: {}", line_, message)); }

  bool read_header(std::string_view header) {
    bool more = true;
    while (more && result_.faults.size() < most_faults) {
      const std::string_view name = next_field(header, more);
      const auto found = std::find(names.begin(), names.end(), name);
      if (found == names.end()) {
        const std::string_view nearest = nearest_name(name, names);
        fault(fmt::format("unknown column '{}'{}; allowed: {}", name.substr(0, 40),
                          nearest.empty() ? "" : fmt::format(" (perhaps '{}')", nearest), fmt::join(names, ", ")));
        continue;
      }
      const auto column = static_cast<Column>(found - names.begin());
      if (present_[column]) fault(fmt::format("column '{}' twice", name));
      present_[column] = true;
      order_.push_back(column);
    }
    for (const Column column : {x, y, z})
      if (result_.faults.empty() && !has(column))
        fault(fmt::format("no column '{}'; allowed: a header row with x, y, z and any of {}", names[column],
                          fmt::join(names, ", ")));
    moves_ = has(vx) || has(vy) || has(vz);
    spins_ = has(wx) || has(wy) || has(wz);
    return result_.faults.empty();
  }

  void reserve(std::size_t rows) {
    result_.positions.reserve(rows);
    if (moves_) result_.velocities.reserve(rows);
    if (spins_) result_.spins.reserve(rows);
    if (has(radius)) result_.radii.reserve(rows);
    if (has(density)) result_.densities.reserve(rows);
    if (has(id)) ids_.reserve(rows);
  }

  void read_row(std::string_view line) {
    std::array<double, names.size()> value{};
    std::int64_t number = 0;
    bool more = true;
    for (std::size_t i = 0; i < order_.size(); ++i) {
      if (!more) return fault(fmt::format("{} fields where the header has {}", i, order_.size()));
      const std::string_view field = next_field(line, more);
      const Column column = order_[i];
      const bool good = column == id ? read_number(field, number) && number >= 0 : read_number(field, value[column]);
      if (!good)
        return fault(fmt::format("{} = '{}': not a {}", names[column], field.substr(0, 40),
                                 column == id ? "whole number from 0" : "finite number"));
      if ((column == radius || column == density) && !(value[column] > 0.0))
        return fault(fmt::format("{} = {}: out of range; allowed: above 0", names[column], field));
    }
    if (more) return fault(fmt::format("more fields than the {} of the header", order_.size()));
    result_.positions.push_back({value[x], value[y], value[z]});
    if (moves_) result_.velocities.push_back({value[vx], value[vy], value[vz]});
    if (spins_) result_.spins.push_back({value[wx], value[wy], value[wz]});
    if (has(radius)) result_.radii.push_back(value[radius]);
    if (has(density)) result_.densities.push_back(value[density]);
    if (has(id)) ids_.emplace_back(number, line_);
  }

  void sort_by_id() {
    std::vector<std::size_t> order(ids_.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [this](std::size_t a, std::size_t b) { return ids_[a].first < ids_[b].first; });
    for (std::size_t i = 1; i < order.size(); ++i)
      if (ids_[order[i]].first == ids_[order[i - 1]].first) {
        line_ = ids_[order[i]].second;
        return fault(fmt::format("id {} again, first on line {}", ids_[order[i]].first, ids_[order[i - 1]].second));
      }
    const auto sorted = [&order](auto& list) {
      if (list.empty()) return;
      auto copy = list;
      for (std::size_t i = 0; i < order.size(); ++i) list[i] = copy[order[i]];
    };
    sorted(result_.positions);
    sorted(result_.velocities);
    sorted(result_.spins);
    sorted(result_.radii);
    sorted(result_.densities);
  }

  GranuleFile& result_;
  std::size_t line_ = 0;
  std::array<bool, names.size()> present_{};
  std::vector<Column> order_;
  std::vector<std::pair<std::int64_t, std::size_t>> ids_; // id, line
  bool moves_ = false;
  bool spins_ = false;
};

} // namespace

GranuleFile parse_granules(const std::string& content) {
  GranuleFile result;
  GranuleParser(result).parse(content);
  return result;
}

GranuleFile read_granule_file(const std::filesystem::path& file) {
  const CsvContent content = read_csv(file);
  if (content.fault.empty()) return parse_granules(content.text);
  GranuleFile result;
  result.faults.push_back(content.fault);
  result.unreadable = true;
  return result;
}

} // namespace grandamp
