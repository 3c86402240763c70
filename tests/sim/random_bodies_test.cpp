// The implicit integrators on random bodies over everything that a scene file may ask for.
//
// A failure prints the seed; PNEUMA_SEED=NUMBER runs that one alone.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>

#include "sim/inspect/inspect.h"
#include "tests/support/worlds.h"

namespace pneuma::sim {
namespace {

/// Numbers that do not depend on the standard library's distributions.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(engine_() >> 11) * 0x1p-53;
  }
  /// All orders of magnitude alike.
  double any_size(double low, double high) { return low * std::pow(high / low, uniform(0.0, 1.0)); }
  bool chance(double share) { return uniform(0.0, 1.0) < share; }
  int whole(int low, int high) { return low + static_cast<int>(uniform(0.0, high - low + 1.0)); }
  /// Zero now and then, since it often is a case of its own.
  double zero_or(double chance_of_zero, double other) {
    return chance(chance_of_zero) ? 0.0 : other;
  }
  Vec3 direction() {
    for (;;) {
      const double x = uniform(-1.0, 1.0), y = uniform(-1.0, 1.0), z = uniform(-1.0, 1.0);
      const double size = Vec3(x, y, z).norm();
      if (size > 0.1 && size < 1.0) return Vec3(x, y, z) / size;
    }
  }
  Vec3 zero_or_vector(double chance_of_zero, double low, double high) {
    return chance(chance_of_zero) ? Vec3(Vec3::Zero()) : Vec3(any_size(low, high) * direction());
  }
  unsigned seed() { return static_cast<unsigned>(engine_()); }

 private:
  std::mt19937_64 engine_;
};

TriangleMesh any_mesh(Random& random) {
  const double size = random.chance(0.7) ? random.uniform(0.5, 5.0) : random.any_size(1e-2, 1e3);
  switch (random.whole(0, 3)) {
    case 0:
      return make_sphere(size, random.whole(2, 8), random.whole(3, 8));
    case 1:
      return make_torus(size, size * random.uniform(0.1, 0.8), random.whole(3, 8),
                        random.whole(3, 8));
    case 2: {  // also needles and pancakes
      const double x = random.any_size(0.05, 2.0), y = random.any_size(0.05, 2.0);
      return make_box(size * Vec3(x, y, random.any_size(0.05, 2.0)), random.whole(1, 3));
    }
    default:
      return make_icosphere(size, random.whole(0, 1));
  }
}

SoftMaterial any_material(Random& random) {
  SoftMaterial material;
  material.k = random.zero_or(0.1, random.any_size(1e-2, 1e8));
  material.n = random.zero_or(0.1, random.any_size(1e-4, 1e6));
  material.temperature = random.zero_or(0.1, random.any_size(1.0, 1000.0));
  material.vertex_mass = random.any_size(1e-6, 1e3);
  material.k_max = random.any_size(1.0, 1e8);
  material.rho_g = random.zero_or(0.3, random.uniform(0.0, 0.999));
  material.damping = random.chance(0.8) ? Damping::dashpot : Damping::literal;
  material.surface.restitution =
      random.chance(0.2) ? 1.0 : random.zero_or(0.2, random.uniform(0.0, 1.0));
  material.surface.friction = random.zero_or(0.2, random.any_size(0.01, 3.0));
  return material;
}

/// Crumpled, flattened, thrown and spun; above the ground where there is one.
SoftBody any_body(Random& random, bool ground) {
  SoftBody body = make_body(any_mesh(random));
  body.material = any_material(random);
  const double size = bounds(body.positions).size().norm();
  if (random.chance(0.4)) perturb(body, size * random.any_size(1e-6, 1.0), random.seed());
  const double flatness = random.chance(0.2) ? random.any_size(1e-12, 1.0) : 1.0;
  const Vec3 speed = random.zero_or_vector(0.3, 0.01, 1000.0);
  const Vec3 spin = random.zero_or_vector(0.6, 0.01, 300.0);
  for (int v = 0; v < body.positions.size(); ++v) {
    body.positions[v].z() *= flatness;
    body.velocities[v] += speed + spin.cross(Vec3(body.positions[v]));
  }
  Vec3 place(0.0, 0.0, random.uniform(-5.0, 5.0));
  if (ground) {
    place.z() =
        random.zero_or(0.3, size * random.any_size(1e-3, 10.0)) - bounds(body.positions).low.z();
  }
  if (random.chance(0.05)) place.x() = 1e6;
  for (int v = 0; v < body.positions.size(); ++v) body.positions[v] += place;
  return body;
}

World any_world(std::uint64_t seed, int bodies) {
  Random random(seed);
  World world;
  Settings& settings = world.settings;
  settings.integrator = random.chance(0.5) ? Integrator::implicit_euler : Integrator::sdirk2;
  settings.steps_per_second = random.chance(0.5) ? 60 : static_cast<int>(random.any_size(1.0, 1e4));
  settings.ground.reset();
  if (random.chance(0.7)) settings.ground = {random.uniform(0.0, 1.0), random.any_size(0.01, 3.0)};
  if (random.chance(0.4)) settings.gravity = random.zero_or_vector(0.3, 0.1, 1000.0);
  settings.contact = ContactMethod::impulses;  // which part what starts in each other
  settings.skin_thickness = random.zero_or(0.1, random.any_size(1e-3, 1.0));
  for (int i = 0; i < bodies; ++i) {
    world.soft.push_back(any_body(random, settings.ground.has_value()));
    world.soft.back().name = "body" + std::to_string(i + 1);
  }
  return world;
}

bool holds_gas(const SoftBody& body) { return body.material.n * body.material.temperature > 0.0; }

/// Crumpled bodies may start inside out; then there is nothing to promise.
bool makes_sense(const World& world) {
  for (const SoftBody& body : world.soft) {
    if (holds_gas(body) &&
        !(volume_of(body) > 1e-12 * std::pow(bounds(body.positions).size().norm(), 3))) {
      return false;
    }
  }
  return true;
}

/// J by which sums of energies may be off: each term's 1e-13, and what a vertex' position, known to
/// 1e-15 of its distance from the origin, means to gravity, springs and gas.
double rounding(const World& world) {
  double result = 0.0;
  for (const SoftBody& body : world.soft) {
    const Energy e = energy(body, world.settings.gravity);
    const SoftMaterial& m = body.material;
    const double place = 1e-15 * body.positions.rows().cwiseAbs().maxCoeff();
    const double edges = body.mesh->topology.edge_count();
    const double weight = body.positions.size() * m.vertex_mass * world.settings.gravity.norm();
    const double thinnest = bounds(body.positions).size().minCoeff();
    result += 3e-13 * (e.kinetic + e.spring + std::abs(e.gas) + std::abs(e.gravity)) +
              weight * place + std::sqrt(2.0 * m.k * e.spring * edges) * place +
              m.k * edges * place * place;
    if (holds_gas(body)) result += m.n * gas_constant * m.temperature * place / thinnest;
  }
  return result;
}

/// A volume so small that coordinates with 16 digits do not tell it from none: a sum of products of
/// three of them, each known to 1e-16 of itself.
bool has_volume_of_rounding(const World& world) {
  for (const SoftBody& body : world.soft) {
    const double farthest = body.positions.rows().cwiseAbs().maxCoeff();
    if (holds_gas(body) && volume_of(body) < 1e-14 * std::pow(farthest, 3)) return true;
  }
  return false;
}

/// Empty, or what went wrong.
std::string run_and_look(World world, int steps, bool conserves) {
  Stepper stepper(world);
  for (int i = 1; i <= steps; ++i) {
    const double before = energy(world).total(), rounding_before = rounding(world);
    if (const auto divergence = stepper.step(world)) {
      if (has_volume_of_rounding(world)) return "";
      return "step " + std::to_string(i) + ": " + divergence->what;
    }
    for (const SoftBody& body : world.soft) {
      if (!body.positions.rows().allFinite() || !body.velocities.rows().allFinite()) {
        return "step " + std::to_string(i) + ": not finite";
      }
      if (holds_gas(body) && !(volume_of(body) > 0.0)) {
        return "step " + std::to_string(i) + ": a volume of " + std::to_string(volume_of(body));
      }
    }
    const double rise = energy(world).total() - before;
    if (conserves && rise > rounding_before + rounding(world)) {
      return "step " + std::to_string(i) + ": the energy rose by " + std::to_string(rise) +
             " J of " + std::to_string(before);
    }
  }
  return "";
}

/// Returns how many of the seeds had worlds that make sense.
int check_seeds(std::uint64_t first, std::uint64_t end, int bodies, int steps) {
  if (const char* seed = std::getenv("PNEUMA_SEED")) {
    first = std::strtoull(seed, nullptr, 10);
    end = first + 1;
  }
  int count = std::getenv("PNEUMA_SEED") != nullptr ? std::numeric_limits<int>::max() / 2 : 0;
  for (std::uint64_t seed = first; seed < end; ++seed) {
    const World world = any_world(seed, bodies);
    if (!makes_sense(world)) continue;
    ++count;
    const std::string failure = run_and_look(world, steps, bodies == 1);
    EXPECT_EQ(failure, "") << "PNEUMA_SEED=" << seed << ", " << bodies << " bodies";
  }
  return count;
}

// Of one body, with the ground and alone: finite, volume above zero, and no step adds energy.
TEST(RandomBodies, KeepTheirVolumeAndGainNoEnergy) { EXPECT_GT(check_seeds(0, 300, 1, 30), 250); }

// Of several, at about the same place: what contacts do to part them is work, and may be much.
TEST(RandomBodies, KeepTheirVolumeAmongEachOther) { EXPECT_GT(check_seeds(0, 60, 3, 30), 30); }

TEST(ManyRandomBodies, KeepTheirVolumeAndGainNoEnergy) {
  EXPECT_GT(check_seeds(300, 10'300, 1, 30), 9'000);
}

TEST(ManyRandomBodies, KeepTheirVolumeAmongEachOther) {
  EXPECT_GT(check_seeds(60, 1'060, 3, 30), 600);
}

}  // namespace
}  // namespace pneuma::sim
