// Counts the allocations of a test program. Link support/count_allocations.cpp with
// -Wl,--wrap=malloc (Eigen allocates through malloc, everything else through operator new).
#pragma once

namespace pneuma {

/// Since the program started, over all threads.
long allocation_count();

}  // namespace pneuma
