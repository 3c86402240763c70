#include "app/sweep/measures.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <utility>

#include "app/check/check_report.h"

namespace pneuma::app {
namespace {

struct ShortName {
  std::string_view name;
  std::string_view path;
};

constexpr std::array short_names = {
    ShortName{"seconds", "/seconds"},  // of the scene's time
    ShortName{"steps", "/steps"},
    ShortName{"energy", "/energy_J/end/total"},
    ShortName{"kinetic", "/energy_J/end/kinetic"},
    ShortName{"spring", "/energy_J/end/spring"},
    ShortName{"gas", "/energy_J/end/gas"},
    ShortName{"gravity", "/energy_J/end/gravity"},
    ShortName{"energy_drift", "/energy_J/drift"},
    ShortName{"energy_rise", "/energy_J/greatest_rise_between_frames"},
    ShortName{"penetration", "/penetration_m/greatest"},
    ShortName{"overlap", "/overlap_at_end_m"},
    ShortName{"crossings", "/crossings/max_edges"},
    ShortName{"self_crossings", "/self_crossings/max_edges"},
    ShortName{"speed", "/end_speed_m_per_s"},
    ShortName{"at_rest", "/at_rest"},
    ShortName{"volume", "/volumes_m3/0/end"},
    ShortName{"min_volume", "/volumes_m3/0/least"},
    ShortName{"max_volume", "/volumes_m3/0/greatest"},
    ShortName{"state_hash", "/state_hash"},
};

constexpr std::array<const char*, 8> usual = {"seconds", "energy",      "energy_drift",
                                              "volume",  "penetration", "crossings",
                                              "speed",   "state_hash"};

/// A run of one soft body, whose values say nothing: only what there is.
nlohmann::json example() {
  RunStatistics run;
  run.volumes.push_back({.body = "body", .least = {}});
  return run_statistics_json(run);
}

std::string with_dots(std::string path) {
  std::ranges::replace(path, '/', '.');
  return path.substr(1);
}

/// The path as it is in the example, which has one body only.
std::string of_first_body(const std::string& path) {
  constexpr std::string_view volumes = "/volumes_m3/";
  if (!path.starts_with(volumes)) return path;
  const std::size_t end = path.find('/', volumes.size());
  const std::string number = path.substr(volumes.size(), end - volumes.size());
  const bool is_number =
      !number.empty() && number.size() < 8 && std::ranges::all_of(number, [](char c) {
        return std::isdigit(static_cast<unsigned char>(c)) != 0;
      });
  if (!is_number || end == std::string::npos) return path;
  return std::string(volumes) + "0" + path.substr(end);
}

bool is_value(const nlohmann::json& run, const std::string& path) {
  try {
    const nlohmann::json::json_pointer pointer(path);
    return run.contains(pointer) && run.at(pointer).is_primitive();
  } catch (const nlohmann::json::exception&) {
    return false;
  }
}

}  // namespace

Measure find_measure(const std::string& name) {
  const auto found = std::ranges::find(short_names, name, &ShortName::name);
  if (found != short_names.end()) return {name, std::string(found->path)};
  std::string path = "/" + name;
  std::ranges::replace(path, '.', '/');
  return {name, is_value(example(), of_first_body(path)) ? path : std::string()};
}

std::vector<std::string> measure_names() {
  std::vector<std::string> names;
  for (const ShortName& known : short_names) names.emplace_back(known.name);
  const nlohmann::json paths = example().flatten();
  for (const auto& [path, value] : paths.items()) {
    const std::string name = with_dots(path);
    const bool is_listed = std::ranges::find(names, name) != names.end();
    if (value.is_primitive() && path != "/units" && !is_listed) names.push_back(name);
  }
  return names;
}

std::vector<Measure> default_measures() {
  std::vector<Measure> measures;
  for (const char* name : usual) measures.push_back(find_measure(name));
  return measures;
}

std::string_view unit_of(const Measure& measure) {
  if (measure.path == "/seconds") return "s";
  // The longer endings first: "_m_per_s" ends in "_s" too.
  constexpr std::array<std::pair<std::string_view, std::string_view>, 5> units = {
      {{"_m_per_s", "m/s"}, {"_m3", "m^3"}, {"_J", "J"}, {"_m", "m"}, {"_s", "s"}}};
  // What is nearest to the value says its unit: "penetration_m/at_s" is a time.
  std::string_view path = measure.path;
  while (!path.empty()) {
    const std::size_t slash = path.rfind('/');
    const std::string_view name = path.substr(slash + 1);
    for (const auto& [ending, unit] : units) {
      if (name.ends_with(ending)) return unit;
    }
    path = path.substr(0, slash);
  }
  return {};
}

bool is_of_length(const Measure& measure) {
  return measure.path == "/seconds" || measure.path == "/steps";
}

nlohmann::ordered_json measured(const Measure& measure, const nlohmann::json& run) {
  const nlohmann::json::json_pointer pointer(measure.path);
  return run.contains(pointer) ? nlohmann::ordered_json(run.at(pointer)) : nlohmann::ordered_json();
}

}  // namespace pneuma::app
