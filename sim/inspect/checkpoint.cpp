#include "sim/inspect/checkpoint.h"

#include <cstring>
#include <type_traits>

#include "sim/base/hash.h"
#include "sim/joints/gas_flow.h"

namespace pneuma::sim {
namespace {

constexpr std::uint64_t magic = 0x39414d55454e50ULL;  // "PNEUMA9" as little-endian bytes

std::uint64_t checksum(std::span<const std::uint8_t> bytes) {
  base::Hash hash;
  hash.add({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  return hash.value();
}

/// Appends plain values; the format is this machine's own byte order.
class Writer {
 public:
  template <class T>
  void put(const T& value) {
    static_assert(std::is_arithmetic_v<T>);
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(&value);
    bytes_.insert(bytes_.end(), bytes, bytes + sizeof(T));
  }
  void put(const Vec3& vector) {
    for (const double value : vector) put(value);
  }
  /// With a checksum of all.
  std::vector<std::uint8_t> take() {
    put(checksum(bytes_));
    return std::move(bytes_);
  }

 private:
  std::vector<std::uint8_t> bytes_;
};

class Reader {
 public:
  explicit Reader(std::span<const std::uint8_t> bytes) : bytes_(bytes), all_(bytes) {}

  template <class T>
  void get(T& value) {
    static_assert(std::is_arithmetic_v<T>);
    if (bytes_.size() < sizeof(T)) throw CheckpointError("the saved state is cut short");
    std::memcpy(&value, bytes_.data(), sizeof(T));
    bytes_ = bytes_.subspan(sizeof(T));
  }
  void get(Vec3& vector) {
    for (double& value : vector) get(value);
  }
  template <class T>
  void expect(const T& expected, const char* what) {
    T found{};
    get(found);
    if (found != expected) {
      throw CheckpointError(std::string("the saved state has another ") + what +
                            " than this scene");
    }
  }
  /// The checksum of all before it, and nothing after it.
  void end() {
    expect(checksum(all_.first(all_.size() - bytes_.size())), "checksum");
    if (!bytes_.empty()) throw CheckpointError("the saved state is longer than this scene's");
  }
  /// A number of things to follow, each of at least one byte.
  std::size_t count() {
    std::size_t result = 0;
    get(result);
    if (result > bytes_.size()) throw CheckpointError("the saved state is cut short");
    return result;
  }

 private:
  std::span<const std::uint8_t> bytes_;  // that are left
  std::span<const std::uint8_t> all_;
};

void put(Writer& writer, const VertexArray& values) {
  for (int i = 0; i < values.size(); ++i) writer.put(Vec3(values[i]));
}

void get(Reader& reader, VertexArray& values) {
  for (int i = 0; i < values.size(); ++i) {
    Vec3 value;
    reader.get(value);
    values[i] = value;
  }
}

void put(Writer& writer, bool value) { writer.put(static_cast<std::uint8_t>(value)); }

void get(Reader& reader, bool& value) {
  std::uint8_t byte = 0;
  reader.get(byte);
  value = byte != 0;
}

void put(Writer& writer, const std::vector<int>& values) {
  writer.put(values.size());
  for (const int value : values) writer.put(value);
}

void get(Reader& reader, std::vector<int>& values, int feature_count) {
  values.resize(reader.count());
  if (values.empty()) throw CheckpointError("the saved state has a body without particles");
  for (int& value : values) {
    reader.get(value);
    if (value < 0 || value >= feature_count) {
      throw CheckpointError("the saved state has a particle on a feature that does not exist");
    }
  }
}

template <class Pair>
void get_bodies(Reader& reader, const World& world, Pair& pair) {
  reader.get(pair.first);
  reader.get(pair.second);
  const auto soft = static_cast<int>(world.soft.size());
  if (pair.first < 0 || pair.first >= pair.second || pair.second >= soft) {
    throw CheckpointError("the saved state pairs bodies that do not exist");
  }
}

void get(Reader& reader, const World& world, ParticlePair& pair) {
  get_bodies(reader, world, pair);
  get(reader, pair.first_features, world.soft[at(pair.first)].mesh->topology.feature_count());
  get(reader, pair.second_features, world.soft[at(pair.second)].mesh->topology.feature_count());
  get(reader, pair.near);
}

void get_lost_energy(Reader& reader, World& world) {
  world.lost_energy.assign(reader.count(), 0.0);
  if (!world.lost_energy.empty() && world.lost_energy.size() != world.soft.size()) {
    throw CheckpointError("the saved state has lost energy of other bodies than there are");
  }
  for (double& lost : world.lost_energy) reader.get(lost);
}

void get_rest(Reader& reader, World& world) {
  const std::size_t bodies = world.soft.size() + world.rigid.size();
  world.rest.assign(reader.count(), {});
  if (!world.rest.empty() && world.rest.size() != bodies) {
    throw CheckpointError("the saved state has other bodies at rest than there are");
  }
  for (BodyRest& rest : world.rest) {
    reader.get(rest.quiet_steps);
    reader.get(rest.group);
    if (rest.quiet_steps < 0 || rest.group < -1 || rest.group >= body_count(world)) {
      throw CheckpointError("the saved state has bodies at rest with others that do not exist");
    }
  }
  world.quiet_places.resize(reader.count());
  if (!world.quiet_places.empty() && world.quiet_places.size() != at(soft_vertex_count(world))) {
    throw CheckpointError("the saved state has places of other vertices than there are");
  }
  for (Vec3& place : world.quiet_places) reader.get(place);
}

void get(Reader& reader, const World& world, WarmStartImpulse& impulse) {
  reader.get(impulse.first);
  reader.get(impulse.second);
  reader.get(impulse.point);
  reader.get(impulse.impulse);
  get(reader, impulse.is_of_start);
  const auto boxes = static_cast<int>(world.rigid.size());
  if (impulse.first < 0 || impulse.first >= boxes || impulse.second < -1 ||
      impulse.second >= boxes) {
    throw CheckpointError("the saved state has impulses on boxes that do not exist");
  }
}

void put(Writer& writer, const Feature& feature) {
  writer.put(static_cast<int>(feature.kind));
  writer.put(feature.index);
}

void get(Reader& reader, Feature& feature) {
  int kind = 0;
  reader.get(kind);
  reader.get(feature.index);
  feature.kind = static_cast<FeatureKind>(kind);
}

/// Of a FeatureImpulse or a FrictionSlip.
template <typename OfFeatures>
void put_features(Writer& writer, const OfFeatures& known) {
  writer.put(known.first);
  writer.put(known.second);
  put(writer, known.first_feature);
  put(writer, known.second_feature);
}

template <typename OfFeatures>
void get_features(Reader& reader, const World& world, OfFeatures& known) {
  reader.get(known.first);
  reader.get(known.second);
  get(reader, known.first_feature);
  get(reader, known.second_feature);
  if (known.first < 0 || known.first >= body_count(world) || known.second < -1 ||
      known.second >= body_count(world)) {
    throw CheckpointError("the saved state has contacts of bodies that do not exist");
  }
}

}  // namespace

std::vector<std::uint8_t> save_state(const World& world) {
  Writer writer;
  writer.put(magic);
  writer.put(world.steps);
  writer.put(world.soft.size());
  for (const SoftBody& body : world.soft) {
    writer.put(body.positions.size());
    put(writer, body.positions);
    put(writer, body.velocities);
  }
  for (std::size_t i = 0; i < world.soft.size(); ++i) {
    if (!has_gas_flow(world, static_cast<int>(i))) continue;
    writer.put(world.soft[i].material.n);
    writer.put(world.soft[i].material.temperature);
  }
  writer.put(world.rigid.size());
  for (const RigidBox& box : world.rigid) {
    writer.put(box.position);
    writer.put(box.velocity);
    writer.put(box.angular_velocity);
    for (const double q : box.orientation.coeffs()) writer.put(q);
  }
  writer.put(world.particles.size());
  for (const ParticlePair& pair : world.particles) {
    writer.put(pair.first);
    writer.put(pair.second);
    put(writer, pair.first_features);
    put(writer, pair.second_features);
    put(writer, pair.near);
  }
  writer.put(world.warm_start_impulses.size());
  for (const WarmStartImpulse& impulse : world.warm_start_impulses) {
    writer.put(impulse.first);
    writer.put(impulse.second);
    writer.put(impulse.point);
    writer.put(impulse.impulse);
    put(writer, impulse.is_of_start);
  }
  writer.put(world.feature_impulses.size());
  for (const FeatureImpulse& impulse : world.feature_impulses) {
    put_features(writer, impulse);
    writer.put(impulse.impulse);
    put(writer, impulse.is_of_start);
  }
  writer.put(world.friction_slips.size());
  for (const FrictionSlip& slip : world.friction_slips) {
    put_features(writer, slip);
    writer.put(slip.slip);
  }
  writer.put(world.depenetrating.size());
  for (const DepenetratingPair& pair : world.depenetrating) {
    writer.put(pair.first);
    writer.put(pair.second);
  }
  writer.put(world.lost_energy.size());
  for (const double lost : world.lost_energy) writer.put(lost);
  writer.put(world.rest.size());
  for (const BodyRest& rest : world.rest) {
    writer.put(rest.quiet_steps);
    writer.put(rest.group);
  }
  writer.put(world.quiet_places.size());
  for (const Vec3& place : world.quiet_places) writer.put(place);
  return writer.take();
}

void load_state(std::span<const std::uint8_t> bytes, World& world) {
  World loaded = world;
  Reader reader(bytes);
  reader.expect(magic, "format");
  reader.get(loaded.steps);
  reader.expect(loaded.soft.size(), "number of soft bodies");
  for (SoftBody& body : loaded.soft) {
    reader.expect(body.positions.size(), "number of vertices in a body");
    get(reader, body.positions);
    get(reader, body.velocities);
  }
  for (std::size_t i = 0; i < loaded.soft.size(); ++i) {
    if (!has_gas_flow(loaded, static_cast<int>(i))) continue;
    reader.get(loaded.soft[i].material.n);
    reader.get(loaded.soft[i].material.temperature);
  }
  reader.expect(loaded.rigid.size(), "number of rigid boxes");
  for (RigidBox& box : loaded.rigid) {
    reader.get(box.position);
    reader.get(box.velocity);
    reader.get(box.angular_velocity);
    for (double& q : box.orientation.coeffs()) reader.get(q);
  }
  loaded.particles.assign(reader.count(), {});
  for (ParticlePair& pair : loaded.particles) get(reader, loaded, pair);
  loaded.warm_start_impulses.assign(reader.count(), {});
  for (WarmStartImpulse& impulse : loaded.warm_start_impulses) get(reader, loaded, impulse);
  loaded.feature_impulses.assign(reader.count(), {});
  for (FeatureImpulse& impulse : loaded.feature_impulses) {
    get_features(reader, loaded, impulse);
    reader.get(impulse.impulse);
    get(reader, impulse.is_of_start);
  }
  loaded.friction_slips.assign(reader.count(), {});
  for (FrictionSlip& slip : loaded.friction_slips) {
    get_features(reader, loaded, slip);
    reader.get(slip.slip);
  }
  loaded.depenetrating.assign(reader.count(), {});
  for (DepenetratingPair& pair : loaded.depenetrating) get_bodies(reader, loaded, pair);
  get_lost_energy(reader, loaded);
  get_rest(reader, loaded);
  reader.end();
  world = std::move(loaded);
}

}  // namespace pneuma::sim
