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
  struct sigaction action {};
  action.sa_handler = on_signal;
  action.sa_flags = SA_RESTART;
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, &old_interrupt_);
  sigaction(SIGTERM, &action, &old_terminate_);
  sigaction(SIGUSR1, &action, &old_user_);
}

SignalWatch::~SignalWatch() {
  sigaction(SIGINT, &old_interrupt_, nullptr);
  sigaction(SIGTERM, &old_terminate_, nullptr);
  sigaction(SIGUSR1, &old_user_, nullptr);
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
