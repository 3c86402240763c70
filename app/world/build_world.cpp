#include "app/world/build_world.h"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <numbers>
#include <random>

#include "app/files/find_model.h"
#include "app/files/refuse_body.h"
#include "app/joints/check_turns.h"
#include "app/joints/join_bodies.h"
#include "app/world/fill_body.h"
#include "app/world/pin_body.h"
#include "app/world/step_advice.h"
#include "scenes/loader/load_scene.h"
#include "scenes/loader/print_scene.h"
#include "scenes/loader/report.h"
#include "sim/base/text.h"
#include "sim/equilibrium/held_shape.h"
#include "sim/mesh/hash_vertices.h"
#include "sim/mesh/measure.h"
#include "sim/mesh/primitives.h"
#include "sim/mesh/rotation.h"
#include "sim/rigid/given_motion.h"

namespace pneuma::app {
namespace {

using scenes::BodyKind;
using scenes::BodyScene;
using scenes::Shape;
using sim::Vec3;
using Quaternion = Eigen::Quaterniond;

/// Random numbers that do not depend on the standard library: it fixes the engine's output, but not
/// what its distributions make of it.
class Random {
 public:
  /// A stream per body, so that a body's copies stay as they are when another body is added.
  Random(std::uint64_t seed, std::size_t body)
      : engine_(seed + (body + 1) * 0x9e3779b97f4a7c15ULL) {}

  /// 0 <= value < 1, from the 53 bits that a double holds.
  double unit() { return static_cast<double>(engine_() >> 11) * 0x1.0p-53; }

  /// Uniform in the ball of radius 1, by rejection from the cube around it.
  Vec3 in_ball() {
    for (;;) {
      const double x = 2.0 * unit() - 1.0, y = 2.0 * unit() - 1.0, z = 2.0 * unit() - 1.0;
      const Vec3 point(x, y, z);
      if (point.squaredNorm() <= 1.0) return point;
    }
  }

  /// Uniform over all rotations (Shoemake, Uniform random rotations, Graphics Gems III, 1992).
  Quaternion rotation() {
    const double share = unit();
    const double first = 2.0 * std::numbers::pi * unit();
    const double second = 2.0 * std::numbers::pi * unit();
    const double a = std::sqrt(1.0 - share), b = std::sqrt(share);
    return Quaternion(b * std::cos(second), a * std::sin(first), a * std::cos(first),
                      b * std::sin(second));
  }

 private:
  std::mt19937_64 engine_;
};

/// Where a body starts: what differs between its copies.
struct Start {
  std::string name;
  Vec3 position;
  Quaternion orientation;
};

/// All copies of a body, x fastest.
std::vector<Start> place_copies(const BodyScene& body, Random random) {
  std::vector<Start> starts;
  const auto [nx, ny, nz] = body.copies;
  const bool numbered = scenes::copy_count(body) > 1;
  for (int z = 0; z < nz; ++z) {
    for (int y = 0; y < ny; ++y) {
      for (int x = 0; x < nx; ++x) {
        Start start{body.name, body.position + body.spacing.cwiseProduct(Vec3(x, y, z)),
                    sim::rotation_of_degrees(body.rotation)};
        if (numbered) start.name += fmt::format(".{}", starts.size() + 1);
        if (body.jitter > 0.0) start.position += body.jitter * random.in_ball();
        if (body.tumble) start.orientation = random.rotation() * start.orientation;
        starts.push_back(std::move(start));
      }
    }
  }
  return starts;
}

sim::TriangleMesh make_mesh(const scenes::Scene& scene, const BodyScene& body) {
  switch (body.shape) {
    case Shape::sphere:
      return sim::make_sphere(body.radius, body.stacks, body.slices);
    case Shape::torus:
      return sim::make_torus(body.radius, body.tube_radius, body.stacks, body.slices);
    case Shape::box:
      return sim::make_box(body.size, body.divisions);
    case Shape::icosphere:
      return sim::make_icosphere(body.radius, body.subdivisions);
    case Shape::model:
      return load_model_mesh(scene, body);
  }
  return {};
}

[[noreturn]] void refuse(const scenes::Scene& scene, const BodyScene& body,
                         const std::string& reason) {
  refuse_body(scene, body.place, body.name, reason);
}

std::uint64_t fingerprint(const sim::SoftMesh& mesh) {
  base::Hash hash;
  sim::add(hash, mesh.rest_positions);
  for (const sim::Triangle& triangle : mesh.topology.triangles()) {
    for (const int v : triangle) hash.add(v);
  }
  return hash.value();
}

class Builder {
 public:
  explicit Builder(const scenes::Scene& scene)
      : scene_(scene), memory_gib_(scenes::estimated_memory_gib(scene)) {
    world_.settings = scene.settings;
  }

  sim::World build() {
    for (std::size_t i = 0; i < scene_.bodies.size() && is_within_limits(); ++i) {
      const BodyScene& body = scene_.bodies[i];
      refusals_.attempt([&] { check_turns(scene_, body); });
      refusals_.attempt([&] { add(body, place_copies(body, Random(scene_.settings.seed, i))); });
    }
    join_bodies(scene_, world_, refusals_);
    refusals_.throw_errors();
    return std::move(world_);
  }

 private:
  void add(const BodyScene& body, const std::vector<Start>& starts) {
    if (scenes::is_box(body)) {
      vertices_ += scenes::vertex_count(body) * scenes::copy_count(body);
      for (const Start& start : starts) add_rigid(body, start);
      return;
    }
    const auto mesh = shared_mesh(body);
    if (!mesh) return;
    count(body, mesh->topology.vertex_count());
    if (body.kind != BodyKind::soft) {
      for (const Start& start : starts) add_obstacle(body, start, mesh);
      return;
    }
    check_gas(body, *mesh);
    const sim::SoftMaterial material = filled_material(scene_, body, mesh);
    const auto held =
        body.rest == scenes::Rest::equilibrium ? held_mesh(body, *mesh, material) : mesh;
    for (const Start& start : starts) add_soft(body, start, held, material);
    const auto supply = gas_supply(body);
    for (sim::SoftBody& copy : std::span(world_.soft).last(starts.size())) copy.supply = supply;
    if (!body.pinned.empty()) pin_copies(body, starts);
  }

  /// Null if it was refused before, of another body.
  std::shared_ptr<const sim::SoftMesh> shared_mesh(const BodyScene& body) {
    const bool bends = body.kind == BodyKind::soft && body.material.bending > 0.0;
    const auto [found, is_new] =
        meshes_.try_emplace(scenes::shape_text(body) + (bends ? " bending" : ""));
    auto& mesh = found->second;
    if (!is_new) return mesh;
    try {
      mesh = sim::make_soft_mesh(make_mesh(scene_, body));
      if (bends) mesh = sim::with_hinges(*mesh);
    } catch (const sim::TopologyError& error) {
      refuse(scene_, body, error.what());
    }
    return mesh;
  }

  /// Not shared with other bodies: its rest lengths depend on the material.
  std::shared_ptr<const sim::SoftMesh> held_mesh(const BodyScene& body, const sim::SoftMesh& mesh,
                                                 const sim::SoftMaterial& material) {
    try {
      return sim::held_mesh(mesh, mesh.rest_positions, material);
    } catch (const sim::EquilibriumError& error) {
      refuse_body(scene_, body.rest_place, body.name,
                  fmt::format("rest = \"equilibrium\": {}{}", error.what(),
                              advice_of_stiffer_springs(body, mesh, material)));
    }
  }

  /// Springs that can hold the gas may still fold, and may need shorter steps than the scene's:
  /// "; from k = ... on it keeps its shape; with that k ...".
  std::string advice_of_stiffer_springs(const BodyScene& body, const sim::SoftMesh& mesh,
                                        const sim::SoftMaterial& material) const {
    sim::SoftMaterial stiff = material;
    try {
      const double held = sim::max_held_gas(mesh, mesh.rest_positions, material);
      if (!(held < material.n)) return "";
      stiff.k = std::stod(base::text_above(material.k * material.n / held));
      std::string text;
      if (mesh.topology.vertex_count() <= sim::quickly_stable) {
        const double steady = sim::stable_stiffness(mesh, mesh.rest_positions, stiff);
        if (std::isinf(steady)) return "";
        const std::string k = base::text_above(steady);
        text = fmt::format("; from k = {} N/m on it keeps its shape", k);
        stiff.k = std::stod(k);
      }
      if (!scene_.names_step) return text;  // it gets the one that it needs
      Builder with_stiff(scene_);
      with_stiff.add_soft(body, {body.name, body.position, Quaternion::Identity()},
                          sim::held_mesh(mesh, mesh.rest_positions, stiff), stiff);
      const StepAdvice advice = step_advice(with_stiff.world_, with_stiff.world_.soft.front());
      return advice.too_long() ? text + "; with that k use " + remedy(advice) : text;
    } catch (const sim::EquilibriumError&) {
      return "";
    }
  }

  bool is_within_limits() const {
    return vertices_ <= scene_.limits.vertices && memory_gib_ <= scene_.limits.memory_gib;
  }

  /// The scene was checked without its models.
  void count(const BodyScene& body, std::int64_t in_body) {
    const scenes::Limits& limits = scene_.limits;
    vertices_ += in_body * scenes::copy_count(body);
    if (vertices_ > limits.vertices) {
      refuse(scene_, body,
             fmt::format("{} vertices are more than the limit of {}; use a smaller model, ask for "
                         "fewer copies, or raise vertices in [limits]",
                         vertices_, limits.vertices));
    }
    if (body.shape != Shape::model) return;
    memory_gib_ += scenes::estimated_memory_gib(in_body, scenes::copy_count(body));
    if (memory_gib_ > limits.memory_gib) {
      refuse(scene_, body,
             fmt::format("about {} of memory are needed, more than the limit of {} GiB; "
                         "use a smaller model, ask for fewer copies, or raise memory_gib in "
                         "[limits]",
                         scenes::memory_text(memory_gib_), limits.memory_gib));
    }
  }

  /// P = nRT / V needs a volume.
  void check_gas(const BodyScene& body, const sim::SoftMesh& mesh) const {
    const double volume = sim::volume(mesh.topology, mesh.rest_positions);
    const bool by_n = !body.gauge_pressure && !body.inflation && body.supply_n.empty();
    if (volume > 0.0 || (by_n && body.material.n * body.material.temperature == 0.0)) return;
    const std::string gas = by_n                     ? fmt::format("n = {} mol", body.material.n)
                            : !body.supply_n.empty() ? "by supply.n"
                            : body.inflation         ? "by inflation"
                                                     : "by gauge_pressure";
    refuse(scene_, body,
           fmt::format("holds gas ({} at {} K) but has a volume of {} m^3; give it a "
                       "shape with room inside, or n = 0",
                       gas, body.material.temperature, volume));
  }

  void add_soft(const BodyScene& scene, const Start& start,
                const std::shared_ptr<const sim::SoftMesh>& mesh,
                const sim::SoftMaterial& material) {
    sim::SoftBody body;
    body.name = start.name;
    body.mesh = mesh;
    body.material = material;
    const int count = mesh->topology.vertex_count();
    body.positions = sim::VertexArray(count);
    body.velocities = sim::VertexArray(count);
    const sim::Mat3 rotation = start.orientation.toRotationMatrix();
    for (int v = 0; v < count; ++v) {
      const Vec3 arm = rotation * Vec3(mesh->rest_positions[v]);
      body.positions[v] = start.position + arm;
      body.velocities[v] = scene.velocity + scene.angular_velocity.cross(arm);
    }
    world_.soft.push_back(std::move(body));
  }

  void pin_copies(const BodyScene& body, const std::vector<Start>& starts) {
    const std::span copies = std::span(world_.soft).last(starts.size());
    check_regions(scene_, body, copies, refusals_);
    for (std::size_t i = 0; i < starts.size(); ++i) pin(body, starts[i].position, copies[i]);
  }

  /// A surface that nothing moves but its motion: a soft body without gas, of pinned vertices.
  void add_obstacle(const BodyScene& scene, const Start& start,
                    const std::shared_ptr<const sim::SoftMesh>& mesh) {
    sim::SoftMaterial material;
    material.n = 0.0;
    material.surface = scene.surface;
    add_soft(scene, start, mesh, material);
    pin_all(scene, start.position, world_.soft.back());
  }

  void add_rigid(const BodyScene& scene, const Start& start) {
    sim::RigidBox box;
    box.name = start.name;
    box.size = scene.size;
    box.mass = scene.mass;
    box.is_kinematic = scene.kind == BodyKind::fixed || scene.kind == BodyKind::moved;
    box.rho_g = scene.rho_g;
    box.surface = scene.surface;
    box.position = start.position;
    box.orientation = start.orientation;
    box.velocity = scene.velocity;
    box.angular_velocity = scene.angular_velocity;
    if (!scene.motion.empty()) {
      sim::GivenMotion motion{scene.motion, box.position, box.orientation};
      const sim::Pose pose = sim::pose_at(motion, 0.0);
      box.position = pose.position;
      box.orientation = pose.orientation;
      box.motion = std::make_shared<const sim::GivenMotion>(std::move(motion));
    }
    world_.rigid.push_back(std::move(box));
  }

  const scenes::Scene& scene_;
  sim::World world_;
  std::map<std::string, std::shared_ptr<const sim::SoftMesh>> meshes_;  // by shape_text
  scenes::Refusals refusals_;
  std::int64_t vertices_ = 0;
  double memory_gib_;
};

}  // namespace

sim::World build_world(const scenes::Scene& scene) { return Builder(scene).build(); }

std::vector<std::uint64_t> model_fingerprints(const scenes::Scene& scene, const sim::World& world) {
  std::vector<std::uint64_t> fingerprints;
  std::size_t index = 0;  // of the body's first copy
  for (const BodyScene& body : scene.bodies) {
    if (scenes::is_box(body)) continue;
    if (body.shape == Shape::model) fingerprints.push_back(fingerprint(*world.soft[index].mesh));
    index += static_cast<std::size_t>(scenes::copy_count(body));
  }
  return fingerprints;
}

}  // namespace pneuma::app
