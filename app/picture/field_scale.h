// One scale of a field's colours for the pictures of a run.
#pragma once

#include <map>
#include <string>

#include "app/picture/show.h"
#include "sim/world/world.h"

namespace pneuma::app {

/// The greatest values of the run so far of what its pictures show as colours: their ends only
/// grow, so that a colour stands for less in an earlier picture than in a later one, or for the
/// same. A function of the run's states alone, whatever part of it is drawn and after a resume.
class FieldScale {
 public:
  /// By the names of the fields.
  using Seen = std::map<std::string, double>;

  explicit FieldScale(const Pictures& pictures);

  /// To be told of every frame in its turn.
  void see(const sim::World& world);
  const Seen& seen() const { return seen_; }
  void go_on(const Seen& seen);

  /// The same with the end of its colours, unless it has one.
  Show with_end(Show show) const;

 private:
  Seen seen_;  // of those fields that need an end
};

}  // namespace pneuma::app
