#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/study/error/error_meter.h"
#include "app/study/error/reference_equation.h"
#include "app/study/error/solver.h"
#include "sim/potential/explicit_world_step.h"
#include "sim/soft/acceleration.h"

namespace pneuma::app {
namespace {

/// The simulation's right-hand side on CVODE's numbers.
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

/// The same of a world in which contact is a potential. What is static stays where it is.
class ContactEquation {
 public:
  explicit ContactEquation(const sim::World& world)
      : world_(world),
        surfaces_(world_),
        equation_(world_, surfaces_),
        positions_(surfaces_.vertex_count()),
        velocities_(surfaces_.vertex_count()),
        acceleration_(surfaces_.vertex_count()) {
    double reach = 0.0;
    for (const sim::ContactSurface& surface : surfaces_.all()) {
      reach = std::max(reach, surface.reach);
    }
    equation_.set_margin(reach);
    surfaces_.place_boxes(world_, positions_);
    for (const sim::SoftBody& body : world_.soft) vertices_ += body.positions.size();
  }

  bool operator()(const double* state, double* derivative) {
    using Columns = Eigen::Map<const Eigen::Matrix3Xd>;
    const std::ptrdiff_t values = std::ptrdiff_t{3} * vertices_;
    std::copy(state + values, state + 2 * values, derivative);
    positions_.rows().topLeftCorner(3, vertices_) = Columns(state, 3, vertices_);
    velocities_.rows().topLeftCorner(3, vertices_) = Columns(state + values, 3, vertices_);
    if (!(equation_(positions_, velocities_, acceleration_) > 0.0)) return false;
    if (!std::isfinite(acceleration_.rows().sum())) return false;
    Eigen::Map<Eigen::Matrix3Xd>(derivative + values, 3, vertices_) =
        acceleration_.rows().topLeftCorner(3, vertices_);
    return true;
  }

 private:
  sim::World world_;
  sim::ContactSurfaces surfaces_;
  sim::WorldAcceleration equation_;
  sim::VertexArray positions_, velocities_, acceleration_;
  int vertices_ = 0;  // of soft bodies
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
  }
  return result;
}

class CvodeSolver final : public Solver {
 public:
  CvodeSolver(sim::World world, Cvode solver)
      : world_(std::move(world)), solver_(std::move(solver)) {}

  bool advance(std::size_t i) override {
    reached_ = sample_time(i);
    failed_ = !solver_.advance_to(reached_);
    return !failed_;
  }

  Sample sample() const override {
    sim::World world = world_;
    read_flat_state(solver_.state(), world.soft);
    return take_sample(world);
  }

  std::string failure() const override {
    return failed_ ? fmt::format("CVODE gave up before {:.4g} s", reached_) : "";
  }
  double failure_time() const override { return reached_; }
  long evaluations() const override { return solver_.evaluations(); }

 private:
  sim::World world_;
  Cvode solver_;
  double reached_ = 0.0;
  bool failed_ = false;
};

}  // namespace

std::unique_ptr<Solver> make_peer_solver(const sim::World& world, CvodeMethod method,
                                         double tolerance) {
  // std::function wants to be able to copy.
  if (world.settings.contact == sim::ContactMethod::potential) {
    const auto equation = std::make_shared<ContactEquation>(world);
    const auto evaluate = [equation](const double* state, double* derivative) {
      return (*equation)(state, derivative);
    };
    return std::make_unique<CvodeSolver>(
        world, Cvode(method, evaluate, flat_state(world.soft),
                     {0.0, absolute_tolerances(world, tolerance, frequency)}));
  }
  const auto equation = std::make_shared<FastEquation>(world.soft, world.settings.gravity);
  const auto evaluate = [equation](const double* state, double* derivative) {
    return (*equation)(state, derivative);
  };
  return std::make_unique<CvodeSolver>(
      world, Cvode(method, evaluate, flat_state(world.soft),
                   {0.0, absolute_tolerances(world, tolerance, frequency)}));
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
  const auto evaluate = [problem](const double* state, double* derivative) {
    return problem->equation(state, derivative);
  };
  return std::make_unique<CvodeSolver>(
      world, Cvode(CvodeMethod::adams, evaluate, flat_state(world.soft),
                   {tolerance, absolute_tolerances(world, tolerance, one_per_second)}));
}

}  // namespace pneuma::app
