#include "viewer/programs/quit_signal.h"

#include <pthread.h>

#include <csignal>
#include <ctime>
#include <stop_token>
#include <utility>

namespace pixelflex::viewer {

sigset_t quitSignals() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  struct sigaction hangup {};
  if (sigaction(SIGHUP, nullptr, &hangup) == 0 && hangup.sa_handler != SIG_IGN) sigaddset(&signals, SIGHUP);
  return signals;
}

QuitSignal::QuitSignal(std::function<void()> onQuit) : onQuit_(std::move(onQuit)) {
  const sigset_t signals = quitSignals();
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  // The destructor wakes the thread with SIGINT as well, so it need not poll.
  thread_ = std::jthread([this](const std::stop_token& stop) {
    const sigset_t waited = quitSignals();
    int signal = 0;
    if (sigwait(&waited, &signal) != 0 || stop.stop_requested()) return;
    raised_ = true;
    onQuit_();
  });
}

QuitSignal::~QuitSignal() {
  thread_.request_stop();
  pthread_kill(thread_.native_handle(), SIGINT);
  thread_.join();
}

}  // namespace pixelflex::viewer
