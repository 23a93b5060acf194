#include "io/results.hpp"
#include "io/text_file.hpp"

#include <fmt/format.h>

#include <iterator>

namespace grandamp {
namespace {

std::string_view view(const fmt::memory_buffer& text) {
  return {text.data(), text.size()};
}

} // namespace

void export_history(const History& history, const std::filesystem::path& csv) {
  TextFile file(csv);
  fmt::memory_buffer line;
  fmt::format_to(std::back_inserter(line), "{}\n", fmt::join(history.names, ","));
  file.write(view(line));
  const std::size_t rows = history.columns.empty() ? 0 : history.columns.front().size();
  for (std::size_t row = 0; row < rows; ++row) {
    line.clear();
    for (std::size_t column = 0; column < history.columns.size(); ++column) {
      fmt::format_to(std::back_inserter(line), "{}{:.17g}", column == 0 ? "" : ",", history.columns[column][row]);
    }
    line.push_back('\n');
    file.write(view(line));
  }
  file.close();
}

void export_granules(const GranuleTable& granules, const std::filesystem::path& csv) {
  TextFile file(csv);
  fmt::memory_buffer line;
  fmt::format_to(std::back_inserter(line), "id,x,y,z,radius,vx,vy,vz,wx,wy,wz\n");
  file.write(view(line));
  for (std::size_t id = 0; id < granules.position.size(); ++id) {
    line.clear();
    const Vector3& x = granules.position[id];
    const Vector3& v = granules.velocity[id];
    const Vector3& w = granules.spin[id];
    fmt::format_to(std::back_inserter(line),
                   "{},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g}\n", id, x[0],
                   x[1], x[2], granules.radius[id], v[0], v[1], v[2], w[0], w[1], w[2]);
    file.write(view(line));
  }
  file.close();
}

} // namespace grandamp
