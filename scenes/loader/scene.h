// A scene as plain data: what a scene file says, with every default filled in.
// Simulation settings and materials are the simulation's own structs, so that a default is written
// once. The keys that set these members, with their ranges, are in sections.cpp.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scenes/loader/palette.h"
#include "sim/world/world.h"

namespace pneuma::scenes {

using sim::Vec3;

enum class BodyKind {
  soft,
  rigid,
  fixed,  // "static": it never moves
  moved,  // it keeps its velocities or follows its motion, whatever it meets
};

/// A box along x, y, z: where it begins, then where it ends along each, m.
using Region = std::array<double, 6>;

/// A time in s, and what is reached by it.
using TimedValue = std::array<double, 2>;

enum class Shape { sphere, torus, box, icosphere, model };

/// When a soft body's springs are at rest.
enum class Rest {
  shape,        // in the shape as it is made: the gas then blows it up
  equilibrium,  // with tensions in them that hold the shape against its gas
                // (sim/equilibrium/equilibrium.h)
};

/// What is seen of a body.
enum class Drawn {
  surface,
  edges,  // as bars: what is inside of it is seen
  nothing,
};

/// Allowed for ModelScene::vertices: with fewer a body has no shape.
inline constexpr int min_model_vertices = 20, max_model_vertices = 100'000'000;

/// A triangle model from a file of anyone's.
struct ModelScene {
  std::string file;              // beside the scene file, or as app/files/find_model.h says
  std::string component;         // which, by name or number from 1; empty: the only closed one
  double scale = 1.0;            // m per unit of the file
  Vec3 rotation = Vec3::Zero();  // degrees about x, then y, then z: how the model is set up
  bool centre = true;            // the middle of its bounding box is its centre, else its origin
  bool repair = false;           // assets/repair_mesh.h
  std::optional<int> vertices;   // at most: assets/simplify/simplify_mesh.h; none: all of them
};

/// Where something was written, for errors that only show when the world is built.
struct Place {
  std::string file;  // or "--set PATH=VALUE"; empty: it is of no file
  int line = 0;      // from 1; 0: the file as a whole
  int column = 0;
  std::string source_line;
};

/// One body, or a block of copies of it.
struct BodyScene {
  Place place;  // of its [[body]]
  // Of its keys; where one is left out, of its [[body]].
  Place rest_place, position_place, model_place, pinned_place, still_place;
  std::string name;  // unique; by default "body1", "body2", ...
  BodyKind kind = BodyKind::soft;

  Shape shape = Shape::sphere;  // a rigid body is always a box; static and moved ones unless told
  double radius = 3.0;          // m: sphere, icosphere; of a torus the centre line
  double tube_radius = 1.0;     // m: torus
  int stacks = 8;               // sphere, torus
  int slices = 8;               // sphere, torus
  int subdivisions = 2;         // icosphere
  int divisions = 4;            // soft box: squares along each side of a face
  Vec3 size = {2.0, 2.0, 2.0};  // m: box
  ModelScene model;             // model

  Rest rest = Rest::shape;  // soft
  // Of the skin of a soft body, in place of vertex_mass and k: whatever the mesh.
  std::optional<double> skin_mass;       // kg in all
  std::optional<double> density;         // kg/m^3
  double thickness = 0.001;              // m; means something beside density only
  std::optional<double> stiffness;       // N/m: Young's modulus times thickness
  std::optional<double> gauge_pressure;  // Pa at the start, above the ambient pressure: soft
  std::optional<double> inflation;       // volume at rest over that of the shape: soft
  // soft; with one of the two above, n and start_volume are of app/world/fill_body.h
  sim::SoftMaterial material;

  std::vector<TimedValue> supply_n;            // s, mol: soft, in place of n
  std::vector<TimedValue> supply_temperature;  // s, K: soft, in place of the temperature
  bool supply_smooth = true;
  sim::Orifice leak;  // soft; without an area there is none

  double mass = sim::RigidBox{}.mass;    // kg: rigid
  double rho_g = sim::RigidBox{}.rho_g;  // rigid; a soft body's is in its material
  sim::ContactMaterial surface;          // likewise

  Vec3 position = Vec3::Zero();          // m, of the shape's centre; of the first copy
  Vec3 rotation = Vec3::Zero();          // degrees about world x, then y, then z
  Vec3 velocity = Vec3::Zero();          // m/s
  Vec3 angular_velocity = Vec3::Zero();  // rad/s, world axes

  std::vector<Region> pinned;  // soft: vertices that start in one of these are held
  sim::KeyFrames motion;       // of a moved body, in place of velocities; of pinned vertices
  std::vector<Region> still;   // of the pinned vertices: these do not follow the motion

  std::array<int, 3> copies = {1, 1, 1};  // along x, y, z
  Vec3 spacing = {3.0, 3.0, 3.0};         // m between copies
  double jitter = 0.0;  // m: each copy's position is moved by up to this, from the seed
  bool tumble = false;  // each copy starts turned at random, from the seed

  // "#rrggbb". One: plain; two: along colour_axis; three: along body x, y and z.
  std::vector<std::string> colours = palette_colours(0);
  Vec3 colour_axis = {0.3, 0.0, 1.0};
  double roughness = 0.35;  // of the drawn surface
  Drawn drawn = Drawn::surface;
};

/// An opening between the gas of two bodies.
struct ValveScene {
  Place place;  // of its [[valve]]
  std::string from, to;
  sim::Orifice orifice = {.area = 0.01};
};

/// A spring between two bodies.
struct SpringScene {
  Place place;  // of its [[spring]]
  std::string from, to;
  std::optional<Vec3> from_point, to_point;    // m, in world coordinates
  std::vector<Region> from_region, to_region;  // instead of points
  double k = 50.0;                             // N/m
  double damping = 0.0;                        // N s/m
  std::optional<double> rest_length;           // m
};

/// Where the camera is at a time (s): its eye, then its target, m.
using CameraKey = std::array<double, 7>;

/// Without an eye and a target the camera is placed so that every body is in view, and draws back
/// when they come to go further.
struct CameraScene {
  std::optional<Vec3> eye;          // m
  std::optional<Vec3> target;       // m
  double azimuth = -60.0;           // degrees from +x towards +y: where an automatic camera stands
  std::optional<double> elevation;  // degrees above the horizon
  double field_of_view = 35.0;      // degrees, vertical
  std::vector<CameraKey> path;      // in place of eye and target: times rise
  std::string follow;               // a body's name: the camera keeps its place beside it
  double orbit = 0.0;               // degrees/s about the vertical through the target
};

struct PictureScene {
  int width = 1280;
  int height = 720;
  int frames_per_second = 30;  // divides the steps per second
  int samples = 1;
  bool shadows = true;
  bool caption = true;
  bool pressures = false;  // on the caption
  bool grid = true;        // draw the ground plane with its grid, where the scene has a ground
  bool rounded = true;     // draw coarse soft bodies round, not as the flat triangles they are
};

/// What a scene may ask for at most, so that a slip of the pen does not fill the memory or run for
/// days. A scene that means it raises them.
struct Limits {
  int bodies = 20'000;  // counted with copies
  int vertices_per_body = 100'000;
  int vertices = 2'000'000;      // of all bodies, counted with copies
  int frames = 36'000;           // twenty minutes at 30 frames per second
  double memory_gib = 4.0;       // GiB, as estimated by estimated_memory_gib
  int picture_side = 8192;       // pixels
  double model_file_mib = 64.0;  // MiB, of each model with the files that belong to it
  // MiB, of the scene file itself; the paper's take about 2 KiB. It is enforced before the file's
  // own keys are read, so only an override can raise it, and the file only lower it.
  double scene_file_mib = 1.0;
};

/// Pixels along a side of the largest picture that the renderer makes.
inline constexpr int smallest_picture_side = 16;
inline constexpr int greatest_picture_side = 16384;

/// MiB to which the limit of scene files can be raised.
inline constexpr double max_scene_file_mib = 1024.0;

struct Scene {
  std::string name;  // the file's name without its ending: frames are called NAME_00042.png
  std::filesystem::path folder;       // of the scene file
  std::vector<std::string> warnings;  // of the loader: "file:line:column: warning: ..."
  std::string title;
  std::string figure;               // the paper's figure or benchmark row, as people call it
  std::optional<double> paper_fps;  // what the paper measured
  double duration = 10.0;           // s; a whole number of frames

  sim::Settings settings;
  bool names_step = false;        // settings.steps_per_second is given, not the default
  double ambient_pressure = 0.0;  // Pa, outside of every body with gas
  std::vector<BodyScene> bodies;
  std::vector<ValveScene> valves;
  std::vector<SpringScene> springs;
  CameraScene camera;
  PictureScene picture;
  Limits limits;
};

/// Whether it becomes a sim::RigidBox: else it has a mesh of its own.
inline bool is_box(const BodyScene& body) {
  return body.kind == BodyKind::rigid || (body.kind != BodyKind::soft && body.shape == Shape::box);
}

/// Whether the gas of the body comes or goes by itself, without a valve.
inline bool has_supply(const BodyScene& body) {
  return !body.supply_n.empty() || !body.supply_temperature.empty() || body.leak.area > 0.0;
}

/// Vertices of one copy; a rigid box has 8. 0 for a model: only its file knows, and it is read when
/// the world is built, which checks the limits again.
std::int64_t vertex_count(const BodyScene& body);

/// How many bodies the copies make.
std::int64_t copy_count(const BodyScene& body);

/// The body whose copy a body of the world is: those with a mesh come first there, then the boxes,
/// each in the order of the scene.
const BodyScene& body_of(const Scene& scene, int body);

/// As scene files have it: "soft", "rigid", "static" or "moved".
std::string kind_name(BodyKind kind);

/// Frames of the whole run, without the one at time zero.
std::int64_t frame_count(const Scene& scene);

/// Of a scene that names no step: the least number, from the default one on, that the frames
/// divide.
int default_steps_per_second(int frames_per_second);

/// Steps from one frame to the next: a whole number in every valid scene.
int steps_per_frame(const Scene& scene);

/// A rough estimate, from the sizes of meshes, state and picture: within a factor of two or so.
/// Without models.
double estimated_memory_gib(const Scene& scene);

/// The part of one body of so many vertices and copies.
double estimated_memory_gib(std::int64_t vertices, std::int64_t copies);

/// For messages: two decimals, rounded up, so that what is above a limit reads as above it.
std::string memory_text(double gib);

}  // namespace pneuma::scenes
