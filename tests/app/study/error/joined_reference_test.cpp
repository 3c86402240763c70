// Gas that flows and springs between bodies against CVODE on the whole equation: positions,
// velocities and amounts of gas of all bodies together.
#include <gtest/gtest.h>

#include "app/study/error/reference_equation.h"
#include "app/study/error/sundials.h"
#include "tests/sim/joints/gas_worlds.h"

namespace pneuma::app {
namespace {

using sim::Integrator;
using sim::Vec3;
using sim::World;

constexpr double seconds = 0.1;

/// Two balls with a valve, of which one leaks, or with two springs, or with both.
World make_world(bool with_gas, bool with_springs) {
  World world = sim::make_free_world(sim::make_ball(0.5, 1.02, false));
  world.soft.push_back(sim::make_ball(0.6, 1.0, false, {2.5, 0.3, 0.1}));
  for (sim::SoftBody& body : world.soft) body.material.vertex_mass = 0.5;
  sim::perturb(world.soft[1], 0.005, 3);
  world.soft[1].velocities.rows().setZero();
  if (with_gas) {
    world.valves = {{0, 1, {.area = 0.004}}};
    sim::give_leak(world.soft[0], 0.002);
  }
  if (with_springs) {
    world.springs = {{{0, {3}}, {1, {5, 6, 7}}, 300.0, 1.0, 1.0},
                     {{1, {9}}, {0, {12}}, 200.0, 0.0, 3.0}};
  }
  return world;
}

/// 0.61 times the area, and the flow by Mach numbers.
double flow(double area, double one, double other, double temperature) {
  const double size =
      0.61 * area *
      sim::flux_by_mach_number(std::max(one, other), temperature, std::min(one, other));
  return one > other ? size : -size;
}

/// The state: as flat_state, then n of each body.
class WholeEquation {
 public:
  explicit WholeEquation(const World& world)
      : world_(world), bodies_(world.soft), equation_(bodies_, world.settings.gravity) {}

  bool operator()(const double* state, double* derivative) {
    const std::size_t count = sim::at(bodies_[0].positions.size());
    const std::size_t all = count + sim::at(bodies_[1].positions.size());
    const double* n = state + 6 * all;
    for (std::size_t i = 0; i < 2; ++i) bodies_[i].material.n = n[i];
    if (!equation_(state, derivative)) return false;
    add_springs(state, derivative, count, all);
    add_flow(state, derivative, count, all);
    return true;
  }

  std::vector<double> start() const {
    std::vector<double> state = flat_state(world_.soft);
    for (const sim::SoftBody& body : world_.soft) state.push_back(body.material.n);
    return state;
  }

 private:
  void add_springs(const double* state, double* derivative, std::size_t count, std::size_t all) {
    for (const sim::BodySpring& spring : world_.springs) {
      const auto middle = [&](const sim::SpringEnd& end, std::size_t offset) {
        Vec3 sum = Vec3::Zero();
        for (const int v : end.vertices) {
          const double* row = state + offset + 3 * ((end.body == 0 ? 0 : count) + sim::at(v));
          sum += Vec3(row[0], row[1], row[2]);
        }
        return Vec3(sum / static_cast<double>(end.vertices.size()));
      };
      const Vec3 apart = middle(spring.second, 0) - middle(spring.first, 0);
      const Vec3 parting = middle(spring.second, 3 * all) - middle(spring.first, 3 * all);
      const double length = apart.norm();
      const Vec3 force = (spring.k * (length - spring.rest_length) +
                          spring.damping * parting.dot(apart) / length) /
                         length * apart;
      for (const auto& [end, sign] : {std::pair(&spring.first, 1.0), {&spring.second, -1.0}}) {
        const double part = sign / (static_cast<double>(end->vertices.size()) * 0.5);
        for (const int v : end->vertices) {
          double* row = derivative + 3 * all + 3 * ((end->body == 0 ? 0 : count) + sim::at(v));
          for (int axis = 0; axis < 3; ++axis) row[axis] += part * force[axis];
        }
      }
    }
  }

  void add_flow(const double* state, double* derivative, std::size_t count, std::size_t all) {
    std::array<double, 2> pressure;
    for (std::size_t i = 0; i < 2; ++i) {
      sim::VertexArray positions(bodies_[i].positions.size());
      const double* first = state + (i == 0 ? 0 : 3 * count);
      for (int v = 0; v < positions.size(); ++v) {
        const double* row = first + 3 * sim::at(v);
        positions[v] = Vec3(row[0], row[1], row[2]);
      }
      pressure[i] = state[6 * all + i] * 8.314472 * 293.15 /
                    sim::volume(bodies_[i].mesh->topology, positions);
    }
    double* change = derivative + 6 * all;
    change[0] = change[1] = 0.0;
    if (!world_.valves.empty()) {
      const double through = flow(world_.valves[0].orifice.area, pressure[0], pressure[1], 293.15);
      change[0] -= through;
      change[1] += through;
    }
    if (bodies_[0].supply) {
      change[0] -= flow(bodies_[0].supply->leak.area, pressure[0], sim::air_pressure, 293.15);
    }
  }

  World world_;
  std::vector<sim::SoftBody> bodies_;
  ReferenceEquation equation_;
};

std::vector<double> solved(const World& world) {
  const auto equation = std::make_shared<WholeEquation>(world);
  const std::vector<double> start = equation->start();
  Sundials solver(SundialsMethod::cvode_adams,
                  [equation](double, const double* state, double* derivative) {
                    return (*equation)(state, derivative);
                  },
                  start, {1e-11, std::vector<double>(start.size(), 1e-12)});
  EXPECT_TRUE(solver.advance_to(seconds));
  return solver.state();
}

struct Errors {
  double position, n;  // m; as a part
};

Errors errors(World world, int steps_per_second, const std::vector<double>& exact) {
  world.settings.steps_per_second = steps_per_second;
  const auto divergence = sim::run(world, seconds);
  EXPECT_FALSE(divergence) << divergence->what;
  const std::vector<double> state = flat_state(world.soft);
  Errors result{};
  for (std::size_t i = 0; i < state.size() / 2; ++i) {
    result.position = std::max(result.position, std::abs(state[i] - exact[i]));
  }
  for (std::size_t i = 0; i < 2; ++i) {
    result.n =
        std::max(result.n, std::abs(world.soft[i].material.n / exact[state.size() + i] - 1.0));
  }
  return result;
}

struct Case {
  Integrator integrator;
  double order_of_springs;  // with gas that stays
};

class Joined : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(
    Integrators, Joined,
    testing::Values(Case{Integrator::martin, 1.0}, Case{Integrator::symplectic_euler, 1.0},
                    Case{Integrator::velocity_verlet, 2.0}, Case{Integrator::rk4, 4.0},
                    Case{Integrator::implicit_euler, 1.0}, Case{Integrator::sdirk2, 2.0}));

constexpr int coarse = 1920;

/// Errors at a step and a quarter of it have the order's ratio; a quarter of an order is for what
/// comes after the first term.
void expect_order(World world, double order) {
  const std::vector<double> exact = solved(world);
  const Errors one = errors(world, coarse, exact), quarter = errors(world, 4 * coarse, exact);
  EXPECT_GT(0.5 * std::log2(one.position / quarter.position), order - 0.25) << one.position;
  EXPECT_LT(one.position, 1e-2);
}

TEST_P(Joined, SpringsKeepTheOrderOfTheIntegrator) {
  World world = make_world(false, true);
  world.settings.integrator = GetParam().integrator;
  expect_order(world, GetParam().order_of_springs);
}

TEST_P(Joined, GasThatFlowsIsOfSecondOrderOrTheIntegrators) {
  World world = make_world(true, true);
  world.settings.integrator = GetParam().integrator;
  expect_order(world, std::min(2.0, GetParam().order_of_springs));
  const Errors found = errors(world, 4 * coarse, solved(world));
  EXPECT_LT(found.n, GetParam().order_of_springs > 1.0 ? 1e-6 : 1e-4);
}

}  // namespace
}  // namespace pneuma::app
