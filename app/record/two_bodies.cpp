#include "app/record/two_bodies.h"

#include "sim/inspect/closed_surface.h"
#include "sim/inspect/overlap.h"

namespace pneuma::app {

std::string two_bodies(const sim::World& world, int first, int second) {
  const auto name = [&](int body) {
    return body == sim::ground_body ? std::string("the ground") : sim::body_name(world, body);
  };
  return first == second ? name(first) : name(first) + " and " + name(second);
}

}  // namespace pneuma::app
