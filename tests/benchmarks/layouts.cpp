#include "tests/benchmarks/layouts.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>

#include "sim/mesh/measure.h"
#include "sim/mesh/vec4d.h"
#include "sim/soft/damping.h"
#include "sim/soft/pressure_force.h"
#include "sim/soft/ring_forces.h"
#include "sim/soft/spring_force.h"

namespace pneuma::benchmarks {
namespace {

using namespace sim;

/// What the product does: rows x y z 0, coefficients edge by edge, all forces ring by ring.
class RowsAndRings : public Layout {
 public:
  explicit RowsAndRings(const SoftBody& body)
      : body_(body),
        coefficients_(body.mesh->rest_lengths.size()),
        ring_forces_(body.positions.size()) {}

  void evaluate() override {
    const SoftMaterial& material = body_.material;
    spring_coefficients(*body_.mesh, body_.positions, body_.velocities, material.k,
                        dashpot_constant(material), coefficients_);
    volume_ = gather_rings(body_.mesh->tables, body_.positions, coefficients_, ring_forces_);
  }
  VertexArray forces() const override {
    const double pressure = gas_strength(body_.material) / volume_;
    VertexArray result(body_.positions.size());
    for (int v = 0; v < result.size(); ++v) {
      result[v] = ring_forces_.rows()[RingForces::springs(v)] +
                  pressure / 6.0 * ring_forces_.rows()[RingForces::six_volume_gradients(v)];
    }
    return result;
  }

 private:
  SoftBody body_;
  std::vector<double> coefficients_;
  RingForces ring_forces_;
  double volume_ = 0.0;
};

/// The same rows through Eigen's three-vectors: coefficients edge by edge, springs gathered over
/// the rings, and the volume gradient over the rings once more.
class SpringsThenGather : public Layout {
 public:
  explicit SpringsThenGather(const SoftBody& body)
      : body_(body),
        coefficients_(body.mesh->rest_lengths.size()),
        gradient_(body.positions.size()),
        force_(body.positions.size()) {}

  void evaluate() override {
    const SoftMaterial& material = body_.material;
    const MeshTopology& topology = body_.mesh->topology;
    const VertexArray &x = body_.positions, &v = body_.velocities;
    const double c = dashpot_constant(material);
    for (std::size_t e = 0; e < coefficients_.size(); ++e) {
      const auto& [a, b] = topology.edges()[e];
      const Vec3 edge = x[b] - x[a];
      const double length = edge.norm();
      coefficients_[e] = material.k * (length - body_.mesh->rest_lengths[e]) / length +
                         c * (v[b] - v[a]).dot(edge) / (length * length);
    }
    for (int i = 0; i < topology.vertex_count(); ++i) {
      Vec3 force = Vec3::Zero();
      for (const auto& spoke : topology.ring(i)) {
        force += coefficients_[at(spoke.edge)] * (x[spoke.vertex] - x[i]);
      }
      force_[i] = force;
    }
    volume_gradient(topology, x, gradient_);
    force_.rows() += gas_strength(material) / volume(x, gradient_) * gradient_.rows();
  }
  VertexArray forces() const override { return force_; }

 private:
  SoftBody body_;
  std::vector<double> coefficients_;
  VertexArray gradient_, force_;
};

/// Splits pieces (edges, triangles) into groups of four that have no vertex in common, so that the
/// four can be added to their vertices at once; what is left over makes groups of its own.
template <std::size_t corners>
std::vector<std::array<int, 4>> disjoint_groups(
    const std::vector<std::array<int, corners>>& pieces) {
  std::vector<std::array<int, 4>> groups;
  std::vector<int> open;  // groups that are not full
  std::vector<std::size_t> filled;
  for (int p = 0; p < static_cast<int>(pieces.size()); ++p) {
    const auto meets = [&](int group) {
      for (std::size_t i = 0; i < filled[at(group)]; ++i) {
        for (const int v : pieces[at(groups[at(group)][i])]) {
          const auto& piece = pieces[at(p)];
          if (std::find(piece.begin(), piece.end(), v) != piece.end()) return true;
        }
      }
      return false;
    };
    auto group = std::find_if_not(open.begin(), open.end(), meets);
    if (group == open.end()) {
      groups.push_back({-1, -1, -1, -1});
      filled.push_back(0);
      open.push_back(static_cast<int>(groups.size()) - 1);
      group = open.end() - 1;
    }
    groups[at(*group)][filled[at(*group)]++] = p;
    if (filled[at(*group)] == 4) open.erase(group);
  }
  return groups;
}

/// Springs and triangles each add their forces to their vertices' rows, four disjoint ones at a
/// time.
class ColouredScatter : public Layout {
 public:
  explicit ColouredScatter(const SoftBody& body)
      : body_(body), gradient_(body.positions.size()), force_(body.positions.size()) {
    const MeshTopology& topology = body.mesh->topology;
    for (const auto& group : disjoint_groups(topology.edges())) {
      for (const int e : group) {  // an edge from a vertex to itself in place of none
        edges_.push_back(e < 0 ? ForceTables::Ends{0, 0} : body.mesh->tables.edges[at(e)]);
        rest_lengths_.push_back(e < 0 ? 0.0 : body.mesh->rest_lengths[at(e)]);
      }
    }
    for (const auto& group : disjoint_groups(topology.triangles())) {
      for (const int t : group) {
        if (t >= 0) triangles_.push_back(topology.triangles()[at(t)]);
      }
    }
  }

  void evaluate() override {
    force_.rows().setZero();
    gradient_.rows().setZero();
    add_springs();
    add_triangles();
    force_.rows() +=
        gas_strength(body_.material) / volume(body_.positions, gradient_) * gradient_.rows();
  }
  VertexArray forces() const override { return force_; }

 private:
  void add_springs() {
    const double* x = body_.positions.rows().data();
    const double* v = body_.velocities.rows().data();
    double* force = force_.rows().data();
    const double k = body_.material.k, c = dashpot_constant(body_.material);
    for (std::size_t e = 0; e < edges_.size(); e += 4) {
      std::array<Vec4d, 4> edge, rate;
      for (std::size_t i = 0; i < 4; ++i) {
        const auto& [a, b] = edges_[e + i];
        edge[i] = load_vec4d(x + b) - load_vec4d(x + a);
        rate[i] = load_vec4d(v + b) - load_vec4d(v + a);
      }
      const Vec3x4 d = to_columns(edge[0], edge[1], edge[2], edge[3]);
      const Vec3x4 u = to_columns(rate[0], rate[1], rate[2], rate[3]);
      const Vec4d squared = d.x * d.x + d.y * d.y + d.z * d.z + 1e-200;
      const Vec4d length = square_root(squared);
      const Vec4d pull = k * length * (length - load_vec4d(&rest_lengths_[e])) +
                         c * (d.x * u.x + d.y * u.y + d.z * u.z);
      const Vec4d coefficient = pull / squared;
      for (int i = 0; i < 4; ++i) {
        const auto& [a, b] = edges_[e + at(i)];
        const Vec4d part = coefficient[i] * edge[at(i)];
        store_vec4d(load_vec4d(force + a) + part, force + a);
        store_vec4d(load_vec4d(force + b) - part, force + b);
      }
    }
  }
  void add_triangles() {
    const VertexReader x(body_.positions), sum(gradient_);
    const VertexWriter out(gradient_);
    for (const auto& [a, b, c] : triangles_) {
      const Vec4d side = x[b] - x[a], other = x[c] - x[a];
      const Vec4d sixth = yzx(side * yzx(other) - yzx(side) * other) / 6.0;
      for (const int v : {a, b, c}) out.put(v, sum[v] + sixth);
    }
  }

  SoftBody body_;
  std::vector<ForceTables::Ends> edges_;
  std::vector<double> rest_lengths_;
  std::vector<Triangle> triangles_;
  VertexArray gradient_, force_;
};

/// Columns x, y, z: the loops over edges and rings gather single numbers, and the compiler
/// vectorises what it can.
class ColumnsWithGathers : public Layout {
 public:
  explicit ColumnsWithGathers(const SoftBody& body)
      : body_(body),
        x_(body.positions.rows().topRows<3>().transpose()),
        v_(body.velocities.rows().topRows<3>().transpose()),
        force_(x_.rows(), 3),
        gradient_(x_.rows(), 3),
        squared_(static_cast<Eigen::Index>(body.mesh->rest_lengths.size())),
        parting_(squared_.size()),
        coefficients_(squared_.size()) {}

  void evaluate() override {
    measure_edges();
    const Eigen::Map<const Eigen::ArrayXd> rest(body_.mesh->rest_lengths.data(), squared_.size());
    const double k = body_.material.k, c = dashpot_constant(body_.material);
    coefficients_ = k - (k * rest * squared_.sqrt() - c * parting_) / squared_;
    gather();
    const Eigen::RowVector3d centre = x_.colwise().mean().matrix();
    double volume = 0.0;
    for (int axis = 0; axis < 3; ++axis) {
      volume += ((x_.col(axis) - centre[axis]) * gradient_.col(axis)).sum() / 3.0;
    }
    force_ += gas_strength(body_.material) / volume * gradient_;
  }
  VertexArray forces() const override {
    VertexArray result(body_.positions.size());
    result.rows().topRows<3>() = force_.matrix().transpose();
    return result;
  }

 private:
  using Array3 = Eigen::Array<double, Eigen::Dynamic, 3>;

  void measure_edges() {
    const auto& edges = body_.mesh->topology.edges();
    const double *x = x_.col(0).data(), *y = x_.col(1).data(), *z = x_.col(2).data();
    const double *u = v_.col(0).data(), *v = v_.col(1).data(), *w = v_.col(2).data();
    for (std::size_t e = 0; e < edges.size(); ++e) {
      const auto& [a, b] = edges[e];
      const double dx = x[b] - x[a], dy = y[b] - y[a], dz = z[b] - z[a];
      squared_.data()[e] = dx * dx + dy * dy + dz * dz;
      parting_.data()[e] = dx * (u[b] - u[a]) + dy * (v[b] - v[a]) + dz * (w[b] - w[a]);
    }
  }
  void gather() {
    const MeshTopology& topology = body_.mesh->topology;
    const double *x = x_.col(0).data(), *y = x_.col(1).data(), *z = x_.col(2).data();
    for (int i = 0; i < topology.vertex_count(); ++i) {
      const auto ring = topology.ring(i);
      const int last = ring.back().vertex;
      double px = x[last] - x[i], py = y[last] - y[i], pz = z[last] - z[i];
      double fx = 0, fy = 0, fz = 0, gx = 0, gy = 0, gz = 0;
      for (const auto& spoke : ring) {
        const int n = spoke.vertex;
        const double dx = x[n] - x[i], dy = y[n] - y[i], dz = z[n] - z[i];
        const double s = coefficients_[spoke.edge];
        fx += s * dx, fy += s * dy, fz += s * dz;
        gx += py * dz - pz * dy, gy += pz * dx - px * dz, gz += px * dy - py * dx;
        px = dx, py = dy, pz = dz;
      }
      force_.row(i) << fx, fy, fz;
      gradient_.row(i) << gx / 6.0, gy / 6.0, gz / 6.0;
    }
  }

  SoftBody body_;
  Array3 x_, v_, force_, gradient_;
  Eigen::ArrayXd squared_, parting_, coefficients_;
};

/// Four equal bodies side by side: lane i of every number belongs to body i, so that nothing is
/// gathered or permuted.
class BodiesInLanes : public Layout {
 public:
  explicit BodiesInLanes(const SoftBody& body)
      : body_(body), x_(all_lanes(body.positions)), v_(all_lanes(body.velocities)) {
    force_.resize(x_.size());
    gradient_.resize(x_.size());
    coefficients_.resize(body.mesh->rest_lengths.size());
  }

  int bodies() const override { return 4; }
  void evaluate() override {
    measure_edges();
    Vec4d volume{};
    for (int i = 0; i < body_.positions.size(); ++i) volume += gather(i);
    const Vec4d pressure = gas_strength(body_.material) / volume;
    for (std::size_t i = 0; i < force_.size(); ++i) force_[i] += pressure * gradient_[i];
  }
  VertexArray forces() const override {
    VertexArray result(body_.positions.size());
    for (int i = 0; i < result.size(); ++i) {
      for (int axis = 0; axis < 3; ++axis) result[i][axis] = force_[at(3 * i + axis)][0];
    }
    return result;
  }

 private:
  static std::vector<Vec4d> all_lanes(const VertexArray& values) {
    std::vector<Vec4d> result;
    for (int i = 0; i < values.size(); ++i) {
      for (int axis = 0; axis < 3; ++axis) result.push_back(Vec4d{} + values[i][axis]);
    }
    return result;
  }
  static Vec3x4 difference(const std::vector<Vec4d>& values, int a, int b) {
    const Vec4d *from = &values[at(3 * a)], *to = &values[at(3 * b)];
    return {to[0] - from[0], to[1] - from[1], to[2] - from[2]};
  }
  void measure_edges() {
    const double k = body_.material.k, c = dashpot_constant(body_.material);
    for (std::size_t e = 0; e < coefficients_.size(); ++e) {
      const auto& [a, b] = body_.mesh->topology.edges()[e];
      const Vec3x4 d = difference(x_, a, b), u = difference(v_, a, b);
      const Vec4d squared = d.x * d.x + d.y * d.y + d.z * d.z;
      const Vec4d pull = k * body_.mesh->rest_lengths[e] * square_root(squared) -
                         c * (d.x * u.x + d.y * u.y + d.z * u.z);
      coefficients_[e] = k - pull / squared;
    }
  }
  Vec4d gather(int i) {
    const auto ring = body_.mesh->topology.ring(i);
    Vec3x4 previous = difference(x_, i, ring.back().vertex), f{}, g{};
    for (const auto& spoke : ring) {
      const Vec3x4 d = difference(x_, i, spoke.vertex);
      const Vec4d s = coefficients_[at(spoke.edge)];
      f.x += s * d.x, f.y += s * d.y, f.z += s * d.z;
      g.x += previous.y * d.z - previous.z * d.y;
      g.y += previous.z * d.x - previous.x * d.z;
      g.z += previous.x * d.y - previous.y * d.x;
      previous = d;
    }
    const std::array<Vec4d, 3> force = {f.x, f.y, f.z};
    const std::array<Vec4d, 3> gradient = {g.x / 6.0, g.y / 6.0, g.z / 6.0};
    std::copy(force.begin(), force.end(), &force_[at(3 * i)]);
    std::copy(gradient.begin(), gradient.end(), &gradient_[at(3 * i)]);
    const Vec3x4 r = difference(x_, 0, i);
    return (r.x * gradient[0] + r.y * gradient[1] + r.z * gradient[2]) / 3.0;
  }

  SoftBody body_;
  std::vector<Vec4d> x_, v_, force_, gradient_, coefficients_;
};

template <class T>
NamedLayout named(const std::string& name) {
  return {name, [](const SoftBody& body) { return std::make_unique<T>(body); }};
}

}  // namespace

const std::vector<NamedLayout>& layouts() {
  static const std::vector<NamedLayout> all = {
      named<RowsAndRings>("rows_and_rings"), named<SpringsThenGather>("springs_then_gather"),
      named<ColouredScatter>("coloured_scatter"), named<ColumnsWithGathers>("columns_with_gathers"),
      named<BodiesInLanes>("bodies_in_lanes")};
  return all;
}

}  // namespace pneuma::benchmarks
