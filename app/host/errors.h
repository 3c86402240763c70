// What can go wrong, as exceptions of one name each, and the exit code that each becomes:
//   UsageError            2   the options do not fit together
//   scenes::SceneError    3   scene invalid or not readable
//   assets::ModelError    3   model invalid or not readable
//   render::GlError       4
//   DivergenceError       5
//   base::IoError       6
//   Interrupted         130   asked to stop by SIGINT or SIGTERM
#pragma once

#include <stdexcept>

namespace pneuma::app {

struct UsageError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct DivergenceError : std::runtime_error {
  using std::runtime_error::runtime_error;
  bool tried_parts = false;    // of the step, which diverged too
  bool is_crushed = false;     // the body, between others: no step helps
  bool is_of_contact = false;  // what failed
  bool has_no_room = false;    // a box, beside what is moved: no step helps either
  int steps_per_second = 0;    // of which steps would do, if these are too long
};

struct Interrupted : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace pneuma::app
