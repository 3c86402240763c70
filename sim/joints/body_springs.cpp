#include "sim/joints/body_springs.h"

#include <algorithm>
#include <map>

#include "sim/base/disjoint_sets.h"

namespace pneuma::sim {

std::vector<std::vector<int>> joined_bodies(const World& world) {
  base::DisjointSets joined(world.soft.size());
  for (const BodySpring& spring : world.springs)
    joined.unite(spring.first.body, spring.second.body);
  std::map<int, std::vector<int>> groups;  // by first body
  for (int i = 0; i < soft_count(world); ++i) groups[joined.find(i)].push_back(i);
  std::vector<std::vector<int>> result;
  for (auto& [first, bodies] : groups) result.push_back(std::move(bodies));
  return result;
}

bool has_springs(const World& world, int soft_body) {
  return std::ranges::any_of(world.springs, [&](const BodySpring& spring) {
    return spring.first.body == soft_body || spring.second.body == soft_body;
  });
}

Vec3 middle(const VertexArray& values, const std::vector<int>& rows, int first) {
  Vec3 sum = Vec3::Zero();
  for (const int row : rows) sum += Vec3(values[first + row]);
  return sum / static_cast<double>(rows.size());
}

Vec3 spring_between(const World& world, const BodySpring& spring) {
  const auto end = [&](const SpringEnd& of) {
    return middle(world.soft[at(of.body)].positions, of.vertices);
  };
  return end(spring.second) - end(spring.first);
}

double spring_energy_between_bodies(const World& world) {
  double sum = 0.0;
  for (const BodySpring& spring : world.springs) {
    const double strain = spring_between(world, spring).norm() - spring.rest_length;
    sum += 0.5 * spring.k * strain * strain;
  }
  return sum;
}

Vec3 spring_pull(const BodySpring& spring, const Vec3& apart, const Vec3& parting) {
  const double length = apart.norm();
  if (!(length > 0.0)) return Vec3::Zero();
  const Vec3 along = apart / length;
  const double tension =
      spring.k * (length - spring.rest_length) + spring.damping * parting.dot(along);
  return tension * along;
}

}  // namespace pneuma::sim
