#include "app/joints/join_bodies.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "app/joints/regions.h"
#include "scenes/loader/load_scene.h"
#include "sim/joints/body_springs.h"
#include "sim/mesh/measure.h"

namespace pneuma::app {
namespace {

using scenes::Region;
using sim::Vec3;

/// A key's value is the first number of a frame.
std::vector<sim::KeyFrame> key_frames(const std::vector<scenes::TimedValue>& keys) {
  std::vector<sim::KeyFrame> frames;
  for (const auto& [time, value] : keys) frames.push_back({time, value, 0.0, 0.0});
  return frames;
}

/// Those between which a valve or spring is.
struct Bodies {
  int from;
  int to;
};

/// None if one of them was refused.
std::optional<Bodies> bodies_of(const sim::World& world, const std::string& from,
                                const std::string& to) {
  const auto first = std::ranges::find(world.soft, from, &sim::SoftBody::name);
  const auto second = std::ranges::find(world.soft, to, &sim::SoftBody::name);
  if (first == world.soft.end() || second == world.soft.end()) return std::nullopt;
  return Bodies{static_cast<int>(first - world.soft.begin()),
                static_cast<int>(second - world.soft.begin())};
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
  int index;  // of the body
  const sim::SoftBody& body;
  const std::optional<Vec3>& point;
  const std::vector<Region>& region;
};

/// One spring of a scene.
class SpringMaker {
 public:
  SpringMaker(const scenes::Scene& scene, std::size_t index)
      : scene_(scene), spring_(scene.springs[index]), number_(index + 1) {}

  sim::BodySpring make(const Bodies& bodies, const sim::World& world) const {
    const End from{"from", bodies.from, world.soft[sim::at(bodies.from)], spring_.from_point,
                   spring_.from_region};
    const End to{"to", bodies.to, world.soft[sim::at(bodies.to)], spring_.to_point,
                 spring_.to_region};
    if (sim::is_kinematic(from.body) && sim::is_kinematic(to.body)) {
      refuse("both of its ends are static or moved, so that it moves nothing");
    }
    sim::BodySpring spring{spring_end(from, to), spring_end(to, from), spring_.k, spring_.damping};
    spring.rest_length =
        spring_.rest_length ? *spring_.rest_length : sim::spring_between(world, spring).norm();
    return spring;
  }

 private:
  [[noreturn]] void refuse(const std::string& why) const {
    throw scenes::SceneError(
        {scenes::diagnostic_at(scene_, spring_.place, fmt::format("spring {}: {}", number_, why))});
  }

  /// Where an end is to be looked for by the other one.
  static Vec3 place_of(const End& end) {
    if (end.point) return *end.point;
    const std::vector<int> vertices = vertices_in(end.body, end.region);
    return vertices.empty() ? sim::mean(end.body.positions)
                            : sim::middle(end.body.positions, vertices);
  }

  sim::SpringEnd spring_end(const End& end, const End& other) const {
    if (end.region.empty()) {
      const Vec3 point = end.point ? *end.point : place_of(other);
      return {end.index, {nearest_vertex(end.body, point)}};
    }
    std::vector<int> vertices = vertices_in(end.body, end.region);
    if (vertices.empty()) {
      refuse(fmt::format("{}_region: no vertex of '{}' starts in it", end.key, end.body.name));
    }
    return {end.index, std::move(vertices)};
  }

  const scenes::Scene& scene_;
  const scenes::SpringScene& spring_;
  std::size_t number_;  // from 1
};

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

void join_bodies(const scenes::Scene& scene, sim::World& world, scenes::Refusals& refusals) {
  for (const scenes::ValveScene& valve : scene.valves) {
    const auto bodies = bodies_of(world, valve.from, valve.to);
    if (bodies) world.valves.push_back({bodies->from, bodies->to, valve.orifice});
  }
  for (std::size_t i = 0; i < scene.springs.size(); ++i) {
    const auto bodies = bodies_of(world, scene.springs[i].from, scene.springs[i].to);
    if (!bodies) continue;
    refusals.attempt([&] { world.springs.push_back(SpringMaker(scene, i).make(*bodies, world)); });
  }
}

}  // namespace pneuma::app
