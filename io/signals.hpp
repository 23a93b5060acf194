// What the system asks of a run by signals.
#pragma once

#include <csignal>

namespace grandamp {

/// While it lives SIGTERM and SIGINT ask for a checkpoint and an end, SIGUSR1 for a checkpoint alone. A SIGINT after
/// either of the first two ends the program at once, with status 130: whoever waits at a terminal need not wait.
/// At most one lives at a time.
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
  struct sigaction old_interrupt_ {};
  struct sigaction old_terminate_ {};
  struct sigaction old_user_ {};
};

} // namespace grandamp
