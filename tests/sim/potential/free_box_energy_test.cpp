// The coordinates of free boxes in the incremental potential, against differences and sums by hand.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "sim/potential/world_energy.h"
#include "sim/rigid/inertia.h"
#include "sim/rigid/rigid_motion.h"
#include "tests/sim/potential/potential_worlds.h"

namespace pneuma::sim {
namespace {

/// A ball that lies on a box, beside another, over a static one, all within each other's reach.
World near_boxes() {
  World world = potential_world(Integrator::implicit_euler, 60);
  world.soft.push_back(soft_ball({0.1, 0.05, 2.165}, {0.3, 0, -1}));
  world.rigid.push_back(make_rigid({1.0, 1.2, 0.8}, {0, 0, 0.76}, 2.0));
  world.rigid.push_back(make_rigid({0.5, 0.6, 0.7}, {0.765, 0.1, 0.7}));
  world.rigid.push_back(make_rigid({2.0, 2.0, 0.5}, {0, 0, 0.09}));
  world.rigid[2].is_kinematic = true;
  world.rigid[0].velocity = {0.2, 0.1, -0.5};
  world.rigid[0].angular_velocity = {0.1, -0.3, 0.2};
  world.rigid[1].angular_velocity = {1.0, 2.0, -1.0};
  return world;
}

/// The energy of a step of a world, with friction and restitution as of its start.
struct StepEnergy {
  explicit StepEnergy(const World& world)
      : surfaces(world),
        energy(world, surfaces),
        point(energy.make_point()),
        velocities(surfaces.vertex_count()) {
    surfaces.gather(world, point.positions, velocities);
    surfaces.place_boxes(world, point.positions);
    std::vector<EulerBase> bases;
    for (const WorldEnergy::Body& body : energy.bodies()) {
      EulerBase& base = bases.emplace_back(*body.mesh);
      base.state = {world.soft[at(body.soft)].positions, world.soft[at(body.soft)].velocities};
      measure(*body.mesh, world.soft[at(body.soft)].material, base.state.positions,
              base.deformation);
    }
    std::vector<RigidState> boxes;
    for (std::size_t i = 0; i < energy.boxes().size(); ++i) {
      const RigidBox& box = world.rigid[at(energy.boxes()[i].index)];
      boxes.push_back(state_of(box));
      point.boxes[i] = {box.position, box.orientation};
      move_corners(boxes.back(), energy.boxes()[i].first_vertex, point.positions, velocities);
    }
    constexpr double step = 1.0 / 60.0;
    energy.set_step(world, step, bases, boxes, point.positions);
    PairFinder(surfaces).find(point.positions, point.positions, 0.01, pairs);
    EXPECT_TRUE(energy.evaluate(pairs, point));
    energy.start_lagged(point, velocities, point.positions, step);
    EXPECT_TRUE(energy.evaluate(pairs, point));
  }

  /// Along a direction of which boxes have their six coordinates.
  WorldPoint moved(const VertexArray& direction, double length) const {
    WorldPoint to = point;
    to.positions.rows() += length * direction.rows();
    for (std::size_t i = 0; i < to.boxes.size(); ++i) {
      const int first = energy.boxes()[i].first_vertex;
      to.boxes[i].position += length * direction[first];
      to.boxes[i].orientation = turned(to.boxes[i].orientation, length * direction[first + 1]);
    }
    energy.place_boxes(to);
    EXPECT_TRUE(energy.evaluate(pairs, to));
    return to;
  }

  ContactSurfaces surfaces;
  WorldEnergy energy;
  std::vector<ContactPair> pairs;
  WorldPoint point;
  VertexArray velocities;
};

TEST(FreeBoxEnergy, TheGradientIsTheSlopeOfTheEnergy) {
  const World world = near_boxes();
  StepEnergy step(world);
  int between_boxes = 0, with_ball = 0;
  for (const ActiveContact& contact : step.point.active) {
    between_boxes += contact.first > 0 ? 1 : 0;
    with_ball += contact.first == 0 && contact.second > 0 ? 1 : 0;
  }
  ASSERT_GT(between_boxes, 4);
  ASSERT_GT(with_ball, 0);
  // Beside the start, where friction and the turning have a slope.
  VertexArray beside(step.surfaces.vertex_count());
  for (const WorldEnergy::Box& box : step.energy.boxes()) {
    beside[box.first_vertex] = Vec3(1e-4, 2e-4, -1e-4);
    beside[box.first_vertex + 1] = Vec3(-1e-4, 1e-4, 3e-4);
  }
  step.point = step.moved(beside, 1.0);
  VertexArray gradient(step.surfaces.vertex_count());
  step.energy.gradient(step.point, gradient);
  std::vector<int> columns = {0, 5, 17};  // of the ball
  for (const WorldEnergy::Box& box : step.energy.boxes()) {
    columns.insert(columns.end(), {box.first_vertex, box.first_vertex + 1});
  }
  const double size = std::sqrt(gradient.rows().colwise().squaredNorm().maxCoeff());
  for (const int column : columns) {
    for (int axis = 0; axis < 3; ++axis) {
      VertexArray direction(step.surfaces.vertex_count());
      direction[column][axis] = 1.0;
      constexpr double h = 1e-6;
      const double slope =
          (step.moved(direction, h).energy - step.moved(direction, -h).energy) / (2.0 * h);
      // Differences of second order at 1e-6 of energies of some thousand joules.
      EXPECT_NEAR(gradient[column][axis], slope, 2e-6 * size) << column << ", " << axis;
    }
  }
}

TEST(FreeBoxEnergy, SecondDerivativesOfTurningAreThoseOfDifferences) {
  RigidBox box = make_rigid({1.0, 1.5, 0.4}, {0.3, 0.1, 2.0}, 3.0);
  box.angular_velocity = {5, -3, 8};
  BoxInertia inertia(box);
  inertia.set_step(state_of(box), {0, 0, -9.81}, 0.02);
  BoxFrame frame;
  VertexArray slopes(box_corners);
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const auto any = [&] { return Vec3(uniform(random), uniform(random), uniform(random)); };
  for (int i = 0; i < box_corners; ++i) {
    frame.arms[at(i)] = any();
    slopes[i] = any();
  }
  const Mat6 of_inertia = inertia.hessian({box.position, box.orientation});
  const Mat3 of_slopes = turning_hessian(frame, slopes);
  for (int sample = 0; sample < 10; ++sample) {
    const Vec3 axis = any();
    const auto inertia_at = [&](double h) {
      return inertia.energy({box.position, turned(box.orientation, h * axis)});
    };
    const auto slopes_at = [&](double h) {
      const Eigen::Quaterniond turn = turned(Eigen::Quaterniond::Identity(), h * axis);
      double sum = 0.0;
      for (int i = 0; i < box_corners; ++i) sum += slopes[i].dot(turn * frame.arms[at(i)]);
      return sum;
    };
    constexpr double h = 1e-3;  // differences of second order: 1e-6
    const auto second = [&](const auto& f) { return (f(h) - 2.0 * f(0.0) + f(-h)) / (h * h); };
    const double expected = axis.dot(of_inertia.bottomRightCorner<3, 3>() * axis);
    EXPECT_NEAR(second(inertia_at), expected, 1e-5 * std::abs(expected));
    EXPECT_NEAR(second(slopes_at), axis.dot(of_slopes * axis), 1e-5);
  }
}

// The chain rule: J^T H J with the same matrix of the corners alone.
TEST(FreeBoxEnergy, ProductsAreThoseOfTheCorners) {
  constexpr int count = 4 + box_corners;
  std::vector<std::uint8_t> mobile(at(count), 1);
  for (int i = 6; i < count; ++i) mobile[at(i)] = 0;
  WorldMatrix with_box(mobile), of_corners(std::vector<std::uint8_t>(at(count), 1));
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  Mat12 factor;
  for (double& value : factor.reshaped()) value = uniform(random);
  const Mat12 whole = factor * factor.transpose();
  BoxFrame frame;
  frame.first_vertex = 4;
  for (Vec3& arm : frame.arms) arm = Vec3(uniform(random), uniform(random), uniform(random));
  const Mat6 own = whole.topLeftCorner<6, 6>();
  for (WorldMatrix* matrix : {&with_box, &of_corners}) {
    matrix->clear();
    for (int v = 0; v < 4; ++v) matrix->add_diagonal(v, 2.0);
    matrix->add({1, 5, 9, 11}, whole);
    matrix->blocks().push_back(
        {{0, 2, 6, 7}, 4, {0.7, 0.3, -0.4, -0.6}, Mat3(whole.topLeftCorner<3, 3>())});
  }
  with_box.add_box(frame, own, 0.5);

  VertexArray values(count), product(count), corners(count), expected(count);
  for (int v = 0; v < 6; ++v) values[v] = Vec3(uniform(random), uniform(random), uniform(random));
  with_box.multiply(values, product);
  corners.rows() = values.rows();
  expand({frame}, corners);
  of_corners.multiply(corners, expected);
  contract(frame, expected);
  set_six(frame, six_of(frame, expected) + own * six_of(frame, values), expected);
  EXPECT_LT((product.rows() - expected.rows()).norm(), 1e-13 * expected.rows().norm());

  VertexArray solution(count);
  ASSERT_EQ(with_box.solve(product, 0.0, 1e-3, solution), WorldMatrix::End::solved);
  // What conjugate gradients leave: a thousandth of the residual.
  EXPECT_LT((solution.rows() - values.rows()).norm(), 1e-2 * values.rows().norm());
}

// Of a matrix with the eigenvalues -1, 2 and 5: the quadratic falls along the direction.
TEST(WorldMatrix, GoesOnAlongNegativeCurvature) {
  constexpr int count = 3;
  WorldMatrix matrix(std::vector<std::uint8_t>(at(count), 1));
  matrix.clear();
  for (int v = 0; v < count; ++v) matrix.add_diagonal(v, 2.0);
  Mat3 coupling = Mat3::Zero();
  coupling(2, 2) = 3.0;
  matrix.add_between(0, 1, mat3x4(coupling));
  VertexArray right(count), direction(count), product(count);
  right[0] = Vec3(0.3, 0.0, 0.5);
  right[1] = Vec3(0.0, 0.1, -0.4);
  right[2] = Vec3(1.0, 0.0, 0.0);
  ASSERT_EQ(matrix.solve(right, 0.0, 1e-3, direction), WorldMatrix::End::negative_curvature);
  EXPECT_GT(dot(direction, right), 0.0);
  matrix.multiply(direction, product);
  EXPECT_GT(dot(direction, right), 0.5 * dot(direction, product)) << "the quadratic falls";
  EXPECT_EQ(matrix.solve(right, 2.0, 1e-3, direction), WorldMatrix::End::solved);
}

// What contacts push bodies with adds up to nothing, and neither does its torque, of boxes taken
// about where they are.
TEST(FreeBoxEnergy, ContactsHaveNoNetForceNorTorque) {
  const World world = near_boxes();
  StepEnergy step(world);
  std::erase_if(step.point.active, [](const ActiveContact& contact) { return contact.second < 0; });
  VertexArray slopes(step.surfaces.vertex_count());
  add_gradient(step.point.active, step.point.positions, slopes);
  Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
  double sizes = 0.0, torques = 0.0;
  VertexArray contracted = slopes;
  for (std::size_t i = 0; i < step.energy.boxes().size(); ++i) {
    BoxFrame frame;
    frame.first_vertex = step.energy.boxes()[i].first_vertex;
    const Vec3 centre = step.point.boxes[i].position;
    for (int c = 0; c < box_corners; ++c) {
      frame.arms[at(c)] = step.point.positions[frame.first_vertex + c] - centre;
    }
    contract(frame, contracted);
    const Vec6 six = six_of(frame, contracted);
    force += six.head<3>();
    torque += six.tail<3>() + centre.cross(Vec3(six.head<3>()));
    set_six(frame, Vec6::Zero(), contracted);
  }
  for (int v = 0; v < contracted.size(); ++v) {
    force += contracted[v];
    torque += Vec3(step.point.positions[v]).cross(Vec3(contracted[v]));
    sizes += slopes[v].norm();
    torques += Vec3(step.point.positions[v]).norm() * slopes[v].norm();
  }
  EXPECT_GT(sizes, 1.0);
  EXPECT_LT(force.norm(), 1e-12 * sizes);
  EXPECT_LT(torque.norm(), 1e-12 * torques);
}

}  // namespace
}  // namespace pneuma::sim
