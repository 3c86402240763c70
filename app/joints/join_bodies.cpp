#include "app/joints/join_bodies.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string_view>

#include "app/joints/regions.h"
#include "scenes/loader/load_scene.h"
#include "sim/joints/body_springs.h"
#include "sim/mesh/measure.h"

namespace pneuma::app {
namespace {

using scenes::Place;
using scenes::Region;
using sim::Vec3;

/// Names in a message.
constexpr std::size_t most_named = 10;

constexpr std::string_view valve_kind = "valve", spring_kind = "spring";

/// A key's value is the first number of a frame.
std::vector<sim::KeyFrame> key_frames(const std::vector<scenes::TimedValue>& keys) {
  std::vector<sim::KeyFrame> frames;
  for (const auto& [time, value] : keys) frames.push_back({time, value, 0.0, 0.0});
  return frames;
}

bool is_obstacle(const sim::SoftBody& body) { return body.pins && body.pins->are_all; }

/// Of one valve or spring.
class Joint {
 public:
  Joint(const scenes::Scene& scene, const sim::World& world, std::string_view kind,
        std::size_t index, Place place)
      : world_(world),
        is_valve_(kind == valve_kind),
        what_(fmt::format("{} {}", kind, index + 1)),
        place_(std::move(place)) {
    if (place_.file.empty()) place_.file = (scene.folder / (scene.name + ".toml")).string();
  }

  [[noreturn]] void refuse(const std::string& why) const {
    throw scenes::SceneError({scenes::diagnostic_at(place_, fmt::format("{}: {}", what_, why))});
  }

  int body(std::string_view key, const std::string& name) const {
    const auto found = std::ranges::find(world_.soft, name, &sim::SoftBody::name);
    if (found != world_.soft.end()) return static_cast<int>(found - world_.soft.begin());
    if (std::ranges::find(world_.rigid, name, &sim::RigidBox::name) != world_.rigid.end()) {
      refuse(fmt::format("{} = \"{}\" is a box, which has no {}", key, name,
                         is_valve_ ? "gas; name a soft body"
                                   : "vertices for a spring; name a soft body, or a static or "
                                     "moved one of another shape, as shape = \"icosphere\""));
    }
    std::vector<std::string_view> names;
    for (const sim::SoftBody& soft : world_.soft) {
      if (names.size() < most_named) names.push_back(soft.name);
    }
    refuse(fmt::format("{} = \"{}\" is no soft body; there are {}{}", key, name,
                       fmt::join(names, ", "), world_.soft.size() > most_named ? ", ..." : ""));
  }

  const sim::SoftBody& soft(int body) const { return world_.soft[sim::at(body)]; }

 private:
  const sim::World& world_;
  bool is_valve_;
  std::string what_;
  Place place_;
};

void check_apart(const Joint& joint, int from, int to) {
  if (from == to) joint.refuse("from and to are the same body; name two");
}

sim::Valve make_valve(const scenes::ValveScene& scene, const Joint& joint) {
  const sim::Valve valve{joint.body("from", scene.from), joint.body("to", scene.to), scene.orifice};
  check_apart(joint, valve.first, valve.second);
  for (const int body : {valve.first, valve.second}) {
    const sim::SoftBody& soft = joint.soft(body);
    if (is_obstacle(soft) && soft.material.n == 0.0) {
      joint.refuse(
          fmt::format("'{}' is static or moved and has no gas; name a soft body", soft.name));
    }
  }
  const sim::SoftMaterial& one = joint.soft(valve.first).material;
  const sim::SoftMaterial& other = joint.soft(valve.second).material;
  if (one.gas_exponent != other.gas_exponent) {
    joint.refuse(
        fmt::format("'{}' has gas_exponent = {}, '{}' has {}: it is one gas that flows; "
                    "give both the same",
                    scene.from, one.gas_exponent, scene.to, other.gas_exponent));
  }
  return valve;
}

int nearest_vertex(const sim::SoftBody& body, const Vec3& point) {
  int nearest = 0;
  for (int v = 1; v < body.positions.size(); ++v) {
    const double squared = (body.positions[v] - point).squaredNorm();
    if (squared < (body.positions[nearest] - point).squaredNorm()) nearest = v;
  }
  return nearest;
}

std::vector<int> vertices_in(const sim::SoftBody& body, const std::vector<Region>& regions) {
  std::vector<int> vertices;
  for (int v = 0; v < body.positions.size(); ++v) {
    if (is_in_any(regions, body.positions[v])) vertices.push_back(v);
  }
  return vertices;
}

/// What a scene says of an end, and its body.
struct End {
  std::string_view key;
  int body;
  const std::optional<Vec3>& point;
  const std::vector<Region>& region;
};

/// Where an end is to be looked for by the other one.
Vec3 place_of(const Joint& joint, const End& end) {
  const sim::SoftBody& body = joint.soft(end.body);
  if (end.point) return *end.point;
  const std::vector<int> vertices = vertices_in(body, end.region);
  return vertices.empty() ? sim::mean(body.positions) : sim::middle(body.positions, vertices);
}

sim::SpringEnd spring_end(const Joint& joint, const End& end, const End& other) {
  const sim::SoftBody& body = joint.soft(end.body);
  if (end.region.empty()) {
    const Vec3 point = end.point ? *end.point : place_of(joint, other);
    return {end.body, {nearest_vertex(body, point)}};
  }
  std::vector<int> vertices = vertices_in(body, end.region);
  if (vertices.empty()) {
    joint.refuse(fmt::format("{}_region: no vertex of '{}' starts in it", end.key, body.name));
  }
  return {end.body, std::move(vertices)};
}

sim::BodySpring make_spring(const scenes::SpringScene& scene, const Joint& joint,
                            const sim::World& world) {
  const End from{"from", joint.body("from", scene.from), scene.from_point, scene.from_region};
  const End to{"to", joint.body("to", scene.to), scene.to_point, scene.to_region};
  check_apart(joint, from.body, to.body);
  if (is_obstacle(joint.soft(from.body)) && is_obstacle(joint.soft(to.body))) {
    joint.refuse("both of its ends are static or moved, so that it moves nothing");
  }
  sim::BodySpring spring{spring_end(joint, from, to), spring_end(joint, to, from), scene.k,
                         scene.damping};
  spring.rest_length =
      scene.rest_length ? *scene.rest_length : sim::spring_between(world, spring).norm();
  return spring;
}

}  // namespace

std::shared_ptr<const sim::GasSupply> gas_supply(const scenes::BodyScene& body) {
  if (!scenes::has_supply(body)) return nullptr;
  sim::GasSupply supply;
  supply.n = key_frames(body.supply_n);
  supply.temperature = key_frames(body.supply_temperature);
  supply.smooth = body.supply_smooth;
  supply.leak = body.leak;
  supply.outside_temperature =
      body.supply_temperature.empty() ? body.material.temperature : body.supply_temperature[0][1];
  return std::make_shared<const sim::GasSupply>(std::move(supply));
}

void join_bodies(const scenes::Scene& scene, sim::World& world) {
  for (std::size_t i = 0; i < scene.valves.size(); ++i) {
    const Joint joint(scene, world, valve_kind, i, scene.valves[i].place);
    world.valves.push_back(make_valve(scene.valves[i], joint));
  }
  for (std::size_t i = 0; i < scene.springs.size(); ++i) {
    const Joint joint(scene, world, spring_kind, i, scene.springs[i].place);
    world.springs.push_back(make_spring(scene.springs[i], joint, world));
  }
}

}  // namespace pneuma::app
