#include "io/case_process.hpp"

#include "solver/errors.hpp"

#include <fmt/format.h>

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <fstream>
#include <utility>

namespace grandamp {

namespace {

constexpr int not_started = 127; // as shells say it

/// After fork() only what is safe in a signal handler may be called.
[[noreturn]] void become(char* const* arguments, int log, pid_t parent) {
  setpgid(0, 0);
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (getppid() != parent) _exit(130); // died before the line above
  const int nothing = open("/dev/null", O_RDONLY | O_CLOEXEC);
  dup2(nothing, STDIN_FILENO);
  dup2(log, STDOUT_FILENO);
  dup2(log, STDERR_FILENO);
  execv("/proc/self/exe", arguments);
  _exit(not_started);
}

} // namespace

CaseProcess::CaseProcess(const std::vector<std::string>& arguments, const std::filesystem::path& log) {
  std::vector<std::string> texts{"grandamp"};
  texts.insert(texts.end(), arguments.begin(), arguments.end());
  std::vector<char*> pointers;
  pointers.reserve(texts.size() + 1);
  for (std::string& text : texts) pointers.push_back(text.data());
  pointers.push_back(nullptr);
  const int file = open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (file < 0) throw FileError(log.string() + ": cannot create the file: " + std::strerror(errno));
  const pid_t parent = getpid();
  process_ = fork();
  if (process_ == 0) become(pointers.data(), file, parent);
  const int reason = errno;
  close(file);
  if (process_ < 0) throw FileError(fmt::format("cannot start a process: {}", std::strerror(reason)));
}

CaseProcess::CaseProcess(CaseProcess&& other) noexcept : process_(std::exchange(other.process_, -1)) {}

CaseProcess& CaseProcess::operator=(CaseProcess&& other) noexcept {
  std::swap(process_, other.process_);
  return *this;
}

CaseProcess::~CaseProcess() {
  if (process_ < 0) return;
  ask_to_stop();
  int status = 0;
  while (waitpid(process_, &status, 0) < 0 && errno == EINTR) continue;
}

std::optional<int> CaseProcess::ended() {
  int status = 0;
  const pid_t found = waitpid(process_, &status, WNOHANG);
  if (found == 0 || (found < 0 && errno == EINTR)) return std::nullopt;
  process_ = -1;
  if (found < 0) return not_started;
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

void CaseProcess::ask_to_stop() noexcept {
  if (process_ > 0) kill(process_, SIGTERM);
}

std::string told_error(const std::filesystem::path& log, int status) {
  std::ifstream file(log);
  std::string line, told;
  constexpr std::string_view mark = "error: ";
  while (std::getline(file, line) && told.size() < 2000) {
    const std::size_t at = line.find(mark);
    if (at == std::string::npos || at > 8) continue; // colours may stand before it
    told += (told.empty() ? "" : "; ") + line.substr(at + mark.size());
  }
  if (!told.empty()) return told;
  if (status == not_started) return "the program could not be started";
  if (status > 128) return fmt::format("ended by signal {} ({})", status - 128, strsignal(status - 128));
  return fmt::format("ended with status {}", status);
}

} // namespace grandamp
