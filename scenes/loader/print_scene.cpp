#include "scenes/loader/print_scene.h"

#include <fmt/format.h>

#include <algorithm>

#include "scenes/loader/sections.h"
#include "sim/base/hash.h"
#include "sim/base/nearest.h"

namespace pneuma::scenes {
namespace {

std::string comment(const Key& key, const std::string& value, const std::string& default_value) {
  const bool changed = value != default_value;
  std::string text = fmt::format("# {} ", changed ? '*' : ' ');
  const std::string units = units_text(key);
  if (!units.empty()) text += fmt::format("{}: ", units);
  text += key.meaning;
  if (!changed) return text;
  return text + (default_value.empty() ? " (not set by default)"
                                       : fmt::format(" (default {})", default_value));
}

/// The keys that apply, as TOML lines. `defaults` is the same section of a struct as it is made.
/// What the paper's method sets is refused beside it: it becomes a comment.
std::string section_text(const Section& section, const Section& defaults, bool comments,
                         bool as_printed) {
  std::string text;
  for (std::size_t i = 0; i < section.keys.size(); ++i) {
    const Key& key = section.keys[i];
    const std::string value = value_text(key.slot);
    if (!key.applies || value.empty()) continue;
    const bool set_by_method = as_printed && key.of_method;
    if (set_by_method && !comments) continue;
    const std::string line =
        fmt::format("{}{} = {}", set_by_method ? "# by method: " : "", key.name, value);
    if (comments) {
      text +=
          fmt::format("{:<36}  {}\n", line, comment(key, value, value_text(defaults.keys[i].slot)));
    } else {
      text += line + '\n';
    }
  }
  return text;
}

/// Of another form of contact.
bool applies_nowhere(const Section& section) {
  return std::ranges::none_of(section.keys, &Key::applies);
}

/// Only impulses have collision particles; what a scene says about them all the same is kept.
bool is_idle(const Scene& scene, const Section& section, const Section& defaults) {
  if (section.table != "simulation.particles") return false;
  if (sim::is_as_printed(scene.settings)) return false;
  if (scene.settings.contact == sim::ContactMethod::impulses) return false;
  for (std::size_t i = 0; i < section.keys.size(); ++i) {
    if (value_text(section.keys[i].slot) != value_text(defaults.keys[i].slot)) return false;
  }
  return true;
}

/// Sections point at members that can be set, so this works on a copy.
std::string scene_text(Scene scene, bool comments) {
  Scene default_scene;
  const std::vector<Section> sections = fixed_sections(scene);
  const std::vector<Section> defaults = fixed_sections(default_scene);
  const bool as_printed = sim::is_as_printed(scene.settings);
  std::string text;
  for (std::size_t i = 0; i < sections.size(); ++i) {
    if (applies_nowhere(sections[i])) continue;
    if (comments && is_idle(scene, sections[i], defaults[i])) continue;
    if (!sections[i].table.empty()) text += fmt::format("\n[{}]\n", sections[i].table);
    text += section_text(sections[i], defaults[i], comments, as_printed);
  }
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    BodyScene unsaid = default_body(i);
    if (is_box(scene.bodies[i])) unsaid.shape = Shape::box;
    text += "\n[[body]]\n";
    text += section_text(body_section(scene.bodies[i]), body_section(unsaid), comments, as_printed);
  }
  ValveScene any_valve;
  for (ValveScene& valve : scene.valves) {
    text += "\n[[valve]]\n";
    text += section_text(valve_section(valve), valve_section(any_valve), comments, as_printed);
  }
  SpringScene any_spring;
  for (SpringScene& spring : scene.springs) {
    text += "\n[[spring]]\n";
    text += section_text(spring_section(spring), spring_section(any_spring), comments, as_printed);
  }
  return text;
}

std::string key_reference(const Key& key) {
  const std::string range = key.range.text(key.name);
  const std::string value = value_text(key.slot);
  std::string text = fmt::format("  {:<22}{}", key.name, key.meaning);
  if (!key.only_for.empty()) text += fmt::format(" ({} only)", key.only_for);
  if (key.of_method) text += " (set by method = \"paper\")";
  text += fmt::format("\n  {:<22}  {}", "", type_text(key.slot));
  if (!range.empty()) text += fmt::format(", {}", range);
  if (!key.unit.empty()) text += fmt::format(" {}", key.unit);
  return text + (value.empty() ? "; not set by default\n" : fmt::format("; default {}\n", value));
}

}  // namespace

std::string print_scene(const Scene& scene) {
  return fmt::format("# The effective scene {}. * marks values that are not the default.\n{}",
                     base::in_quotes(scene.name), scene_text(scene, true));
}

std::uint64_t scene_fingerprint(const Scene& scene) {
  base::Hash hash;
  hash.add(scene_text(scene, false));
  return hash.value();
}

std::string shape_text(const BodyScene& body) {
  BodyScene copy = body;  // sections point at members that can be set
  std::string text;
  for (const Key& key : body_section(copy).keys) {
    if (key.of_shape && key.applies)
      text += fmt::format("{} = {}\n", key.name, value_text(key.slot));
  }
  return text;
}

std::string scene_reference() {
  std::string text;
  for (const Section& section : default_sections()) {
    if (!text.empty()) text += '\n';
    text += place_of(section.table);
    text += '\n';
    for (const Key& key : section.keys) text += key_reference(key);
  }
  return text;
}

}  // namespace pneuma::scenes
