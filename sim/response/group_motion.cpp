#include "sim/response/group_motion.h"

#include <Eigen/Cholesky>

#include "sim/rigid/inertia.h"

namespace pneuma::sim {
namespace {

Mat3 own_inertia(const RigidBox& box) {
  const Mat3 axes = box.orientation.toRotationMatrix();
  return axes * body_inertia(box).asDiagonal() * axes.transpose();
}

}  // namespace

template <class Visit>
void GroupMotion::visit_soft(const Visit& visit) const {
  for (const int body : bodies_) {
    if (at(body) < world_.soft.size()) visit(world_.soft[at(body)]);
  }
}

template <class Visit>
void GroupMotion::visit_vertices(const Visit& visit) const {
  visit_soft([&](const SoftBody& body) {
    for (int v = 0; v < body.positions.size(); ++v) {
      visit(body.material.vertex_mass, Vec3(body.positions[v]), Vec3(body.velocities[v]));
    }
  });
}

template <class Visit>
void GroupMotion::visit_boxes(const Visit& visit) const {
  for (const int body : bodies_) {
    if (at(body) >= world_.soft.size()) visit(world_.rigid[at(body) - world_.soft.size()]);
  }
}

void GroupMotion::leave_out_common() {
  find_mean();
  Vec3 angular_momentum = Vec3::Zero();
  visit_vertices([&](double m, const Vec3& x, const Vec3& v) {
    angular_momentum += m * (x - centre_).cross(v - velocity_);
  });
  visit_boxes([&](const RigidBox& box) {
    angular_momentum +=
        box.mass * (box.position - centre_).cross(box.velocity - velocity_) + spin(box);
  });
  angular_velocity_ = inertia().ldlt().solve(angular_momentum);
}

double GroupMotion::energy() const {
  double sum = 0.0;
  visit_vertices([&](double mass, const Vec3& x, const Vec3& v) {
    sum += 0.5 * mass * (v - common(x)).squaredNorm();
  });
  visit_boxes([&](const RigidBox& box) {
    const Vec3 own_spin = box.angular_velocity - angular_velocity_;
    sum += 0.5 * box.mass * (box.velocity - common(box.position)).squaredNorm() +
           0.5 * own_spin.dot(own_inertia(box) * own_spin);
  });
  return sum;
}

void GroupMotion::slow(double factor) {
  visit_soft([&](SoftBody& body) {
    for (int v = 0; v < body.positions.size(); ++v) {
      const Vec3 of_all = common(body.positions[v]);
      body.velocities[v] = of_all + factor * (body.velocities[v] - of_all);
    }
  });
  visit_boxes([&](RigidBox& box) {
    const Vec3 of_all = common(box.position);
    box.velocity = of_all + factor * (box.velocity - of_all);
    box.angular_velocity = angular_velocity_ + factor * (box.angular_velocity - angular_velocity_);
  });
}

void GroupMotion::turn(const Vec3& angular_momentum) {
  find_mean();
  const Vec3 angular_velocity = inertia().ldlt().solve(angular_momentum);
  visit_soft([&](SoftBody& body) {
    for (int v = 0; v < body.positions.size(); ++v) {
      body.velocities[v] += angular_velocity.cross(body.positions[v] - centre_);
    }
  });
  visit_boxes([&](RigidBox& box) {
    box.velocity += angular_velocity.cross(box.position - centre_);
    box.angular_velocity += angular_velocity;
  });
}

bool GroupMotion::has_soft_bodies() const {
  bool any = false;
  visit_soft([&](const SoftBody&) { any = true; });
  return any;
}

double GroupMotion::mass() const {
  double sum = 0.0;
  visit_soft(
      [&](const SoftBody& body) { sum += body.material.vertex_mass * body.positions.size(); });
  visit_boxes([&](const RigidBox& box) { sum += box.mass; });
  return sum;
}

void GroupMotion::find_mean() {
  double mass = 0.0;
  centre_ = velocity_ = Vec3::Zero();
  const auto add = [&](double m, const Vec3& x, const Vec3& v) {
    mass += m;
    centre_ += m * x;
    velocity_ += m * v;
  };
  visit_vertices(add);
  visit_boxes([&](const RigidBox& box) { add(box.mass, box.position, box.velocity); });
  centre_ /= mass;
  velocity_ /= mass;
}

Mat3 GroupMotion::inertia() const {
  Mat3 sum = Mat3::Zero();
  const auto add = [&](double m, const Vec3& x) {
    const Vec3 arm = x - centre_;
    sum += m * (arm.squaredNorm() * Mat3::Identity() - arm * arm.transpose());
  };
  visit_vertices([&](double m, const Vec3& x, const Vec3&) { add(m, x); });
  visit_boxes([&](const RigidBox& box) {
    add(box.mass, box.position);
    sum += own_inertia(box);
  });
  return sum;
}

}  // namespace pneuma::sim
