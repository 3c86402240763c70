#include "app/interrupt.h"

#include <csignal>

#include "app/errors.h"

namespace pneuma::app {
namespace {

volatile std::sig_atomic_t asked_to_stop = 0;

void remember(int) { asked_to_stop = 1; }

}  // namespace

void catch_signals() {
  struct sigaction action = {};
  action.sa_handler = remember;
  action.sa_flags = SA_RESTART | static_cast<int>(SA_RESETHAND);
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  std::signal(SIGXFSZ, SIG_IGN);
}

bool interrupted() { return asked_to_stop != 0; }

void throw_if_interrupted() {
  if (interrupted()) throw Interrupted("interrupted");
}

}  // namespace pneuma::app
