#include "sim/potential/world_matrix.h"

#include <Eigen/Cholesky>
#include <algorithm>

#include "sim/soft/vertex_matrix.h"

namespace pneuma::sim {
namespace {

/// The fraction of the residual, in the preconditioner's norm, that may be left.
constexpr double world_forcing_term = 1e-3;
/// Per vertex: as many iterations as there are coordinates solve any system but for rounding.
constexpr int iterations_per_vertex = 3;

}  // namespace

WorldMatrix::WorldMatrix(const std::vector<std::uint8_t>& is_mobile)
    : is_mobile_(is_mobile),
      diagonal_(is_mobile.size(), Mat3::Zero()),
      inverse_(is_mobile.size()),
      residual_(static_cast<int>(is_mobile.size())),
      preconditioned_(static_cast<int>(is_mobile.size())),
      search_(static_cast<int>(is_mobile.size())),
      product_(static_cast<int>(is_mobile.size())) {}

void WorldMatrix::clear() {
  std::fill(diagonal_.begin(), diagonal_.end(), Mat3::Zero());
  edges_.clear();
  rank_one_count_ = 0;
  blocks_.clear();
  wholes_.clear();
}

void WorldMatrix::add_diagonal(int vertex, double value) {
  diagonal_[at(vertex)].diagonal().array() += value;
}

void WorldMatrix::add_between(int a, int b, const Mat3& block) {
  edges_.push_back({a, b, mat3x4(block), mat3x4(block.transpose())});
}

void WorldMatrix::add_rank_one(int first, const VertexArray& q) {
  if (rank_one_count_ == rank_ones_.size()) rank_ones_.emplace_back();
  RankOne& part = rank_ones_[rank_one_count_++];
  part.first = first;
  part.q = q;
}

void WorldMatrix::add_whole(const std::array<int, 4>& vertices, const Mat12& block) {
  wholes_.push_back({vertices, block});
}

void WorldMatrix::multiply(const VertexArray& values, VertexArray& product) const {
  const VertexReader x(values), y(product);
  const VertexWriter out(product);
  for (int v = 0; v < values.size(); ++v) product[v] = diagonal_[at(v)] * values[v];
  for (const Edge& edge : edges_) {
    out.put(edge.a, y[edge.a] + edge.block * x[edge.b]);
    out.put(edge.b, y[edge.b] + edge.transposed * x[edge.a]);
  }
  for (std::size_t r = 0; r < rank_one_count_; ++r) {
    const RankOne& part = rank_ones_[r];
    const auto& q = part.q.rows();
    const double along = q.cwiseProduct(values.rows().middleCols(part.first, q.cols())).sum();
    product.rows().middleCols(part.first, q.cols()) += along * q;
  }
  for (const WeightedBlock& term : blocks_) {
    Vec3 sum = Vec3::Zero();
    for (int i = 0; i < term.count; ++i) {
      sum += term.weights[at(i)] * values[term.vertices[at(i)]];
    }
    const Vec3 force = term.block * sum;
    for (int i = 0; i < term.count; ++i) {
      product[term.vertices[at(i)]] += term.weights[at(i)] * force;
    }
  }
  for (const Whole& whole : wholes_) {
    Vec12 own;
    for (int i = 0; i < 4; ++i) own.segment<3>(3 * i) = values[whole.vertices[at(i)]];
    const Vec12 force = whole.block * own;
    for (int i = 0; i < 4; ++i) product[whole.vertices[at(i)]] += force.segment<3>(3 * i);
  }
}

bool WorldMatrix::invert_diagonal(double shift) {
  std::vector<Mat3>& whole = whole_diagonal_;
  whole = diagonal_;
  for (std::size_t r = 0; r < rank_one_count_; ++r) {
    const RankOne& part = rank_ones_[r];
    for (int v = 0; v < part.q.size(); ++v) {
      whole[at(part.first + v)] += part.q[v] * part.q[v].transpose();
    }
  }
  for (const WeightedBlock& term : blocks_) {
    for (int i = 0; i < term.count; ++i) {
      const double weight = term.weights[at(i)];
      whole[at(term.vertices[at(i)])] += weight * weight * term.block;
    }
  }
  for (const Whole& each : wholes_) {
    for (int i = 0; i < 4; ++i) {
      whole[at(each.vertices[at(i)])] += each.block.block<3, 3>(3 * i, 3 * i);
    }
  }
  for (std::size_t v = 0; v < whole.size(); ++v) {
    if (is_mobile_[v] == 0) continue;
    whole[v].diagonal().array() += shift;
    const Eigen::LLT<Mat3> factor(whole[v]);
    if (factor.info() != Eigen::Success) return false;
    inverse_[v] = mat3x4(factor.solve(Mat3::Identity()));
  }
  return true;
}

void WorldMatrix::precondition() {
  const VertexReader residual(residual_);
  const VertexWriter out(preconditioned_);
  for (int v = 0; v < residual_.size(); ++v) {
    out.put(v, is_mobile_[at(v)] != 0 ? inverse_[at(v)] * residual[v] : Vec4d{});
  }
}

void WorldMatrix::clear_fixed(VertexArray& values) const {
  for (int v = 0; v < values.size(); ++v) {
    if (is_mobile_[at(v)] == 0) values[v].setZero();
  }
}

WorldMatrix::End WorldMatrix::solve(const VertexArray& right, double shift,
                                    VertexArray& direction) {
  if (!invert_diagonal(shift)) return End::not_positive;
  direction.rows().setZero();
  residual_.rows() = right.rows();
  precondition();
  search_.rows() = preconditioned_.rows();
  double size = dot(residual_, preconditioned_);
  const double target = world_forcing_term * world_forcing_term * size;
  const int max_iterations = iterations_per_vertex * right.size();
  for (int i = 0; i < max_iterations && size > target; ++i) {
    ++iterations_;
    multiply(search_, product_);
    clear_fixed(product_);
    product_.rows() += shift * search_.rows();
    const double curvature = dot(search_, product_);
    if (!(curvature > 0.0)) return End::not_positive;
    const double length = size / curvature;
    direction.rows() += length * search_.rows();
    residual_.rows() -= length * product_.rows();
    precondition();
    const double before = size;
    size = dot(residual_, preconditioned_);
    search_.rows() = preconditioned_.rows() + size / before * search_.rows();
  }
  return size <= target ? End::solved : End::too_slow;
}

}  // namespace pneuma::sim
