#include "sim/potential/world_matrix.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "sim/base/block_inverse.h"
#include "sim/soft/vertex_matrix.h"

namespace pneuma::sim {
namespace {

/// Of r^T M^-1 r, M the preconditioner: negative curvature nearer to 0 counts as this much.
constexpr double min_curvature = 1e-3;
/// Per vertex: as many iterations as there are coordinates solve any system but for rounding.
constexpr int iterations_per_vertex = 3;

}  // namespace

WorldMatrix::WorldMatrix(std::vector<std::uint8_t> is_mobile)
    : is_mobile_(std::move(is_mobile)),
      diagonal_(is_mobile_.size(), Mat3::Zero()),
      inverse_(is_mobile_.size()),
      box_of_vertex_(is_mobile_.size(), -1),
      corners_(static_cast<int>(is_mobile_.size())),
      residual_(static_cast<int>(is_mobile_.size())),
      preconditioned_(static_cast<int>(is_mobile_.size())),
      search_(static_cast<int>(is_mobile_.size())),
      product_(static_cast<int>(is_mobile_.size())) {}

void WorldMatrix::clear() {
  std::fill(diagonal_.begin(), diagonal_.end(), Mat3::Zero());
  between_.clear();
  between_blocks_.clear();
  rank_one_count_ = 0;
  blocks_.clear();
  frames_.clear();
  boxes_.clear();
}

void WorldMatrix::add_diagonal(int vertex, double value) {
  diagonal_[at(vertex)].diagonal().array() += value;
}

void WorldMatrix::add_between(int a, int b, const Mat3x4& block) {
  between_.push_back({a, b});
  between_blocks_.push_back(block);
}

void WorldMatrix::add_rank_one(int first, const VertexArray& q) {
  if (rank_one_count_ == rank_ones_.size()) rank_ones_.emplace_back();
  RankOne& part = rank_ones_[rank_one_count_++];
  part.first = first;
  part.q = q;
}

void WorldMatrix::add(const std::array<int, 4>& vertices, const Mat12& block) {
  for (int i = 0; i < 4; ++i) {
    add(vertices[at(i)], block.block<3, 3>(3 * i, 3 * i));
    for (int j = i + 1; j < 4; ++j) {
      add_between(vertices[at(i)], vertices[at(j)], mat3x4(block.block<3, 3>(3 * i, 3 * j)));
    }
  }
}

void WorldMatrix::add_box(const BoxFrame& frame, const Mat6& own, double squared_radius) {
  const int index = static_cast<int>(boxes_.size());
  for (int i = 0; i < box_corners; ++i) box_of_vertex_[at(frame.first_vertex + i)] = index;
  frames_.push_back(frame);
  boxes_.push_back({own, squared_radius, Mat6::Zero(), Mat6::Zero()});
}

void WorldMatrix::multiply(const VertexArray& values, VertexArray& product) const {
  if (boxes_.empty()) return multiply_vertices(values, product);
  corners_.rows() = values.rows();
  expand(frames_, corners_);
  multiply_vertices(corners_, product);
  for (const BoxFrame& frame : frames_) contract(frame, product);
  for (std::size_t b = 0; b < boxes_.size(); ++b) {
    const BoxFrame& frame = frames_[b];
    set_six(frame, six_of(frame, product) + boxes_[b].own * six_of(frame, values), product);
  }
}

void WorldMatrix::multiply_vertices(const VertexArray& values, VertexArray& product) const {
  const VertexReader x(values), y(product);
  const VertexWriter out(product);
  for (int v = 0; v < values.size(); ++v) product[v] = diagonal_[at(v)] * values[v];
  for (std::size_t i = 0; i < between_.size(); ++i) {
    const auto& [a, b] = between_[i];
    const Mat3x4& block = between_blocks_[i];
    out.put(a, y[a] + block * x[b]);
    out.put(b, y[b] + transposed(block) * x[a]);
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
  for (std::size_t v = 0; v < whole.size(); ++v) {
    if (is_mobile_[v] == 0 || box_of_vertex_[v] >= 0) continue;
    whole[v].diagonal().array() += shift;
    Mat3 inverse;
    if (!base::invert_positive_definite(whole[v], inverse)) return false;
    inverse_[v] = mat3x4(inverse);
  }
  return boxes_.empty() || invert_boxes(shift);
}

bool WorldMatrix::invert_boxes(double shift) {
  for (Box& box : boxes_) box.whole = box.own;
  for (const WeightedBlock& term : blocks_) add_to_boxes(term);
  add_corners_to_boxes();
  for (Box& box : boxes_) {
    box.whole.diagonal().head<3>().array() += shift;
    box.whole.diagonal().tail<3>().array() += shift * box.squared_radius;
    const Eigen::LLT<Mat6> factor(box.whole);
    if (factor.info() != Eigen::Success) return false;
    box.inverse = factor.solve(Mat6::Identity());
  }
  return true;
}

/// How the weighted sum of a term's vertices moves with a box.
Mat3x6 WorldMatrix::rates_of(const WeightedBlock& term, int box) const {
  Mat3x6 sum = Mat3x6::Zero();
  for (int i = 0; i < term.count; ++i) {
    const int v = term.vertices[at(i)];
    if (box_of(v) == box) sum += term.weights[at(i)] * frames_[at(box)].rates(v);
  }
  return sum;
}

void WorldMatrix::add_to_boxes(const WeightedBlock& term) {
  int last = -1;  // the vertices of a surface follow each other
  for (int i = 0; i < term.count; ++i) {
    const int box = box_of(term.vertices[at(i)]);
    if (box < 0 || box == last) continue;
    last = box;
    const Mat3x6 rates = rates_of(term, box);
    boxes_[at(box)].whole += rates.transpose() * (term.block * rates);
  }
}

/// The blocks of corners, and between corners of one box.
void WorldMatrix::add_corners_to_boxes() {
  for (std::size_t b = 0; b < boxes_.size(); ++b) {
    for (int i = 0; i < box_corners; ++i) {
      const int v = frames_[b].first_vertex + i;
      const Mat3x6 rates = frames_[b].rates(v);
      boxes_[b].whole += rates.transpose() * (diagonal_[at(v)] * rates);
    }
  }
  for (std::size_t i = 0; i < between_.size(); ++i) {
    const auto& [v, w] = between_[i];
    const int box = box_of(v);
    if (box < 0 || box_of(w) != box) continue;
    const BoxFrame& frame = frames_[at(box)];
    const Mat6 part = frame.rates(v).transpose() * (to_mat3(between_blocks_[i]) * frame.rates(w));
    boxes_[at(box)].whole += part + part.transpose();
  }
}

void WorldMatrix::precondition() {
  const VertexReader residual(residual_);
  const VertexWriter out(preconditioned_);
  for (int v = 0; v < residual_.size(); ++v) {
    out.put(v, is_mobile_[at(v)] != 0 ? inverse_[at(v)] * residual[v] : Vec4d{});
  }
  for (std::size_t b = 0; b < boxes_.size(); ++b) {
    set_six(frames_[b], boxes_[b].inverse * six_of(frames_[b], residual_), preconditioned_);
  }
}

/// To the product with what is searched along.
void WorldMatrix::add_shift(double shift) {
  product_.rows() += shift * search_.rows();
  for (std::size_t b = 0; b < boxes_.size(); ++b) {
    const int turn = frames_[b].first_vertex + 1;
    product_[turn] += shift * (boxes_[b].squared_radius - 1.0) * search_[turn];
  }
}

void WorldMatrix::clear_fixed(VertexArray& values) const {
  for (int v = 0; v < values.size(); ++v) {
    if (is_mobile_[at(v)] == 0) values[v].setZero();
  }
}

WorldMatrix::End WorldMatrix::solve(const VertexArray& right, double shift, double forcing,
                                    VertexArray& direction) {
  if (!invert_diagonal(shift)) return End::not_positive;
  direction.rows().setZero();
  residual_.rows() = right.rows();
  precondition();
  search_.rows() = preconditioned_.rows();
  double size = dot(residual_, preconditioned_);
  const double target = forcing * forcing * size;
  const int max_iterations = iterations_per_vertex * right.size();
  for (int i = 0; i < max_iterations && size > target; ++i) {
    ++iterations_;
    multiply(search_, product_);
    clear_fixed(product_);
    add_shift(shift);
    const double curvature = dot(search_, product_);
    if (!std::isfinite(curvature)) return End::not_positive;
    if (curvature <= 0.0) {
      direction.rows() += size / std::max(-curvature, min_curvature * size) * search_.rows();
      return End::negative_curvature;
    }
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
