#include "benchmarks/peer/bullet_world.h"

#include <BulletSoftBody/btSoftBody.h>
#include <BulletSoftBody/btSoftBodyHelpers.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>
#include <btBulletDynamicsCommon.h>
#include <dlfcn.h>
#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "sim/soft/pressure_force.h"

namespace pneuma::benchmarks {
namespace {

btScalar scalar(double value) { return static_cast<btScalar>(value); }
btVector3 vector(const sim::Vec3& v) { return {scalar(v.x()), scalar(v.y()), scalar(v.z())}; }
sim::Vec3 vector(const btVector3& v) { return {v.x(), v.y(), v.z()}; }

/// Bullet multiplies the coefficients of both sides, ours takes their geometric mean: roots make
/// the products the same.
btScalar friction(const sim::ContactMaterial& material) {
  return scalar(std::sqrt(material.friction));
}

}  // namespace

/// Members are destroyed from the last to the first: bodies before the world, the world before what
/// it was made of.
struct BulletWorld::Parts {
  btSoftBodyRigidBodyCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher{&configuration};
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btSoftRigidDynamicsWorld world{&dispatcher, &broadphase, &solver, &configuration};
  std::vector<std::unique_ptr<btCollisionShape>> shapes;
  std::vector<std::unique_ptr<btMotionState>> motion_states;
  std::vector<std::unique_ptr<btRigidBody>> rigid;
  std::vector<std::unique_ptr<btSoftBody>> soft;

  BulletOptions options;
  double substep_seconds;

  Parts(const sim::Settings& settings, const BulletOptions& given);
  ~Parts();
  Parts(const Parts&) = delete;
  Parts& operator=(const Parts&) = delete;

  void add(const sim::SoftBody& body, bool several_soft);
  void add(const sim::RigidBox& box);
  void add_ground(const sim::ContactMaterial& surface);
  btRigidBody& add_rigid(std::unique_ptr<btCollisionShape> shape, double mass,
                         const btTransform& place, const sim::ContactMaterial& surface);
};

BulletWorld::Parts::Parts(const sim::Settings& settings, const BulletOptions& given)
    : options(given), substep_seconds(sim::time_step(settings) / given.substeps) {
  world.setGravity(vector(settings.gravity));
  btSoftBodyWorldInfo& info = world.getWorldInfo();
  info.m_gravity = vector(settings.gravity);
  info.air_density = 0;
  info.water_density = 0;
  info.m_dispatcher = &dispatcher;
  info.m_broadphase = &broadphase;
  info.m_sparsesdf.Initialize();
  info.m_sparsesdf.setDefaultVoxelsz(scalar(options.voxel_size));
  info.m_sparsesdf.Reset();  // only this takes the size over
}

BulletWorld::Parts::~Parts() {
  for (const auto& body : soft) world.removeSoftBody(body.get());
  for (const auto& body : rigid) world.removeRigidBody(body.get());
}

void BulletWorld::Parts::add(const sim::SoftBody& body, bool several_soft) {
  std::vector<btVector3> positions;
  for (int v = 0; v < body.positions.size(); ++v) positions.push_back(vector(body.positions[v]));
  const std::vector<btScalar> masses(positions.size(), scalar(body.material.vertex_mass));
  auto made = std::make_unique<btSoftBody>(
      &world.getWorldInfo(), static_cast<int>(positions.size()), positions.data(), masses.data());
  made->m_materials[0]->m_kLST = scalar(options.link_stiffness);
  const sim::MeshTopology& topology = body.mesh->topology;
  for (const auto& [a, b] : topology.edges()) made->appendLink(a, b);
  for (const auto& [a, b, c] : topology.triangles()) made->appendFace(a, b, c);
  made->m_cfg.collisions = btSoftBody::fCollision::SDF_RS;
  if (several_soft) made->m_cfg.collisions |= btSoftBody::fCollision::VF_SS;  // a tree of faces
  made->m_cfg.piterations = options.position_iterations;
  // A fraction of the velocity per substep, where rho_g and drag are such per 1/60 s.
  const double kept = (1.0 - body.material.rho_g) * (1.0 - options.drag);
  made->m_cfg.kDP = scalar(1.0 - std::pow(kept, 60.0 * substep_seconds));
  made->getCollisionShape()->setMargin(scalar(options.margin));
  made->m_cfg.kDF = friction(body.material.surface);
  made->m_cfg.kPR =  // pressure: kPR / V
      scalar(options.gas_fraction * sim::gas_strength(body.material));
  for (int v = 0; v < body.velocities.size(); ++v) {
    made->m_nodes[v].m_v = vector(body.velocities[v]);
  }
  world.addSoftBody(made.get());
  soft.push_back(std::move(made));
}

btRigidBody& BulletWorld::Parts::add_rigid(std::unique_ptr<btCollisionShape> shape, double mass,
                                           const btTransform& place,
                                           const sim::ContactMaterial& surface) {
  btVector3 inertia(0, 0, 0);
  if (mass > 0.0) shape->calculateLocalInertia(scalar(mass), inertia);
  motion_states.push_back(std::make_unique<btDefaultMotionState>(place));
  const btRigidBody::btRigidBodyConstructionInfo info(scalar(mass), motion_states.back().get(),
                                                      shape.get(), inertia);
  rigid.push_back(std::make_unique<btRigidBody>(info));
  rigid.back()->setFriction(friction(surface));
  rigid.back()->setActivationState(DISABLE_DEACTIVATION);
  shapes.push_back(std::move(shape));
  world.addRigidBody(rigid.back().get());
  return *rigid.back();
}

void BulletWorld::Parts::add(const sim::RigidBox& box) {
  const auto& q = box.orientation;
  const btTransform place(btQuaternion(scalar(q.x()), scalar(q.y()), scalar(q.z()), scalar(q.w())),
                          vector(box.position));
  btRigidBody& body =
      add_rigid(std::make_unique<btBoxShape>(vector(0.5 * box.size)), box.mass, place, box.surface);
  body.setLinearVelocity(vector(box.velocity));
  body.setAngularVelocity(vector(box.angular_velocity));
}

void BulletWorld::Parts::add_ground(const sim::ContactMaterial& surface) {
  btTransform place = btTransform::getIdentity();
  if (options.ground == BulletGround::plane) {
    const btVector3 up(0, 0, 1);
    add_rigid(std::make_unique<btStaticPlaneShape>(up, scalar(0)), 0.0, place, surface);
    return;
  }
  const btVector3 half_size(500, 500, 10);
  place.setOrigin({0, 0, -half_size.z()});
  add_rigid(std::make_unique<btBoxShape>(half_size), 0.0, place, surface);
}

BulletWorld::BulletWorld(const sim::World& world, const BulletOptions& options)
    : parts_(std::make_unique<Parts>(world.settings, options)) {
  if (world.settings.ground) parts_->add_ground(*world.settings.ground);
  for (const sim::RigidBox& box : world.rigid) parts_->add(box);
  for (const sim::SoftBody& body : world.soft) parts_->add(body, world.soft.size() > 1);
}

BulletWorld::~BulletWorld() = default;
BulletWorld::BulletWorld(BulletWorld&&) noexcept = default;
BulletWorld& BulletWorld::operator=(BulletWorld&&) noexcept = default;

void BulletWorld::step() {
  for (int i = 0; i < parts_->options.substeps; ++i) {
    parts_->world.stepSimulation(scalar(parts_->substep_seconds), 0);  // 0: one of just that length
  }
}

void BulletWorld::copy_state(sim::World& world) const {
  const std::size_t ground = world.settings.ground ? 1 : 0;
  for (std::size_t i = 0; i < world.rigid.size(); ++i) {
    const btRigidBody& from = *parts_->rigid[ground + i];
    const btQuaternion turn = from.getWorldTransform().getRotation();
    sim::RigidBox& to = world.rigid[i];
    to.position = vector(from.getWorldTransform().getOrigin());
    to.orientation = Eigen::Quaterniond(turn.w(), turn.x(), turn.y(), turn.z()).normalized();
    to.velocity = vector(from.getLinearVelocity());
    to.angular_velocity = vector(from.getAngularVelocity());
  }
  for (std::size_t i = 0; i < world.soft.size(); ++i) {
    const btSoftBody& from = *parts_->soft[i];
    for (int v = 0; v < from.m_nodes.size(); ++v) {
      world.soft[i].positions[v] = vector(from.m_nodes[v].m_x);
      world.soft[i].velocities[v] = vector(from.m_nodes[v].m_v);
    }
  }
}

std::size_t BulletWorld::contact_count() const {
  int count = 0;
  for (const auto& body : parts_->soft) {
    count += body->m_rcontacts.size() + body->m_scontacts.size();
  }
  for (int i = 0; i < parts_->dispatcher.getNumManifolds(); ++i) {
    count += parts_->dispatcher.getManifoldByIndexInternal(i)->getNumContacts();
  }
  return static_cast<std::size_t>(count);
}

double BulletWorld::volume(int body) const {
  return static_cast<double>(parts_->soft[static_cast<std::size_t>(body)]->getVolume());
}

double BulletWorld::voxel_size() const {
  return static_cast<double>(parts_->world.getWorldInfo().m_sparsesdf.voxelsz);
}

sim::Vec3 BulletWorld::mean_velocity(int body) const {
  const btSoftBody& soft = *parts_->soft[static_cast<std::size_t>(body)];
  sim::Vec3 sum = sim::Vec3::Zero();
  for (int v = 0; v < soft.m_nodes.size(); ++v) {
    const btVector3& velocity = soft.m_nodes[v].m_v;
    sum += sim::Vec3(velocity.x(), velocity.y(), velocity.z());
  }
  return sum / soft.m_nodes.size();
}

/// Debian's package says nothing of its flags: these are of debian/rules and dpkg-buildflags of
/// bullet 3.24+dfsg-2, for the baseline of its architecture.
std::string bullet_build() {
  Dl_info found{};
  const bool known =
      dladdr(reinterpret_cast<void*>(&btSoftBodyHelpers::CreatePatchUV), &found) != 0;
  const std::string path = known ? found.dli_fname : "";
  const bool is_debian = path.starts_with("/lib/") || path.starts_with("/usr/lib/");
  return fmt::format("{} ({})", path,
                     is_debian ? "Debian's: GNU -O2 -g -DNDEBUG -fstack-protector-strong "
                                 "-D_FORTIFY_SOURCE=2, no -march"
                               : "built by hand, with flags of which it does not tell");
}

}  // namespace pneuma::benchmarks
