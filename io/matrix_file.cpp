#include "io/matrix_file.hpp"

#include "io/csv_text.hpp"
#include "solver/several_modes.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <string_view>

namespace grandamp {

namespace {

constexpr std::array<std::string_view, 7> words{"mass", "damping", "stiffness", "x", "y", "z", "force"};

class MatrixParser {
  enum Word : std::size_t { mass, damping, stiffness, x, y, z, force };

public:
  explicit MatrixParser(MatrixFile& result) : result_(result) {}

  void parse(std::string_view content, const Vector3& direction) {
    skip_byte_order_mark(content);
    while (!content.empty() && result_.faults.size() < most_faults) {
      ++line_;
      const std::string_view line = trimmed(next_line(content));
      if (!line.empty()) read_row(line);
    }
    if (result_.faults.empty()) take(direction);
  }

private:
  void fault(const std::string& message) { result_.faults.push_back(fmt::format("line {}: {}", line_, message)); }

  void read_row(std::string_view line) {
    bool more = true;
    const std::string_view name = next_field(line, more);
    const auto word = static_cast<std::size_t>(std::find(words.begin(), words.end(), name) - words.begin());
    if (word == words.size())
      return fault(fmt::format("'{}': unknown row; allowed: {}", name.substr(0, 40), fmt::join(words, ", ")));
    std::size_t count = 0;
    while (more) {
      double number = 0.0;
      const std::string_view field = next_field(line, more);
      if (!read_number(field, number)) return fault(fmt::format("'{}': not a finite number", field.substr(0, 40)));
      rows_[word].push_back(number);
      ++count;
    }
    if (size_ == 0) size_ = count;
    if (count == 0 || count != size_) return fault(fmt::format("{} numbers, where the first row has {}", count, size_));
    if (size_ > static_cast<std::size_t>(DrivenStructure::most))
      return fault(fmt::format("{} degrees of freedom; allowed: at most {}", size_, DrivenStructure::most));
    const std::size_t most = word <= stiffness ? size_ : 1;
    if (rows_[word].size() > most * size_) fault(fmt::format("more than {} rows of {}", most, words[word]));
  }

  void take(const Vector3& direction) {
    if (size_ == 0) return fault(fmt::format("no rows; allowed: {}", fmt::join(words, ", ")));
    if (rows_[damping].empty()) rows_[damping].assign(size_ * size_, 0.0);
    for (const Word word : {mass, damping, stiffness})
      if (rows_[word].size() != size_ * size_)
        fault(fmt::format("{} rows of {}; allowed: {}", rows_[word].size() / size_, words[word], size_));
    SeveralModes& modes = result_.modes;
    modes.size = size_;
    modes.mass = rows_[mass];
    modes.damping = rows_[damping];
    modes.stiffness = rows_[stiffness];
    for (const Word word : {x, y, z}) {
      if (rows_[word].empty()) rows_[word].assign(size_, 0.0);
      modes.attachment.insert(modes.attachment.end(), rows_[word].begin(), rows_[word].end());
    }
    modes.force = rows_[force];
    if (modes.force.empty())
      for (std::size_t i = 0; i < size_; ++i)
        modes.force.push_back(direction[0] * rows_[x][i] + direction[1] * rows_[y][i] + direction[2] * rows_[z][i]);
    modes.displacement.assign(size_, 0.0);
    modes.velocity.assign(size_, 0.0);
    if (!result_.faults.empty()) return;
    for (const MatrixFault& wrong : faults_of(modes))
      result_.faults.push_back(fmt::format("{}: {}; allowed: {}", wrong.key, wrong.message, wrong.allowed));
  }

  MatrixFile& result_;
  std::array<std::vector<double>, words.size()> rows_;
  std::size_t size_ = 0, line_ = 0;
};

} // namespace

MatrixFile parse_matrices(const std::string& content, const Vector3& direction) {
  MatrixFile result;
  MatrixParser(result).parse(content, direction);
  return result;
}

MatrixFile read_matrix_file(const std::filesystem::path& file, const Vector3& direction) {
  const CsvContent content = read_csv(file);
  if (content.fault.empty()) return parse_matrices(content.text, direction);
  MatrixFile result;
  result.faults.push_back(content.fault);
  result.unreadable = true;
  return result;
}

} // namespace grandamp
