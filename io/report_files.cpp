#include "io/report_files.hpp"

#include "io/json.hpp"
#include "solver/errors.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <fstream>

namespace grandamp::report {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> fields_of(const std::string& line) {
  std::vector<std::string> fields(1);
  bool quoted = false;
  for (const char c : line) {
    if (c == '"')
      quoted = !quoted;
    else if (c == ',' && !quoted)
      fields.emplace_back();
    else if (c != '\r')
      fields.back() += c;
  }
  return fields;
}

double number_in(const std::string& field) {
  char* end = nullptr;
  const double value = std::strtod(field.c_str(), &end);
  return field.empty() || *end != '\0' ? not_known : value;
}

} // namespace

double number(const Json& json, std::string_view path) {
  const Json::json_pointer pointer(std::string("/").append(path));
  if (!json.is_object() || !json.contains(pointer)) return not_known;
  const Json& value = json.at(pointer);
  return value.is_number() ? value.get<double>() : not_known;
}

double number_of(const Json& object, const std::string& key) {
  if (!object.is_object()) return not_known;
  const auto found = object.find(key);
  return found != object.end() && found->is_number() ? found->get<double>() : not_known;
}

std::string text(const Json& json, std::string_view path) {
  const Json::json_pointer pointer(std::string("/").append(path));
  if (!json.is_object() || !json.contains(pointer)) return "";
  const Json& value = json.at(pointer);
  return value.is_string() ? value.get<std::string>() : "";
}

Json read_json(const fs::path& file, const std::vector<std::string>& arrays) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw FileError(file.string() + ": cannot read the file");
  Json json = Json::parse(stream, nullptr, false);
  if (!json.is_object()) throw FileError(file.string() + ": is damaged: not a JSON object");
  for (const std::string& name : arrays)
    if (!json.contains(name) || !json[name].is_array())
      throw FileError(file.string() + ": is damaged: has no list \"" + name + "\"");
  return json;
}

const std::vector<double>* CsvColumns::find(std::string_view name) const {
  const auto found = std::find(names.begin(), names.end(), name);
  return found == names.end() ? nullptr : &values[static_cast<std::size_t>(found - names.begin())];
}

CsvColumns read_csv(const fs::path& file) {
  std::ifstream stream(file);
  std::string line;
  if (!stream || !std::getline(stream, line)) throw FileError(file.string() + ": cannot read the file");
  CsvColumns columns;
  columns.names = fields_of(line);
  columns.values.resize(columns.names.size());
  for (int row = 2; std::getline(stream, line); ++row) {
    const std::vector<std::string> fields = fields_of(line);
    if (fields.size() != columns.names.size())
      throw FileError(fmt::format("{}:{}: is damaged: {} fields, the header has {}", file.string(), row, fields.size(),
                                  columns.names.size()));
    for (std::size_t k = 0; k < fields.size(); ++k) columns.values[k].push_back(number_in(fields[k]));
  }
  return columns;
}

std::string time_of(const fs::path& file) {
  std::error_code error;
  const auto written = fs::last_write_time(file, error);
  if (error) return "";
  const auto system = std::chrono::time_point_cast<std::chrono::seconds>(std::chrono::file_clock::to_sys(written));
  return fmt::format("{:%Y-%m-%d %H:%M} UTC", fmt::gmtime(std::chrono::system_clock::to_time_t(system)));
}

std::string title_of(const Json& json, const fs::path& folder) {
  if (std::string title = text(json, "title"); !title.empty()) return title;
  const fs::path whole = fs::absolute(folder).lexically_normal();
  const std::string name =
      whole.filename().empty() ? whole.parent_path().filename().string() : whole.filename().string();
  return name.empty() ? std::string("Untitled") : name;
}

} // namespace grandamp::report
