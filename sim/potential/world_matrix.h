// The second derivative of the incremental potential of a whole world, as a sum of parts that can
// be multiplied and summed up, and Newton's directions by conjugate gradients.
//
// Parts: 3 x 3 blocks of vertices and between two of them, q q^T of each body's gas, 3 x 3 blocks
// between weighted sums of vertices, and a 6 x 6 block for each free box, whose corners take its
// six coordinates with them (box_frame.h). The preconditioner is block Jacobi, of a box in all of
// its coordinates.
#pragma once

#include <cstdint>
#include <vector>

#include "sim/mesh/vec4d.h"
#include "sim/mesh/vertex_array.h"
#include "sim/potential/box_frame.h"
#include "sim/potential/lagged_terms.h"

namespace pneuma::sim {

class WorldMatrix {
 public:
  /// `is_mobile`: rows and columns of other vertices are left out when it is solved for; of boxes
  /// all that carry no coordinates.
  explicit WorldMatrix(std::vector<std::uint8_t> is_mobile);

  void clear();
  void add_diagonal(int vertex, double value);
  void add(int vertex, const Mat3& block) { diagonal_[at(vertex)] += block; }
  /// In the rows of a and the columns of b, and transposed.
  void add_between(int a, int b, const Mat3x4& block);
  /// q q^T of the vertices from `first` on.
  void add_rank_one(int first, const VertexArray& q);
  std::vector<WeightedBlock>& blocks() { return blocks_; }
  void add(const std::array<int, 4>& vertices, const Mat12& block);
  /// A free box with its own second derivative; `squared_radius` (m^2): of what shifts the diagonal
  /// of ways, the part that shifts that of turns.
  void add_box(const BoxFrame& frame, const Mat6& own, double squared_radius);

  /// Of the boxes so far.
  const std::vector<BoxFrame>& frames() const { return frames_; }

  /// All of it times `values`. Of free boxes both are contracted.
  void multiply(const VertexArray& values, VertexArray& product) const;

  enum class End {
    solved,
    negative_curvature,  // H is not positive: p goes on along a direction in which it is not
    not_positive,        // not even the diagonal is: p means nothing
    too_slow,
  };
  /// Solves H p = right for the mobile vertices, on whose rows `right` must be zero elsewhere.
  /// `shift` is added to the diagonal. Of the residual, in the preconditioner's norm, the fraction
  /// `forcing` may be left. p . right > 0 but for not_positive.
  End solve(const VertexArray& right, double shift, double forcing, VertexArray& direction);

  int iterations() const { return iterations_; }  // of conjugate gradients so far

 private:
  struct RankOne {
    int first;
    VertexArray q;
  };
  struct Box {
    Mat6 own;
    double squared_radius;
    Mat6 whole;  // of all parts
    Mat6 inverse;
  };

  void multiply_vertices(const VertexArray& values, VertexArray& product) const;
  bool invert_diagonal(double shift);
  bool invert_boxes(double shift);
  int box_of(int vertex) const { return box_of_vertex_[at(vertex)]; }
  void add_to_boxes(const WeightedBlock& term);
  void add_corners_to_boxes();
  Mat3x6 rates_of(const WeightedBlock& term, int box) const;
  void add_shift(double shift);
  void precondition();
  void clear_fixed(VertexArray& values) const;

  std::vector<std::uint8_t> is_mobile_;
  std::vector<Mat3> diagonal_;
  std::vector<std::array<int, 2>> between_;  // the vertices of
  std::vector<Mat3x4> between_blocks_;
  std::vector<RankOne> rank_ones_;
  std::size_t rank_one_count_ = 0;
  std::vector<WeightedBlock> blocks_;
  std::vector<Mat3> whole_diagonal_;  // of all parts
  std::vector<Mat3x4> inverse_;
  std::vector<BoxFrame> frames_;
  std::vector<Box> boxes_;
  std::vector<int> box_of_vertex_;  // -1: of none
  mutable VertexArray corners_;     // what is multiplied, of boxes by corner
  VertexArray residual_, preconditioned_, search_, product_;
  int iterations_ = 0;
};

}  // namespace pneuma::sim
