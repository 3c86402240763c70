#include "sim/collision/oriented_box.h"

#include "sim/mesh/vec4d.h"

namespace pneuma::sim {

Vec3 OrientedBox::corner(int i) const {
  const Vec3 side((i & 1) != 0 ? 1.0 : -1.0, (i & 2) != 0 ? 1.0 : -1.0, (i & 4) != 0 ? 1.0 : -1.0);
  return to_world(half.cwiseProduct(side));
}

Bounds bounds(const OrientedBox& box) {
  const Vec3 reach = box.axes.cwiseAbs() * box.half;
  return {box.centre - reach, box.centre + reach};
}

std::array<Vec3, 8> corners(const OrientedBox& box) {
  const Mat3x4 axes = mat3x4(box.axes);
  const Vec4d x = axes.columns[0] * box.half.x(), y = axes.columns[1] * box.half.y();
  const Vec4d z = axes.columns[2] * box.half.z(), centre = to_vec4d(box.centre);
  std::array<Vec3, 8> result;
  for (const int i : {0, 1, 2, 3, 4, 5, 6, 7}) {
    const Vec4d from_centre =
        ((i & 1) != 0 ? x : -x) + ((i & 2) != 0 ? y : -y) + ((i & 4) != 0 ? z : -z);
    result[at(i)] = to_vec3(centre + from_centre);
  }
  return result;
}

Vec3 nearest_point(const OrientedBox& box, const Vec3& point) {
  return box.to_world(box.to_local(point).cwiseMax(-box.half).cwiseMin(box.half));
}

// Section 5.2.2: inside when (p - t_i).n_i < 0 for every face, the depth being the largest of
// these. The two faces of one axis are |p_k| - half_k in the box's own coordinates.
std::optional<BoxExit> find_box_exit(const OrientedBox& box, const Vec3& point) {
  const Vec3 local = box.to_local(point);
  const Vec3 depths = box.half - local.cwiseAbs();
  int axis = 0;
  const double depth = depths.minCoeff(&axis);
  if (!(depth > 0.0)) return {};
  const bool negative = local[axis] < 0.0;
  const Vec3 normal = negative ? Vec3(-box.axes.col(axis)) : Vec3(box.axes.col(axis));
  return BoxExit{2 * axis + (negative ? 1 : 0), normal, point + depth * normal, depth};
}

}  // namespace pneuma::sim
