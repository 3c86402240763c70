// The motion that contacts are measured against: that of the contact potential as the distance at
// which it begins to push goes to zero.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "app/study/error/reference.h"

namespace pneuma::app {

struct LimitOptions {
  int halvings = 6;  // of the scene's distance, at most; at least two
  /// s of processor time: after one that took longer there is no other, but for what it takes.
  double longest_run = 60;
};

struct ContactLimit {
  Reference reference;
  std::vector<double> distances;  // m, each half of the one before
  /// The max. position error of the motion at each distance, against the limit.
  std::vector<double> errors;
};

/// CVODE's Adams method on the equation with contact, at a distance d and its halves. What a
/// motion is off falls with d, so that 2 x(d / 2) - x(d) is off by its square (Richardson); the
/// limit is that of the two shortest, as far as that of the two before agrees within 1e-3. The
/// flight's contacts are a potential. Throws DivergenceError when not even one sample is known.
ContactLimit find_contact_limit(const Flight& flight, const LimitOptions& options,
                                const std::function<void(const std::string&)>& say);

}  // namespace pneuma::app
