// SIGINT (Ctrl-C) and SIGTERM, so that a run ends between two frames.
#pragma once

namespace pneuma::app {

/// From now on the first of these signals is only remembered, but for NothingToKeep; a second one
/// ends the process as ever. A write beyond a file size limit becomes an error instead of the end
/// of the process.
void catch_signals();

/// While one exists, such a signal ends the process at once with the exit code of an interruption:
/// for what takes long without looking whether it is to stop, such as reading a large model or a
/// pipe that nobody writes to, and leaves nothing behind.
class NothingToKeep {
 public:
  NothingToKeep();
  ~NothingToKeep();
  NothingToKeep(const NothingToKeep&) = delete;
  NothingToKeep& operator=(const NothingToKeep&) = delete;
};

template <class Work>
auto with_nothing_to_keep(const Work& work) {
  const NothingToKeep nothing;
  return work();
}

bool interrupted();

/// Throws Interrupted if the process has been asked to stop.
void throw_if_interrupted();

}  // namespace pneuma::app
