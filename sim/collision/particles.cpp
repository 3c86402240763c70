#include "sim/collision/particles.h"

#include <algorithm>
#include <cmath>
#include <utility>

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
  bool move(std::size_t particle) {
    int best = features_[particle];
    double least = cost(particle, own_[particle]);
    for (const int neighbour : surface_.topology.feature_neighbours(best)) {
      const Vec3 there = feature_centre(surface_, neighbour);
      const double neighbour_cost = cost(particle, there);
      if (neighbour_cost < least) {
        least = neighbour_cost;
        best = neighbour;
        own_[particle] = there;
      }
    }
    return std::exchange(features_[particle], best) != best;
  }

  double nearness(const Vec3& a, const Vec3& b) const {
    return 1.0 / std::max((a - b).squaredNorm(), least_squared_);
  }

  double cost(std::size_t particle, const Vec3& place) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < own_.size(); ++i) {
      if (i != particle) sum += nearness(place, own_[i]);
    }
    for (const Vec3& other : other_) sum -= attraction_ * nearness(place, other);
    return sum;
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
    places[i] = feature_centre(surface, features[i]);
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

Vec3 feature_centre(const SurfaceView& surface, int feature_id) {
  const auto vertices = surface.topology.feature_vertices(surface.topology.feature(feature_id));
  Vec3 sum = Vec3::Zero();
  for (const int v : vertices) sum += surface.positions[v];
  return sum / static_cast<double>(vertices.size());
}

}  // namespace pneuma::sim
