// Squared distances from planes and points, summed: a quadratic function of the place.
#pragma once

#include <cmath>

#include "sim/mesh/triangle_mesh.h"

namespace pneuma::assets {

/// x' A x - 2 b' x + c, with A symmetric. Written out in numbers, so that every compiler rounds
/// alike.
class Quadric {
 public:
  /// Adds weight (normal . x - distance)^2.
  void add_plane(const sim::Vec3& normal, double distance, double weight) {
    const double x = normal.x(), y = normal.y(), z = normal.z(), w = weight;
    xx_ += w * x * x, xy_ += w * x * y, xz_ += w * x * z;
    yy_ += w * y * y, yz_ += w * y * z, zz_ += w * z * z;
    bx_ += w * distance * x, by_ += w * distance * y, bz_ += w * distance * z;
    c_ += w * distance * distance;
  }

  /// Adds weight |x - point|^2.
  void add_point(const sim::Vec3& point, double weight) {
    xx_ += weight, yy_ += weight, zz_ += weight;
    bx_ += weight * point.x(), by_ += weight * point.y(), bz_ += weight * point.z();
    c_ += weight * dot(point, point);
  }

  Quadric& operator+=(const Quadric& other) {
    xx_ += other.xx_, xy_ += other.xy_, xz_ += other.xz_;
    yy_ += other.yy_, yz_ += other.yz_, zz_ += other.zz_;
    bx_ += other.bx_, by_ += other.by_, bz_ += other.bz_;
    c_ += other.c_;
    return *this;
  }

  double value(const sim::Vec3& at) const {
    const double x = at.x(), y = at.y(), z = at.z();
    return x * (xx_ * x + 2.0 * (xy_ * y + xz_ * z - bx_)) + y * (yy_ * y + 2.0 * (yz_ * z - by_)) +
           z * (zz_ * z - 2.0 * bz_) + c_;
  }

  /// Where it is least on the plane normal . x = distance; not finite where there is no such place.
  sim::Vec3 minimum_on(const sim::Vec3& normal, double distance) const {
    const sim::Vec3 free = solved(sim::Vec3(bx_, by_, bz_));
    const sim::Vec3 towards = solved(normal);
    return free + (distance - dot(normal, free)) / dot(normal, towards) * towards;
  }

 private:
  static double dot(const sim::Vec3& a, const sim::Vec3& b) {
    return a.x() * b.x() + a.y() * b.y() + a.z() * b.z();
  }

  /// The x of A x = right, by Cramer's rule.
  sim::Vec3 solved(const sim::Vec3& right) const {
    const double cxx = yy_ * zz_ - yz_ * yz_, cxy = xz_ * yz_ - xy_ * zz_,
                 cxz = xy_ * yz_ - xz_ * yy_;
    const double cyy = xx_ * zz_ - xz_ * xz_, cyz = xy_ * xz_ - xx_ * yz_,
                 czz = xx_ * yy_ - xy_ * xy_;
    const double determinant = xx_ * cxx + xy_ * cxy + xz_ * cxz;
    const double x = right.x(), y = right.y(), z = right.z();
    return sim::Vec3(cxx * x + cxy * y + cxz * z, cxy * x + cyy * y + cyz * z,
                     cxz * x + cyz * y + czz * z) /
           determinant;
  }

  double xx_ = 0.0, xy_ = 0.0, xz_ = 0.0, yy_ = 0.0, yz_ = 0.0, zz_ = 0.0;
  double bx_ = 0.0, by_ = 0.0, bz_ = 0.0;
  double c_ = 0.0;
};

}  // namespace pneuma::assets
