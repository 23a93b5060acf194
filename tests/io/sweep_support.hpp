// What the tests of sweeps and of optimisations share.
#pragma once

#include "tests/io/io_support.hpp"

#include <nlohmann/json.hpp>

#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace grandamp::test {

/// A CSV without quoted commas, row by row under its header.
inline std::vector<std::map<std::string, std::string>> rows_of(const std::filesystem::path& csv) {
  const std::vector<std::string> lines = lines_of(content_of(csv));
  const auto fields = [](const std::string& line) {
    std::vector<std::string> found(1);
    bool quoted = false;
    for (const char c : line) {
      if (c == '"') quoted = !quoted;
      if (c == ',' && !quoted)
        found.emplace_back();
      else
        found.back() += c;
    }
    return found;
  };
  const std::vector<std::string> header = fields(lines.at(0));
  std::vector<std::map<std::string, std::string>> rows;
  for (std::size_t k = 1; k < lines.size(); ++k) {
    const std::vector<std::string> values = fields(lines[k]);
    if (values.size() != header.size()) throw std::runtime_error("a row of another width: " + lines[k]);
    for (std::size_t i = 0; i < header.size(); ++i) rows.resize(k), rows[k - 1][header[i]] = values[i];
  }
  return rows;
}

inline nlohmann::json json_of(const std::filesystem::path& file) {
  return nlohmann::json::parse(content_of(file));
}

/// When the summaries of all runs under a folder were written: those that ran again differ.
inline std::map<std::string, std::filesystem::file_time_type> runs_in(const std::filesystem::path& folder) {
  std::map<std::string, std::filesystem::file_time_type> found;
  for (const auto& entry : std::filesystem::directory_iterator(folder / "runs"))
    if (const auto summary = entry.path() / "summary.json";
        std::filesystem::exists(summary) && json_of(summary)["status"] == "done")
      found[entry.path().filename().string()] = std::filesystem::last_write_time(summary);
  return found;
}

} // namespace grandamp::test
