// How long a measurement goes on.
#pragma once

#include <cstdint>
#include <optional>

#include "app/host/clock.h"

namespace pneuma::app {

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
