#include "sim/potential/box_frame.h"

#include <Eigen/Geometry>

#include "sim/mesh/rotation.h"

namespace pneuma::sim {

Mat3x6 BoxFrame::rates(int vertex) const {
  Mat3x6 result;
  result.leftCols<3>().setIdentity();
  result.rightCols<3>() = -cross_matrix(arms[at(vertex - first_vertex)]);
  return result;
}

Vec6 six_of(const BoxFrame& frame, const VertexArray& values) {
  Vec6 six;
  six << values[frame.first_vertex], values[frame.first_vertex + 1];
  return six;
}

void set_six(const BoxFrame& frame, const Vec6& six, VertexArray& values) {
  for (int i = 2; i < box_corners; ++i) values[frame.first_vertex + i].setZero();
  values[frame.first_vertex] = six.head<3>();
  values[frame.first_vertex + 1] = six.tail<3>();
}

void expand(const std::vector<BoxFrame>& frames, VertexArray& values) {
  for (const BoxFrame& frame : frames) {
    const Vec6 six = six_of(frame, values);
    const Vec3 way = six.head<3>(), turn = six.tail<3>();
    for (int i = 0; i < box_corners; ++i) {
      values[frame.first_vertex + i] = way + turn.cross(frame.arms[at(i)]);
    }
  }
}

void contract(const BoxFrame& frame, VertexArray& values) {
  Vec6 six = Vec6::Zero();
  for (int i = 0; i < box_corners; ++i) {
    const Vec3 force = values[frame.first_vertex + i];
    six.head<3>() += force;
    six.tail<3>() += frame.arms[at(i)].cross(force);
  }
  set_six(frame, six, values);
}

}  // namespace pneuma::sim
