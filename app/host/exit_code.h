// What the program tells its caller.
#pragma once

namespace pneuma::app {

enum class ExitCode {
  done = 0,
  internal_error = 1,  // an error of the program itself
  usage = 2,           // the command line is wrong
  invalid_scene = 3,   // scene or model invalid, or not readable
  no_gl = 4,
  diverged = 5,  // a step came to no valid state (find_divergence.h), or a body was lost
  input_output = 6,
  check_failed = 7,
  interrupted = 130,  // 128 + SIGINT, as shells have it
};

}  // namespace pneuma::app
