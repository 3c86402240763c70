#include "tests/scenes/same_scene.h"

#include <cmath>
#include <optional>

namespace pneuma::scenes {
namespace {

// Each structured binding names all members of its struct, so that a new member does not compile
// until it is compared here.

bool same(double a, double b) { return a == b && std::signbit(a) == std::signbit(b); }
bool same(int a, int b) { return a == b; }
bool same(std::uint64_t a, std::uint64_t b) { return a == b; }
bool same(const std::string& a, const std::string& b) { return a == b; }

bool same(const Vec3& a, const Vec3& b) {
  return same(a.x(), b.x()) && same(a.y(), b.y()) && same(a.z(), b.z());
}

template <class T>
bool same(const std::optional<T>& a, const std::optional<T>& b) {
  return a.has_value() == b.has_value() && (!a || same(*a, *b));
}

class Comparison {
 public:
  template <class T>
  void member(const char* name, const T& a, const T& b) {
    if constexpr (requires { same(a, b); }) {
      if (!same(a, b)) note(name);
    } else {
      if (!(a == b)) note(name);
    }
  }
  const std::string& first() const { return first_; }

 private:
  void note(const char* name) {
    if (first_.empty()) first_ = name;
  }
  std::string first_;
};

void compare(Comparison& c, const sim::ContactMaterial& a, const sim::ContactMaterial& b) {
  const auto& [restitution, friction] = a;
  c.member("restitution", restitution, b.restitution);
  c.member("friction", friction, b.friction);
}

void compare(Comparison& c, const sim::SoftMaterial& a, const sim::SoftMaterial& b) {
  const auto& [k, n, temperature, gas_exponent, start_volume, ambient_pressure, vertex_mass,
               bending, bending_damping, pressure_weighting, damping, rho_g, k_max, surface] = a;
  c.member("k", k, b.k);
  c.member("n", n, b.n);
  c.member("temperature", temperature, b.temperature);
  c.member("gas_exponent", gas_exponent, b.gas_exponent);
  c.member("start_volume", start_volume, b.start_volume);
  c.member("material ambient_pressure", ambient_pressure, b.ambient_pressure);
  c.member("vertex_mass", vertex_mass, b.vertex_mass);
  c.member("pressure_weighting", pressure_weighting, b.pressure_weighting);
  c.member("damping", damping, b.damping);
  c.member("rho_g", rho_g, b.rho_g);
  c.member("k_max", k_max, b.k_max);
  c.member("bending", bending, b.bending);
  c.member("bending_damping", bending_damping, b.bending_damping);
  compare(c, surface, b.surface);
}

void compare(Comparison& c, const ModelScene& a, const ModelScene& b) {
  const auto& [file, component, scale, rotation, centre, repair, vertices] = a;
  c.member("model.file", file, b.file);
  c.member("model.component", component, b.component);
  c.member("model.scale", scale, b.scale);
  c.member("model.rotation", rotation, b.rotation);
  c.member("model.centre", centre, b.centre);
  c.member("model.repair", repair, b.repair);
  c.member("model.vertices", vertices, b.vertices);
}

void compare(Comparison& c, const BodyScene& a, const BodyScene& b) {
  // The line is no part of what a scene says.
  const auto& [place, rest_place, position_place, model_place, pinned_place, still_place, name,
               kind, shape, radius, tube_radius, stacks, slices, subdivisions, divisions, size,
               model, rest, skin_mass, density, thickness, stiffness, gauge_pressure, inflation,
               material, supply_n, supply_temperature, supply_smooth, leak, mass, rho_g, surface,
               position, rotation, velocity, angular_velocity, pinned, motion, still, copies,
               spacing, jitter, tumble, colours, colour_axis, roughness, drawn] = a;
  c.member("name", name, b.name);
  c.member("kind", kind, b.kind);
  c.member("shape", shape, b.shape);
  c.member("radius", radius, b.radius);
  c.member("tube_radius", tube_radius, b.tube_radius);
  c.member("stacks", stacks, b.stacks);
  c.member("slices", slices, b.slices);
  c.member("subdivisions", subdivisions, b.subdivisions);
  c.member("divisions", divisions, b.divisions);
  c.member("size", size, b.size);
  compare(c, model, b.model);
  c.member("rest", rest, b.rest);
  c.member("skin_mass", skin_mass, b.skin_mass);
  c.member("density", density, b.density);
  c.member("thickness", thickness, b.thickness);
  c.member("stiffness", stiffness, b.stiffness);
  c.member("gauge_pressure", gauge_pressure, b.gauge_pressure);
  c.member("inflation", inflation, b.inflation);
  compare(c, material, b.material);
  c.member("supply.n", supply_n, b.supply_n);
  c.member("supply.temperature", supply_temperature, b.supply_temperature);
  c.member("supply.smooth", supply_smooth, b.supply_smooth);
  c.member("leak.area", leak.area, b.leak.area);
  c.member("leak.discharge", leak.discharge, b.leak.discharge);
  c.member("mass", mass, b.mass);
  c.member("body rho_g", rho_g, b.rho_g);
  compare(c, surface, b.surface);
  c.member("position", position, b.position);
  c.member("rotation", rotation, b.rotation);
  c.member("velocity", velocity, b.velocity);
  c.member("angular_velocity", angular_velocity, b.angular_velocity);
  c.member("motion.path", motion.path, b.motion.path);
  c.member("motion.rotation", motion.rotation, b.motion.rotation);
  c.member("pinned", pinned, b.pinned);
  c.member("motion.still", still, b.still);
  c.member("motion.smooth", motion.smooth, b.motion.smooth);
  c.member("copies", copies, b.copies);
  c.member("spacing", spacing, b.spacing);
  c.member("jitter", jitter, b.jitter);
  c.member("tumble", tumble, b.tumble);
  c.member("colours", colours, b.colours);
  c.member("colour_axis", colour_axis, b.colour_axis);
  c.member("roughness", roughness, b.roughness);
  c.member("drawn", drawn, b.drawn);
}

void compare(Comparison& c, const ValveScene& a, const ValveScene& b) {
  const auto& [place, from, to, orifice] = a;
  c.member("valve.from", from, b.from);
  c.member("valve.to", to, b.to);
  c.member("valve.area", orifice.area, b.orifice.area);
  c.member("valve.discharge", orifice.discharge, b.orifice.discharge);
}

void compare(Comparison& c, const SpringScene& a, const SpringScene& b) {
  const auto& [place, from, to, from_point, to_point, from_region, to_region, k, damping,
               rest_length] = a;
  c.member("spring.from", from, b.from);
  c.member("spring.to", to, b.to);
  c.member("spring.from_point", from_point, b.from_point);
  c.member("spring.to_point", to_point, b.to_point);
  c.member("spring.from_region", from_region, b.from_region);
  c.member("spring.to_region", to_region, b.to_region);
  c.member("spring.k", k, b.k);
  c.member("spring.damping", damping, b.damping);
  c.member("spring.rest_length", rest_length, b.rest_length);
}

void compare(Comparison& c, const sim::Settings& a, const sim::Settings& b) {
  const auto& [method, steps_per_second, integrator, gravity, ground, contact, skin_thickness,
               soft_search, potential, particles, relaxation_time, contact_iterations, sleep_speed,
               seed] = a;
  const auto& [per_vertex, attraction, max_sweeps, settled_below, shown] = particles;
  c.member("particles.shown", shown, b.particles.shown);
  c.member("method", method, b.method);
  c.member("steps_per_second", steps_per_second, b.steps_per_second);
  c.member("integrator", integrator, b.integrator);
  c.member("gravity", gravity, b.gravity);
  c.member("ground.present", ground.has_value(), b.ground.has_value());
  if (ground && b.ground) compare(c, *ground, *b.ground);
  c.member("contact", contact, b.contact);
  c.member("skin_thickness", skin_thickness, b.skin_thickness);
  const auto& [distance, stiffness, regularisation_speed] = potential;
  c.member("potential.distance", distance, b.potential.distance);
  c.member("potential.stiffness", stiffness, b.potential.stiffness);
  c.member("potential.regularisation_speed", regularisation_speed,
           b.potential.regularisation_speed);
  c.member("soft_search", soft_search, b.soft_search);
  c.member("per_vertex", per_vertex, b.particles.per_vertex);
  c.member("attraction", attraction, b.particles.attraction);
  c.member("max_sweeps", max_sweeps, b.particles.max_sweeps);
  c.member("settled_below", settled_below, b.particles.settled_below);
  c.member("relaxation_time", relaxation_time, b.relaxation_time);
  c.member("contact_iterations", contact_iterations, b.contact_iterations);
  c.member("sleep_speed", sleep_speed, b.sleep_speed);
  c.member("seed", seed, b.seed);
}

void compare(Comparison& c, const CameraScene& a, const CameraScene& b) {
  const auto& [eye, target, azimuth, elevation, field_of_view, path, follow, orbit] = a;
  c.member("eye", eye, b.eye);
  c.member("target", target, b.target);
  c.member("azimuth", azimuth, b.azimuth);
  c.member("elevation", elevation, b.elevation);
  c.member("field_of_view", field_of_view, b.field_of_view);
  c.member("path", path, b.path);
  c.member("follow", follow, b.follow);
  c.member("orbit", orbit, b.orbit);
}

void compare(Comparison& c, const PictureScene& a, const PictureScene& b) {
  const auto& [width, height, frames_per_second, samples, shadows, caption, pressures, grid,
               rounded] = a;
  c.member("width", width, b.width);
  c.member("height", height, b.height);
  c.member("frames_per_second", frames_per_second, b.frames_per_second);
  c.member("samples", samples, b.samples);
  c.member("shadows", shadows, b.shadows);
  c.member("caption", caption, b.caption);
  c.member("pressures", pressures, b.pressures);
  c.member("grid", grid, b.grid);
  c.member("rounded", rounded, b.rounded);
}

void compare(Comparison& c, const Limits& a, const Limits& b) {
  const auto& [bodies, vertices_per_body, vertices, frames, memory_gib, picture_side,
               model_file_mib, scene_file_mib] = a;
  c.member("limits.bodies", bodies, b.bodies);
  c.member("limits.vertices_per_body", vertices_per_body, b.vertices_per_body);
  c.member("limits.vertices", vertices, b.vertices);
  c.member("limits.frames", frames, b.frames);
  c.member("limits.memory_gib", memory_gib, b.memory_gib);
  c.member("limits.picture_side", picture_side, b.picture_side);
  c.member("limits.model_file_mib", model_file_mib, b.model_file_mib);
  c.member("limits.scene_file_mib", scene_file_mib, b.scene_file_mib);
}

}  // namespace

std::string difference(const Scene& a, const Scene& b) {
  // Where a scene's file lies, what the loader said of it, and which of its values are given is no
  // part of what it says.
  const auto& [name, folder, warnings, title, figure, paper_fps, duration, settings, names_step,
               ambient_pressure, bodies, valves, springs, camera, picture, limits] = a;
  Comparison c;
  c.member("scene name", name, b.name);
  c.member("title", title, b.title);
  c.member("figure", figure, b.figure);
  c.member("paper_fps", paper_fps, b.paper_fps);
  c.member("duration", duration, b.duration);
  compare(c, settings, b.settings);
  c.member("ambient_pressure", ambient_pressure, b.ambient_pressure);
  c.member("number of bodies", bodies.size(), b.bodies.size());
  for (std::size_t i = 0; i < bodies.size() && i < b.bodies.size(); ++i) {
    compare(c, bodies[i], b.bodies[i]);
  }
  c.member("number of valves", valves.size(), b.valves.size());
  for (std::size_t i = 0; i < valves.size() && i < b.valves.size(); ++i) {
    compare(c, valves[i], b.valves[i]);
  }
  c.member("number of springs", springs.size(), b.springs.size());
  for (std::size_t i = 0; i < springs.size() && i < b.springs.size(); ++i) {
    compare(c, springs[i], b.springs[i]);
  }
  compare(c, camera, b.camera);
  compare(c, picture, b.picture);
  compare(c, limits, b.limits);
  return c.first();
}

}  // namespace pneuma::scenes
