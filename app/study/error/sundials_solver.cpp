#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "app/study/error/body_preconditioner.h"
#include "app/study/error/error_meter.h"
#include "app/study/error/reference_equation.h"
#include "app/study/error/solver.h"
#include "sim/potential/explicit_world_step.h"
#include "sim/rigid/given_motion.h"
#include "sim/soft/acceleration.h"

namespace pneuma::app {
namespace {

/// The simulation's right-hand side on SUNDIALS' numbers.
class FastEquation {
 public:
  FastEquation(std::span<const sim::SoftBody> bodies, const sim::Vec3& gravity) {
    for (const sim::SoftBody& body : bodies) {
      parts_.push_back(std::make_unique<Part>(body, gravity));
      values_ += 3 * static_cast<std::size_t>(body.positions.size());
    }
  }

  bool operator()(const double* state, double* derivative) const {
    std::copy(state + values_, state + 2 * values_, derivative);
    std::size_t first = 0;
    for (const auto& part : parts_) {
      const int count = part->positions.size();
      const Columns x(state + first, 3, count), v(state + values_ + first, 3, count);
      part->positions.rows().topRows<3>() = x;
      part->velocities.rows().topRows<3>() = v;
      if (!(part->equation(part->positions, part->velocities, part->acceleration) > 0.0)) {
        return false;
      }
      Eigen::Map<Eigen::Matrix3Xd>(derivative + values_ + first, 3, count) =
          part->acceleration.rows().topRows<3>();
      first += 3 * static_cast<std::size_t>(count);
    }
    return true;
  }

 private:
  using Columns = Eigen::Map<const Eigen::Matrix3Xd>;

  struct Part {
    Part(const sim::SoftBody& body, const sim::Vec3& gravity)
        : mesh(body.mesh),
          scratch(*mesh),
          equation(*mesh, body.material, gravity, scratch),
          positions(body.positions.size()),
          velocities(body.positions.size()),
          acceleration(body.positions.size()) {}

    std::shared_ptr<const sim::SoftMesh> mesh;
    sim::AccelerationScratch scratch;
    sim::SoftAcceleration equation;
    sim::VertexArray positions, velocities, acceleration;
  };

  std::vector<std::unique_ptr<Part>> parts_;  // apart, as equations refer to their scratch
  std::size_t values_ = 0;                    // of all positions
};

/// What a state means that lies beyond a crossing, seen from where the last step ended.
enum class Beyond {
  as_any_other,  // as solvers have it that know nothing of contacts
  nothing,
};

/// The same of a world in which contact is a potential. Boxes that keys move are where these say at
/// every time. Numbers are those of the soft bodies and then nine of each free box
/// (sim/potential/box_coordinates.h), positions before velocities.
class ContactEquation {
 public:
  ContactEquation(const sim::World& world, Beyond beyond)
      : world_(world),
        beyond_(beyond),
        surfaces_(world_),
        equation_(world_, surfaces_, sim::BoxCoordinates::Form::quaternion),
        positions_(surfaces_.vertex_count()),
        velocities_(surfaces_.vertex_count()),
        acceleration_(surfaces_.vertex_count()) {
    double reach = 0.0;
    for (const sim::ContactSurface& surface : surfaces_.all()) {
      reach = std::max(reach, surface.reach);
    }
    equation_.set_margin(reach);
    surfaces_.place_boxes(world_, positions_);
    for (const sim::SoftBody& body : world_.soft) {
      parts_.push_back({count_, body.positions.size()});
      count_ += body.positions.size();
    }
    for (int i = 0; i < static_cast<int>(world_.rigid.size()); ++i) {
      if (world_.rigid[sim::at(i)].is_kinematic) continue;
      parts_.push_back({surfaces_.of_box(i).first_vertex, columns_of_box});
      boxes_.push_back(sim::state_of(world_.rigid[sim::at(i)]));
      free_.push_back(i);
      count_ += columns_of_box;
    }
  }

  std::vector<double> start() {
    int first = 0;
    for (const sim::SoftBody& body : world_.soft) {
      positions_.rows().middleCols(first, body.positions.size()) = body.positions.rows();
      velocities_.rows().middleCols(first, body.positions.size()) = body.velocities.rows();
      first += body.positions.size();
    }
    equation_.start_boxes(boxes_, positions_, velocities_);
    std::vector<double> state(6 * sim::at(count_));
    write(positions_, state.data());
    write(velocities_, state.data() + values());
    return state;
  }

  bool operator()(double time, const double* state, double* derivative) {
    std::copy(state + values(), state + 2 * values(), derivative);
    if (!evaluate(time, state)) return false;
    write(acceleration_, derivative + values());
    return true;
  }

  /// A step has ended. One that ends beyond a crossing all the same is the last one.
  void end_step(double time, const double* state) {
    has_crossed_ |= !evaluate(time, state);
    last_ = equation_.vertices(positions_);
  }

  /// The bodies of a world of the same bodies.
  void set(const double* state, sim::World& world) {
    read(state, positions_);
    read(state + values(), velocities_);
    int first = 0;
    for (sim::SoftBody& body : world.soft) {
      body.positions.rows() = positions_.rows().middleCols(first, body.positions.size());
      body.velocities.rows() = velocities_.rows().middleCols(first, body.positions.size());
      first += body.positions.size();
    }
    equation_.end_boxes(positions_, velocities_, boxes_);
    for (std::size_t i = 0; i < free_.size(); ++i) {
      sim::set_state(world.rigid[sim::at(free_[i])], boxes_[i]);
    }
  }

 private:
  /// Vertices, or the coordinates of a box in their places.
  struct Part {
    int first = 0;
    int count = 0;
  };
  static constexpr int columns_of_box = 3;

  bool evaluate(double time, const double* state) {
    read(state, positions_);
    read(state + values(), velocities_);
    for (int i = 0; i < static_cast<int>(world_.rigid.size()); ++i) {
      const sim::RigidBox& box = world_.rigid[sim::at(i)];
      if (box.motion) move_box(i, *box.motion, time);
    }
    if (has_crossed_ || !(equation_(positions_, velocities_, acceleration_) > 0.0)) return false;
    if (!std::isfinite(acceleration_.rows().sum())) return false;
    return beyond_ == Beyond::as_any_other || is_before_crossing();
  }

  /// Its corners.
  void move_box(int i, const sim::GivenMotion& motion, double time) {
    const sim::Pose pose = pose_at(motion, time);
    const auto [velocity, angular_velocity] = velocities_at(motion, time);
    surfaces_.place_box(pose, i, positions_);
    move_corners({pose.position, pose.orientation, velocity, angular_velocity},
                 surfaces_.of_box(i).first_vertex, positions_, velocities_);
  }

  /// Whether nothing crosses on straight ways from where the last step ended to the last
  /// evaluation.
  bool is_before_crossing() {
    const sim::VertexArray& vertices = equation_.vertices(positions_);
    if (last_.size() == 0) return true;
    const auto& pairs = equation_.pairs_between(last_, vertices);
    return !sim::limit_ways(surfaces_, pairs, last_, vertices, 0.0).is_limited;
  }

  std::ptrdiff_t values() const { return std::ptrdiff_t{3} * count_; }

  void read(const double* from, sim::VertexArray& to) const {
    for (const auto& [first, count] : parts_) {
      to.rows().block(0, first, 3, count) = Eigen::Map<const Eigen::Matrix3Xd>(from, 3, count);
      from += std::ptrdiff_t{3} * count;
    }
  }
  void write(const sim::VertexArray& from, double* to) const {
    for (const auto& [first, count] : parts_) {
      Eigen::Map<Eigen::Matrix3Xd>(to, 3, count) = from.rows().block(0, first, 3, count);
      to += std::ptrdiff_t{3} * count;
    }
  }

  sim::World world_;
  Beyond beyond_;
  sim::ContactSurfaces surfaces_;
  sim::WorldAcceleration equation_;
  sim::VertexArray positions_, velocities_, acceleration_;
  sim::VertexArray last_;  // m, of all vertices, where the last step ended
  bool has_crossed_ = false;
  std::vector<Part> parts_;
  std::vector<sim::RigidState> boxes_;  // of the free ones
  std::vector<int> free_;               // which these are
  int count_ = 0;                       // columns of all parts
};

/// Without springs a body has no frequency of its own, and a second is as good as any time.
double frequency(const sim::SoftMaterial& material) {
  const double squared = material.k / material.vertex_mass;
  return squared > 0.0 ? std::sqrt(squared) : 1.0;
}

/// `tolerance` of the rest radius for positions, and of that times a frequency for velocities.
template <class Frequency>
std::vector<double> absolute_tolerances(const sim::World& world, double tolerance,
                                        const Frequency& frequency_of) {
  std::vector<double> result;
  for (const bool velocities : {false, true}) {
    for (const sim::SoftBody& body : world.soft) {
      const double scale = rest_radius(body) * (velocities ? frequency_of(body.material) : 1.0);
      result.insert(result.end(), 3 * static_cast<std::size_t>(body.positions.size()),
                    tolerance * scale);
    }
    if (world.settings.contact != sim::ContactMethod::potential) continue;
    for (const sim::RigidBox& box : world.rigid) {
      if (box.is_kinematic) continue;
      result.insert(result.end(), 3, tolerance * 0.5 * box.size.norm());
      result.insert(result.end(), 6, tolerance);  // of the quaternion
    }
  }
  return result;
}

class SundialsSolver final : public Solver {
 public:
  /// Gives a world the bodies of a state.
  using Read = std::function<void(std::span<const double>, sim::World&)>;

  SundialsSolver(sim::World world, Sundials solver, Read read)
      : world_(std::move(world)), solver_(std::move(solver)), read_(std::move(read)) {}

  bool advance(std::size_t i) override {
    reached_ = sample_time(i);
    failed_ = !solver_.advance_to(reached_);
    return !failed_;
  }

  Sample sample() const override {
    sim::World world = world_;
    place_given_motions(world, reached_);
    read_(solver_.state(), world);
    return take_sample(world);
  }

  std::string failure() const override {
    return failed_ ? fmt::format("it gave up before {:.4g} s", reached_) : "";
  }
  double failure_time() const override { return reached_; }
  long evaluations() const override { return solver_.evaluations(); }

 private:
  sim::World world_;
  Sundials solver_;
  Read read_;
  double reached_ = 0.0;
  bool failed_ = false;
};

void read_soft(std::span<const double> state, sim::World& world) {
  read_flat_state(state, world.soft);
}

// std::function wants to be able to copy.
std::unique_ptr<Solver> make_contact_solver(const sim::World& world, SundialsMethod method,
                                            double tolerance, Beyond beyond) {
  const auto equation = std::make_shared<ContactEquation>(world, beyond);
  const auto evaluate = [equation](double time, const double* state, double* derivative) {
    return (*equation)(time, state, derivative);
  };
  const auto read = [equation](std::span<const double> state, sim::World& into) {
    equation->set(state.data(), into);
  };
  Sundials solver(method, evaluate, equation->start(),
                  {0.0, absolute_tolerances(world, tolerance, frequency)});
  if (beyond == Beyond::nothing) {
    solver.set_step_done(
        [equation](double time, const double* state) { equation->end_step(time, state); });
  }
  return std::make_unique<SundialsSolver>(world, std::move(solver), read);
}

std::unique_ptr<Sundials::Preconditioner> preconditioner_of(SundialsMethod method,
                                                            const sim::World& world) {
  switch (method) {
    case SundialsMethod::cvode_bdf_blocks:
      return make_body_preconditioner(world.soft, BodyPreconditioning::blocks);
    case SundialsMethod::cvode_bdf_factors:
      return make_body_preconditioner(world.soft, BodyPreconditioning::factors);
    default:
      return nullptr;
  }
}

}  // namespace

std::unique_ptr<Solver> make_peer_solver(const sim::World& world, SundialsMethod method,
                                         double tolerance) {
  if (world.settings.contact == sim::ContactMethod::potential) {
    return make_contact_solver(world, method, tolerance, Beyond::as_any_other);
  }
  const auto equation = std::make_shared<FastEquation>(world.soft, world.settings.gravity);
  const auto evaluate = [equation](double, const double* state, double* derivative) {
    return (*equation)(state, derivative);
  };
  return std::make_unique<SundialsSolver>(
      world,
      Sundials(method, evaluate, flat_state(world.soft),
               {0.0, absolute_tolerances(world, tolerance, frequency)},
               preconditioner_of(method, world)),
      read_soft);
}

std::unique_ptr<Solver> make_contact_reference_solver(const sim::World& world, double tolerance) {
  return make_contact_solver(world, SundialsMethod::cvode_adams, tolerance, Beyond::nothing);
}

std::unique_ptr<Solver> make_reference_solver(const sim::World& world, double tolerance) {
  struct Problem {
    explicit Problem(const sim::World& given)
        : bodies(given.soft), equation(bodies, given.settings.gravity) {}
    std::vector<sim::SoftBody> bodies;
    ReferenceEquation equation;
  };
  const auto one_per_second = [](const sim::SoftMaterial&) { return 1.0; };  // the stricter choice
  const auto problem = std::make_shared<Problem>(world);
  const auto evaluate = [problem](double, const double* state, double* derivative) {
    return problem->equation(state, derivative);
  };
  return std::make_unique<SundialsSolver>(
      world,
      Sundials(SundialsMethod::cvode_adams, evaluate, flat_state(world.soft),
               {tolerance, absolute_tolerances(world, tolerance, one_per_second)}),
      read_soft);
}

}  // namespace pneuma::app
