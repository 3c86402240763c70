#include "sim/collision/box_contact.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/collision/separating_axis.h"

namespace pneuma::sim {

namespace {

/// rad: edges whose normal is so near to that of a face touch as this face does.
constexpr double angle_of_face = 0.1;
/// Of half the boxes' shortest sides: a point that is no further from the depth is as deep.
constexpr double same_depth = 1e-6;
/// Of the shortest half side of both: boxes that are apart, and share a narrower strip of their
/// faces, do not face each other, as a box on the ground does not face a slab whose top is level
/// with that.
constexpr double narrow = 5e-5;

double narrow_strip(const OrientedBox& one, const OrientedBox& other) {
  return narrow * std::min(one.half.minCoeff(), other.half.minCoeff());
}

/// The incident face while it is being clipped: a convex polygon, in the reference face's
/// coordinates. A square clipped by four lines has at most eight corners; what rounding might
/// add to those repeats a neighbour and is dropped.
class Polygon {
 public:
  int size() const { return size_; }
  const Vec3& operator[](int i) const { return corners_[at(i % size_)]; }
  void add(const Vec3& corner) {
    if (size_ < BoxContact::max_points) corners_[at(size_++)] = corner;
  }
  double extent(int coordinate) const {
    const auto [least, greatest] = std::minmax_element(
        corners_.begin(), corners_.begin() + size_,
        [&](const Vec3& a, const Vec3& b) { return a[coordinate] < b[coordinate]; });
    return size_ == 0 ? 0.0 : (*greatest)[coordinate] - (*least)[coordinate];
  }
  bool is_within(int coordinate, double sign, double limit) const {
    return std::all_of(corners_.begin(), corners_.begin() + size_,
                       [&](const Vec3& corner) { return sign * corner[coordinate] <= limit; });
  }

 private:
  int size_ = 0;
  std::array<Vec3, BoxContact::max_points> corners_;
};

/// Sutherland and Hodgman's clipping, by sign * coordinate <= limit.
void clip(Polygon& polygon, int coordinate, double sign, double limit) {
  if (polygon.is_within(coordinate, sign, limit)) return;
  Polygon result;
  for (int i = 0; i < polygon.size(); ++i) {
    const Vec3& here = polygon[i];
    const Vec3& next = polygon[i + 1];
    const double here_beyond = sign * here[coordinate] - limit;
    const double next_beyond = sign * next[coordinate] - limit;
    if (here_beyond <= 0.0) result.add(here);
    if ((here_beyond <= 0.0) == (next_beyond <= 0.0)) continue;
    Vec3 crossing = here + here_beyond / (here_beyond - next_beyond) * (next - here);
    crossing[coordinate] = sign * limit;
    result.add(crossing);
  }
  polygon = result;
}

/// The face that the boxes' normal belongs to, on one box, and the box that meets it.
struct FacePair {
  const OrientedBox& reference;
  const OrientedBox& incident;
  int axis;      // of the reference face
  Vec3 outward;  // its normal, towards the incident box

  int u() const { return (axis + 1) % 3; }
  int v() const { return (axis + 2) % 3; }

  /// A point in the reference face's coordinates: along its two sides, and the height over it.
  Vec3 to_face(const Vec3& point) const {
    const Vec3 offset = point - reference.centre;
    return {offset.dot(reference.axes.col(u())), offset.dot(reference.axes.col(v())),
            offset.dot(outward) - reference.half[axis]};
  }
  Vec3 to_world(const Vec3& at_face) const {
    return reference.centre + at_face.x() * reference.axes.col(u()) +
           at_face.y() * reference.axes.col(v()) + (reference.half[axis] + at_face.z()) * outward;
  }
};

/// The corners, in order, of the face of a box whose outward normal is most opposed to `direction`.
std::array<Vec3, 4> incident_face(const OrientedBox& box, const Vec3& direction) {
  const Vec3 along = box.axes.transpose() * direction;
  int axis = 0;
  along.cwiseAbs().maxCoeff(&axis);
  const int u = (axis + 1) % 3;
  const int v = (axis + 2) % 3;
  const double side = along[axis] > 0.0 ? -box.half[axis] : box.half[axis];
  const Vec3 middle = box.centre + side * box.axes.col(axis);
  const Vec3 to_u = box.half[u] * box.axes.col(u);
  const Vec3 to_v = box.half[v] * box.axes.col(v);
  return {middle + to_u + to_v, middle - to_u + to_v, middle - to_u - to_v, middle + to_u - to_v};
}

/// The number of the corner that reaches farthest in a direction.
int support_corner(const OrientedBox& box, const Vec3& direction) {
  const Vec3 along = box.axes.transpose() * direction;
  return (along.x() > 0.0 ? 1 : 0) + (along.y() > 0.0 ? 2 : 0) + (along.z() > 0.0 ? 4 : 0);
}

/// Cuts the incident face off at the reference face's sides.
Polygon shared_face(const FacePair& faces) {
  Polygon polygon;
  for (const Vec3& corner : incident_face(faces.incident, faces.outward)) {
    polygon.add(faces.to_face(corner));
  }
  const double u_limit = faces.reference.half[faces.u()];
  const double v_limit = faces.reference.half[faces.v()];
  clip(polygon, 0, 1.0, u_limit);
  clip(polygon, 0, -1.0, u_limit);
  clip(polygon, 1, 1.0, v_limit);
  clip(polygon, 1, -1.0, v_limit);
  return polygon;
}

/// What the boxes share of their faces and is no higher than `reach` over the reference face
/// touches. All points are kept: a choice of the deepest four would change from step to step.
/// `cosine`: of the angle from the face's normal to the contact's.
void add_shared_points(BoxContact& contact, const FacePair& faces, double cosine, double reach) {
  const Polygon polygon = shared_face(faces);
  const double across = std::min(polygon.extent(0), polygon.extent(1));
  if (contact.depth < 0.0 && across < narrow_strip(faces.reference, faces.incident)) return;
  for (int i = 0; i < polygon.size(); ++i) {
    const Vec3& corner = polygon[i];
    const double height = cosine * corner.z();
    if (height > reach) continue;
    contact.all[at(contact.count++)] = {faces.to_world(corner), -height};
  }
}

void add_face_points(BoxContact& contact, const FacePair& faces, double reach) {
  add_shared_points(contact, faces, 1.0, reach);
  if (contact.count > 0 || contact.depth < 0.0) return;
  // Of boxes that overlap only when this face was preferred to edges that overlap a little less:
  // the incident box passes the face by its side, and its deepest corner stands for it.
  const int corner = support_corner(faces.incident, -faces.outward);
  contact.all[at(contact.count++)] = {faces.incident.corner(corner), contact.depth};
}

/// The middle of the edge along `axis` that reaches farthest in `direction`.
Vec3 support_edge(const OrientedBox& box, int axis, const Vec3& direction) {
  Vec3 local = box.half;
  for (int k = 0; k < 3; ++k) {
    if (box.axes.col(k).dot(direction) < 0.0) local[k] = -local[k];
  }
  local[axis] = 0.0;
  return box.to_world(local);
}

/// Halfway between the nearest points of the two edges p + s a and q + t b. There the line between
/// them is at right angles to both: with r = p - q and c = a.b,
///   s = (c b.r - a.r) / (1 - c^2),  t = (b.r - c a.r) / (1 - c^2).
/// The axis exists, so the edges are not parallel. Edges of boxes that are apart may not cross, or
/// at their ends: these pass each other by their sides.
void add_edge_point(BoxContact& contact, const OrientedBox& first, const OrientedBox& second,
                    const MinOverlap& overlap) {
  const Vec3 p = support_edge(first, overlap.first_axis, -overlap.normal);
  const Vec3 q = support_edge(second, overlap.second_axis, overlap.normal);
  const Vec3 a = first.axes.col(overlap.first_axis);
  const Vec3 b = second.axes.col(overlap.second_axis);
  const Vec3 r = p - q;
  const double squared_sine = a.cross(b).squaredNorm();
  const double c = a.dot(b);
  const double s_reach = first.half[overlap.first_axis];
  const double t_reach = second.half[overlap.second_axis];
  const double s_on_line = (c * b.dot(r) - a.dot(r)) / squared_sine;
  const double t_on_line = (b.dot(r) - c * a.dot(r)) / squared_sine;
  const double s = std::clamp(s_on_line, -s_reach, s_reach);
  const double t = std::clamp(t_on_line, -t_reach, t_reach);
  const double strip = narrow_strip(first, second);
  const bool cross =
      std::abs(s_on_line) <= s_reach - strip && std::abs(t_on_line) <= t_reach - strip;
  if (overlap.overlap < 0.0 && !cross) return;
  const Vec3 middle = 0.5 * (p + s * a + q + t * b);
  contact.all[at(contact.count++)] = {middle, overlap.overlap};
}

/// The face whose normal is the contact's but for a small angle.
std::optional<FacePair> face_along(const Vec3& normal, const OrientedBox& first,
                                   const OrientedBox& second) {
  int of_first = 0, of_second = 0;
  const Vec3 along_first = first.axes.transpose() * normal;
  const Vec3 along_second = second.axes.transpose() * normal;
  const double first_cosine = along_first.cwiseAbs().maxCoeff(&of_first);
  const double second_cosine = along_second.cwiseAbs().maxCoeff(&of_second);
  if (std::max(first_cosine, second_cosine) < std::cos(angle_of_face)) return {};
  const auto outward = [](const OrientedBox& box, int axis, double sign) -> Vec3 {
    return std::copysign(1.0, sign) * box.axes.col(axis);
  };
  if (first_cosine >= second_cosine) {
    return FacePair{first, second, of_first, outward(first, of_first, -along_first[of_first])};
  }
  return FacePair{second, first, of_second, outward(second, of_second, along_second[of_second])};
}

/// Of long boxes that cross, of which one is turned a little: its far end is deeper below the
/// other's face than its edges are below the other's, but what the faces share is what touches.
/// Where the edges cross beside that, their point is one more.
void add_points_of_edges(BoxContact& contact, const OrientedBox& first, const OrientedBox& second,
                         const MinOverlap& overlap, double reach) {
  if (const auto faces = face_along(overlap.normal, first, second)) {
    add_shared_points(contact, *faces, std::abs(faces->outward.dot(overlap.normal)), reach);
  }
  const double allowed = same_depth * (first.half.minCoeff() + second.half.minCoeff());
  const auto is_nearest = [&](const BoxContactPoint& point) {
    return point.depth > overlap.overlap - allowed;
  };
  if (std::ranges::any_of(contact.points(), is_nearest)) return;
  contact.count = std::min(contact.count, BoxContact::max_points - 1);
  add_edge_point(contact, first, second, overlap);
}

std::optional<BoxContact> touch(const OrientedBox& first, const OrientedBox& second,
                                double reach_of_boxes, double reach_of_points) {
  const auto overlap = find_min_overlap(first, second, reach_of_boxes);
  if (!overlap) return {};
  BoxContact contact;
  contact.normal = overlap->normal;
  contact.depth = overlap->overlap;
  if (overlap->kind == AxisKind::edges) {
    add_points_of_edges(contact, first, second, *overlap, reach_of_points);
  } else if (overlap->kind == AxisKind::first_face) {
    add_face_points(contact, {first, second, overlap->first_axis, -overlap->normal},
                    reach_of_points);
  } else {
    add_face_points(contact, {second, first, overlap->second_axis, overlap->normal},
                    reach_of_points);
  }
  if (contact.count == 0) return {};  // they are apart, and pass each other by their sides
  return contact;
}

}  // namespace

std::optional<BoxContact> find_box_contact(const OrientedBox& first, const OrientedBox& second) {
  return touch(first, second, 0.0, 0.0);
}

std::optional<BoxContact> find_box_contact_within(double reach, const OrientedBox& first,
                                                  const OrientedBox& second) {
  return touch(first, second, reach, std::numeric_limits<double>::infinity());
}

}  // namespace pneuma::sim
