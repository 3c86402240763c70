#include "app/host/interrupt.h"

#include <unistd.h>

#include <atomic>
#include <csignal>
#include <string_view>

#include "app/host/errors.h"
#include "app/host/exit_code.h"

namespace pneuma::app {
namespace {

// Set by a handler and read by several threads.
std::atomic<bool> asked_to_stop = false;
std::atomic<int> nothing_to_keep = 0;  // how many of them exist
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<int>::is_always_lock_free);

/// Calls only what a handler may call. A second signal comes here too and not to SA_RESETHAND's
/// default: programs such as timeout send two at once, of which that would take the first as well.
void take_signal(int signal) {
  const bool again = asked_to_stop.exchange(true);
  if (nothing_to_keep > 0) {
    constexpr std::string_view words = "pneuma: interrupted\n";
    [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, words.data(), words.size());
    _exit(static_cast<int>(ExitCode::interrupted));
  }
  if (!again) return;
  std::signal(signal, SIG_DFL);
  std::raise(signal);  // takes effect at the handler's end
}

}  // namespace

void catch_signals() {
  struct sigaction action = {};
  action.sa_handler = take_signal;
  action.sa_flags = SA_RESTART;
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  std::signal(SIGXFSZ, SIG_IGN);
}

NothingToKeep::NothingToKeep() {
  ++nothing_to_keep;
  if (!asked_to_stop) return;
  --nothing_to_keep;
  throw_if_interrupted();
}

NothingToKeep::~NothingToKeep() { --nothing_to_keep; }

bool interrupted() { return asked_to_stop; }

void throw_if_interrupted() {
  if (interrupted()) throw Interrupted("interrupted");
}

}  // namespace pneuma::app
