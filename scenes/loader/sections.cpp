#include "scenes/loader/sections.h"

#include <fmt/format.h>

#include <utility>

#include "scenes/loader/integrator_names.h"
#include "scenes/loader/text_checks.h"

namespace pneuma::scenes {
namespace {

// Positions and lengths end here: beyond, the pictures' single precision resolves no better than
// 6 cm.
constexpr double farthest = 1e6;

Range any() { return {}; }
Range at_least(double low) { return {.low = low}; }
Range above(double low) { return {.low = low, .low_open = true}; }
Range between(double low, double high) { return {.low = low, .high = high}; }
Range above_to(double low, double high) { return {.low = low, .high = high, .low_open = true}; }
Range from_below(double low, double high) { return {.low = low, .high = high, .high_open = true}; }
Range one_of(std::vector<int> values) { return {.only = std::move(values)}; }
Range length() { return above_to(0, farthest); }
Range place() { return between(-farthest, farthest); }

template <class Enum>
using Named = std::pair<Enum, std::string_view>;

constexpr std::array integrators = {
    Named<sim::Integrator>{sim::Integrator::martin, "martin"},
    Named<sim::Integrator>{sim::Integrator::symplectic_euler, "symplectic_euler"},
    Named<sim::Integrator>{sim::Integrator::velocity_verlet, "velocity_verlet"},
    Named<sim::Integrator>{sim::Integrator::rk4, "rk4"},
    Named<sim::Integrator>{sim::Integrator::implicit_euler, "implicit_euler"},
    Named<sim::Integrator>{sim::Integrator::sdirk2, "sdirk2"},
};
constexpr std::array methods = {
    Named<sim::Method>{sim::Method::corrected, "corrected"},
    Named<sim::Method>{sim::Method::paper, "paper"},
};
constexpr std::array soft_searches = {
    Named<sim::SoftSearch>{sim::SoftSearch::particles, "particles"},
    Named<sim::SoftSearch>{sim::SoftSearch::exact, "exact"},
};
constexpr std::array contact_methods = {
    Named<sim::ContactMethod>{sim::ContactMethod::impulses, "impulses"},
    Named<sim::ContactMethod>{sim::ContactMethod::swept, "swept"},
};
constexpr std::array pressures = {
    Named<sim::PressureWeighting>{sim::PressureWeighting::uniform, "uniform"},
    Named<sim::PressureWeighting>{sim::PressureWeighting::valence, "valence"},
};
constexpr std::array dampings = {
    Named<sim::Damping>{sim::Damping::dashpot, "dashpot"},
    Named<sim::Damping>{sim::Damping::literal, "literal"},
};
constexpr std::array kinds = {
    Named<BodyKind>{BodyKind::soft, "soft"},
    Named<BodyKind>{BodyKind::rigid, "rigid"},
};
constexpr std::array rests = {
    Named<Rest>{Rest::shape, "shape"},
    Named<Rest>{Rest::equilibrium, "equilibrium"},
};
constexpr std::array shapes = {
    Named<Shape>{Shape::sphere, "sphere"}, Named<Shape>{Shape::torus, "torus"},
    Named<Shape>{Shape::box, "box"},       Named<Shape>{Shape::icosphere, "icosphere"},
    Named<Shape>{Shape::model, "model"},
};

/// `names` must outlive the word.
template <class Enum, std::size_t Count>
Word word(Enum& member, const std::array<Named<Enum>, Count>& names) {
  Word result;
  result.member = &member;
  for (const auto& [value, name] : names) result.words.push_back(name);
  result.get = [&member, &names] {
    std::size_t i = 0;
    while (i + 1 < Count && names[i].first != member) ++i;
    return i;
  };
  result.set = [&member, &names](std::size_t i) { member = names[i].first; };
  return result;
}

/// The structs for which a key is meant, and whether the one at hand is such.
struct Applicability {
  std::string_view only_for;
  bool applies;
  bool by_shape = false;  // whether the body's shape decides
};

Key only(const Applicability& applicability, Key key) {
  key.only_for = applicability.only_for;
  key.applies = applicability.applies;
  key.of_shape = applicability.by_shape;
  return key;
}

Key of_shape(Key key) {
  key.of_shape = true;
  return key;
}

Key of_method(Key key) {
  key.of_method = true;
  return key;
}

Key selector(Key key) {
  key.selects = true;
  return key;
}

Key or_number(Key key) {
  key.or_number = true;
  return key;
}

Section top_section(Scene& scene) {
  return {
      .table = "",
      .what = "a scene",
      .keys = {
          {"title", &scene.title, any(), "", "what the scene shows", check_line},
          {"figure", &scene.figure, any(), "", "the paper's figure or benchmark row", check_line},
          {"paper_fps", &scene.paper_fps, above(0), "frames/s",
           "frame rate that the paper measured"},
          {"duration", &scene.duration, above_to(0, 1e6), "s",
           "length of the run, a whole number of frames"},
      }};
}

Section simulation_section(Scene& scene) {
  sim::Settings& settings = scene.settings;
  return {
      .table = "simulation",
      .what = "the simulation",
      .keys = {
          {"steps_per_second", &settings.steps_per_second, between(1, 1e6), "steps/s",
           "simulation steps; the time step is the inverse"},
          {"method", word(settings.method, methods), any(), "",
           "paper: all as printed, and no key beside it that it sets; corrected: as ERRATA says"},
          of_method({"integrator", word(settings.integrator, integrators), any(), "",
                     "how soft bodies are stepped"}),
          {"gravity", &settings.gravity, any(), "m/s^2", "acceleration along x, y, z"},
          of_method(
              {"contact", word(settings.contact, contact_methods), any(), "",
               "swept: nothing passes through a soft body; impulses: as in the paper, after the "
               "motion"}),
          of_method({"skin_thickness", &settings.skin_thickness, length(), "m",
                     "features nearer than twice this are in contact; swept contacts need a few "
                     "hundredths of an edge, and keep no more"}),
          of_method({"soft_search", word(settings.soft_search, soft_searches), any(), "",
                     "how impulses find contacts of soft bodies: the paper's particles, or all "
                     "within reach"}),
          of_method(
              {"relaxation_time", &settings.relaxation_time, at_least(0), "s",
               "in which impulses part soft features by a factor e; 0: at once, as in the paper"}),
          of_method({"contact_iterations", &settings.contact_iterations, between(1, 10'000), "",
                     "of impulses, over an island of contacts; at most 3 if none of them is "
                     "a box's with another or the ground"}),
          {"seed", &settings.seed, at_least(0), "",
           "of everything random: particles, jitter, tumble"},
      }};
}

Section particles_section(Scene& scene) {
  sim::ParticleSettings& particles = scene.settings.particles;
  return {.table = "simulation.particles",
          .what = "the collision particles",
          .keys = {
              of_method({"per_vertex", &particles.per_vertex, above_to(0, 100), "",
                         "particles per vertex of a body, at least one per body"}),
              of_method({"attraction", &particles.attraction, between(0, 1e6), "",
                         "pull of the other body's particles, in units of the own ones' push"}),
              of_method({"max_sweeps", &particles.max_sweeps, between(1, 10'000), "",
                         "of the refinement loop per step"}),
              of_method({"settled_below", &particles.settled_below, between(0, 1e9), "",
                         "the loop ends when fewer particles than this move"}),
          }};
}

Section ground_section(Scene& scene) {
  sim::Settings& settings = scene.settings;
  const bool present = settings.ground.has_value();
  const Slot restitution = present ? Slot(&settings.ground->restitution) : Slot();
  const Slot friction = present ? Slot(&settings.ground->friction) : Slot();
  const Applicability there{"a ground that is present", present};
  return {.table = "ground",
          .what = present ? "a ground" : "no ground (present = false)",
          .keys = {
              selector({"present", &settings.ground, any(), "",
                        "whether the plane z = 0 holds bodies up"}),
              only(there, {"restitution", restitution, between(0, 1), "",
                           "0 keeps no normal velocity, 1 keeps all"}),
              only(there, {"friction", friction, at_least(0), "", "Coulomb's coefficient"}),
          }};
}

Section camera_section(Scene& scene) {
  CameraScene& camera = scene.camera;
  const bool placed = camera.eye.has_value() || camera.target.has_value();
  const Applicability automatic{"a camera without eye and target", !placed};
  return {.table = "camera",
          .what = placed ? "a camera with an eye and a target" : "an automatic camera",
          .keys = {
              selector({"eye", &camera.eye, place(), "m", "where the camera stands"}),
              selector({"target", &camera.target, place(), "m", "the point it looks at"}),
              only(automatic, {"azimuth", &camera.azimuth, between(-360, 360), "degrees",
                               "of the automatic camera's place, from +x towards +y"}),
              only(automatic, {"elevation", &camera.elevation, between(-89, 89), "degrees",
                               "of the automatic camera's place above the horizon"}),
              {"field_of_view", &camera.field_of_view, between(1, 120), "degrees", "vertical"},
          }};
}

Section picture_section(Scene& scene) {
  PictureScene& picture = scene.picture;
  return {
      .table = "picture",
      .what = "the picture",
      .keys = {
          {"width", &picture.width, between(16, greatest_picture_side), "pixels", "of a frame"},
          {"height", &picture.height, between(16, greatest_picture_side), "pixels", "of a frame"},
          {"frames_per_second", &picture.frames_per_second, between(1, 1e6), "frames/s",
           "of simulated time; divides steps_per_second"},
          {"samples", &picture.samples, one_of({1, 2, 4}), "",
           "per pixel; four cost up to 1.7 times as much as one"},
          {"shadows", &picture.shadows, any(), "", "draw shadows"},
          {"caption", &picture.caption, any(), "", "draw the caption"},
          {"grid", &picture.grid, any(), "", "draw the ground with its grid, where there is one"},
      }};
}

Section limits_section(Scene& scene) {
  Limits& limits = scene.limits;
  return {
      .table = "limits",
      .what = "the limits",
      .keys = {
          {"bodies", &limits.bodies, between(1, 10'000'000), "", "at most, with copies"},
          // Features (vertices, edges and triangles: six per vertex) are numbered by an int.
          {"vertices_per_body", &limits.vertices_per_body, between(1, 100'000'000), "", "at most"},
          {"vertices", &limits.vertices, between(1, 2e9), "", "of all bodies, with copies"},
          {"frames", &limits.frames, between(1, 1e9), "", "of the run, at most"},
          {"memory_gib", &limits.memory_gib, above(0), "GiB", "estimated, at most"},
          {"picture_side", &limits.picture_side, between(16, greatest_picture_side), "pixels",
           "width and height at most"},
          {"model_file_mib", &limits.model_file_mib, above_to(0, 2048), "MiB",
           "of a model with its files, at most"},
          {"scene_file_mib", &limits.scene_file_mib, above_to(0, max_scene_file_mib), "MiB",
           "of the scene file; raised by --set only, because it is read before its keys"},
      }};
}

constexpr std::array<SectionMaker, 7> makers = {
    top_section,    simulation_section, particles_section, ground_section,
    camera_section, picture_section,    limits_section,
};

}  // namespace

std::span<const SectionMaker> section_makers() { return makers; }

std::vector<Section> fixed_sections(Scene& scene) {
  std::vector<Section> sections;
  for (const SectionMaker make : makers) sections.push_back(make(scene));
  return sections;
}

Section body_section(BodyScene& body) {
  const bool soft = body.kind == BodyKind::soft;
  const bool sphere = soft && body.shape == Shape::sphere;
  const bool torus = soft && body.shape == Shape::torus;
  const bool icosphere = soft && body.shape == Shape::icosphere;
  const bool box = !soft || body.shape == Shape::box;
  const bool model = soft && body.shape == Shape::model;

  const Applicability round{"spheres, icospheres and tori", sphere || torus || icosphere, true};
  const Applicability tori{"tori", torus, true};
  const Applicability stacked{"spheres and tori", sphere || torus, true};
  const Applicability icospheres{"icospheres", icosphere, true};
  const Applicability soft_boxes{"soft boxes", soft && box, true};
  const Applicability boxes{"boxes", box, true};
  const Applicability models{"models", model, true};
  const Applicability soft_bodies{"soft bodies", soft};
  const Applicability rigid_bodies{"rigid bodies", !soft};
  const Applicability two_colours{"bodies with two colours", body.colours.size() == 2};

  const Word kind = word(body.kind, kinds);
  const Word shape = word(body.shape, shapes);
  sim::SoftMaterial& material = body.material;
  sim::ContactMaterial& surface = soft ? material.surface : body.surface;
  double& rho_g = soft ? material.rho_g : body.rho_g;
  return {
      .table = "body",
      .what = fmt::format("a {} {}", kind.words[kind.get()], shape.words[shape.get()]),
      .keys = {
          {"name", &body.name, any(), "", "of this body alone", check_body_name},
          selector({"kind", kind, any(), "", "gas-filled membrane, or box that keeps its shape"}),
          of_shape(selector({"shape", shape, any(), "", "a rigid body is always a box"})),
          only(round, {"radius", &body.radius, length(), "m",
                       "of a sphere; of the centre line of a torus"}),
          only(tori, {"tube_radius", &body.tube_radius, length(), "m", "less than radius"}),
          only(stacked,
               {"stacks", &body.stacks, between(torus ? 3 : 2, 10'000), "",
                "circles; of a sphere one fewer, between its poles; of a torus 3 or more"}),
          only(stacked,
               {"slices", &body.slices, between(3, 10'000), "", "vertices of each circle"}),
          only(icospheres, {"subdivisions", &body.subdivisions, between(0, 11), "",
                            "10 * 4^subdivisions + 2 vertices"}),
          only(soft_boxes, {"divisions", &body.divisions, between(1, 4'000), "",
                            "squares along each side of a face"}),
          only(boxes, {"size", &body.size, length(), "m", "full lengths along x, y, z"}),
          only(models, {"model.file", &body.model.file, any(), "",
                        "a triangle model, beside the scene file or in assets/", check_file}),
          only(models, or_number({"model.component", &body.model.component, any(), "",
                                  "of several in the file, by name or number", check_line})),
          only(models,
               {"model.scale", &body.model.scale, above_to(0, 1e30), "m", "per unit of the file"}),
          only(models, {"model.rotation", &body.model.rotation, between(-360, 360), "degrees",
                        "sets the model upright: about x, then y, then z"}),
          only(models, {"model.centre", &body.model.centre, any(), "",
                        "its middle is the body's position, not the file's origin"}),

          only(soft_bodies, {"rest", word(body.rest, rests), any(), "",
                             "of the springs: in the shape, or so that it holds its gas"}),
          only(soft_bodies, {"k", &material.k, at_least(0), "N/m", "spring constant"}),
          only(soft_bodies, {"n", &material.n, at_least(0), "mol", "amount of gas"}),
          only(soft_bodies, {"temperature", &material.temperature, at_least(0), "K", "of the gas"}),
          only(soft_bodies, {"vertex_mass", &material.vertex_mass, above(0), "kg", "per vertex"}),
          only(soft_bodies,
               of_method({"pressure_weighting", word(material.pressure_weighting, pressures), any(),
                          "", "uniform: conservative; valence: the paper's"})),
          only(soft_bodies, of_method({"damping", word(material.damping, dampings), any(), "",
                                       "dashpot: continuous; literal: the paper's"})),
          only(soft_bodies, {"k_max", &material.k_max, above(0), "N/m",
                             "springs of this k or more are damped most"}),
          only(rigid_bodies, {"mass", &body.mass, above(0), "kg", "of the whole box"}),
          {"rho_g", &rho_g, from_below(0, 1), "", "fraction of velocity lost per 1/60 s"},
          {"restitution", &surface.restitution, between(0, 1), "",
           "0 keeps no normal velocity, 1 keeps all"},
          {"friction", &surface.friction, at_least(0), "", "Coulomb's coefficient"},

          {"position", &body.position, place(), "m", "of the shape's centre"},
          {"rotation", &body.rotation, between(-360, 360), "degrees",
           "about world x, then y, then z"},
          {"velocity", &body.velocity, place(), "m/s", "at the start"},
          {"angular_velocity", &body.angular_velocity, place(), "rad/s", "about world axes"},

          {"copies", &body.copies, between(1, 1'000'000), "", "along x, y, z"},
          {"spacing", &body.spacing, place(), "m", "between copies along x, y, z"},
          {"jitter", &body.jitter, between(0, farthest), "m",
           "each copy is moved at random by up to this"},
          {"tumble", &body.tumble, any(), "", "each copy starts turned at random"},
          selector({"colours", &body.colours, any(), "",
                    "one to three: plain, along colour_axis, along x, y, z", check_colour}),
          only(two_colours,
               {"colour_axis", &body.colour_axis, any(), "", "of two colours' gradient"}),
      }};
}

std::span<const std::pair<sim::Integrator, std::string_view>> integrator_names() {
  return integrators;
}

std::string integrator_name(sim::Integrator integrator) {
  for (const auto& [known, name] : integrator_names()) {
    if (known == integrator) return std::string(name);
  }
  return {};
}

std::string default_name(std::size_t index) { return fmt::format("body{}", index + 1); }

}  // namespace pneuma::scenes
