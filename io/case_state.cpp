#include "io/case_pool.hpp"

#include "io/text_file.hpp"
#include "solver/errors.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <fstream>
#include <iterator>
#include <system_error>

namespace grandamp {

namespace {

namespace fs = std::filesystem;

nlohmann::json read_json(const fs::path& file) {
  std::ifstream stream(file);
  return nlohmann::json::parse(stream, nullptr, false);
}

/// A run holds a lock on its folder (io/run_folder.hpp).
bool runs_now(const fs::path& folder) {
  const int file = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (file < 0) return false;
  const bool locked = flock(file, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  close(file);
  return locked;
}

/// The scene as run begins with the overrides that made it: those of another case are another case.
void demand_overrides(const CaseJob& job) {
  std::ifstream file(job.folder / "scene.toml");
  std::string line;
  std::vector<std::string> found;
  constexpr std::string_view mark = "# --set ";
  while (std::getline(file, line) && line.starts_with('#'))
    if (line.starts_with(mark)) found.push_back(line.substr(mark.size()));
  if (file.is_open() && found != job.overrides)
    throw FileError(fmt::format("{}: holds another case than {}; remove the folder, or choose another with -o",
                                job.folder.string(), fmt::format("{}", fmt::join(job.overrides, " "))));
}

} // namespace

const char* name(CaseStatus status) {
  switch (status) {
  case CaseStatus::missing:
    return "missing";
  case CaseStatus::started:
    return "started";
  case CaseStatus::running_elsewhere:
    return "running";
  case CaseStatus::done:
    return "done";
  case CaseStatus::failed:
    return "failed";
  }
  return "";
}

CaseState state_of(const CaseJob& job) {
  std::error_code error;
  if (!fs::exists(job.folder, error)) return {};
  demand_overrides(job);
  const nlohmann::json summary = read_json(job.folder / "summary.json");
  const nlohmann::json status = summary.is_object() ? summary.value("status", nlohmann::json()) : nlohmann::json();
  if (status == "done") return {CaseStatus::done, 0, ""};
  if (runs_now(job.folder)) return {CaseStatus::running_elsewhere, 0, ""};
  if (status == "stopped by a guard")
    return {CaseStatus::failed, 3,
            summary.value("message", nlohmann::json()).is_string() ? summary["message"] : nlohmann::json("")};
  const nlohmann::json failure = read_json(job.folder / "failure.json");
  if (failure.is_object() && failure.value("status", nlohmann::json()).is_number_integer() &&
      failure.value("error", nlohmann::json()).is_string())
    return {CaseStatus::failed, failure["status"], failure["error"]};
  return {fs::exists(job.folder / "scene.toml", error) ? CaseStatus::started : CaseStatus::missing, 0, ""};
}

void note_failure(const CaseJob& job, int exit_status, const std::string& error) {
  const nlohmann::json failure{{"status", exit_status}, {"error", error}};
  std::error_code made;
  fs::create_directories(job.folder, made);
  if (made) throw FileError(job.folder.string() + ": cannot make the folder: " + made.message());
  replace_shared_file(job.folder / "failure.json",
                      failure.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
}

std::string summary_of(const CaseJob& job) {
  std::ifstream file(job.folder / "summary.json");
  return {std::istreambuf_iterator<char>(file), {}};
}

void replace_shared_file(const fs::path& path, const std::string& text) {
  std::array<char, 256> host{};
  gethostname(host.data(), host.size() - 1);
  replace_file(path, text, fmt::format(".{}.{}.new", host.data(), getpid()));
}

} // namespace grandamp
