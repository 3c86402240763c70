#include "app/world/pin_body.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string_view>
#include <utility>

#include "app/files/refuse_body.h"
#include "app/joints/regions.h"
#include "sim/mesh/measure.h"
#include "sim/soft/pins.h"

namespace pneuma::app {
namespace {

using scenes::BodyScene;
using scenes::Region;
using sim::Vec3;

bool has_vertex_in(std::span<const sim::SoftBody> copies, const Region& region) {
  return std::ranges::any_of(copies, [&](const sim::SoftBody& body) {
    for (int v = 0; v < body.positions.size(); ++v) {
      if (is_in(region, body.positions[v])) return true;
    }
    return false;
  });
}

void check(const scenes::Scene& scene, const BodyScene& body, const scenes::Place& place,
           std::string_view key, const Region& region, std::span<const sim::SoftBody> copies) {
  if (has_vertex_in(copies, region)) return;
  sim::Bounds all;
  for (const sim::SoftBody& copy : copies) all.include(sim::bounds(copy.positions));
  refuse_body(scene, place, body.name,
              fmt::format("{}: no vertex starts in the box [{}]; at the start they lie from "
                          "[{:.4g}, {:.4g}, {:.4g}] m to [{:.4g}, {:.4g}, {:.4g}] m",
                          key, fmt::join(region, ", "), all.low.x(), all.low.y(), all.low.z(),
                          all.high.x(), all.high.y(), all.high.z()));
}

sim::GivenMotion motion_about(const BodyScene& scene, const Vec3& position) {
  sim::GivenMotion motion;
  motion.keys = scene.motion;
  motion.position = position;
  return motion;
}

void set_pins(std::vector<std::uint8_t> is_pinned, std::vector<std::uint8_t> follows,
              sim::GivenMotion motion, sim::SoftBody& body) {
  body.pins =
      sim::make_pins(body.positions, std::move(is_pinned), std::move(follows), std::move(motion));
  for (int v = 0; v < body.positions.size(); ++v) {
    if (sim::is_pinned(body, v)) body.velocities[v] = Vec3::Zero();
  }
  sim::place_pins(body, 0.0);
}

}  // namespace

void check_regions(const scenes::Scene& scene, const BodyScene& body,
                   std::span<const sim::SoftBody> copies, scenes::Refusals& refusals) {
  const auto check_all = [&](const scenes::Place& place, std::string_view key,
                             const std::vector<Region>& regions) {
    for (const Region& region : regions) {
      refusals.attempt([&] { check(scene, body, place, key, region, copies); });
    }
  };
  check_all(body.pinned_place, "pinned", body.pinned);
  check_all(body.still_place, "motion.still", body.still);
}

void pin(const BodyScene& scene, const Vec3& position, sim::SoftBody& body) {
  const auto count = static_cast<std::size_t>(body.positions.size());
  std::vector<std::uint8_t> is_pinned(count), follows(count);
  for (int v = 0; v < body.positions.size(); ++v) {
    const bool in = is_in_any(scene.pinned, body.positions[v]);
    const bool stays = scene.motion.empty() || is_in_any(scene.still, body.positions[v]);
    is_pinned[sim::at(v)] = in ? 1 : 0;
    follows[sim::at(v)] = in && !stays ? 1 : 0;
  }
  set_pins(std::move(is_pinned), std::move(follows), motion_about(scene, position), body);
}

void pin_all(const BodyScene& scene, const Vec3& position, sim::SoftBody& body) {
  const bool has_velocity = !scene.velocity.isZero(0.0) || !scene.angular_velocity.isZero(0.0);
  const bool moves =
      scene.kind == scenes::BodyKind::moved && (has_velocity || !scene.motion.empty());
  const auto count = static_cast<std::size_t>(body.positions.size());
  sim::GivenMotion motion = motion_about(scene, position);
  if (scene.motion.empty()) {
    motion.velocity = scene.velocity;
    motion.angular_velocity = scene.angular_velocity;
  }
  set_pins(std::vector<std::uint8_t>(count, 1), std::vector<std::uint8_t>(count, moves ? 1 : 0),
           std::move(motion), body);
}

}  // namespace pneuma::app
