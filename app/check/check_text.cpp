#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <sstream>
#include <string_view>

#include "app/check/check_report.h"
#include "app/record/world_json.h"
#include "app/terminal/table.h"
#include "app/world/gas_warnings.h"
#include "scenes/loader/print_scene.h"

namespace pneuma::app {
namespace {

std::string planned(const sim::Plan::Item& item) {
  return item.runs ? "runs" : "left out: " + item.reason;
}

std::string plan_text(const sim::Plan& plan) {
  std::string text = "Stages of a step, in their order\n";
  for (int s = 0; s < sim::stage_count; ++s) {
    const auto stage = static_cast<sim::Stage>(s);
    text += named_line(sim::to_string(stage), planned(plan.stages[static_cast<std::size_t>(s)]));
  }
  text += "\nKinds of contact that find_contacts looks for\n";
  for (int k = 0; k < sim::contact_kind_count; ++k) {
    const auto kind = static_cast<sim::ContactKind>(k);
    text +=
        named_line(sim::to_string(kind), planned(plan.contact_kinds[static_cast<std::size_t>(k)]));
  }
  return text;
}

std::string bytes(double count) {
  if (count < 1e4) return fmt::format("{:.0f} bytes", count);
  if (count < 1e7) return fmt::format("{:.0f} KiB", count / 1024.0);
  return fmt::format("{:.0f} MiB", count / (1024.0 * 1024.0));
}

/// The scene's own estimate leaves models out.
double memory_gib(const WorldSize& size, const scenes::Scene& scene) {
  std::int64_t of_models = size.vertices;
  for (const scenes::BodyScene& body : scene.bodies) {
    if (scenes::is_box(body)) continue;
    of_models -= scenes::vertex_count(body) * scenes::copy_count(body);
  }
  return scenes::estimated_memory_gib(scene) + scenes::estimated_memory_gib(of_models, 1);
}

std::string size_text(const WorldSize& size, const scenes::Scene& scene) {
  const double all_bytes = memory_gib(size, scene) * 1024.0 * 1024.0 * 1024.0;
  const std::string shared =
      size.soft_bodies > size.meshes
          ? fmt::format(", sharing {} mesh{}", size.meshes, size.meshes == 1 ? "" : "es")
          : "";
  std::string text = "Size\n";
  text += named_line("soft bodies", grouped(size.soft_bodies) + shared);
  text += named_line("rigid boxes", grouped(size.rigid_boxes));
  if (size.obstacles > 0) text += named_line("other obstacles", grouped(size.obstacles));
  text += named_line("vertices", grouped(size.vertices));
  text += named_line("springs", grouped(size.springs));
  text += named_line("triangles", grouped(size.triangles));
  text += named_line("state",
                     fmt::format("{}; with meshes and pictures about {}",
                                 bytes(static_cast<double>(size.state_bytes)), bytes(all_bytes)));
  text += named_line(
      "run",
      fmt::format("{:g} s: {}, {} with the first at 0 s", scene.duration,
                  counted(scenes::frame_count(scene) * scenes::steps_per_frame(scene), "step"),
                  counted(scenes::frame_count(scene) + 1, "frame")));
  return text;
}

std::string steps_text(const std::vector<StepAdvice>& steps) {
  if (steps.empty()) return "";
  std::string text = "\nSteps of soft bodies\n";
  text += named_line("step", fmt::format("{:.4g} s", steps.front().step));
  for (const StepAdvice& advice : steps) {
    text += named_line(advice.body,
                       std::isinf(advice.limit)
                           ? "no step is too long"
                           : fmt::format("small motions stay stable up to {:.3g} s{}", advice.limit,
                                         advice.too_long() ? ": THE STEP IS TOO LONG" : ""));
  }
  return text;
}

std::string gas_text(const std::vector<GasAdvice>& gas) {
  if (gas.empty()) return "";
  std::string text = "\nVolumes of soft bodies\n";
  for (const GasAdvice& advice : gas) {
    text += named_line(advice.body, volumes_text(advice) + (advice.blown_up() ? ": BLOWN UP" : ""));
  }
  return text;
}

std::string crossings_text(const std::string& name, const CrossingStatistics& crossings,
                           int frames) {
  if (crossings.frames == 0) return named_line(name, "none");
  const std::string more =
      crossings.more > 0 ? fmt::format("; {} more with them", crossings.more) : "";
  return named_line(name, fmt::format("in {} of {} frames, at most {:.0f} edges at {:.2f} s ({}{})",
                                      crossings.frames, frames, crossings.edges.value,
                                      crossings.edges.time, crossings.first_bodies, more));
}

/// Less than what is written here is a rounding of the positions.
constexpr double shown_depth = 0.5e-4;

std::string penetration_text(const RunStatistics& run, const sim::Settings& settings) {
  if (run.penetration.value < shown_depth) return named_line("penetration", "none");
  std::string last_half =
      fmt::format("in the last half of the run {:.4f} m", run.settled_penetration);
  // Swept contacts keep surfaces apart whatever the skin.
  if (settings.contact == sim::ContactMethod::impulses) {
    last_half +=
        fmt::format(", {} the skin thickness of {:g} m",
                    run.settled_penetration < settings.skin_thickness ? "below" : "NOT below",
                    settings.skin_thickness);
  }
  if (settings.contact == sim::ContactMethod::potential) {
    last_half += fmt::format("; the ground is up to {:g} m (simulation.potential.distance) lower",
                             settings.potential.distance);
  }
  return named_line("penetration",
                    fmt::format("greatest {:.4f} m at {:.2f} s, of {}", run.penetration.value,
                                run.penetration.time, run.penetration_bodies)) +
         named_line("", last_half);
}

std::string self_crossings_text(const RunStatistics& run) {
  std::string text = crossings_text("self-crossings", run.self_crossings, run.frames);
  if (run.self_crossings.frames > 0) {
    text += named_line("", "a surface folds through itself; the check does not fail for it");
    if (run.may_use_potential) {
      text += named_line("",
                         "with simulation.contact = \"potential\" it cannot, soonest done with "
                         "integrator = \"implicit_euler\"");
    }
  }
  return text;
}

std::string energy_text(const RunStatistics& run) {
  const double start = run.energy_start.total(), end = run.energy_end.total();
  if (!std::isfinite(start) || !std::isfinite(end))
    return named_line("energy", "not a finite number");
  std::string text =
      named_line("energy", fmt::format("{:.6g} J at the start, {:.6g} J at the end, change "
                                       "{:+.4g} J",
                                       start, end, end - start));
  const double part = run.energy_span > 0.0 ? run.energy_rise.value / run.energy_span : 0.0;
  const std::string rise =
      run.energy_rise.value > 0.0
          ? fmt::format("{:.4g} J at {:.2f} s, {:.2g} % of the {:.4g} J it varies by",
                        run.energy_rise.value, run.energy_rise.time, 100.0 * part, run.energy_span)
          : "none";
  const std::string less = run.driven_work || run.gas_work ? ", less the work below" : "";
  text += named_line("", "greatest rise from one frame to the next" + less + ": " + rise);
  if (run.driven_work) {
    text += named_line("", fmt::format("work of moved bodies: {:+.4g} J", *run.driven_work));
  }
  if (run.pins_move) text += named_line("", "pins that move do work, which is not counted");
  if (run.springs_are_moved) {
    text += named_line("", "springs to moved bodies do work, which is not counted");
  }
  if (run.gas_work) {
    text += named_line(
        "", fmt::format("of gas that came, went or was heated: {:+.4g} J", *run.gas_work));
  }
  const std::string of_gas =
      "gas without ambient pressure counts as 0 J at 1 m^3 and less in any greater volume, ";
  return text + named_line("", (run.has_gas_in_vacuum ? of_gas : "") +
                                   "weight counts as 0 J at the origin: only differences mean "
                                   "anything");
}

std::string contacts_text(const ContactTally& contacts) {
  std::string text = named_line(
      "contacts", fmt::format("{} per step on average, {} at most",
                              readable(contacts.mean(contacts.all)), grouped(contacts.all.most)));
  const auto kind_text = [&](std::string_view kind, const ContactTally::Count& count) {
    return named_line("", fmt::format("{} {} on average, {} at most", kind,
                                      readable(contacts.mean(count)), grouped(count.most)));
  };
  for (int k = 0; k < sim::contact_kind_count; ++k) {
    const auto kind = static_cast<sim::ContactKind>(k);
    const ContactTally::Count& count = contacts.of(kind);
    if (count.most == 0) continue;
    text += kind_text(sim::to_string(kind), count);
  }
  if (contacts.with_obstacles.most > 0) {
    text += kind_text("soft bodies with static or moved ones", contacts.with_obstacles);
  }
  return text;
}

/// Of those whose gas comes or goes also how much there is.
std::string gas_ranges_text(const RunStatistics& run) {
  std::string pressures, amounts;
  const auto add = [](std::string& text, const char* name, const std::string& body,
                      const ValueRange& range, const char* unit) {
    text += named_line(
        text.empty() ? name : "",
        fmt::format("{}: {} to {} {}, {} at the start, {} at the end", body, readable(range.least),
                    readable(range.greatest), unit, readable(range.start), readable(range.end)));
  };
  for (const GasRange& gas : run.gas) {
    add(pressures, "pressure", gas.body, gas.pressure, "Pa above that outside");
    if (gas.n.least < gas.n.greatest) add(amounts, "gas", gas.body, gas.n, "mol");
  }
  return pressures + amounts;
}

std::string shapes_text(const RunStatistics& run) {
  std::string text;
  for (const VolumeRange& range : run.volumes) {
    if (range.is_obstacle) continue;
    text += named_line(text.empty() ? "shape at the end" : "",
                       fmt::format("{}: at most {:.2g} % of its diagonal off its rigid rest shape",
                                   range.body, 100.0 * range.shape_deviation));
  }
  return text;
}

std::string momentum_text(const RunStatistics& run) {
  if (!run.pushed_by.empty()) {
    return named_line("momentum", fmt::format("is changed by {}", fmt::join(run.pushed_by, ", ")));
  }
  const auto drift = [](const sim::Vec3& start, const sim::Vec3& end, const char* unit) {
    return fmt::format("{:.6g} {} at the start, changed by {:.2g}", start.norm(), unit,
                       (end - start).norm());
  };
  return named_line("momentum", "linear " + drift(run.momentum_start.linear,
                                                  run.momentum_end.linear, "kg m/s")) +
         named_line("", "angular " + drift(run.momentum_start.angular, run.momentum_end.angular,
                                           "kg m^2/s"));
}

std::string rest_text(const RunStatistics& run) {
  const FastestPoint& liveliest = run.liveliest_at_end;
  if (run.rests_from) {
    return fmt::format("at rest (that is below {:g} m/s for {:g} s) from {:.2f} s on",
                       liveliest.limit, rest_time, *run.rests_from);
  }
  if (liveliest.over_limit() < 1.0) {
    return fmt::format("not at rest yet: below {:g} m/s for less than {:g} s", liveliest.limit,
                       rest_time);
  }
  const std::string whose =
      liveliest.body == run.at_end.body
          ? ""
          : fmt::format(", as {} with {:.3g} m/s is", liveliest.body, liveliest.speed);
  return fmt::format("not at rest{} (that is below {:g} m/s)", whose, liveliest.limit);
}

std::string end_speed_text(const RunStatistics& run) {
  return fmt::format("{:.3g} m/s at most{}: {}", run.at_end.speed,
                     run.at_end.body.empty() ? "" : ", of " + run.at_end.body, rest_text(run));
}

/// Lines that TOML skips.
std::string as_comments(const std::string& text) {
  std::istringstream lines(text);
  std::string comments;
  for (std::string line; std::getline(lines, line);) {
    comments += line.empty() ? "#\n" : "# " + line + '\n';
  }
  return comments;
}

}  // namespace

std::string start_overlap_text(const StartOverlapStatistics& start) {
  const std::string who = start.pairs == 1 ? start.bodies
                                           : fmt::format("{} pairs of bodies, {} the first",
                                                         grouped(start.pairs), start.bodies);
  if (start.left == 0) {
    return fmt::format("{}: overlap from the start, parted by t = {:.2f} s", who, start.parted);
  }
  return fmt::format("{}: overlap from the start, {} still at the end of the run; move them apart",
                     who, start.pairs == 1 ? "and" : grouped(start.left));
}

std::string run_statistics_text(const RunStatistics& run, const sim::Settings& settings) {
  std::string text = fmt::format("Run of {} steps, {:g} s\n", grouped(run.steps), run.seconds);
  if (run.divergence) text += named_line("DIVERGED", *run.divergence);
  if (run.divided_steps > 0) {
    text += named_line("divided steps",
                       fmt::format("{}, which diverged and were done again in up to {} parts",
                                   grouped(run.divided_steps), run.most_parts));
  }
  text += penetration_text(run, settings);
  text += crossings_text("crossings", run.crossings, run.frames);
  if (run.touching_frames > 0) {
    text +=
        named_line("", fmt::format("touches in {} frames: no deeper than weight moves bodies into "
                                   "each other in a step",
                                   run.touching_frames));
  }
  if (run.sunk.frames > 0) {
    text += named_line(
        "in the ground",
        fmt::format("bodies in {} of {} frames, at most {:.4f} m at {:.2f} s ({})", run.sunk.frames,
                    run.frames, run.sunk.depth.value, run.sunk.depth.time, run.sunk.body));
  }
  if (run.start_overlap.pairs > 0) {
    text += named_line("at the start", start_overlap_text(run.start_overlap));
  }
  text += self_crossings_text(run);
  if (run.end_overlap >= shown_depth) {
    text += named_line("overlap at the end",
                       fmt::format("{:.4f} m, {}", run.end_overlap, run.end_overlap_bodies));
  }
  text += energy_text(run) + contacts_text(run.contacts) + volume_ranges_text(run.volumes) +
          gas_ranges_text(run) + shapes_text(run) + momentum_text(run);
  if (!run.divergence) text += named_line("speed at the end", end_speed_text(run));
  return text + named_line("state hash", hex(run.state_hash));
}

std::string check_text(const CheckReport& report) {
  const std::string before = plan_text(report.plan) + '\n' + size_text(report.size, report.scene) +
                             steps_text(report.steps) + gas_text(report.gas);
  const std::string text = as_comments(before) + '\n' + scenes::print_scene(report.scene);
  if (!report.run) return text;
  // Last, where it is seen: the scene is long.
  return text + '\n' + as_comments(run_statistics_text(*report.run, report.scene.settings));
}

}  // namespace pneuma::app
