// The machine that a run's times belong to.
#pragma once

#include <string>

namespace pneuma::app {

struct Machine {
  std::string cpu;  // model name; "unknown" where the system does not say
  int cores = 1;    // that this process may use
  std::string os;   // "Debian GNU/Linux 12 (bookworm), Linux 6.1.0"
};

Machine machine();

}  // namespace pneuma::app
