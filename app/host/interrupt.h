// SIGINT (Ctrl-C) and SIGTERM, so that a run ends between two frames.
#pragma once

namespace pneuma::app {

/// From now on the first of these signals is only remembered; a second one ends the process as
/// ever. A write beyond a file size limit becomes an error instead of the end of the process.
void catch_signals();

bool interrupted();

/// Throws Interrupted if the process has been asked to stop.
void throw_if_interrupted();

}  // namespace pneuma::app
