#include "app/study/impact/random_impact.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <utility>

#include "sim/mesh/triangle_mesh.h"

namespace pneuma::app {
namespace {

using sim::Vec3;

/// Of the standard library only the engine, whose numbers are the same everywhere.
class Random {
 public:
  Random(std::uint64_t seed, int number)
      : engine_(seed * 0x9e3779b97f4a7c15ULL + static_cast<std::uint64_t>(number)) {
    engine_.discard(8);
  }

  double between(double low, double high) {
    return low + (high - low) * static_cast<double>(engine_() >> 11) * 0x1.0p-53;
  }
  /// As many between 1 and 2 as between 2 and 4.
  double by_ratio(double low, double high) { return low * std::pow(high / low, between(0.0, 1.0)); }
  int whole(int low, int high) {
    return std::min(high, static_cast<int>(std::floor(between(low, high + 1.0))));
  }
  template <class Value, std::size_t Count>
  const Value& one_of(const std::array<Value, Count>& values) {
    return values[static_cast<std::size_t>(whole(0, static_cast<int>(Count) - 1))];
  }
  Vec3 direction() {
    const double z = between(-1.0, 1.0), angle = between(0.0, 2.0 * std::numbers::pi);
    const double r = std::sqrt(1.0 - z * z);
    return {r * std::cos(angle), r * std::sin(angle), z};
  }

 private:
  std::mt19937_64 engine_;
};

std::string text(const Vec3& v) { return fmt::format("[{}, {}, {}]", v.x(), v.y(), v.z()); }

struct Body {
  std::string name;
  std::string keys;
  double radius = 0.0;  // m, of a ball around it that its gas does not make it leave
};

/// Springs and gas that blow it up by about a third, and weight for all vertices together.
std::string material(Random& random, int vertices, double size) {
  const double k = random.by_ratio(50.0, 500.0);
  const double n = 0.5 * (k / 50.0) * std::pow(size / 3.0, 2);
  const double mass = random.by_ratio(1.0, 30.0);
  return fmt::format("k = {}\nn = {}\nvertex_mass = {}\n", k, n, mass / vertices);
}

Body round_body(Random& random) {
  const double radius = random.between(1.0, 3.0);
  if (random.whole(0, 1) == 0) {
    const int count = random.whole(8, 16);
    return {"sphere",
            fmt::format("radius = {}\nstacks = {}\nslices = {}\n{}", radius, count, count,
                        material(random, (count - 1) * count + 2, radius)),
            1.5 * radius};
  }
  const int subdivisions = random.whole(2, 3);
  return {"icosphere",
          fmt::format("shape = \"icosphere\"\nradius = {}\nsubdivisions = {}\n{}", radius,
                      subdivisions, material(random, subdivisions == 2 ? 162 : 642, radius)),
          1.5 * radius};
}

Body torus(Random& random) {
  const double radius = random.between(1.5, 3.0), tube = radius * random.between(0.25, 0.5);
  const int stacks = random.whole(8, 24), slices = random.whole(8, 24);
  return {"torus",
          fmt::format("shape = \"torus\"\nradius = {}\ntube_radius = {}\nstacks = {}\nslices = "
                      "{}\n{}",
                      radius, tube, stacks, slices, material(random, stacks * slices, 2.0 * tube)),
          1.5 * (radius + tube)};
}

Body soft_box(Random& random) {
  const Vec3 size(random.between(1.0, 4.0), random.between(1.0, 4.0), random.between(1.0, 4.0));
  const int divisions = random.whole(3, 10);
  return {"soft box",
          fmt::format("shape = \"box\"\nsize = {}\ndivisions = {}\n{}", text(size), divisions,
                      material(random, 6 * divisions * divisions + 2, 0.5 * size.minCoeff())),
          0.75 * size.norm() + 0.5 * size.maxCoeff()};
}

Body model(Random& random) {
  struct Model {
    const char* name;
    const char* file;
    int vertices;
    double extent;  // of the file, its longest side
  };
  static constexpr std::array<Model, 2> models = {
      {{"cat", "cat_500.ply", 491, 2.2}, {"pear", "pear.ply", 162, 2.2}}};
  const Model& chosen = random.one_of(models);
  const double scale = random.between(1.0, 2.0);
  return {chosen.name,
          fmt::format("shape = \"model\"\nmodel.file = \"{}\"\nmodel.scale = {}\n{}", chosen.file,
                      scale, material(random, chosen.vertices, 0.3 * scale)),
          0.9 * scale * chosen.extent};
}

Body rigid(Random& random) {
  const double side = random.between(1.0, 4.0), thin = random.between(0.1, 0.3);
  const std::array<std::pair<const char*, Vec3>, 3> boxes = {
      {{"cube", Vec3(side, side, side)},
       {"plate", Vec3(side, side, thin)},
       {"needle", Vec3(2.0 * side, thin, thin)}}};
  const auto& [name, size] = random.one_of(boxes);
  return {name,
          fmt::format("kind = \"rigid\"\nsize = {}\nmass = {}\n", text(size),
                      random.by_ratio(1.0, 30.0)),
          0.5 * size.norm()};
}

Body soft(Random& random) {
  switch (random.whole(0, 4)) {
    case 0:
    case 1:
      return round_body(random);
    case 2:
      return torus(random);
    case 3:
      return soft_box(random);
    default:
      return model(random);
  }
}

std::string surface(Random& random) {
  return fmt::format("restitution = {}\nfriction = {}\nrho_g = 0.0\nrotation = [{}, {}, {}]\n",
                     random.between(0.0, 1.0), random.between(0.0, 1.0),
                     random.between(-180.0, 180.0), random.between(-180.0, 180.0),
                     random.between(-180.0, 180.0));
}

}  // namespace

RandomImpact random_impact(std::uint64_t seed, int number) {
  static constexpr std::array<int, 5> rates = {60, 120, 240, 480, 960};
  Random random(seed, number);
  const bool of_boxes = random.whole(0, 5) == 0;
  const Body first = of_boxes ? rigid(random) : soft(random);
  const Body second = of_boxes || random.whole(0, 2) == 0 ? rigid(random) : soft(random);
  RandomImpact impact;
  impact.bodies = second.name + " on " + first.name;
  impact.speed = random.by_ratio(1.0, 200.0);
  const double apart = first.radius + second.radius;
  impact.seconds = 2.0 * apart / impact.speed + 1.0;
  const Vec3 flight = random.direction();
  const Vec3 aside = flight.cross(random.direction()).normalized();
  const Vec3 start = -apart * flight + random.between(0.0, 0.3) * apart * aside;
  impact.scene = fmt::format(
      "title = \"Impact {}: {} at {:.1f} m/s\"\nduration = {}\n[simulation]\nsteps_per_second = "
      "{}\ngravity = [0, 0, 0]\n[ground]\npresent = false\n",
      number, impact.bodies, impact.speed, std::ceil(impact.seconds), random.one_of(rates));
  impact.scene += "[[body]]\n" + first.keys + surface(random);
  impact.scene +=
      fmt::format("[[body]]\n{}{}position = {}\nvelocity = {}\nangular_velocity = {}\n",
                  second.keys, surface(random), text(start), text(impact.speed * flight),
                  text(random.between(0.0, 10.0) * random.direction()));
  return impact;
}

}  // namespace pneuma::app
