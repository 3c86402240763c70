// The contact potential of whole worlds against differences, brute force and closed forms.
#include "sim/potential/contact_potential.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>

#include "sim/potential/continuous_collision.h"
#include "sim/potential/kept_pairs.h"
#include "sim/potential/lagged_terms.h"
#include "tests/support/worlds.h"

namespace pneuma::sim {
namespace {

World by_potential(World world = {}) {
  world.settings.contact = ContactMethod::potential;
  return world;
}

struct Scattered {
  explicit Scattered(World given)
      : world(std::move(given)),
        surfaces(world),
        finder(surfaces),
        positions(surfaces.vertex_count()),
        velocities(surfaces.vertex_count()) {
    surfaces.gather(world, positions, velocities);
    finder.find(positions, positions, 0.0, pairs);
  }

  World world;  // whose meshes the surfaces refer to
  ContactSurfaces surfaces;
  PairFinder finder;
  VertexArray positions, velocities;
  std::vector<ContactPair> pairs;
};

void move_body(SoftBody& body, const Vec3& way) {
  for (int v = 0; v < body.positions.size(); ++v) body.positions[v] += way;
}

/// Whether two bodies are nearer than 0.7 of their reach.
bool are_near(const World& world, int first, int second) {
  Scattered s(world);
  std::vector<ActiveContact> active;
  find_active(s.surfaces, s.positions, s.pairs, active);
  return std::ranges::any_of(active, [&](const ActiveContact& contact) {
    return contact.first == first && contact.second == second &&
           contact.point.distance < 0.7 * s.surfaces[first].reach;
  });
}

/// Two rough balls, near each other and one on the ground, and another one folded nearly flat.
World near_world() {
  World world = by_potential();
  world.soft.push_back(make_body(make_icosphere(1.0, 2)));
  world.soft.push_back(make_body(make_icosphere(1.0, 2), {2.2, 0.1, 1.1}));
  world.soft.push_back(make_body(make_icosphere(1.0, 1), {0, 4, 3}));
  for (unsigned i = 0; i < 3; ++i) perturb(world.soft[i], 0.002, i + 1);
  const double reach = ContactSurfaces(world)[0].reach;
  const double low = bounds(world.soft[0].positions).low.z();
  move_body(world.soft[0], {0, 0, -0.5 * reach - low});
  while (!are_near(world, 0, 1)) move_body(world.soft[1], {-0.1 * reach, 0, 0});
  SoftBody& flat = world.soft[2];
  for (int v = 0; v < flat.positions.size(); ++v) {
    flat.positions[v].z() = 3.0 + 0.012 * (flat.positions[v].z() - 3.0);
  }
  return world;
}

double energy_at(Scattered& s, const VertexArray& positions) {
  s.finder.find(positions, positions, 0.0, s.pairs);
  return contact_energy(s.surfaces, positions, s.pairs);
}

/// m, of all vertices each for itself.
VertexArray scattered(const VertexArray& from, const VertexArray& to, double beside,
                      std::mt19937_64& random) {
  std::uniform_real_distribution<double> along(0.0, 1.0), coordinate(-1.0, 1.0);
  VertexArray positions(from.size());
  for (int v = 0; v < from.size(); ++v) {
    const Vec3 way = Vec3(to[v]) - Vec3(from[v]);
    const Vec3 aside(coordinate(random), coordinate(random), coordinate(random));
    positions[v] = Vec3(from[v]) + along(random) * way + beside * aside.normalized();
  }
  return positions;
}

// Wherever on its way each vertex is, nothing is missed that a search there finds within reach.
TEST(KeptPairs, HoldAroundTheWaysOfAllVertices) {
  Scattered s(near_world());
  VertexArray to = s.positions;
  for (int v = 0; v < to.size(); ++v) to[v] += Vec3(0.02, -0.03, 0.05 * std::sin(1.0 * v));
  constexpr double margin = 0.01;
  KeptPairs kept(s.surfaces);
  EXPECT_FALSE(kept.cover(s.positions)) << "before a search";
  kept.find(s.positions, to, margin);
  std::mt19937_64 random(3);
  std::vector<ActiveContact> active;
  std::size_t met = 0;
  for (int i = 0; i < 200; ++i) {
    const VertexArray x = scattered(s.positions, to, 0.999 * margin, random);
    ASSERT_TRUE(kept.cover(x));
    s.finder.find(x, x, 0.0, s.pairs);
    find_active(s.surfaces, x, s.pairs, active);
    const std::size_t expected = active.size();
    find_active(s.surfaces, x, kept.pairs(), active);
    ASSERT_EQ(active.size(), expected);
    met += expected;
  }
  EXPECT_GT(met, 2000U);
  EXPECT_FALSE(kept.cover(scattered(s.positions, to, 1.1 * margin, random)));
  EXPECT_TRUE(kept.cover(to, 0.9 * margin));
  EXPECT_FALSE(kept.cover(to, 1.1 * margin));
}

TEST(ContactPotential, HasItsDifferencesAsForces) {
  Scattered s(near_world());
  std::vector<ActiveContact> active;
  const double energy = find_active(s.surfaces, s.positions, s.pairs, active);
  EXPECT_GT(energy, 0.0);
  EXPECT_DOUBLE_EQ(energy, energy_at(s, s.positions));
  int on_ground = 0, between = 0, within = 0, mollified = 0;
  for (const ActiveContact& contact : active) {
    on_ground += contact.second < 0;
    between += contact.second >= 0 && contact.first != contact.second;
    within += contact.first == contact.second;
    mollified += contact.is_mollified();
  }
  EXPECT_GT(on_ground, 0);
  EXPECT_GT(between, 0);
  EXPECT_GT(within, 0);
  EXPECT_GT(mollified, 0);

  VertexArray gradient(s.positions.size());
  add_gradient(active, s.positions, gradient);
  double scale = 0.0;
  for (int v = 0; v < gradient.size(); ++v) scale = std::max(scale, Vec3(gradient[v]).norm());
  constexpr double width = 1e-7;
  for (int v = 0; v < s.positions.size(); ++v) {
    if (Vec3(gradient[v]).isZero(0.0) && v % 10 != 0) continue;
    for (int axis = 0; axis < 3; ++axis) {
      VertexArray moved = s.positions;
      moved[v][axis] += width;
      const double after = energy_at(s, moved);
      moved[v][axis] -= 2.0 * width;
      const double before = energy_at(s, moved);
      EXPECT_NEAR(gradient[v][axis], (after - before) / (2.0 * width), 1e-5 * scale);
    }
  }
}

TEST(ContactPotential, HasItsForcesDifferencesAsSecondDerivatives) {
  Scattered s(near_world());
  std::vector<ActiveContact> active;
  find_active(s.surfaces, s.positions, s.pairs, active);
  constexpr double width = 1e-8;
  int checked = 0;
  for (const ActiveContact& contact : active) {
    if (contact.count == 1) continue;
    const Mat12 hessian = contact_hessian(contact, s.positions);
    // A pair alone: what it is among.
    const auto own = [&](const VertexArray& positions) -> std::optional<Vec12> {
      std::vector<ActiveContact> found;
      find_active(s.surfaces, positions, s.pairs, found);
      const auto same = std::ranges::find_if(found, [&](const ActiveContact& other) {
        return other.vertices == contact.vertices && other.count == contact.count &&
               (other.threshold > 0.0) == (contact.threshold > 0.0);
      });
      if (same == found.end() || same->point.slides != contact.point.slides) return std::nullopt;
      VertexArray gradient(positions.size());
      add_gradient({*same}, positions, gradient);
      Vec12 of_pair;
      for (int i = 0; i < 4; ++i) of_pair.segment<3>(3 * i) = gradient[contact.vertices[at(i)]];
      return of_pair;
    };
    bool is_smooth = true;
    Mat12 differences;
    for (int i = 0; i < 12 && is_smooth; ++i) {
      VertexArray moved = s.positions;
      moved[contact.vertices[at(i / 3)]][i % 3] += width;
      const auto after = own(moved);
      moved[contact.vertices[at(i / 3)]][i % 3] -= 2.0 * width;
      const auto before = own(moved);
      is_smooth = after && before;
      if (is_smooth) differences.col(i) = (*after - *before) / (2.0 * width);
    }
    if (!is_smooth) continue;
    ++checked;
    EXPECT_LT((hessian - differences).norm(), 2e-4 * hessian.norm());
    if (checked == 60) break;
  }
  EXPECT_GT(checked, 20);
}

TEST(ContactPotential, PushesBodiesAgainstEachOtherAlone) {
  World world = near_world();
  world.settings.ground.reset();
  // Friction acts across the distance between surfaces: its couple is its force times that.
  for (SoftBody& body : world.soft) body.material.surface.friction = 0.0;
  Scattered s(world);
  std::vector<ActiveContact> active;
  find_active(s.surfaces, s.positions, s.pairs, active);
  VertexArray forces(s.positions.size());
  add_forces(active, s.positions, s.velocities, 0.02, forces);
  Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
  double sizes = 0.0, torques = 0.0;
  for (int v = 0; v < forces.size(); ++v) {
    force += forces[v];
    torque += Vec3(s.positions[v]).cross(Vec3(forces[v]));
    sizes += Vec3(forces[v]).norm();
    torques += Vec3(s.positions[v]).norm() * Vec3(forces[v]).norm();
  }
  EXPECT_LT(force.norm(), 1e-12 * sizes);
  EXPECT_LT(torque.norm(), 1e-12 * torques);
}

TEST(ContactPotential, FrictionAndRestitutionOnlyTakeEnergy) {
  Scattered s(near_world());
  std::vector<ActiveContact> active;
  find_active(s.surfaces, s.positions, s.pairs, active);
  VertexArray all(s.positions.size()), gradient(s.positions.size());
  add_forces(active, s.positions, s.velocities, 0.02, all);
  add_gradient(active, s.positions, gradient);
  all.rows() += gradient.rows();
  EXPECT_LT(all.rows().cwiseProduct(s.velocities.rows()).sum(), 0.0);
}

TEST(LaggedTerms, HaveTheirDifferencesAsForcesAndAreConvexWithTheBarrier) {
  Scattered s(near_world());
  std::vector<ActiveContact> active;
  find_active(s.surfaces, s.positions, s.pairs, active);
  constexpr double h = 1.0 / 60.0, speed = 0.02;
  LaggedTerms terms;
  terms.start(active, s.positions, s.velocities, s.positions, h, speed);
  VertexArray ahead = s.positions;
  ahead.rows() += h * s.velocities.rows();
  VertexArray gradient(ahead.size());
  terms.add_gradient(ahead, gradient);
  std::vector<WeightedBlock> blocks;
  terms.append_hessian(ahead, LaggedTerms::Form::derivative, blocks);
  VertexArray along = s.velocities;
  VertexArray product(ahead.size());
  double bend = 0.0;
  ASSERT_EQ(blocks.size(), active.size());
  for (std::size_t term = 0; term < blocks.size(); ++term) {
    const WeightedBlock& block = blocks[term];
    const ActiveContact& contact = active[term];
    Vec3 sum = Vec3::Zero();
    for (int i = 0; i < block.count; ++i) {
      sum += block.weights[at(i)] * along[block.vertices[at(i)]];
    }
    bend += sum.dot(block.block * sum);
    const double parting = contact.point.normal().dot(sum);  // m/s, as `along` is the velocities
    const FunctionValue b = barrier_at(contact.point.distance + h * parting, contact.reach,
                                       contact.mollifier * contact.strength);
    const double by_barrier = parting > 0.0 ? b.curvature * parting * parting : 0.0;
    EXPECT_GE(sum.dot(block.block * sum) + by_barrier, -1e-12);
  }
  constexpr double width = 1e-7;
  VertexArray after = ahead, before = ahead;
  after.rows() += width * along.rows();
  before.rows() -= width * along.rows();
  const double slope = gradient.rows().cwiseProduct(along.rows()).sum();
  EXPECT_NEAR(slope, (terms.energy(after) - terms.energy(before)) / (2.0 * width),
              1e-6 * std::abs(slope));
  VertexArray gradient_after(ahead.size()), gradient_before(ahead.size());
  terms.add_gradient(after, gradient_after);
  terms.add_gradient(before, gradient_before);
  const double bend_by_differences =
      (gradient_after.rows() - gradient_before.rows()).cwiseProduct(along.rows()).sum() /
      (2.0 * width);
  EXPECT_NEAR(bend, bend_by_differences, 1e-4 * std::abs(bend));
}

/// Along a contact's normal: what restitution leaves of the barrier's push is none below zero, and
/// its sum with the barrier is convex.
TEST(LaggedTerms, TakeNoMoreThanTheBarrierPushes) {
  World world = near_world();
  for (SoftBody& body : world.soft) body.material.surface = {0.0, 0.0};
  world.settings.ground.reset();
  Scattered s(world);
  std::vector<ActiveContact> active;
  find_active(s.surfaces, s.positions, s.pairs, active);
  constexpr double h = 1.0 / 60.0, speed = 0.02;
  int checked = 0;
  for (const ActiveContact& contact : active) {
    LaggedTerms terms;
    terms.start({contact}, s.positions, s.velocities, s.positions, h, speed);
    const Vec3 normal = contact.point.normal();
    double squared = 0.0;
    for (const double weight : contact.point.weights) squared += weight * weight;
    for (const double parting : {-0.5, 0.1, 0.5, 1.0, 2.0, 10.0, 50.0}) {
      const double way = parting * h * speed;
      if (contact.point.distance + way <= 0.0) continue;
      VertexArray to = s.positions;
      for (int i = 0; i < contact.count; ++i) {
        Vec3 moved = to[contact.vertices[at(i)]];
        moved += contact.point.weights[at(i)] / squared * way * normal;
        to[contact.vertices[at(i)]] = moved;
      }
      const FunctionValue b = barrier_at(contact.point.distance + way, contact.reach,
                                         contact.mollifier * contact.strength);
      VertexArray gradient(to.size());
      terms.add_gradient(to, gradient);
      double taken = 0.0;
      for (int i = 0; i < contact.count; ++i) {
        taken += contact.point.weights[at(i)] / squared *
                 normal.dot(Vec3(gradient[contact.vertices[at(i)]]));
      }
      std::vector<WeightedBlock> blocks;
      terms.append_hessian(to, LaggedTerms::Form::derivative, blocks);
      ASSERT_EQ(blocks.size(), 1U);
      EXPECT_LE(taken, -b.slope * (1.0 + 1e-9)) << parting;
      EXPECT_GE(normal.dot(blocks[0].block * normal), -b.curvature * (1.0 + 1e-9)) << parting;
      ++checked;
    }
  }
  EXPECT_GT(checked, 100);
}

TEST(LaggedTerms, AreNowhereAboveTheirBounds) {
  Scattered s(near_world());
  std::vector<ActiveContact> active;
  find_active(s.surfaces, s.positions, s.pairs, active);
  constexpr double h = 1.0 / 60.0;
  LaggedTerms terms;
  terms.start(active, s.positions, s.velocities, s.positions, h, 0.02);
  // From before what is parting to beyond it, and as far.
  for (const double start : {-2.0, -0.3, -0.02, 0.001, 0.02, 0.3, 2.0}) {
    VertexArray from = s.positions;
    from.rows() += start * h * s.velocities.rows();
    VertexArray slopes(from.size());
    terms.add_gradient(from, slopes);
    std::vector<WeightedBlock> blocks;
    terms.append_hessian(from, LaggedTerms::Form::bounding, blocks);
    for (const double length : {-3.0, -0.5, -0.1, -0.01, 0.001, 0.01, 0.1, 0.5, 3.0}) {
      VertexArray way(from.size()), to(from.size());
      way.rows() = length * h * s.velocities.rows();
      to.rows() = from.rows() + way.rows();
      double bound = terms.energy(from) + slopes.rows().cwiseProduct(way.rows()).sum();
      for (const WeightedBlock& block : blocks) {
        Vec3 sum = Vec3::Zero();
        for (int i = 0; i < block.count; ++i) {
          sum += block.weights[at(i)] * way[block.vertices[at(i)]];
        }
        bound += 0.5 * sum.dot(block.block * sum);
        EXPECT_GE(sum.dot(block.block * sum), -1e-12);
      }
      EXPECT_LE(terms.energy(to), bound + 1e-12 * std::abs(bound)) << start << ", " << length;
    }
  }
}

TEST(PairFinder, FindsWhatLookingAtEveryPairFinds) {
  World world = near_world();
  Scattered s(world);
  int expected = 0, near = 0;
  const auto holds = [&](int a, int b, int c, int d, bool is_edges) {
    return std::ranges::any_of(s.pairs, [&](const ContactPair& pair) {
      return pair.is_edges == is_edges && pair.vertices == std::array{a, b, c, d};
    });
  };
  for (int i = 0; i < s.surfaces.count(); ++i) {
    for (int j = 0; j < s.surfaces.count(); ++j) {
      const ContactSurface &a = s.surfaces[i], &b = s.surfaces[j];
      const double reach = i == j ? a.self_reach : std::min(a.reach, b.reach);
      for (int v = 0; v < a.vertex_count; ++v) {
        for (const Triangle& t : b.topology().triangles()) {
          if (i == j && (t[0] == v || t[1] == v || t[2] == v)) continue;
          const std::array<int, 4> pair = {a.first_vertex + v, b.first_vertex + t[0],
                                           b.first_vertex + t[1], b.first_vertex + t[2]};
          const PairPoint point =
              nearest_vertex_triangle({s.positions[pair[0]], s.positions[pair[1]],
                                       s.positions[pair[2]], s.positions[pair[3]]});
          if (point.distance >= reach) continue;
          ++near;
          expected += holds(pair[0], pair[1], pair[2], pair[3], false) ? 0 : 1;
        }
      }
      if (j < i) continue;
      const auto &of_a = a.topology().edges(), &of_b = b.topology().edges();
      for (std::size_t e = 0; e < of_a.size(); ++e) {
        for (std::size_t f = i == j ? e + 1 : 0; f < of_b.size(); ++f) {
          const std::array<int, 4> pair = {a.first_vertex + of_a[e][0], a.first_vertex + of_a[e][1],
                                           b.first_vertex + of_b[f][0],
                                           b.first_vertex + of_b[f][1]};
          if (pair[0] == pair[2] || pair[0] == pair[3] || pair[1] == pair[2] || pair[1] == pair[3])
            continue;
          const PairPoint point = nearest_edge_edge({s.positions[pair[0]], s.positions[pair[1]],
                                                     s.positions[pair[2]], s.positions[pair[3]]});
          if (point.distance >= reach) continue;
          ++near;
          expected += holds(pair[0], pair[1], pair[2], pair[3], true) ? 0 : 1;
        }
      }
    }
  }
  EXPECT_EQ(expected, 0) << "pairs within reach that were not found";
  EXPECT_GT(near, 100);
  for (std::size_t i = 1; i < s.pairs.size(); ++i) {
    EXPECT_TRUE(s.pairs[i - 1].vertices != s.pairs[i].vertices ||
                s.pairs[i - 1].is_edges != s.pairs[i].is_edges)
        << "a pair was found twice";
  }
}

// Two flat lids of soft boxes at half the reach: the energy of the area between them, whatever the
// meshes, by the vertices, and less than once more by the edges.
TEST(ContactPotential, IsAnEnergyPerAreaWhateverTheMesh) {
  for (const int divisions : {8, 16, 32}) {
    World world = by_potential();
    world.settings.ground.reset();
    world.settings.potential.distance = 0.001;
    world.settings.potential.stiffness = 1000.0;
    world.soft.push_back(make_body(make_box({1, 1, 1}, divisions)));
    world.soft.push_back(make_body(make_box({1, 1, 1}, divisions), {0.003, 0.0017, 1.0005}));
    const Scattered s(world);
    double by_vertices = 0.0, by_edges = 0.0;
    std::vector<ActiveContact> active;
    find_active(s.surfaces, s.positions, s.pairs, active);
    for (const ActiveContact& contact : active) {
      (contact.threshold > 0.0 ? by_edges : by_vertices) +=
          contact.mollifier * contact.barrier.value;
    }
    const double expected = 1000.0 * 0.001 * barrier(0.5).value;
    // Along the lids' rim, and where a vertex is near several triangles, some is counted twice.
    EXPECT_NEAR(by_vertices, expected, 6.0 / divisions * expected) << divisions;
    EXPECT_LT(by_edges, 3.0 * expected) << divisions;
  }
}

TEST(LimitWays, LeavesNothingThatCrosses) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  World world = by_potential();
  world.settings.ground.reset();
  world.soft.push_back(make_body(make_icosphere(1.0, 1)));
  world.soft.push_back(make_body(make_icosphere(1.0, 1), {2.3, 0, 0}));
  Scattered s(world);
  int limited = 0;
  for (int trial = 0; trial < 5; ++trial) {
    VertexArray ahead = s.positions;
    const Vec3 way(-1.5, 0.5 * uniform(random), 0.5 * uniform(random));
    for (int v = 0; v < s.surfaces[1].vertex_count; ++v) {
      const Vec3 own(0.2 * uniform(random), 0.2 * uniform(random), 0.2 * uniform(random));
      ahead[s.surfaces[1].first_vertex + v] += way + own;
    }
    s.finder.find(s.positions, ahead, 0.0, s.pairs);
    const WayLimit limit = limit_ways(s.surfaces, s.pairs, s.positions, ahead, 0.1);
    ASSERT_TRUE(limit.is_limited);
    ++limited;
    // No pair gets nearer than it may, at many moments up to there, and one is nearly there.
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i <= 60; ++i) {
      const double fraction = limit.fraction * i / 60.0;
      for (const ContactPair& pair : s.pairs) {
        PairCorners x, start;
        for (std::size_t c = 0; c < 4; ++c) {
          start[c] = s.positions[pair.vertices[c]];
          x[c] = start[c] + fraction * (Vec3(ahead[pair.vertices[c]]) - start[c]);
        }
        const auto distance = pair.is_edges ? nearest_edge_edge : nearest_vertex_triangle;
        const double kept = 0.1 * std::min(distance(start).distance, pair.reach);
        least = std::min(least, distance(x).distance / kept);
      }
    }
    EXPECT_GT(least, 1.0);
  }
  EXPECT_EQ(limited, 5);
}

}  // namespace
}  // namespace pneuma::sim
