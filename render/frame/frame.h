// A picture to be drawn, as plain data: the only thing the renderer is ever handed.
// Metres, right-handed, +z up. Colours are sRGB, 0..1.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace pneuma::render {

using Vec3f = Eigen::Vector3f;
using Colour = Vec3f;

struct Camera {
  Vec3f eye = {0.0f, -10.0f, 5.0f};
  Vec3f target = Vec3f::Zero();
  float field_of_view = 40.0f;  // degrees, vertical, 1..120
};

/// One light, far away.
struct Light {
  Vec3f direction = {-0.45f, 0.35f, -0.82f};  // the way it shines; any length but zero
  float softness = 0.012f;  // width of a shadow's edge, as a fraction of the scene, 0..0.2
  bool shadows = true;
  bool between_bodies = true;  // with shadows: bodies take light of each other and of the ground
};

/// The plane z = 0 with a grid that gives scale.
struct Ground {
  float grid_spacing = 1.0f;  // m between lines; every fifth is stronger
};

/// What meshes of one origin share from frame to frame; uploaded once per object.
struct MeshShape {
  std::vector<std::array<std::uint32_t, 3>> triangles;  // counter-clockwise from outside
  std::vector<std::array<std::uint32_t, 2>> edges;      // drawn when `wireframe` is on
  std::vector<Colour> colours;                          // per vertex
  // Of a mesh without normals, per triangle: the numbers of its corners' normals, below three times
  // the number of triangles. Corners with the same number, which must be of one vertex, are shaded
  // smoothly with each other. Empty: each triangle is flat.
  std::vector<std::array<std::uint32_t, 3>> corner_normals;
};

struct Mesh {
  std::shared_ptr<const MeshShape> shape;
  std::vector<Vec3f> positions;  // per vertex
  std::vector<Vec3f> normals;    // per vertex, unit; empty for a surface with sharp edges
  float roughness = 0.35f;       // of the surface, 0.05 (shines) .. 1 (dull)
  std::vector<Colour> colours;   // per vertex, in place of the shape's; empty: those
  // Per triangle, m: how far the drawn surface may bulge out of it to look round; empty: nowhere.
  std::vector<float> room;
  // Whether it takes light of sky and ground from what is near. What is thin takes too little.
  bool takes_light = true;
};

/// Drawn over the surfaces, round, with a dark rim so that it stands out on any colour.
struct Point {
  Vec3f position;
  Colour colour;
  float diameter = 6.0f;       // pixels at 480 lines; scales with the picture's height, down to 5
  bool always_visible = true;  // drawn over what would hide it (faintly), or hidden by it
};

struct Line {
  Vec3f from;
  Vec3f to;
  Colour colour;
  float width = 1.5f;           // pixels at 480 lines
  bool always_visible = false;  // also drawn, faintly, over what hides it
  // The number of the only mesh, beside the ground, that an always visible line shines through.
  // None: every mesh.
  std::optional<std::uint32_t> through = std::nullopt;
};

/// Lines of text in the lower left corner.
struct Caption {
  std::string text;  // UTF-8; newlines start a new line
};

/// A name over a point, in front of all bodies.
struct Label {
  Vec3f position;
  std::string text;  // UTF-8
};

/// What the colours of surfaces mean: a bar from its low end, at the bottom, to its high end.
struct Legend {
  struct Tick {
    float at;  // 0 at the low end, 1 at the high end
    std::string text;
  };
  std::string title;
  std::vector<Colour> colours;  // evenly from low to high, at least two
  std::vector<Tick> ticks;
};

struct Frame {
  Camera camera;
  Light light;
  std::optional<Ground> ground = Ground{};
  std::vector<Mesh> meshes;
  bool wireframe = false;  // edges over the surfaces
  std::vector<Point> points;
  std::vector<Line> lines;
  std::optional<Caption> caption;
  std::vector<Label> labels;
  bool scale_bar = false;  // how long a metre is where the camera's target is
  std::optional<Legend> legend;
};

}  // namespace pneuma::render
