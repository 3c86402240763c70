#include "scenes/loader/check_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "scenes/loader/check_joints.h"
#include "sim/base/nearest.h"

namespace pneuma::scenes {
namespace {

class Checks {
 public:
  Checks(const Scene& scene, const Reader& reader, const std::vector<Origin>& headers,
         Report& report)
      : scene_(scene), reader_(reader), headers_(headers), report_(report) {}

  void run() {
    check_frames();
    check_picture();
    check_camera();
    check_followed_body();
    check_names();
    for (std::size_t i = 0; i < scene_.bodies.size(); ++i) {
      check_body(scene_.bodies[i], headers_[i]);
    }
    check_forms_of_joints();
    check_joints(scene_, reader_, report_);
    check_counts();
    check_memory();
  }

 private:
  void check_frames() {
    const int& steps = scene_.settings.steps_per_second;
    const int& frames = scene_.picture.frames_per_second;
    if (!reader_.valid({&frames})) return;
    if (reader_.valid({&steps}) && steps % frames != 0) {
      report_.add(reader_.origin({&frames, &steps}, whole_file),
                  fmt::format("frames_per_second = {} does not divide steps_per_second = {}, but a "
                              "frame takes a whole number of steps; set frames_per_second = {} or "
                              "steps_per_second = {}",
                              frames, steps, nearest_divisor(steps, frames),
                              (steps / frames + 1) * frames));
    }
    if (reader_.valid({&scene_.duration})) check_duration();
  }

  static int nearest_divisor(int steps, int frames) {
    for (int distance = 0;; ++distance) {  // ends at 1 at the latest
      if (frames > distance && steps % (frames - distance) == 0) return frames - distance;
      if (steps % (frames + distance) == 0) return frames + distance;
    }
  }

  void check_duration() {
    const int& fps = scene_.picture.frames_per_second;
    const double frames = scene_.duration * fps;
    const Origin at = reader_.origin({&scene_.duration}, whole_file);
    // A duration such as 0.1 s is not exact in binary; a millionth of a frame is meant as none.
    if (std::abs(frames - std::round(frames)) > 1e-6 || std::round(frames) < 1.0) {
      const double below = std::floor(frames) / fps;
      const double above = std::ceil(frames) / fps;
      report_.add(at, fmt::format("duration = {} s is {:.10g} frames of 1/{} s; it must be a whole "
                                  "number of them, such as {} s",
                                  scene_.duration, frames, fps, below > 0.0 ? below : above));
      return;
    }
    if (!reader_.valid({&scene_.limits.frames}) || frame_count(scene_) <= scene_.limits.frames) {
      return;
    }
    report_.add(at, fmt::format("{} frames are more than the limit of {}; make duration or "
                                "frames_per_second smaller, or raise frames in [limits]",
                                frame_count(scene_), scene_.limits.frames));
  }

  void check_picture() {
    const int& limit = scene_.limits.picture_side;
    const PictureScene& picture = scene_.picture;
    if (!reader_.valid({&limit})) return;
    for (const auto& [name, side] :
         {std::pair("width", &picture.width), std::pair("height", &picture.height)}) {
      if (!reader_.valid({side}) || *side <= limit) continue;
      report_.add(reader_.origin({side, &limit}, whole_file),
                  fmt::format("{} = {} pixels are more than the limit of {}; make the picture "
                              "smaller, or raise picture_side in [limits]",
                              name, *side, limit));
    }
  }

  void check_camera() {
    const CameraScene& camera = scene_.camera;
    // A misspelt key beside one of them may be meant as the other.
    if (reader_.has_unknown("camera") || !reader_.valid({&camera.eye, &camera.target})) return;
    const Origin at = reader_.origin({&camera.eye, &camera.target}, whole_file);
    if (camera.eye.has_value() != camera.target.has_value()) {
      report_.add(at, camera.eye ? "eye without target; give both, or neither for an automatic "
                                   "camera"
                                 : "target without eye; give both, or neither for an automatic "
                                   "camera");
    } else if (camera.eye && *camera.eye == *camera.target) {
      report_.add(at, "eye and target are the same point, so the camera looks nowhere");
    }
  }

  void check_followed_body() {
    const std::string& follow = scene_.camera.follow;
    if (follow.empty() || !reader_.valid({&follow})) return;
    std::vector<std::string_view> names;
    for (const BodyScene& body : scene_.bodies) names.push_back(body.name);
    if (std::ranges::find(names, follow) != names.end()) return;
    report_.add(reader_.origin({&follow}, whole_file),
                fmt::format("follow: there is no body {}{}", base::in_quotes(follow),
                            base::suggestion_and_all(follow, names)));
  }

  void check_names() {
    std::map<std::string, std::size_t> first;  // body of each name
    for (std::size_t i = 0; i < scene_.bodies.size(); ++i) {
      const std::string& name = scene_.bodies[i].name;
      const auto [found, is_new] = first.emplace(name, i);
      if (is_new || !reader_.valid({&name})) continue;
      report_.add(
          reader_.origin({&name}, headers_[i]),
          fmt::format("two bodies are called '{}', numbers {} and {}; give one another name", name,
                      found->second + 1, i + 1));
    }
  }

  void check_body(const BodyScene& body, Origin header) {
    const bool soft = !is_box(body);
    if (soft && body.shape == Shape::torus && body.tube_radius >= body.radius &&
        reader_.valid({&body.tube_radius, &body.radius})) {
      report_.add(
          reader_.origin({&body.tube_radius, &body.radius}, header),
          fmt::format("tube_radius = {} m must be less than radius = {} m, or the torus has "
                      "no hole",
                      body.tube_radius, body.radius));
    }
    if (soft && body.shape == Shape::model && body.model.file.empty() &&
        reader_.valid({&body.model.file})) {
      report_.add(reader_.origin({&body.model.file}, header),
                  "a model needs a file; write model.file = \"...\"");
    }
    if (body.colours.size() == 2 && body.colour_axis.norm() == 0.0) {
      report_.add(reader_.origin({&body.colour_axis}, header),
                  "colour_axis has no direction; make one of its numbers other than 0");
    }
    check_kinematic(body, header);
    check_potential(body, header);
    check_integrator(body, header);
    check_gas(body, header);
    check_supply(body, header);
    check_spacing(body, header);
  }

  void check_potential(const BodyScene& body, Origin header) {
    const sim::ContactMethod& contact = scene_.settings.contact;
    if (contact != sim::ContactMethod::potential) return;
    if (body.kind == BodyKind::soft && body.material.damping == sim::Damping::literal) {
      report_.add(reader_.origin({&body.material.damping, &contact}, header),
                  "damping = \"literal\" acts between steps, while contact = \"potential\" is a "
                  "term of one differential equation; use damping = \"dashpot\", or "
                  "simulation.contact = \"swept\"");
    }
  }

  void check_kinematic(const BodyScene& body, Origin header) {
    if (scene_.settings.contact != sim::ContactMethod::impulses) return;
    if (!body.pinned.empty()) {
      report_.add(reader_.origin({&body.pinned, &scene_.settings.contact}, header),
                  fmt::format("pinned vertices need {}, or leave pinned out", other_contacts()));
    }
    if (body.kind == BodyKind::soft || body.kind == BodyKind::rigid) return;
    report_.add(reader_.origin({&body.kind, &scene_.settings.contact}, header),
                fmt::format("kind = \"{}\" needs {}, or make the body rigid", kind_name(body.kind),
                            other_contacts()));
  }

  /// Than impulses: those that the scene can have.
  const char* other_contacts() const {
    return scene_.springs.empty()
               ? "swept contacts or the contact potential; set simulation.contact = \"swept\" or "
                 "\"potential\" and no method = \"paper\""
               : "swept contacts; set simulation.contact = \"swept\" and no method = \"paper\"";
  }

  void check_integrator(const BodyScene& body, Origin header) {
    if (body.kind != BodyKind::soft) return;
    const sim::Integrator& integrator = scene_.settings.integrator;
    if (sim::can_integrate(integrator, body.material)) return;
    report_.add(
        reader_.origin({&body.material.pressure_weighting, &integrator}, header),
        "an implicit integrator minimises an energy, but valence pressure is not the "
        "force of one; use pressure_weighting = \"uniform\", or an explicit integrator such as "
        "\"rk4\"");
  }

  void check_gas(const BodyScene& body, Origin header) {
    if (body.kind != BodyKind::soft) return;
    const Origin at = reader_.origin({&body.inflation, &body.gauge_pressure}, header);
    if (body.gauge_pressure && body.inflation) {
      report_.add(at,
                  fmt::format("both inflation and gauge_pressure ({}) are given; drop one of the "
                              "two: each says how much gas the body has",
                              reader_.where(&body.gauge_pressure)));
    }
    if (body.gauge_pressure && *body.gauge_pressure + scene_.ambient_pressure < 0.0 &&
        reader_.valid({&body.gauge_pressure, &scene_.ambient_pressure})) {
      report_.add(at, fmt::format("gauge_pressure = {} Pa is below a vacuum: with "
                                  "simulation.ambient_pressure = {} Pa it must be at least {} Pa",
                                  *body.gauge_pressure, scene_.ambient_pressure,
                                  0.0 - scene_.ambient_pressure));
    }
    if (body.inflation && body.rest == Rest::equilibrium) {
      report_.add(at,
                  "inflation beside rest = \"equilibrium\", which holds the shape at its own "
                  "volume whatever its gas; give n or gauge_pressure, or rest = \"shape\"");
    }
    if ((body.gauge_pressure || body.inflation) && body.material.temperature == 0.0) {
      report_.add(reader_.origin({&body.material.temperature}, header),
                  "temperature = 0 K: such gas has no pressure, however much of it; give a "
                  "temperature above 0 K, such as 293.15");
    }
  }

  void check_supply(const BodyScene& body, Origin header) {
    if (body.kind != BodyKind::soft || !has_supply(body)) return;
    const Origin at =
        reader_.origin({&body.supply_n, &body.supply_temperature, &body.leak.area}, header);
    if (sim::is_as_printed(scene_.settings)) refuse_beside_paper(at, "supply and leak");
    if (!body.supply_n.empty() && (body.gauge_pressure || body.inflation)) {
      const void* start = body.inflation ? static_cast<const void*>(&body.inflation)
                                         : static_cast<const void*>(&body.gauge_pressure);
      report_.add(
          at, fmt::format("both supply.n and {} ({}) are given; drop one of the two: each "
                          "says how much gas the body has at the start",
                          body.inflation ? "inflation" : "gauge_pressure", reader_.where(start)));
    }
    if (!body.supply_temperature.empty() && body.material.gas_exponent != 1.0 &&
        reader_.valid({&body.supply_temperature, &body.material.gas_exponent})) {
      report_.add(reader_.origin({&body.supply_temperature}, header),
                  fmt::format("supply.temperature says what the gas exchanges heat for, and "
                              "gas_exponent = {} that it does so otherwise; leave out one of the "
                              "two, or set gas_exponent = 1",
                              body.material.gas_exponent));
    }
    const bool runs_out =
        std::ranges::any_of(body.supply_n, [](const TimedValue& key) { return key[1] == 0.0; });
    if (runs_out && scene_.ambient_pressure > 0.0) {
      report_.add(reader_.origin({&body.supply_n}, header),
                  "supply.n of 0 mol beside ambient_pressure: a body without gas is an open "
                  "membrane, on which nothing outside presses; give it a little gas");
    }
  }

  void refuse_beside_paper(Origin at, std::string_view what) {
    report_.add(
        at, fmt::format("simulation.method = \"paper\" has no {}; leave out one of the two", what));
  }

  void check_forms_of_joints() {
    if (!scene_.springs.empty() && scene_.settings.contact == sim::ContactMethod::potential) {
      report_.add(reader_.origin({&scene_.settings.contact}, whole_file),
                  "springs between bodies are not part of the equation that contact = "
                  "\"potential\" solves; leave them out, or set simulation.contact = \"swept\"");
    }
    const Origin at = reader_.origin({&scene_.settings.method}, whole_file);
    if (!sim::is_as_printed(scene_.settings)) return;
    if (!scene_.valves.empty()) refuse_beside_paper(at, "valves");
    if (!scene_.springs.empty()) refuse_beside_paper(at, "springs between bodies");
  }

  void check_spacing(const BodyScene& body, Origin header) {
    if (!reader_.valid({&body.spacing, &body.copies})) return;
    for (int axis = 0; axis < 3; ++axis) {
      const int copies = body.copies[static_cast<std::size_t>(axis)];
      if (copies == 1 || body.spacing[axis] != 0.0) continue;
      report_.add(
          reader_.origin({&body.spacing, &body.copies}, header),
          fmt::format("{} copies along {} with no spacing are all in one place; set spacing",
                      copies, "xyz"[axis]));
    }
  }

  void check_counts() {
    const Limits& limits = scene_.limits;
    if (!reader_.valid({&limits.bodies, &limits.vertices_per_body, &limits.vertices})) return;
    std::int64_t bodies = 0;
    std::int64_t vertices = 0;
    for (std::size_t i = 0; i < scene_.bodies.size(); ++i) {
      const BodyScene& body = scene_.bodies[i];
      const std::int64_t in_body = vertex_count(body);
      const Origin detail = reader_.origin(
          {&body.stacks, &body.slices, &body.subdivisions, &body.divisions}, headers_[i]);
      if (!check_limit(in_body, limits.vertices_per_body, "vertices in one body",
                       "vertices_per_body", detail)) {
        return;
      }
      const Origin copies = reader_.origin({&body.copies}, headers_[i]);
      bodies += copy_count(body);
      if (!check_limit(bodies, limits.bodies, "bodies", "bodies", copies)) return;
      // Both factors are within limits of at most 1e8 and 1e7 here: no overflow.
      vertices += in_body * copy_count(body);
      if (!check_limit(vertices, limits.vertices, "vertices", "vertices", copies)) return;
    }
  }

  bool check_limit(std::int64_t count, int limit, std::string_view what, std::string_view key,
                   Origin at) {
    if (count <= limit) return true;
    report_.add(at,
                fmt::format("{} {} are more than the limit of {}; ask for fewer, or raise {} in "
                            "[limits]",
                            count, what, limit, key));
    return false;
  }

  void check_memory() {
    const double needed = estimated_memory_gib(scene_);
    const double& limit = scene_.limits.memory_gib;
    if (!report_.empty() || needed <= limit) return;
    const Origin at = reader_.origin(
        {&limit, &scene_.picture.width, &scene_.picture.height, &scene_.picture.samples},
        whole_file);
    report_.add(at, fmt::format("about {} of memory are needed, more than the limit of {} "
                                "GiB; make the picture or the bodies smaller, or raise memory_gib "
                                "in [limits]",
                                memory_text(needed), limit));
  }

  const Scene& scene_;
  const Reader& reader_;
  const std::vector<Origin>& headers_;
  Report& report_;
};

}  // namespace

void check_scene(const Scene& scene, const Reader& reader, const std::vector<Origin>& headers,
                 Report& report) {
  Checks(scene, reader, headers, report).run();
}

}  // namespace pneuma::scenes
