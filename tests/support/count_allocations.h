// Counts the allocations of a test program that links the CMake target count_allocations.
#pragma once

namespace pneuma {

/// Since the program started, over all threads.
long allocation_count();

}  // namespace pneuma
