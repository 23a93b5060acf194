// One process of this program, started, watched and asked to stop. Internal to io.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <sys/types.h>

namespace grandamp {

class CaseProcess {
public:
  /// Starts this very program with these arguments; what it says goes to the end of `log`. It has a process group of
  /// its own, so that a terminal's Ctrl-C reaches it through us alone, and is asked to stop if we die. Throws
  /// FileError.
  CaseProcess(const std::vector<std::string>& arguments, const std::filesystem::path& log);
  CaseProcess(CaseProcess&& other) noexcept;
  CaseProcess& operator=(CaseProcess&& other) noexcept;
  /// Asks it to stop, and waits.
  ~CaseProcess();

  /// Its exit status, or 128 and the signal that ended it; nothing while it runs.
  std::optional<int> ended();
  void ask_to_stop() noexcept;

private:
  pid_t process_ = -1;
};

/// What the log says went wrong, or else what the status means.
std::string told_error(const std::filesystem::path& log, int status);

} // namespace grandamp
