// What the system asks of a run by signals.
#pragma once

#include <array>
#include <csignal>

namespace grandamp {

/// While it lives SIGTERM, SIGINT and SIGHUP (a terminal that goes away, unless nohup has it ignored) ask for a
/// checkpoint and an end, SIGUSR1 for a checkpoint alone. A SIGINT after any of the first three ends the program at
/// once, with status 130: whoever waits at a terminal need not wait. SIGPIPE is ignored: a reader of messages that
/// dies must not take hours of work with it. At most one lives at a time.
class SignalWatch {
public:
  SignalWatch();
  ~SignalWatch();
  SignalWatch(const SignalWatch&) = delete;
  SignalWatch& operator=(const SignalWatch&) = delete;

  static bool stop_requested() noexcept;
  /// True once per request.
  static bool take_checkpoint_request() noexcept;

private:
  static constexpr std::array watched{SIGINT, SIGTERM, SIGHUP, SIGUSR1, SIGPIPE};
  std::array<struct sigaction, watched.size()> old_{};
};

} // namespace grandamp
