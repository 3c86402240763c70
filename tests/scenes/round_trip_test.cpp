#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <set>

#include "scenes/loader/load_scene.h"
#include "scenes/loader/print_scene.h"
#include "scenes/loader/sections.h"
#include "sim/world/paper_method.h"
#include "tests/scenes/same_scene.h"

namespace pneuma::scenes {
namespace {

Scene read_back(const Scene& scene) {
  return parse_scene(print_scene(scene), scene.name + ".toml");
}

/// A finite number within a range: its ends, small and large ones, and everything between.
double any_number(const Range& range) {
  const auto wild = rc::gen::map(rc::gen::arbitrary<std::uint64_t>(), [](std::uint64_t bits) {
    double value = 0.0;
    static_assert(sizeof value == sizeof bits);
    std::memcpy(&value, &bits, sizeof value);
    return value;
  });
  const double low = std::max(range.low, -1e9);
  const double high = std::min(range.high, 1e9);
  const double share = *rc::gen::map(rc::gen::inRange(0, 1 << 30),
                                     [](int i) { return static_cast<double>(i) / (1 << 30); });
  for (const double candidate : {*wild, low + share * (high - low), std::round(share * 100.0)}) {
    if (range.contains(candidate)) return candidate;
  }
  return range.high_open ? range.low : std::min(range.high, range.low + 1.0);
}

int any_integer(const Range& range) {
  if (!range.only.empty()) return *rc::gen::elementOf(range.only);
  // Few, so that products of copies and slices stay within the limits.
  const int low = static_cast<int>(std::max(range.low, -5.0));
  const int high = static_cast<int>(std::min(range.high, low + 5.0));
  return *rc::gen::inRange(low, high + 1);
}

Vec3 any_vector(const Range& range) {
  return {any_number(range), any_number(range), any_number(range)};
}

std::string any_text() {
  // Quotes, backslashes and comment signs among letters.
  const auto piece = rc::gen::element<std::string>("a", "\"", "\\", "'", "#", " ", "=", ".");
  std::string text;
  for (const std::string& part : *rc::gen::container<std::vector<std::string>>(piece)) {
    if (text.size() + part.size() <= 200) text += part;
  }
  return text;
}

struct SetAtRandom {
  const Key& key;

  void operator()(std::monostate) const {}
  void operator()(double* member) const { *member = any_number(key.range); }
  void operator()(int* member) const { *member = any_integer(key.range); }
  void operator()(std::uint64_t* member) const {
    *member = *rc::gen::arbitrary<std::uint64_t>() >> 1;
  }
  void operator()(bool* member) const { *member = *rc::gen::arbitrary<bool>(); }
  void operator()(std::string* member) const {
    if (key.name != "name") *member = any_text();
  }
  void operator()(Vec3* member) const { *member = any_vector(key.range); }
  void operator()(std::optional<int>* member) const {
    if (*rc::gen::arbitrary<bool>()) *member = any_integer(key.range);
  }
  void operator()(std::optional<double>* member) const {
    if (*rc::gen::arbitrary<bool>()) *member = any_number(key.range);
  }
  void operator()(std::optional<Vec3>*) const {}  // eye and target come together, see below
  void operator()(std::array<int, 3>* member) const {
    for (int& element : *member) element = any_integer(key.range);
  }
  void operator()(std::vector<std::string>* member) const {
    member->resize(*rc::gen::inRange<std::size_t>(1, 4), "#fF0099");
  }
  void operator()(std::vector<sim::KeyFrame>* member) const {
    double time = 0.0;
    for (int rows = *rc::gen::inRange(0, 4); rows > 0; --rows, time += 0.5) {
      const Vec3 value = any_vector(key.range);
      member->push_back({time, value.x(), value.y(), value.z()});
    }
  }
  void operator()(std::vector<Region>* member) const {
    for (int rows = *rc::gen::inRange(0, 3); rows > 0; --rows) {
      const Vec3 one = any_vector(key.range), other = any_vector(key.range);
      const Vec3 low = one.cwiseMin(other), high = one.cwiseMax(other);
      member->push_back({low.x(), low.y(), low.z(), high.x(), high.y(), high.z()});
    }
  }
  void operator()(std::vector<TimedValue>* member) const {
    double time = 0.0;
    for (int rows = *rc::gen::inRange(0, 4); rows > 0; --rows, time += 0.5) {
      member->push_back({time, any_number(key.range)});
    }
  }
  void operator()(std::vector<CameraKey>* member) const {
    double time = 0.0;
    for (int rows = *rc::gen::inRange(0, 3); rows > 0; --rows, time += 0.5) {
      const Vec3 eye = any_vector(key.range);
      const double target = eye.x() + (eye.x() > 0.0 ? -1.0 : 1.0);
      member->push_back({time, eye.x(), eye.y(), eye.z(), target, eye.y(), eye.z()});
    }
  }
  void operator()(std::optional<sim::ContactMaterial>* member) const {
    if (*rc::gen::arbitrary<bool>()) member->reset();
  }
  void operator()(const Word& word) const {
    word.set(*rc::gen::inRange<std::size_t>(0, word.words.size()));
  }
};

void set_at_random(const Section& section, bool selectors) {
  for (const Key& key : section.keys) {
    if (key.selects == selectors && key.applies) std::visit(SetAtRandom{key}, key.slot);
  }
}

void make_supply_consistent(const Scene& scene, BodyScene& body) {
  const bool is_soft = body.kind == BodyKind::soft;
  if (!is_soft) body.skin_mass.reset();
  if (body.skin_mass) {
    body.density.reset();
    body.thickness = BodyScene{}.thickness;
  }
  if (!is_soft) {
    body.density.reset();
    body.stiffness.reset();
    body.material.bending = 0.0;
  }
  if (!is_soft || sim::is_as_printed(scene.settings)) {
    body.supply_n.clear();
    body.supply_temperature.clear();
    body.leak = {};
  }
  if (scene.ambient_pressure > 0.0) {
    std::erase_if(body.supply_n, [](const TimedValue& key) { return key[1] == 0.0; });
  }
  if (body.material.gas_exponent != 1.0) body.supply_temperature.clear();
  if (body.supply_n.empty() && body.supply_temperature.empty()) body.supply_smooth = true;
  if (body.supply_n.empty()) return;
  body.gauge_pressure.reset();
  body.inflation.reset();
}

/// Keeps what no single key can promise.
void make_consistent(Scene& scene) {
  scene.limits = {.bodies = 1000,
                  .vertices_per_body = 99'999'999,
                  .vertices = 1'999'999'999,
                  .frames = 999'999,
                  .memory_gib = 1e6,
                  .picture_side = *rc::gen::inRange(1000, 9000),
                  .model_file_mib = 0.25 * *rc::gen::inRange(1, 100),
                  .scene_file_mib = 0.25 * *rc::gen::inRange(1, 100)};
  const bool follows = scene.camera.path.empty() && *rc::gen::arbitrary<bool>();
  scene.camera.follow = follows ? scene.bodies.front().name : "";
  scene.picture.frames_per_second = *rc::gen::element(1, 2, 10, 60);
  scene.settings.steps_per_second = scene.picture.frames_per_second * *rc::gen::inRange(1, 100);
  scene.duration =
      static_cast<double>(*rc::gen::inRange(1, 1000)) / scene.picture.frames_per_second;
  if (sim::is_as_printed(scene.settings)) {
    sim::use_paper_method(scene.settings);
    scene.ambient_pressure = 0.0;
    for (BodyScene& body : scene.bodies) sim::use_paper_method(body.material);
  }
  for (BodyScene& body : scene.bodies) {
    const bool by_impulses = scene.settings.contact == sim::ContactMethod::impulses;
    if (body.kind != BodyKind::soft || by_impulses) body.pinned.clear();
    if (scene.settings.contact == sim::ContactMethod::potential) {
      body.material.damping = sim::Damping::dashpot;
    }
    if (body.kind != BodyKind::moved && body.pinned.empty()) body.motion = {};
    if (body.pinned.empty() || body.motion.empty()) body.still.clear();
    if (body.shape == Shape::torus) {
      body.tube_radius = body.radius / 3.0;
      RC_PRE(body.tube_radius > 0.0 && body.tube_radius < body.radius);
    }
    if (!sim::can_integrate(scene.settings.integrator, body.material)) {
      body.material.pressure_weighting = sim::PressureWeighting::uniform;
    }
    make_supply_consistent(scene, body);
    if (body.kind != BodyKind::soft || body.material.temperature == 0.0) {
      body.gauge_pressure.reset();
      body.inflation.reset();
    }
    if (body.gauge_pressure || body.rest == Rest::equilibrium) body.inflation.reset();
    if (body.gauge_pressure) {
      body.gauge_pressure = std::max(*body.gauge_pressure, -scene.ambient_pressure);
    }
    if (body.shape == Shape::model && body.model.file.empty()) body.model.file = "a.ply";
    for (int axis = 0; axis < 3; ++axis) {
      if (body.spacing[axis] == 0.0) body.spacing[axis] = 1.0;
    }
    if (body.colours.size() == 2 && body.colour_axis.norm() == 0.0) body.colour_axis.x() = 1.0;
  }
}

Scene any_scene() {
  Scene scene;
  scene.name = "any";
  if (*rc::gen::arbitrary<bool>()) {
    scene.camera.eye = any_vector({.low = -1e6, .high = 1e6});
    scene.camera.target = *scene.camera.eye + Vec3(1.0, 0.0, 0.0);
    RC_PRE(scene.camera.target->x() <= 1e6 && *scene.camera.eye != *scene.camera.target);
  }
  for (const bool selectors : {true, false}) {
    for (const Section& section : fixed_sections(scene)) set_at_random(section, selectors);
    if (!scene.camera.path.empty()) scene.camera.eye = scene.camera.target = std::nullopt;
  }
  scene.bodies.resize(*rc::gen::inRange<std::size_t>(1, 4));
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    BodyScene& body = scene.bodies[i];
    body.name = *rc::gen::arbitrary<bool>() ? default_name(i) : "x-" + std::to_string(i);
    set_at_random(body_section(body), true);
    const bool by_impulses = scene.settings.contact == sim::ContactMethod::impulses ||
                             sim::is_as_printed(scene.settings);
    if (body.kind != BodyKind::soft && by_impulses) body.kind = BodyKind::rigid;
    if (body.kind == BodyKind::rigid) body.shape = Shape::box;
    set_at_random(body_section(body), false);
  }
  make_consistent(scene);
  return scene;
}

RC_GTEST_PROP(RoundTrip, PrintedScenesReadBackAsTheSame, ()) {
  const Scene scene = any_scene();
  const Scene again = read_back(scene);
  const std::string differs = difference(scene, again);
  if (!differs.empty()) RC_FAIL(differs + " differs after:\n" + print_scene(scene));
  RC_ASSERT(scene_fingerprint(scene) == scene_fingerprint(again));
  RC_ASSERT(print_scene(scene) == print_scene(again));
}

Scene default_scene() { return parse_scene("[[body]]\n", "x.toml"); }

TEST(RoundTrip, NothingOfADefaultSceneIsMarkedAsChanged) {
  const std::string text = print_scene(default_scene());
  EXPECT_EQ(text.find("# * "), std::string::npos) << text;
}

TEST(RoundTrip, AChangedValueIsMarkedWithItsDefault) {
  Scene scene = default_scene();
  scene.bodies[0].material.k = 150.0;
  const std::string text = print_scene(scene);
  EXPECT_NE(text.find("# * N/m: spring constant (default 50)"), std::string::npos) << text;
}

/// Changes a number, flag or vector; other members stay.
bool change(const Key& key) {
  if (auto* const* number = std::get_if<double*>(&key.slot)) return **number *= 0.5, true;
  if (auto* const* integer = std::get_if<int*>(&key.slot)) return **integer += 1, true;
  if (auto* const* flag = std::get_if<bool*>(&key.slot)) return **flag = !**flag, true;
  if (auto* const* vector = std::get_if<Vec3*>(&key.slot)) {
    return (*vector)->array() += 0.5, true;
  }
  return false;
}

TEST(RoundTrip, EveryKeyIsPrintedAndChangesTheFingerprint) {
  std::set<std::uint64_t> fingerprints;
  int changes = 0;
  const auto note = [&](const Scene& scene) {
    fingerprints.insert(scene_fingerprint(scene));
    ++changes;
  };
  note(default_scene());
  // One member at a time, through the sections of a default scene.
  Scene counted = default_scene();
  for (std::size_t s = 0; s < fixed_sections(counted).size(); ++s) {
    for (std::size_t k = 0; k < fixed_sections(counted)[s].keys.size(); ++k) {
      Scene scene = default_scene();
      const Section section = fixed_sections(scene)[s];
      const std::string_view name = section.keys[k].name;
      const bool is_zero = name == "ambient_pressure" || name == "orbit";  // as jitter, below
      if (section.keys[k].applies && !is_zero && change(section.keys[k])) note(scene);
    }
  }
  for (std::size_t k = 0; k < body_section(counted.bodies[0]).keys.size(); ++k) {
    Scene scene = default_scene();
    const Section section = body_section(scene.bodies[0]);
    const std::string_view name = section.keys[k].name;
    // 0 times a half is still 0.
    const bool is_zero = name == "jitter" || name == "bending" || name == "leak.area";
    if (section.keys[k].applies && !is_zero && change(section.keys[k])) note(scene);
  }
  EXPECT_GT(changes, 30);
  EXPECT_EQ(fingerprints.size(), static_cast<std::size_t>(changes));
}

TEST(RoundTrip, TheSceneNameIsNotInTheFingerprint) {
  Scene scene = default_scene();
  const std::uint64_t fingerprint = scene_fingerprint(scene);
  scene.name = "another";
  EXPECT_EQ(scene_fingerprint(scene), fingerprint);
}

TEST(RoundTrip, ANameCannotBreakOutOfItsComment) {
  Scene scene = default_scene();
  scene.name = "a\ntitle = \"b\"";
  EXPECT_EQ(read_back(scene).title, "");
}

TEST(RoundTrip, NegativeZeroSurvives) {
  Scene scene = default_scene();
  scene.bodies[0].position.x() = -0.0;
  EXPECT_TRUE(std::signbit(read_back(scene).bodies[0].position.x()));
}

TEST(ShapeText, DiffersWhereTheMeshDoes) {
  BodyScene sphere;
  BodyScene other = sphere;
  other.size = {1.0, 2.0, 3.0};  // a box's
  other.position = {1.0, 2.0, 3.0};
  other.material.k = 7.0;
  EXPECT_EQ(shape_text(other), shape_text(sphere));
  for (const Shape shape :
       {Shape::sphere, Shape::torus, Shape::box, Shape::icosphere, Shape::model}) {
    BodyScene body;
    body.shape = shape;
    std::set<std::string> texts = {shape_text(body)};
    std::size_t keys = 0;
    for (std::size_t i = 0; i < body_section(body).keys.size(); ++i) {
      BodyScene changed = body;
      const Key key = body_section(changed).keys[i];
      if (!key.of_shape || !key.applies || key.selects || !change(key)) continue;
      ++keys;
      texts.insert(shape_text(changed));
    }
    EXPECT_GT(keys, 0u);
    EXPECT_EQ(texts.size(), keys + 1);
  }
}

TEST(Reference, NamesEveryKeyOnceWithUnitRangeAndDefault) {
  const std::string text = scene_reference();
  Scene scene;
  BodyScene body;
  std::vector<Section> sections = fixed_sections(scene);
  sections.push_back(body_section(body));
  for (const Section& section : sections) {
    EXPECT_NE(text.find(place_of(section.table)), std::string::npos) << section.table;
    for (const Key& key : section.keys) {
      EXPECT_NE(text.find("\n  " + std::string(key.name) + " "), std::string::npos) << key.name;
      EXPECT_FALSE(key.meaning.empty()) << key.name;
    }
  }
  EXPECT_NE(text.find("k >= 0 N/m; default 50"), std::string::npos) << text;
}

/// The words of an enumeration, against a switch that does not compile without a warning when an
/// enumerator is missing.
std::string_view expected_word(sim::Integrator integrator) {
  switch (integrator) {
    case sim::Integrator::martin:
      return "martin";
    case sim::Integrator::symplectic_euler:
      return "symplectic_euler";
    case sim::Integrator::velocity_verlet:
      return "velocity_verlet";
    case sim::Integrator::rk4:
      return "rk4";
    case sim::Integrator::rk8:
      return "rk8";
    case sim::Integrator::implicit_euler:
      return "implicit_euler";
    case sim::Integrator::sdirk2:
      return "sdirk2";
  }
  return "";
}

TEST(Words, OfAnIntegratorAreItsEnumeratorsNames) {
  Scene scene;
  int found = 0;
  for (const Section& section : fixed_sections(scene)) {
    for (const Key& key : section.keys) {
      if (key.name != "integrator") continue;
      ++found;
      const Word& word = std::get<Word>(key.slot);
      for (std::size_t i = 0; i < word.words.size(); ++i) {
        word.set(i);
        EXPECT_EQ(word.words[i], expected_word(scene.settings.integrator));
        EXPECT_EQ(word.get(), i);
      }
    }
  }
  EXPECT_EQ(found, 1);
}

}  // namespace
}  // namespace pneuma::scenes
