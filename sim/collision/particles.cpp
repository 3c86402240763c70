#include "sim/collision/particles.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "sim/mesh/row.h"

namespace pneuma::sim {
namespace {

/// SplitMix64 (Steele, Lea, Flood 2014): a generator whose numbers are the same everywhere.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  std::uint64_t next() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15ULL);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    return z ^ (z >> 31);
  }

 private:
  std::uint64_t state_;
};

std::vector<int> random_features(const MeshTopology& mesh, double per_vertex, Random& random) {
  std::vector<int> features(at(particle_count(mesh.vertex_count(), per_vertex)));
  const auto range = static_cast<std::uint64_t>(mesh.feature_count());
  for (int& feature : features) feature = static_cast<int>(random.next() % range);
  return features;
}

/// One body's particles on the way to lesser cost, among its own and against the other's.
class Walk {
 public:
  Walk(const SurfaceView& surface, std::vector<int>& features, std::vector<Vec3>& own,
       const std::vector<Vec3>& other, double attraction, double least_distance)
      : surface_(surface),
        features_(features),
        own_(own),
        other_(other),
        attraction_(attraction),
        least_squared_(least_distance * least_distance) {}

  /// Moves each particle to the cheapest of its feature and the neighbouring ones. Returns how many
  /// moved.
  int sweep() {
    int moved = 0;
    for (std::size_t particle = 0; particle < features_.size(); ++particle) {
      moved += move(particle) ? 1 : 0;
    }
    return moved;
  }

 private:
  /// Where it is and where it may go are looked at four at a time. Of equal costs the first wins,
  /// so that a particle without reason to go stays.
  bool move(std::size_t particle) {
    const int here = features_[particle];
    const auto neighbours = surface_.topology.feature_neighbours(here);
    const auto option = [&](std::size_t i) { return i == 0 ? here : neighbours[i - 1]; };
    const std::size_t count = 1 + neighbours.size();
    int best = here;
    Vec3 best_place = own_[particle];
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t first = 0; first < count; first += 4) {
      std::array<Row, 4> places;
      for (std::size_t i = 0; i < 4; ++i)
        places[i] = feature_centre(surface_, option(std::min(first + i, count - 1)));
      const Row costs = cost(particle, columns(places[0], places[1], places[2], places[3]));
      for (std::size_t i = 0; i < std::min<std::size_t>(4, count - first); ++i) {
        const double option_cost = costs[static_cast<int>(i)];
        if (!(option_cost < least)) continue;
        least = option_cost;
        best = option(first + i);
        best_place = to_vec3(places[i]);
      }
    }
    features_[particle] = best;
    own_[particle] = best_place;
    return best != here;
  }

  /// Not below the least.
  Row squared_distance(const Columns& places, const Vec3& other) const {
    const Row x = places.x - other.x(), y = places.y - other.y(), z = places.z - other.z();
    const Row squared = x * x + (y * y + z * z);
    const Row bound = Row{} + least_squared_;
    return squared > bound ? squared : bound;
  }

  /// The sum of 1/d^2. Two at a time, 1/a + 1/b = (a + b) / ab: divisions are what takes the time.
  Row nearness(const Columns& places, std::span<const Vec3> others) const {
    Row sum{};
    std::size_t i = 0;
    for (; i + 1 < others.size(); i += 2) {
      const Row a = squared_distance(places, others[i]);
      const Row b = squared_distance(places, others[i + 1]);
      sum += (a + b) / (a * b);
    }
    if (i < others.size()) sum += 1.0 / squared_distance(places, others[i]);
    return sum;
  }

  /// Of the particle in four places.
  Row cost(std::size_t particle, const Columns& places) const {
    const std::span<const Vec3> own(own_);
    return nearness(places, own.first(particle)) + nearness(places, own.subspan(particle + 1)) -
           attraction_ * nearness(places, other_);
  }

  const SurfaceView& surface_;
  std::vector<int>& features_;
  std::vector<Vec3>& own_;
  const std::vector<Vec3>& other_;
  double attraction_;
  double least_squared_;
};

void place(const SurfaceView& surface, const std::vector<int>& features,
           std::vector<Vec3>& places) {
  places.resize(features.size());
  for (std::size_t i = 0; i < features.size(); ++i) {
    places[i] = to_vec3(feature_centre(surface, features[i]));
  }
}

}  // namespace

int particle_count(int vertices, double per_vertex) {
  return std::max(1, static_cast<int>(std::lround(vertices * per_vertex)));
}

double least_particle_distance(double skin_thickness) {
  return std::max(0.1 * skin_thickness, 1e-6);
}

ParticlePair make_particles(int first, const MeshTopology& first_mesh, int second,
                            const MeshTopology& second_mesh, const ParticleSettings& settings,
                            std::uint64_t seed) {
  const auto pair_number =
      static_cast<std::uint64_t>(first) << 32 | static_cast<std::uint32_t>(second);
  Random random(seed ^ Random(pair_number).next());
  ParticlePair pair{first, second, {}, {}, false};
  pair.first_features = random_features(first_mesh, settings.per_vertex, random);
  pair.second_features = random_features(second_mesh, settings.per_vertex, random);
  return pair;
}

int settle_particles(const SurfaceView& first, const SurfaceView& second,
                     const ParticleSettings& settings, double least_distance, ParticlePair& pair,
                     ParticleScratch& scratch) {
  place(first, pair.first_features, scratch.first);
  place(second, pair.second_features, scratch.second);
  Walk first_walk(first, pair.first_features, scratch.first, scratch.second, settings.attraction,
                  least_distance);
  Walk second_walk(second, pair.second_features, scratch.second, scratch.first, settings.attraction,
                   least_distance);
  for (int sweeps = 1; sweeps <= settings.max_sweeps; ++sweeps) {
    const int moved = first_walk.sweep() + second_walk.sweep();
    if (moved < settings.settled_below) return sweeps;
  }
  return settings.max_sweeps;
}

}  // namespace pneuma::sim
