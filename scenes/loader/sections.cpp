#include "scenes/loader/sections.h"

#include <fmt/format.h>

#include "scenes/loader/integrator_names.h"
#include "scenes/loader/make_keys.h"
#include "scenes/loader/text_checks.h"

namespace pneuma::scenes {
namespace {

constexpr std::array integrators = {
    Named<sim::Integrator>{sim::Integrator::martin, "martin"},
    Named<sim::Integrator>{sim::Integrator::symplectic_euler, "symplectic_euler"},
    Named<sim::Integrator>{sim::Integrator::velocity_verlet, "velocity_verlet"},
    Named<sim::Integrator>{sim::Integrator::rk4, "rk4"},
    Named<sim::Integrator>{sim::Integrator::rk8, "rk8"},
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
    Named<sim::ContactMethod>{sim::ContactMethod::potential, "potential"},
};

Section top_section(Scene& scene) {
  return {
      .table = "",
      .what = "a scene",
      .keys = {
          {"title", &scene.title, any(), "", "what the scene shows", check_line},
          {"figure", &scene.figure, any(), "", "the paper's figure or benchmark row", check_line},
          {"paper_fps", &scene.paper_fps, above(0), "frames/s",
           "frame rate that the paper measured"},
          {"duration", &scene.duration, above_to(0, longest_duration), "s",
           "length of the run, a whole number of frames"},
      }};
}

/// The paper's method has contacts by impulses, whatever `contact` says beside it. A file may have
/// keys for impulses without choosing them, for `--set simulation.contact=impulses`.
Applicability contacts_by_impulses(const sim::Settings& settings) {
  return {"contact = \"impulses\"",
          sim::is_as_printed(settings) || settings.contact == sim::ContactMethod::impulses, false,
          &settings.contact};
}

/// The same of the other forms.
Applicability contacts_as(sim::ContactMethod contact, std::string_view only_for,
                          const sim::Settings& settings) {
  return {only_for, !contacts_by_impulses(settings).applies && settings.contact == contact, false,
          &settings.contact};
}

Applicability contacts_by_potential(const sim::Settings& settings) {
  return contacts_as(sim::ContactMethod::potential, "contact = \"potential\"", settings);
}

std::string with_contact(std::string_view what, const sim::Settings& settings) {
  const char* contact = contacts_by_impulses(settings).applies    ? "impulses"
                        : contacts_by_potential(settings).applies ? "potential"
                                                                  : "swept";
  return fmt::format("{} with contact = \"{}\"", what, contact);
}

Section simulation_section(Scene& scene) {
  sim::Settings& settings = scene.settings;
  const Applicability impulses = contacts_by_impulses(settings);
  const Applicability swept =
      contacts_as(sim::ContactMethod::swept, "contact = \"swept\"", settings);
  const Applicability with_skin{"contact = \"swept\" or \"impulses\"",
                                !contacts_by_potential(settings).applies, false, &settings.contact};
  return {
      .table = "simulation",
      .what = with_contact("a simulation", settings),
      .keys = {
          {"steps_per_second", &settings.steps_per_second, between(1, 1e6), "steps/s",
           "simulation steps; the time step is the inverse; where left out, up to 100,000 "
           "if the small motions of bodies need it, and no run if they need more; up to some 2,000 "
           "if what is moved would go further in one than a tenth of a soft body, or a rigid box "
           "would fall by its own size in less than six"},
          selector({"method", word(settings.method, methods), any(), "",
                    "paper: all as printed, and no key beside it that it sets; corrected: as "
                    "ERRATA says"}),
          of_method(
              {"integrator", word(settings.integrator, integrators), any(), "",
               "how soft bodies are stepped; under implicit_euler and martin their free spin dies "
               "away, under sdirk2 a fast one (some % of 10 rad/s in 3 s at 60 steps/s); rk8 is "
               "for free flight: where bodies may touch, its steps are no longer than rk4's"}),
          {"gravity", &settings.gravity, any(), "m/s^2", "acceleration along x, y, z"},
          of_method({"ambient_pressure", &scene.ambient_pressure, at_least(0), "Pa",
                     "outside of every body with gas; that of air is 101325"}),
          of_method(selector(
              {"contact", word(settings.contact, contact_methods), any(), "",
               "swept: nothing passes through a soft body; potential: nor through itself, by a "
               "term of the equation of motion; impulses: as in the paper, after the motion"})),
          only(with_skin,
               of_method({"skin_thickness", &settings.skin_thickness, length(), "m",
                          "features nearer than twice this are in contact; swept contacts need a "
                          "few hundredths of an edge, and keep no more"})),
          only(impulses,
               of_method({"soft_search", word(settings.soft_search, soft_searches), any(), "",
                          "how contacts of soft bodies are found: the paper's particles, or all "
                          "within reach"})),
          only(impulses,
               of_method({"relaxation_time", &settings.relaxation_time, at_least(0), "s",
                          "in which impulses part soft features by a factor e; 0: at once, as in "
                          "the paper"})),
          only(impulses, of_method({"contact_iterations", &settings.contact_iterations,
                                    between(1, 10'000), "",
                                    "over an island of contacts; at most 3 if none of them is "
                                    "a box's with another or the ground"})),
          only(swept,
               of_method({"sleep_speed", &settings.sleep_speed, at_least(0), "m/s",
                          "bodies that touch leave the step, until something touches them, when no "
                          "box was faster for half a second and no soft one got further in a "
                          "second than this leads in half of it; of a body shorter than 1 m, this "
                          "times its length in m; less in gravity below 5 m/s^2; 0: never"})),
          {"seed", &settings.seed, at_least(0), "",
           "of everything random: particles, jitter, tumble"},
      }};
}

Section potential_section(Scene& scene) {
  sim::PotentialSettings& potential = scene.settings.potential;
  const Applicability applies = contacts_by_potential(scene.settings);
  return {.table = "simulation.potential",
          .what = with_contact("a simulation", scene.settings),
          .keys = {
              only(applies, {"distance", &potential.distance, length(), "m",
                             "from which on surfaces push each other, and at most a twentieth of "
                             "an edge"}),
              only(applies, {"stiffness", &potential.stiffness, above(0), "Pa",
                             "of the push; without it from the bodies' gas, springs and weight"}),
              only(applies, {"regularisation_speed", &potential.regularisation_speed,
                             above_to(0, 1e6), "m/s",
                             "at which friction and restitution act in full; what holds creeps "
                             "more slowly"}),
          }};
}

Section particles_section(Scene& scene) {
  sim::ParticleSettings& particles = scene.settings.particles;
  return {.table = "simulation.particles",
          .what = "collision particles",
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
  const bool on_path = !camera.path.empty();
  const Applicability automatic{"a camera without eye, target and path", !placed && !on_path};
  const Applicability free{"a camera without path", !on_path};
  return {
      .table = "camera",
      .what = on_path  ? "a camera with a path"
              : placed ? "a camera with an eye and a target"
                       : "an automatic camera",
      .keys = {
          selector(only(free, {"eye", &camera.eye, place(), "m", "where the camera stands"})),
          selector(only(free, {"target", &camera.target, place(), "m", "the point it looks at"})),
          selector({"path", &camera.path, place(), "m",
                    "where eye and target are at some times, in place of both"}),
          only(free, {"follow", &camera.follow, any(), "",
                      "a body's name: the camera moves as it does, and shows it alone if it "
                      "is automatic",
                      check_line}),
          only(free, {"orbit", &camera.orbit, between(-3600, 3600), "degrees/s",
                      "how fast the camera goes around the vertical through its target"}),
          only(automatic, {"azimuth", &camera.azimuth, between(-360, 360), "degrees",
                           "of the automatic camera's place, from +x towards +y"}),
          only(automatic, {"elevation", &camera.elevation, between(-89, 89), "degrees",
                           "of the automatic camera's place above the horizon; left out: 22, or up "
                           "to 82 to look over what stands still or is moved"}),
          {"field_of_view", &camera.field_of_view, between(1, 120), "degrees", "vertical"},
      }};
}

Section picture_section(Scene& scene) {
  PictureScene& picture = scene.picture;
  return {.table = "picture",
          .what = "the picture",
          .keys = {
              {"width", &picture.width, between(smallest_picture_side, greatest_picture_side),
               "pixels", "of a frame"},
              {"height", &picture.height, between(smallest_picture_side, greatest_picture_side),
               "pixels", "of a frame"},
              {"frames_per_second", &picture.frames_per_second, between(1, 1e6), "frames/s",
               "of simulated time; divides steps_per_second"},
              {"samples", &picture.samples, one_of({1, 2, 4}), "",
               "per pixel; one smooths the edges of bodies, four also where they pass through each "
               "other"},
              {"shadows", &picture.shadows, any(), "", "draw shadows"},
              {"caption", &picture.caption, any(), "", "draw the caption"},
              {"pressures", &picture.pressures, any(), "",
               "the caption gives the pressure in each body with gas, above ambient_pressure"},
              {"grid", &picture.grid, any(), "",
               "draw the ground with its grid, where there is one: of 1 m, or of another power of "
               "ten where "
               "the largest body is smaller than 0.3 m or larger than 50 m"},
              {"rounded", &picture.rounded, any(), "",
               "draw coarse soft bodies round; false: as the flat triangles that are simulated"},
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
          {"picture_side", &limits.picture_side,
           between(smallest_picture_side, greatest_picture_side), "pixels",
           "width and height at most"},
          {"model_file_mib", &limits.model_file_mib, above_to(0, 2048), "MiB",
           "of a model with its files, at most"},
          {"scene_file_mib", &limits.scene_file_mib, above_to(0, max_scene_file_mib), "MiB",
           "of the scene file; raised by --set only, because it is read before its keys"},
      }};
}

constexpr std::array<SectionMaker, 8> makers = {
    top_section,    simulation_section, potential_section, particles_section,
    ground_section, camera_section,     picture_section,   limits_section,
};

}  // namespace

Section valve_section(ValveScene& valve) {
  return {.table = "valve",
          .what = "a valve",
          .keys = {
              {"from", &valve.from, any(), "", "a soft body with gas; of copies NAME.NUMBER",
               check_line},
              {"to", &valve.to, any(), "", "the other one; gas flows either way", check_line},
              {"area", &valve.orifice.area, above_to(0, max_hole), "m^2", "of the opening"},
              {"discharge", &valve.orifice.discharge, above_to(0, 1), "",
               "coefficient of the opening: 0.61 has sharp edges, 1 loses nothing"},
          }};
}

Section spring_section(SpringScene& spring) {
  const Applicability without_region{"ends without a region", spring.from_region.empty()};
  const Applicability without_other{"ends without a region", spring.to_region.empty()};
  return {
      .table = "spring",
      .what = "a spring",
      .keys = {
          {"from", &spring.from, any(), "",
           "a soft body, or a static or moved shape that is no box; of copies NAME.NUMBER",
           check_line},
          {"to", &spring.to, any(), "", "another one", check_line},
          only(without_region,
               {"from_point", &spring.from_point, place(), "m",
                "in world coordinates: the nearest vertex is the end, else that nearest to the "
                "other end"}),
          only(without_other,
               {"to_point", &spring.to_point, place(), "m", "likewise of the other body"}),
          selector({"from_region", &spring.from_region, place(), "m",
                    "instead of a point: the middle of the vertices that start in these boxes, all "
                    "of which it pulls alike"}),
          selector({"to_region", &spring.to_region, place(), "m", "likewise of the other body"}),
          {"k", &spring.k, at_least(0), "N/m", "spring constant"},
          {"damping", &spring.damping, at_least(0), "N s/m", "of the dashpot along it"},
          {"rest_length", &spring.rest_length, at_least(0), "m",
           "instead of the distance of its ends at the start"},
      }};
}

std::span<const SectionMaker> section_makers() { return makers; }

std::vector<Section> fixed_sections(Scene& scene) {
  std::vector<Section> sections;
  for (const SectionMaker make : makers) sections.push_back(make(scene));
  return sections;
}

namespace {

/// Every section points into the scene or the body beside it.
struct Defaults {
  Defaults() : sections(fixed_sections(scene)) {
    sections.push_back(valve_section(valve));
    sections.push_back(spring_section(spring));
    sections.push_back(body_section(body));
  }
  Scene scene;
  ValveScene valve;
  SpringScene spring;
  BodyScene body = default_body(0);
  std::vector<Section> sections;
};

}  // namespace

const std::vector<Section>& default_sections() {
  static Defaults defaults;
  return defaults.sections;
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

}  // namespace pneuma::scenes
