// Damaged scene files: each either loads or is refused with a SceneError, and nothing else happens.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <random>
#include <sstream>

#include "scenes/loader/load_scene.h"
#include "scenes/loader/print_scene.h"
#include "tests/scenes/same_scene.h"

namespace pneuma::scenes {
namespace {

std::string everything() {
  const Scene rich = parse_scene(R"(
title = "x"
paper_fps = 3.5
[simulation]
contact = "impulses"
[simulation.particles]
per_vertex = 0.5
[camera]
eye = [1, 2, 3]
target = [0, 0, 0]
[[body]]
shape = "torus"
[[body]]
kind = "rigid"
copies = [2, 2, 2]
colours = ["#ffffff", "#000000", "#ff0000"]
[[body]]
shape = "icosphere"
)",
                                 "rich.toml");
  return print_scene(rich);
}

/// What people and disks do to files: lost, doubled, swapped and strange pieces.
std::string damaged(std::string text, const std::string& donor, std::mt19937& random) {
  const auto below = [&](std::size_t end) {
    return std::uniform_int_distribution<std::size_t>(0, end - 1)(random);
  };
  static const std::vector<std::string> pieces = {"\"",
                                                  "'''",
                                                  "[",
                                                  "]",
                                                  "[[",
                                                  "]]",
                                                  "{",
                                                  "}",
                                                  "=",
                                                  ".",
                                                  ",",
                                                  "\n",
                                                  "#",
                                                  "-",
                                                  "1e999",
                                                  "nan",
                                                  "-inf",
                                                  "9223372036854775808",
                                                  "0x7fffffffffffffff",
                                                  "1979-05-27",
                                                  "true",
                                                  "\\u0000",
                                                  "\xff",
                                                  "body",
                                                  "[[body]]\n",
                                                  "k = 1\n",
                                                  "copies = [1000000, 1000000, 1000000]\n",
                                                  "a.a.a.a = 1\n"};
  const std::size_t times = 1 + below(4);
  for (std::size_t i = 0; i < times; ++i) {
    const std::size_t at = below(text.size() + 1);
    const std::size_t length = std::min(below(20) + 1, text.size() - at);
    switch (below(6)) {
      case 0:
        text.erase(at, length);
        break;
      case 1:
        text.insert(at, pieces[below(pieces.size())]);
        break;
      case 2:
        text.replace(at, length, pieces[below(pieces.size())]);
        break;
      case 3:
        text.insert(at, donor.substr(below(donor.size()), below(200)));
        break;
      case 4:
        if (at < text.size()) text[at] = static_cast<char>(below(256));
        break;
      default:
        text.resize(at);
    }
  }
  return text;
}

TEST(Mutation, DamagedScenesLoadOrAreRefused) {
  const std::string whole = everything();
  const std::string tiny = "[[body]]\nk = 10\nposition = [0, 0, 3]\n";
  std::mt19937 random(1);
  int loaded = 0;
  int refused = 0;
  for (int i = 0; i < 6000; ++i) {
    const std::string text = damaged(i % 3 == 0 ? tiny : whole, whole, random);
    try {
      const Scene scene = parse_scene(text, "damaged.toml");
      EXPECT_EQ(difference(parse_scene(print_scene(scene), "damaged.toml"), scene), "") << text;
      ++loaded;
    } catch (const SceneError& error) {
      EXPECT_FALSE(error.diagnostics().empty());
      ++refused;
    }
  }
  // Both must happen often, or the damage is not what a loader meets.
  EXPECT_GT(loaded, 300);
  EXPECT_GT(refused, 1000);
}

TEST(Mutation, DamagedOverridesAreAppliedOrRefused) {
  const std::vector<std::string> good = {"body.k=200", "simulation.gravity=[0, 0, -9.81]",
                                         "body.2.mass=3", "title=\"x\"", "camera.azimuth=3"};
  const std::string scene = "[[body]]\n[[body]]\nkind = \"rigid\"\n";
  const std::string donor = everything();
  std::mt19937 random(2);
  int applied = 0;
  for (int i = 0; i < 3000; ++i) {
    const std::vector<std::string> overrides = {
        damaged(good[static_cast<std::size_t>(i) % good.size()], donor, random)};
    try {
      parse_scene(scene, "x.toml", overrides);
      ++applied;
    } catch (const SceneError&) {
    }
  }
  EXPECT_GT(applied, 50);
}

TEST(Mutation, RandomBytesAreRefused) {
  std::mt19937 random(3);
  for (int i = 0; i < 2000; ++i) {
    std::string text(random() % 200, '\0');
    for (char& c : text) c = static_cast<char>(random() & 0xffu);
    EXPECT_THROW(parse_scene(text, "noise.toml"), SceneError);
  }
}

}  // namespace
}  // namespace pneuma::scenes
