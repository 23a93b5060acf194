#include "io/results.hpp"
#include "solver/errors.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <iterator>
#include <utility>

namespace grandamp {
namespace {

/// A text file that tells of every failed write, the last one at closing included.
class TextFile {
public:
  explicit TextFile(const std::filesystem::path& path) : path_(path), file_(std::fopen(path.c_str(), "wb")) {
    if (file_ == nullptr) fail("create");
  }
  TextFile(const TextFile&) = delete;
  TextFile& operator=(const TextFile&) = delete;
  ~TextFile() {
    if (file_ != nullptr) std::fclose(file_);
  }

  void write(const fmt::memory_buffer& text) {
    if (std::fwrite(text.data(), 1, text.size(), file_) != text.size()) fail("write");
  }
  void close() {
    std::FILE* const file = std::exchange(file_, nullptr);
    if (std::fclose(file) != 0) fail("write");
  }

private:
  [[noreturn]] void fail(const char* what) const {
    throw FileError(fmt::format("{}: cannot {} the file: {}", path_.string(), what, std::strerror(errno)));
  }

  std::filesystem::path path_;
  std::FILE* file_;
};

} // namespace

void export_history(const History& history, const std::filesystem::path& csv) {
  TextFile file(csv);
  fmt::memory_buffer line;
  fmt::format_to(std::back_inserter(line), "{}\n", fmt::join(history.names, ","));
  file.write(line);
  const std::size_t rows = history.columns.empty() ? 0 : history.columns.front().size();
  for (std::size_t row = 0; row < rows; ++row) {
    line.clear();
    for (std::size_t column = 0; column < history.columns.size(); ++column) {
      fmt::format_to(std::back_inserter(line), "{}{:.17g}", column == 0 ? "" : ",", history.columns[column][row]);
    }
    line.push_back('\n');
    file.write(line);
  }
  file.close();
}

void export_granules(const GranuleTable& granules, const std::filesystem::path& csv) {
  TextFile file(csv);
  fmt::memory_buffer line;
  fmt::format_to(std::back_inserter(line), "id,x,y,z,radius,vx,vy,vz,wx,wy,wz\n");
  file.write(line);
  for (std::size_t id = 0; id < granules.position.size(); ++id) {
    line.clear();
    const Vector3& x = granules.position[id];
    const Vector3& v = granules.velocity[id];
    const Vector3& w = granules.spin[id];
    fmt::format_to(std::back_inserter(line),
                   "{},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g}\n", id, x[0],
                   x[1], x[2], granules.radius[id], v[0], v[1], v[2], w[0], w[1], w[2]);
    file.write(line);
  }
  file.close();
}

} // namespace grandamp
