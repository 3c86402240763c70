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
  edges_.clear();
  rank_one_count_ = 0;
  blocks_.clear();
  wholes_.clear();
  frames_.clear();
  boxes_.clear();
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
    if (is_mobile_[v] == 0 || box_of_vertex_[v] >= 0) continue;
    whole[v].diagonal().array() += shift;
    const Eigen::LLT<Mat3> factor(whole[v]);
    if (factor.info() != Eigen::Success) return false;
    inverse_[v] = mat3x4(factor.solve(Mat3::Identity()));
  }
  return boxes_.empty() || invert_boxes(shift);
}

bool WorldMatrix::invert_boxes(double shift) {
  for (Box& box : boxes_) box.whole = box.own;
  for (const WeightedBlock& term : blocks_) add_to_boxes(term);
  for (const Whole& each : wholes_) add_to_boxes(each);
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

void WorldMatrix::add_to_boxes(const Whole& whole) {
  int last = -1;
  for (int i = 0; i < 4; ++i) {
    const int box = box_of(whole.vertices[at(i)]);
    if (box < 0 || box == last) continue;
    last = box;
    Eigen::Matrix<double, 12, 6> rates = Eigen::Matrix<double, 12, 6>::Zero();
    for (int j = 0; j < 4; ++j) {
      const int v = whole.vertices[at(j)];
      if (box_of(v) == box) rates.middleRows<3>(3 * j) = frames_[at(box)].rates(v);
    }
    boxes_[at(box)].whole += rates.transpose() * (whole.block * rates);
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
    add_shift(shift);
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
