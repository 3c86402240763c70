// Springs between bodies (sim/world/body_spring.h), and the bodies that they join.
#pragma once

#include <vector>

#include "sim/mesh/vertex_array.h"
#include "sim/world/world.h"

namespace pneuma::sim {

/// Bodies that springs join, directly or through others, in ascending order; a body without any is
/// one for itself. In the order of their first bodies.
std::vector<std::vector<int>> joined_bodies(const World& world);

bool has_springs(const World& world, int soft_body);

/// Sum over the springs of k (l - L)^2 / 2, in joule.
double spring_energy_between_bodies(const World& world);

/// m, from the first end of a spring to its second: of where the bodies are.
Vec3 spring_between(const World& world, const BodySpring& spring);

/// The middle of some rows, from the `first` on.
Vec3 middle(const VertexArray& values, const std::vector<int>& rows, int first = 0);

/// N, on the first end; on the second it is the opposite. `apart`: from the first end to the
/// second, m; `parting`: its rate, m/s. Ends in one place have no direction: then it is zero.
Vec3 spring_pull(const BodySpring& spring, const Vec3& apart, const Vec3& parting);

}  // namespace pneuma::sim
