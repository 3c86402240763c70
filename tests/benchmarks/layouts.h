// The force on every vertex by springs, dashpots and gas, in the memory layouts that were tried
// before sim/soft got its own. README.md beside this has the numbers.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "sim/world/world.h"

namespace pneuma::benchmarks {

/// One way to evaluate the forces on a body at its state.
class Layout {
 public:
  virtual ~Layout() = default;

  virtual void evaluate() = 0;
  /// Of the last evaluation, N.
  virtual sim::VertexArray forces() const = 0;
  /// How many bodies one evaluation does.
  virtual int bodies() const { return 1; }
};

struct NamedLayout {
  std::string name;
  std::function<std::unique_ptr<Layout>(const sim::SoftBody&)> make;
};

/// The body's pressure is taken to be uniform.
const std::vector<NamedLayout>& layouts();

}  // namespace pneuma::benchmarks
