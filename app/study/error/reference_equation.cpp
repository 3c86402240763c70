#include "app/study/error/reference_equation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace pneuma::app {
namespace {

/// One body's part of the state and of its derivative: x, v and a of vertex i are at 3 i.
struct Part {
  const double* x;
  const double* v;
  double* a;
};

/// k (l - L) d and c (v_rel . d) d on both ends of every spring. c is the dashpot with which two
/// masses m on one spring lose k / k_max (99 % at most) of their relative velocity in 1/60 s: that
/// velocity decays at the rate 2 c / m (ERRATA row 5).
void add_springs(const sim::SoftBody& body, const Part& part) {
  const double m = body.material.vertex_mass;
  double share = body.material.k / body.material.k_max;
  if (share > 0.99) share = 0.99;
  const double c = -30.0 * m * std::log(1.0 - share);
  const auto& edges = body.mesh->topology.edges();
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto i = static_cast<std::size_t>(3 * edges[e][0]);
    const auto j = static_cast<std::size_t>(3 * edges[e][1]);
    const double dx = part.x[j] - part.x[i];
    const double dy = part.x[j + 1] - part.x[i + 1];
    const double dz = part.x[j + 2] - part.x[i + 2];
    const double length = std::sqrt(dx * dx + dy * dy + dz * dz);
    if (length == 0.0) continue;  // no direction to act in
    const double approach = ((part.v[j] - part.v[i]) * dx + (part.v[j + 1] - part.v[i + 1]) * dy +
                             (part.v[j + 2] - part.v[i + 2]) * dz) /
                            length;
    const double force = body.material.k * (length - body.mesh->rest_lengths[e]) + c * approach;
    const double scale = force / length / m;
    part.a[i] += scale * dx;
    part.a[i + 1] += scale * dy;
    part.a[i + 2] += scale * dz;
    part.a[j] -= scale * dx;
    part.a[j + 1] -= scale * dy;
    part.a[j + 2] -= scale * dz;
  }
}

/// A triangle relative to the body's first vertex, which keeps the digits of a body far away; the
/// volume of a closed mesh and its triangles' area vectors are the same about any point.
struct Corner {
  double x, y, z;
};
Corner corner(const Part& part, int vertex) {
  const auto i = static_cast<std::size_t>(3 * vertex);
  return {part.x[i] - part.x[0], part.x[i + 1] - part.x[1], part.x[i + 2] - part.x[2]};
}

/// V = 1/6 sum a . (b x c) (ERRATA row 2).
double volume_of(const sim::SoftBody& body, const Part& part) {
  double six_volumes = 0.0;
  for (const auto& triangle : body.mesh->topology.triangles()) {
    const Corner a = corner(part, triangle[0]);
    const Corner b = corner(part, triangle[1]);
    const Corner c = corner(part, triangle[2]);
    six_volumes += a.x * (b.y * c.z - b.z * c.y) + a.y * (b.z * c.x - b.x * c.z) +
                   a.z * (b.x * c.y - b.y * c.x);
  }
  return six_volumes / 6.0;
}

/// P = nRT / V0 (V0 / V)^g less the pressure outside (row 69) on each triangle's area vector, a
/// third to each corner (ERRATA rows 1 and 3), scaled by the corner's weight (row 4).
bool add_pressure(const sim::SoftBody& body, const std::vector<double>& weights, const Part& part) {
  const double nrt = body.material.n * 8.314472 * body.material.temperature;
  if (nrt == 0.0) return true;
  const double volume = volume_of(body, part);
  if (!(volume > 0.0)) return false;
  const double start = body.material.start_volume;
  const double pressure = nrt / start * std::pow(start / volume, body.material.gas_exponent) -
                          body.material.ambient_pressure;
  for (const auto& triangle : body.mesh->topology.triangles()) {
    const Corner a = corner(part, triangle[0]);
    const Corner b = corner(part, triangle[1]);
    const Corner c = corner(part, triangle[2]);
    const double ux = b.x - a.x, uy = b.y - a.y, uz = b.z - a.z;
    const double wx = c.x - a.x, wy = c.y - a.y, wz = c.z - a.z;
    const double area_x = 0.5 * (uy * wz - uz * wy);
    const double area_y = 0.5 * (uz * wx - ux * wz);
    const double area_z = 0.5 * (ux * wy - uy * wx);
    for (const int vertex : triangle) {
      const auto i = static_cast<std::size_t>(3 * vertex);
      const double scale =
          weights[static_cast<std::size_t>(vertex)] * pressure / 3.0 / body.material.vertex_mass;
      part.a[i] += scale * area_x;
      part.a[i + 1] += scale * area_y;
      part.a[i + 2] += scale * area_z;
    }
  }
  return true;
}

/// s of a triangle of the normal n (row 72), and its derivative by the area.
struct Weight {
  double value = 1.0, slope = 0.0;
};
Weight weight_of(const sim::Vec3& n, double area_at_rest) {
  const double a = 0.5 * n.norm() / (0.8 * area_at_rest);
  if (a >= 1.0) return {};
  return {(15.0 * a - 10.0 * std::pow(a, 3) + 3.0 * std::pow(a, 5)) / 8.0,
          15.0 / 8.0 * std::pow(1.0 - a * a, 2) / (0.8 * area_at_rest)};
}

/// A hinge as it is: t, the angle between its triangles; their normals, as long as twice their
/// areas; and how the vertices move as t falls.
struct Hinge {
  Hinge(const sim::HingeTable::Corners& hinge, const Part& part) : corners(hinge) {
    for (std::size_t i = 0; i < 4; ++i) {
      points[i] = sim::Vec3(part.x + 3 * static_cast<std::size_t>(corners[i]));
    }
    const auto& [x3, x4, x1, x2] = points;
    const sim::Vec3 along = x4 - x3;
    n1 = (x1 - x3).cross(x1 - x4);
    n2 = (x2 - x4).cross(x2 - x3);
    const double length = along.norm();
    angle = std::atan2(n1.cross(n2).dot(along) / length, n1.dot(n2));
    const sim::Vec3 u1 = length / n1.squaredNorm() * n1, u2 = length / n2.squaredNorm() * n2;
    const double s1 = (x1 - x4).dot(along) / (length * length);
    const double s2 = (x2 - x4).dot(along) / (length * length);
    const double r1 = (x1 - x3).dot(along) / (length * length);
    const double r2 = (x2 - x3).dot(along) / (length * length);
    falls = {s1 * u1 + s2 * u2, -r1 * u1 - r2 * u2, u1, u2};
  }

  /// dt/dt, rad/s.
  double rate(const Part& part) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < 4; ++i) {
      sum -= falls[i].dot(sim::Vec3(part.v + 3 * static_cast<std::size_t>(corners[i])));
    }
    return sum;
  }
  void add(std::size_t corner, const sim::Vec3& acceleration, const Part& part) const {
    for (int c = 0; c < 3; ++c) part.a[3 * corners[corner] + c] += acceleration[c];
  }
  /// Draws the triangle of these corners, in their turn about the normal `n`, larger: each corner
  /// along the height from the edge across it, by half of that edge.
  void enlarge(double strength, const sim::Vec3& n, const std::array<std::size_t, 3>& turn,
               const Part& part) const {
    for (std::size_t i = 0; i < 3 && strength != 0.0; ++i) {
      const sim::Vec3 across = points[turn[(i + 2) % 3]] - points[turn[(i + 1) % 3]];
      add(turn[i], 0.5 * strength * n.normalized().cross(across), part);
    }
  }

  const sim::HingeTable::Corners& corners;
  std::array<sim::Vec3, 4> points;
  sim::Vec3 n1, n2;
  double angle;
  std::array<sim::Vec3, 4> falls;
};

/// K (1 - s1 s2 cos(t - t0)) of every hinge: its derivative by t is the torque about the edge,
/// which acts on the vertices across it with the lever of their height, and on the edge's ends with
/// what balances both in force and torque (Bridson et al., Simulation of clothing with folds and
/// wrinkles, 2003, with E turned around). Damping adds K tau dt/dt, less of it from 0.9 down to 0.8
/// of a triangle's area at rest. Its derivatives by the areas draw the triangles larger.
void add_hinges(const sim::SoftBody& body, const Part& part) {
  if (body.material.bending == 0.0) return;
  const sim::HingeTable& hinges = *body.mesh->hinges;
  for (std::size_t e = 0; e < hinges.corners.size(); ++e) {
    const Hinge hinge(hinges.corners[e], part);
    const auto& [first_area, second_area] = hinges.areas[e];
    const double bent = hinge.angle - std::atan2(hinges.rest[e].sine, hinges.rest[e].cosine);
    const double left = 0.5 * std::min(hinge.n1.norm() / first_area, hinge.n2.norm() / second_area);
    const double damping =
        body.material.bending_damping * std::min(1.0, std::max(0.0, 10.0 * left - 8.0));
    const double scale = body.material.bending * hinges.weights[e] / body.material.vertex_mass;
    const Weight w1 = weight_of(hinge.n1, first_area), w2 = weight_of(hinge.n2, second_area);
    const double torque =
        scale * (w1.value * w2.value * std::sin(bent) + damping * hinge.rate(part));
    for (std::size_t i = 0; i < 4; ++i) hinge.add(i, torque * hinge.falls[i], part);
    const double drawn = scale * std::cos(bent);
    hinge.enlarge(drawn * w2.value * w1.slope, hinge.n1, {0, 1, 2}, part);
    hinge.enlarge(drawn * w1.value * w2.slope, hinge.n2, {1, 0, 3}, part);
  }
}

/// Gravity, and the drag that loses the fraction rho_g of the velocity in 1/60 s (ERRATA row 5).
void set_gravity_and_drag(const sim::SoftBody& body, const sim::Vec3& gravity, const Part& part) {
  const double gamma = -60.0 * std::log(1.0 - body.material.rho_g);
  const int vertices = body.mesh->topology.vertex_count();
  for (int i = 0; i < 3 * vertices; ++i) part.a[i] = gravity[i % 3] - gamma * part.v[i];
}

/// 1 (`uniform`), or springs of the vertex / mean springs (`valence`).
std::vector<double> pressure_weights(const sim::SoftBody& body) {
  const auto vertices = static_cast<std::size_t>(body.mesh->topology.vertex_count());
  if (body.material.pressure_weighting == sim::PressureWeighting::uniform) {
    return std::vector<double>(vertices, 1.0);
  }
  std::vector<double> springs(vertices, 0.0);
  double ends = 0.0;
  for (const auto& edge : body.mesh->topology.edges()) {
    for (const int vertex : edge) {
      springs[static_cast<std::size_t>(vertex)] += 1.0;
      ends += 1.0;
    }
  }
  const double mean = ends / static_cast<double>(vertices);
  for (double& weight : springs) weight /= mean;
  return springs;
}

}  // namespace

ReferenceEquation::ReferenceEquation(std::span<const sim::SoftBody> bodies,
                                     const sim::Vec3& gravity)
    : bodies_(bodies), gravity_(gravity) {
  for (const sim::SoftBody& body : bodies) {
    if (body.material.damping == sim::Damping::literal) {
      throw std::invalid_argument("literal damping is no differential equation");
    }
    pressure_weights_.push_back(pressure_weights(body));
    vertices_ += static_cast<std::size_t>(body.mesh->topology.vertex_count());
  }
}

bool ReferenceEquation::operator()(const double* state, double* derivative) const {
  const std::size_t velocities = 3 * vertices_;
  for (std::size_t i = 0; i < velocities; ++i) derivative[i] = state[velocities + i];
  std::size_t first = 0;
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const sim::SoftBody& body = bodies_[b];
    const Part part{state + first, state + velocities + first, derivative + velocities + first};
    set_gravity_and_drag(body, gravity_, part);
    add_springs(body, part);
    add_hinges(body, part);
    if (!add_pressure(body, pressure_weights_[b], part)) return false;
    first += static_cast<std::size_t>(3 * body.mesh->topology.vertex_count());
  }
  return true;
}

std::vector<double> flat_state(std::span<const sim::SoftBody> bodies) {
  std::vector<double> state;
  for (const auto array : {&sim::SoftBody::positions, &sim::SoftBody::velocities}) {
    for (const sim::SoftBody& body : bodies) {
      for (int v = 0; v < (body.*array).size(); ++v) {
        for (const double value : sim::Vec3((body.*array)[v])) state.push_back(value);
      }
    }
  }
  return state;
}

void read_flat_state(std::span<const double> state, std::span<sim::SoftBody> bodies) {
  std::size_t next = 0;
  for (const auto array : {&sim::SoftBody::positions, &sim::SoftBody::velocities}) {
    for (sim::SoftBody& body : bodies) {
      for (int v = 0; v < (body.*array).size(); ++v) {
        (body.*array)[v] = sim::Vec3(state[next], state[next + 1], state[next + 2]);
        next += 3;
      }
    }
  }
}

}  // namespace pneuma::app
