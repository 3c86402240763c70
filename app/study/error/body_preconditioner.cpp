#include "app/study/error/body_preconditioner.h"

#include <Eigen/LU>
#include <cmath>
#include <vector>

#include "sim/soft/damping.h"
#include "sim/soft/incremental_potential.h"

namespace pneuma::app {
namespace {

using sim::at;
using sim::Mat3;
using sim::Vec3;
using sim::VertexArray;

using Columns = Eigen::Map<const Eigen::Matrix3Xd>;

class OneBody {
 public:
  OneBody(const sim::SoftBody& body, BodyPreconditioning kind)
      : kind_(kind),
        mesh_(body.mesh),
        material_(body.material),
        opposite_(sim::opposite_vertices(mesh_->topology)),
        energy_(*mesh_),
        point_(*mesh_),
        velocities_(size()),
        matrix_(mesh_->topology, mesh_->hinges ? &*mesh_->hinges : nullptr),
        rank_one_(size()),
        rank_one_solved_(size()),
        inverse_(kind == BodyPreconditioning::blocks ? at(size()) : 0),
        known_(size()),
        unknown_(size()) {
    energy_.gas = sim::gas_law(material_);
    energy_.bending = material_.bending;
  }

  int size() const { return mesh_->topology.vertex_count(); }

  bool set_up(const Columns& x, const Columns& v, double gamma) {
    gamma_ = gamma;
    point_.positions.rows().topRows<3>() = x;
    velocities_.rows().topRows<3>() = v;
    set_energy();
    if (!sim::evaluate(*mesh_, energy_, point_)) return false;
    sim::hessian_without_rank_one(*mesh_, energy_, point_, opposite_, matrix_);
    if (has_gas()) {
      rank_one_.rows() = std::sqrt(sim::pressure_slope(energy_.gas, point_.volume)) *
                         point_.volume_gradient.rows();
    }
    return kind_ == BodyPreconditioning::blocks ? invert_blocks() : factorize();
  }

  void solve(const Columns& r, const Columns& s, double* dx, double* dv) {
    known_.rows().topRows<3>() = r;
    unknown_.rows().topRows<3>() = material_.vertex_mass / (gamma_ * gamma_) * (r + gamma_ * s);
    add_damped();
    if (kind_ == BodyPreconditioning::blocks) {
      for (int v = 0; v < size(); ++v) unknown_[v] = (inverse_[at(v)] * unknown_[v]).eval();
    } else {
      solve_by_factors();
    }
    const auto solved = unknown_.rows().topRows<3>();
    Eigen::Map<Eigen::Matrix3Xd>(dx, 3, size()) = solved;
    Eigen::Map<Eigen::Matrix3Xd>(dv, 3, size()) = (solved - known_.rows().topRows<3>()) / gamma_;
  }

 private:
  bool has_gas() const { return energy_.gas.strength > 0.0; }

  /// Springs and dashpots as springs of one stiffness with the same force.
  void set_energy() {
    const double dashpot = sim::dashpot_constant(material_);
    energy_.inertia =
        material_.vertex_mass * (1.0 + gamma_ * sim::drag_rate(material_)) / (gamma_ * gamma_);
    energy_.stiffness = material_.k + dashpot / gamma_;
    const auto& edges = mesh_->topology.edges();
    for (std::size_t e = 0; e < edges.size(); ++e) {
      const auto& [a, b] = edges[e];
      const Vec3 edge = point_.positions[b] - point_.positions[a];
      const double length = edge.norm();
      const double opening = edge.dot(velocities_[b] - velocities_[a]) / length;
      const double force = material_.k * (length - mesh_->rest_lengths[e]) + dashpot * opening;
      energy_.rest_lengths[e] = length - force / energy_.stiffness;
    }
  }

  /// C r / gamma, onto what is known of the right side.
  void add_damped() {
    const double dashpot = sim::dashpot_constant(material_) / gamma_;
    unknown_.rows() += material_.vertex_mass * sim::drag_rate(material_) / gamma_ * known_.rows();
    for (const auto& [a, b] : mesh_->topology.edges()) {
      const Vec3 edge = point_.positions[b] - point_.positions[a];
      const Vec3 apart = known_[b] - known_[a];
      const Vec3 pull = dashpot * edge.dot(apart) / edge.squaredNorm() * edge;
      unknown_[a] -= pull;
      unknown_[b] += pull;
    }
  }

  bool invert_blocks() {
    for (int v = 0; v < size(); ++v) {
      Mat3 block = matrix_.diagonal_block(v);
      block += rank_one_[v] * rank_one_[v].transpose();
      bool invertible = false;
      block.computeInverseWithCheck(inverse_[at(v)], invertible);
      if (!invertible) return false;
    }
    return true;
  }

  bool factorize() {
    if (!matrix_.factorize()) return false;
    if (has_gas()) {
      rank_one_solved_.rows() = rank_one_.rows();
      matrix_.solve(rank_one_solved_);
    }
    return true;
  }

  /// Sherman and Morrison's formula.
  void solve_by_factors() {
    matrix_.solve(unknown_);
    if (!has_gas()) return;
    const double along =
        sim::dot(rank_one_, unknown_) / (1.0 + sim::dot(rank_one_, rank_one_solved_));
    unknown_.rows() -= along * rank_one_solved_.rows();
  }

  BodyPreconditioning kind_;
  std::shared_ptr<const sim::SoftMesh> mesh_;
  sim::SoftMaterial material_;
  std::vector<std::array<int, 2>> opposite_;
  double gamma_ = 1.0;
  sim::IncrementalPotential energy_;
  sim::EnergyPoint point_;
  VertexArray velocities_;
  sim::VertexMatrix matrix_;
  VertexArray rank_one_, rank_one_solved_;
  std::vector<Mat3> inverse_;
  VertexArray known_, unknown_;
};

class BodyPreconditioner final : public Sundials::Preconditioner {
 public:
  BodyPreconditioner(std::span<const sim::SoftBody> bodies, BodyPreconditioning kind) {
    for (const sim::SoftBody& body : bodies) {
      bodies_.push_back(std::make_unique<OneBody>(body, kind));
      values_ += 3 * body.positions.size();
    }
  }

  bool set_up(const double* state, double gamma) override {
    for (const auto& body : bodies_) {
      if (!body->set_up(Columns(state, 3, body->size()), Columns(state + values_, 3, body->size()),
                        gamma)) {
        return false;
      }
      state += std::ptrdiff_t{3} * body->size();
    }
    return true;
  }

  void solve(const double* r, double* z) override {
    for (const auto& body : bodies_) {
      body->solve(Columns(r, 3, body->size()), Columns(r + values_, 3, body->size()), z,
                  z + values_);
      r += std::ptrdiff_t{3} * body->size();
      z += std::ptrdiff_t{3} * body->size();
    }
  }

 private:
  std::vector<std::unique_ptr<OneBody>> bodies_;  // apart, as matrices refer to their meshes
  std::ptrdiff_t values_ = 0;                     // of all positions
};

}  // namespace

std::unique_ptr<Sundials::Preconditioner> make_body_preconditioner(
    std::span<const sim::SoftBody> bodies, BodyPreconditioning kind) {
  return std::make_unique<BodyPreconditioner>(bodies, kind);
}

}  // namespace pneuma::app
