// How long a measurement goes on, and the clocks it is made with.
#pragma once

#include <time.h>

#include <chrono>
#include <cstdint>
#include <optional>

namespace pneuma::app {

using Clock = std::chrono::steady_clock;

inline double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Processor time of the calling thread, s. Unlike the clock it stands still while another process
/// has the core. A reading takes a good part of a microsecond.
inline double thread_seconds() {
  timespec now = {};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

class Budget {
 public:
  /// Exactly so many measurements or, without a number, for so many seconds from now on, but at
  /// least `at_least`.
  Budget(std::optional<std::int64_t> exactly, double seconds, std::int64_t at_least)
      : exactly_(exactly), seconds_(seconds), at_least_(at_least) {}

  bool more(std::int64_t done) const {
    if (exactly_) return done < *exactly_;
    return done < at_least_ || (done < most && seconds_since(start_) < seconds_);
  }

 private:
  // More make no percentile better; keeps the memory bounded whatever is asked for.
  static constexpr std::int64_t most = 2'000'000;

  std::optional<std::int64_t> exactly_;
  double seconds_;
  std::int64_t at_least_;
  Clock::time_point start_ = Clock::now();
};

}  // namespace pneuma::app
