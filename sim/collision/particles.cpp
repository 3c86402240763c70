#include "sim/collision/particles.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "sim/mesh/vec4d.h"

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

using Point = ParticleScratch::Point;

/// m, on each axis: where a particle stands that is to count for nothing. What it costs is the same
/// wherever another goes, and d^4 is still a number.
constexpr Point far_away{1e9f, 1e9f, 1e9f};

/// A coordinate of eight points, in single precision: which feature is the cheapest hardly ever
/// hangs on the eighth digit, and eight points take no longer than four in double precision.
typedef float Eight __attribute__((vector_size(32)));

struct EightPoints {
  Eight x, y, z;
};

Eight joined(Vec4d low, Vec4d high) {
  typedef float Four __attribute__((vector_size(16)));
  const Four first = __builtin_convertvector(low, Four);
  const Four second = __builtin_convertvector(high, Four);
  return __builtin_shufflevector(first, second, 0, 1, 2, 3, 4, 5, 6, 7);
}

EightPoints eight_points(const std::array<Vec4d, 8>& rows) {
  const Vec3x4 low = to_columns(rows[0], rows[1], rows[2], rows[3]);
  const Vec3x4 high = to_columns(rows[4], rows[5], rows[6], rows[7]);
  return {joined(low.x, high.x), joined(low.y, high.y), joined(low.z, high.z)};
}

Point to_point(Vec4d row) {
  return {static_cast<float>(row[0]), static_cast<float>(row[1]), static_cast<float>(row[2])};
}

/// m^2, of one edge: that features are about as large is all that matters.
double squared_feature_size(const SurfaceView& surface) {
  const auto& [a, b] = edge_segment(surface, 0);
  return (b - a).squaredNorm();
}

/// One body's particles on the way to lower cost, among its own and against the other's.
class Walk {
 public:
  /// Positions are relative to `origin` (m), on one of the bodies, so that few digits suffice.
  Walk(const SurfaceView& surface, Vec4d origin, std::vector<int>& features,
       std::vector<Point>& own, const std::vector<Point>& other, const ParticleSettings& settings,
       double min_distance)
      : surface_(surface),
        origin_(origin),
        features_(features),
        own_(own),
        other_(other),
        attraction_(static_cast<float>(settings.attraction)),
        min_squared_(static_cast<float>(min_distance * min_distance)) {}

  /// To be called for both bodies before the first sweep. Adds one more point, far away, where
  /// the number of particles is odd.
  void gather_points() {
    own_.assign(features_.size() + features_.size() % 2, far_away);
    for (std::size_t i = 0; i < features_.size(); ++i) own_[i] = to_point(centre(features_[i]));
  }

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
  Vec4d centre(int feature) const { return feature_centre(surface_, feature) - origin_; }

  /// Where it is and where it may go are looked at eight at a time. Of equal costs the first wins,
  /// so that a particle without reason to go stays.
  bool move(std::size_t particle) {
    const int here = features_[particle];
    const auto neighbours = surface_.topology.feature_neighbours(here);
    const auto option = [&](std::size_t i) { return i == 0 ? here : neighbours[i - 1]; };
    const std::size_t count = 1 + neighbours.size();
    std::size_t best = 0;
    float min_cost = std::numeric_limits<float>::infinity();
    own_[particle] = far_away;  // costs itself nothing
    for (std::size_t first = 0; first < count; first += 8) {
      const std::size_t options = std::min<std::size_t>(8, count - first);
      std::array<Vec4d, 8> points{};
      for (std::size_t i = 0; i < options; ++i) points[i] = centre(option(first + i));
      const Eight costs = cost(eight_points(points));
      for (std::size_t i = 0; i < options; ++i) {
        const float option_cost = costs[static_cast<int>(i)];
        if (!(option_cost < min_cost)) continue;
        min_cost = option_cost;
        best = first + i;
      }
    }
    features_[particle] = option(best);
    own_[particle] = to_point(centre(features_[particle]));
    return best > 0;
  }

  /// Not below the minimum.
  Eight squared_distance(const EightPoints& points, const Point& other) const {
    const Eight x = points.x - other.x, y = points.y - other.y, z = points.z - other.z;
    const Eight squared = x * x + (y * y + z * z);
    const Eight bound = Eight{} + min_squared_;
    return squared > bound ? squared : bound;
  }

  /// The sum of 1/d^2. Two at a time, 1/a + 1/b = (a + b) / ab: divisions are what takes the time.
  Eight nearness(const EightPoints& points, const std::vector<Point>& others) const {
    Eight sum{};
    for (std::size_t i = 0; i < others.size(); i += 2) {
      const Eight a = squared_distance(points, others[i]);
      const Eight b = squared_distance(points, others[i + 1]);
      sum += (a + b) / (a * b);
    }
    return sum;
  }

  Eight cost(const EightPoints& points) const {
    return nearness(points, own_) - attraction_ * nearness(points, other_);
  }

  const SurfaceView& surface_;
  Vec4d origin_;
  std::vector<int>& features_;
  std::vector<Point>& own_;
  const std::vector<Point>& other_;
  float attraction_;
  float min_squared_;
};

}  // namespace

int particle_count(int vertices, double per_vertex) {
  return std::max(1, static_cast<int>(std::lround(vertices * per_vertex)));
}

double min_particle_distance(double skin_thickness) { return std::max(0.1 * skin_thickness, 1e-6); }

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
                     const ParticleSettings& settings, double min_distance, ParticlePair& pair,
                     ParticleScratch& scratch) {
  // The origin lies on the body of smaller features: near it single precision is at its best.
  const bool first_is_finer = squared_feature_size(first) < squared_feature_size(second);
  const Vec4d origin = first_is_finer ? feature_centre(first, pair.first_features.front())
                                      : feature_centre(second, pair.second_features.front());
  Walk first_walk(first, origin, pair.first_features, scratch.first, scratch.second, settings,
                  min_distance);
  Walk second_walk(second, origin, pair.second_features, scratch.second, scratch.first, settings,
                   min_distance);
  first_walk.gather_points();
  second_walk.gather_points();
  for (int sweeps = 1; sweeps <= settings.max_sweeps; ++sweeps) {
    const int moved = first_walk.sweep() + second_walk.sweep();
    if (moved < settings.settled_below) return sweeps;
  }
  return settings.max_sweeps;
}

}  // namespace pneuma::sim
