#include "io/signals.hpp"

#include <unistd.h>

namespace grandamp {
namespace {

// A signal handler can reach nothing else.
volatile std::sig_atomic_t stop = 0;
volatile std::sig_atomic_t checkpoint = 0;

void on_signal(int signal) {
  if (signal == SIGUSR1) {
    checkpoint = 1;
  } else {
    if (signal == SIGINT && stop != 0) _exit(130);
    stop = 1;
  }
}

} // namespace

SignalWatch::SignalWatch() {
  stop = 0;
  checkpoint = 0;
  for (std::size_t k = 0; k < watched.size(); ++k) {
    sigaction(watched[k], nullptr, &old_[k]);
    if (watched[k] == SIGHUP && old_[k].sa_handler == SIG_IGN) continue;
    struct sigaction action {};
    action.sa_handler = watched[k] == SIGPIPE ? SIG_IGN : on_signal;
    action.sa_flags = SA_RESTART;
    sigemptyset(&action.sa_mask);
    sigaction(watched[k], &action, nullptr);
  }
}

SignalWatch::~SignalWatch() {
  for (std::size_t k = 0; k < watched.size(); ++k) sigaction(watched[k], &old_[k], nullptr);
}

bool SignalWatch::stop_requested() noexcept {
  return stop != 0;
}

bool SignalWatch::take_checkpoint_request() noexcept {
  if (checkpoint == 0) return false;
  checkpoint = 0;
  return true;
}

} // namespace grandamp
