// The program as a process of its own, which can be sent signals.
#pragma once

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace grandamp::test {

inline void wait_for(double seconds) {
  std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
}

class Process {
public:
  /// `grandamp ARGUMENTS` with what it says appended to `messages`.
  Process(const std::vector<std::string>& arguments, const std::filesystem::path& messages)
      : begun_(std::chrono::steady_clock::now()) {
    std::vector<char*> argv{const_cast<char*>(GRANDAMP_PROGRAM)};
    for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
    argv.push_back(nullptr);
    child_ = fork();
    if (child_ < 0) throw std::runtime_error("no process");
    if (child_ == 0) {
      const int file = open(messages.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0666);
      dup2(file, STDOUT_FILENO);
      dup2(file, STDERR_FILENO);
      execv(GRANDAMP_PROGRAM, argv.data());
      _exit(127);
    }
  }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;
  ~Process() {
    if (status_ != running) return;
    kill(child_, SIGKILL);
    wait();
  }

  void send(int signal) const { kill(child_, signal); }
  bool ended() {
    int status = 0;
    if (status_ == running && waitpid(child_, &status, WNOHANG) == child_) note(status);
    return status_ != running;
  }
  /// The exit status, or 128 and the signal that ended it.
  int wait() {
    int status = 0;
    if (status_ == running && waitpid(child_, &status, 0) == child_) note(status);
    return status_;
  }
  /// True if it ended within so many seconds.
  bool ends_within(double seconds) {
    const auto until = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
    while (!ended() && std::chrono::steady_clock::now() < until) wait_for(0.002);
    return ended();
  }
  /// From its start to its end, or to now, s.
  double seconds() const {
    const auto end = status_ == running ? std::chrono::steady_clock::now() : ended_;
    return std::chrono::duration<double>(end - begun_).count();
  }

private:
  static constexpr int running = -1;
  void note(int status) {
    status_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    ended_ = std::chrono::steady_clock::now();
  }

  std::chrono::steady_clock::time_point begun_, ended_;
  pid_t child_ = -1;
  int status_ = running;
};

} // namespace grandamp::test
