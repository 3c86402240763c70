// How many threads a simulation may be asked to have.
#pragma once

namespace pneuma::app {

inline constexpr int max_threads = 256;  // at least 1

}  // namespace pneuma::app
