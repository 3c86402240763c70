#include "app/render/log/run_record.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/host/command_line.h"
#include "app/host/version.h"
#include "app/record/contact_tally.h"
#include "app/record/gas_json.h"
#include "app/record/provenance.h"
#include "app/record/two_bodies.h"
#include "app/record/world_json.h"
#include "app/world/build_world.h"
#include "app/world/touch.h"
#include "scenes/loader/print_scene.h"
#include "sim/base/file.h"
#include "sim/inspect/closed_surface.h"
#include "sim/inspect/crossings.h"
#include "sim/inspect/inspect.h"

namespace pneuma::app {
namespace {

Json volumes_json(const sim::World& world) {
  Json volumes = Json::object();
  for (const sim::SoftBody& body : world.soft) {
    if (sim::is_kinematic(body)) continue;  // an obstacle keeps it
    volumes[body.name] = number_json<Json>(sim::volume(body.mesh->topology, body.positions));
  }
  return volumes;
}

Json contacts_json(std::span<const sim::Contact> contacts, const sim::World& world) {
  ContactCounts counts = count_by_kind(contacts);
  const std::int64_t with_obstacles = count_with_obstacles(contacts, world);
  counts[static_cast<std::size_t>(sim::ContactKind::soft_soft)] -= with_obstacles;
  Json json = {{"count", contacts.size()}};
  json.update(json_by_contact_kind<Json>(
      [&](sim::ContactKind kind) { return counts[static_cast<std::size_t>(kind)]; }));
  json["soft_obstacle"] = with_obstacles;
  return json;
}

Json crossings_json(const sim::Crossings& crossings) {
  return {{"between_bodies", crossings.between_bodies}, {"within_bodies", crossings.within_bodies}};
}

Json camera_json(const render::Camera& camera) {
  return {{"eye", vector_json<Json>(camera.eye)},
          {"target", vector_json<Json>(camera.target)},
          {"field_of_view", camera.field_of_view}};
}

Json program_with_libraries() {
  Json program = program_json<Json>();
  program["libraries"] = Json::object();
  for (const auto& [name, number] : library_versions()) program["libraries"][name] = number;
  return program;
}

}  // namespace

Json identity_json(const RunIdentity& run) {
  const Pictures& pictures = run.pictures;
  const Version built = version();
  const Json shown = shown_names(pictures.show);
  const Json overlay = pictures.overlay ? Json(shown_names(*pictures.overlay)) : Json();
  Json identity = {{"scene", run.scene.name},
                   {"fingerprint", hex(scenes::scene_fingerprint(run.scene))},
                   {"first_frame", run.frames.first},
                   {"last_frame", run.frames.last},
                   {"show", shown},
                   {"overlay", overlay},
                   {"build", fmt::format("pneuma {} {} {} {} {}", built.program, built.commit,
                                         built.compiler, built.build_type, built.flags)},
                   {"gl", run.gl}};
  if (run.on_divergence != OnDivergence::automatic) {
    identity["on_divergence"] = run.on_divergence == OnDivergence::stop ? "stop" : "substep";
  }
  for (const std::uint64_t model : model_fingerprints(run.scene, run.start)) {
    identity["models"].push_back(hex(model));
  }
  return identity;
}

Json run_header(const Json& identity, const scenes::Scene& scene) {
  return {{"run", identity},
          {"title", scene.title},
          {"figure", scene.figure},
          {"seed", scene.settings.seed},
          {"steps_per_second", scene.settings.steps_per_second},
          {"frames_per_second", scene.picture.frames_per_second},
          {"units", json_units},
          {"scene_toml", scenes::print_scene(scene)},
          {"program", program_with_libraries()}};
}

std::optional<render::ViewFit::Seen> seen_in(const Json& line) {
  if (!line.contains("seen")) return std::nullopt;
  try {
    return line["seen"].get<render::ViewFit::Seen>();
  } catch (const Json::exception& error) {
    throw base::IoError(
        fmt::format("what the camera has seen cannot be read in the journal ({}); start again with "
                    "--overwrite",
                    error.what()));
  }
}

FieldScale::Seen fields_in(const Json& line) {
  FieldScale::Seen seen;
  const Json greatest = line.value("greatest_so_far", Json::object());
  for (const auto& [field, value] : greatest.items()) {
    if (value.is_number()) seen[field] = value.get<double>();
  }
  return seen;
}

Json divergence_line(const std::string& message) { return {{"diverged", message}}; }

Json change_line(const Json& identity, const scenes::Scene& scene, std::int64_t from,
                 const std::string& reason) {
  return {{"change",
           {{"run", identity},
            {"steps_per_second", scene.settings.steps_per_second},
            {"scene_toml", scenes::print_scene(scene)}}},
          {"first_frame", from},
          {"reason", reason}};
}

Json present_header(const JournalContents& journal) {
  Json header = journal.header;
  for (const Json& line : journal.lines) {
    if (line.contains("change")) header.update(line["change"]);
  }
  return header;
}

Json launch_line(const std::vector<std::string>& command_line, const std::string& video,
                 int threads, std::int64_t from) {
  Json launch = {{"date", utc_date()},
                 {"command_line", shell_line(command_line)},
                 {"first_frame", from},
                 {"threads", threads},
                 {"machine", machine_json<Json>()}};
  if (!video.empty()) launch["video"] = video;
  return {{"launch", launch}};
}

FrameState frame_state(const Simulation& simulation, const FrameCamera& camera) {
  const sim::World& world = simulation.world();
  Json times = Json::object();
  for (std::size_t i = 0; i < simulation.stage_times().size(); ++i) {
    const auto stage = static_cast<sim::Stage>(i);
    if (!simulation.stepper().plan().runs(stage)) continue;
    times[std::string(to_string(stage))] = simulation.stage_times()[i];
  }

  const sim::Crossings crossings = sim::crossings(world);
  Json line = {{"frame", simulation.frame()},
               {"time", sim::time(world)},
               {"step", world.steps},
               {"state_hash", hex(sim::state_hash(world))},
               {"energy", energy_json<Json>(sim::energy(world))},
               {"momentum", momentum_json<Json>(sim::momentum(world))},
               {"volumes", volumes_json(world)},
               {"gas", gas_of_bodies_json<Json>(world)},
               {"contacts", contacts_json(simulation.contacts(), world)},
               {"greatest_penetration", number_json<Json>(sim::max_penetration(world))},
               {"crossings", crossings_json(crossings)},
               {"camera", camera_json(camera.camera)}};
  if (camera.seen) line["seen"] = *camera.seen;
  if (!camera.fields.empty()) line["greatest_so_far"] = camera.fields;
  if (!simulation.step_parts().empty()) line["step_parts"] = simulation.step_parts();
  const std::vector<sim::CrossingPair> deep = crossings_beyond_touch(world, crossings);
  const auto of_itself = [](const sim::CrossingPair& pair) { return pair.first == pair.second; };
  const auto own = std::ranges::find_if(crossings.pairs, of_itself);
  return {std::move(line), std::move(times),
          deep.empty() ? std::string() : two_bodies(world, deep[0].first, deep[0].second),
          own == crossings.pairs.end() ? std::string() : sim::body_name(world, own->first)};
}

Json frame_line(FrameState state, const PictureBytes& bytes, const FrameSeconds& seconds) {
  Json times = std::move(state.stage_seconds);
  times["mesh"] = seconds.mesh;
  times["draw"] = seconds.draw;
  times["png"] = seconds.png;
  times["write"] = seconds.write;
  times["total"] = seconds.total;
  Json line = std::move(state.line);
  line["png_bytes"] = bytes.frame;
  line["seconds"] = std::move(times);
  if (bytes.overlay) line["overlay_png_bytes"] = *bytes.overlay;
  if (seconds.look_ahead) line["look_ahead_seconds"] = *seconds.look_ahead;
  return line;
}

Json whole_record(const JournalContents& journal) {
  Json record = present_header(journal);
  Json launches = Json::array();
  Json changes = Json::array();
  Json frames = Json::array();
  double wall_seconds = 0.0, look_ahead_seconds = 0.0;
  for (const Json& line : journal.lines) {
    if (line.contains("launch")) launches.push_back(line["launch"]);
    if (line.contains("change")) changes.push_back(line);
    if (!line.contains("frame")) continue;
    frames.push_back(line);
    wall_seconds += line["seconds"]["total"].get<double>();
    look_ahead_seconds += line.value("look_ahead_seconds", 0.0);
  }
  record["launches"] = launches;
  if (!changes.empty()) record["changes"] = changes;
  record["wall_seconds"] = wall_seconds;
  record["look_ahead_seconds"] = look_ahead_seconds;
  record["frames"] = frames;
  return record;
}

}  // namespace pneuma::app
