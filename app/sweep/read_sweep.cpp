#include "app/sweep/read_sweep.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>
#include <system_error>

#include "app/files/data_folders.h"
#include "app/host/errors.h"
#include "app/sweep/read_parameter.h"
#include "app/sweep/sweep_values.h"
#include "app/terminal/grid_size.h"
#include "app/world/open_scene.h"
#include "assets/model.h"
#include "scenes/loader/load_scene.h"
#include "sim/base/file.h"
#include "sim/base/nearest.h"

namespace pneuma::app {
namespace {

namespace fs = std::filesystem;
using scenes::Table;
using scenes::Value;

constexpr std::size_t most_bytes = 1 << 20;
constexpr double most_samples = 1e8;
constexpr std::size_t most_values_tried = 20;

class SweepReader {
 public:
  SweepReader(Sweep& sweep, scenes::Report& report)
      : sweep_(sweep), values_(report), report_(report) {}

  void read(const Table& document) {
    values_.refuse_unknown(document, sweep_keys(), "in a sweep");
    read_scenes(document);
    for (const Value* text : strings(document, "set")) {
      sweep_.overrides.push_back(std::get<std::string>(text->data));
    }
    read_measures(document);
    read_numbers(document);
    read_frames(document);
    read_parameters(document);
    check_together(document);
  }

  /// A scene that cannot be loaded, and a key that no scene takes, are errors before any run.
  void check_scenes(const Table& document) {
    for (std::size_t s = 0; s < sweep_.scenes.size(); ++s) {
      if (const auto refusal = refused(sweep_.scene_paths[s], sweep_.overrides)) {
        report_.add(scene_places_[s], fmt::format("scene {}: {}", sweep_.scenes[s], *refusal));
        return;
      }
    }
    check_parameters(document);
  }

 private:
  std::vector<const Value*> strings(const Table& table, std::string_view key) {
    const scenes::Member* member = scenes::find(table, key);
    if (member == nullptr) return {};
    return values_.strings(*member);
  }

  void read_scenes(const Table& document) {
    for (const Value* value : strings(document, "scenes")) {
      const std::string& name = std::get<std::string>(value->data);
      const fs::path beside = sweep_.file.parent_path() / name;
      std::error_code ignored;
      sweep_.scenes.push_back(name);
      sweep_.scene_paths.push_back(fs::is_regular_file(beside, ignored) ? beside.string() : name);
      scene_places_.push_back(value->at);
    }
    if (scenes::find(document, "scenes") == nullptr) {
      report_.add(scenes::whole_file,
                  "scenes is missing: which scenes are run, as scenes = [\"one_sphere\"]");
    }
  }

  void read_measures(const Table& document) {
    if (scenes::find(document, "measure") == nullptr) sweep_.measures = default_measures();
    for (const Value* value : strings(document, "measure")) {
      const std::string& name = std::get<std::string>(value->data);
      const Measure found = find_measure(name);
      if (found.path.empty()) {
        const std::vector<std::string> names = measure_names();
        report_.add(
            value->at,
            fmt::format("nothing that is called {} is measured{}; `pneuma sweep --keys` lists all",
                        base::in_quotes(name),
                        base::suggestion(name, {names.begin(), names.end()})));
      } else if (std::ranges::any_of(sweep_.measures,
                                     [&](const Measure& m) { return m.name == name; })) {
        report_.add(value->at, fmt::format("{} is measured already", base::in_quotes(name)));
      } else {
        sweep_.measures.push_back(found);
      }
    }
  }

  void read_numbers(const Table& document) {
    if (const auto* member = scenes::find(document, "seed")) {
      sweep_.seed = static_cast<std::uint64_t>(values_.whole(*member, 0.0, 9e15).value_or(1));
    }
    if (const auto* member = scenes::find(document, "samples")) {
      sweep_.samples = values_.whole(*member, 1.0, most_samples).value_or(1);
    }
  }

  void read_frames(const Table& document) {
    const scenes::Member* frames = scenes::find(document, "frames");
    if (frames != nullptr) {
      const std::string word = values_.word(*frames, {"none", "last", "all"});
      if (word == "last") sweep_.frames = SweepFrames::last;
      if (word == "all") sweep_.frames = SweepFrames::all;
    }
    const scenes::Member* size = scenes::find(document, "size");
    if (size == nullptr) return;
    try {
      append_size(values_.text(*size), sweep_.overrides);
    } catch (const UsageError& error) {
      report_.add(size->value.at, error.what());
    }
  }

  void read_parameters(const Table& document) {
    const scenes::Member* member = scenes::find(document, "parameter");
    if (member == nullptr) return;
    const auto* tables = std::get_if<scenes::Array>(&member->value.data);
    if (tables == nullptr || tables->empty() || !scenes::holds_tables(member->value)) {
      report_.add(member->at,
                  fmt::format("parameter is {}; write each parameter as a table [[parameter]]",
                              scenes::describe(member->value)));
      return;
    }
    for (const Value& table : *tables) {
      const auto parameter = read_parameter(std::get<Table>(table.data), table.at, values_);
      if (!parameter) continue;
      if (std::ranges::any_of(sweep_.parameters, [&](const Parameter& other) {
            return other.key == parameter->key;
          })) {
        report_.add(table.at, fmt::format("{} is varied already", base::in_quotes(parameter->key)));
        continue;
      }
      sweep_.parameters.push_back(*parameter);
      parameter_places_.push_back(table.at);
    }
  }

  void check_together(const Table& document) {
    const bool random = std::ranges::any_of(sweep_.parameters, &Parameter::is_random);
    const scenes::Member* samples = scenes::find(document, "samples");
    if (samples != nullptr && !random && report_.empty()) {
      report_.add(samples->at, "samples has no effect: no parameter is random or log_random");
    }
    double runs = static_cast<double>(sweep_.scenes.size()) * static_cast<double>(sweep_.samples);
    for (const Parameter& parameter : sweep_.parameters) {
      if (!parameter.is_random()) runs *= static_cast<double>(parameter.values.size());
    }
    if (runs <= static_cast<double>(most_runs)) return;
    report_.add(scenes::whole_file,
                fmt::format("{:.3g} runs are more than the {} that a sweep may have; "
                            "give fewer values or samples",
                            runs, most_runs));
  }

  /// Why the scene cannot be loaded with these overrides, if it cannot.
  static std::optional<std::string> refused(const std::string& scene,
                                            const std::vector<std::string>& overrides) {
    try {
      open_scene(scene, overrides);
      return std::nullopt;
    } catch (const scenes::SceneError& error) {
      return scenes::to_string(error.diagnostics().front());
    } catch (const assets::ModelError& error) {
      return error.what();
    }
  }

  /// One value may well be refused: that run is then a row that says so.
  void check_parameters(const Table&) {
    for (std::size_t p = 0; p < sweep_.parameters.size(); ++p) {
      if (const auto refusal = refused_always(p)) report_.add(parameter_places_[p], *refusal);
    }
  }

  /// Why no scene takes the first of a parameter's values, if none takes any that is tried.
  std::optional<std::string> refused_always(std::size_t parameter) const {
    std::optional<std::string> first_refusal;
    for (const std::string& value : values_to_try(parameter)) {
      for (const std::string& scene : sweep_.scene_paths) {
        std::vector<std::string> overrides = sweep_.overrides;
        overrides.push_back(fmt::format("{}={}", sweep_.parameters[parameter].key, value));
        const auto refusal = refused(scene, overrides);
        if (!refusal) return std::nullopt;
        if (!first_refusal) first_refusal = refusal;
      }
    }
    return first_refusal;
  }

  std::vector<std::string> values_to_try(std::size_t parameter) const {
    const std::vector<std::string>& all = sweep_.parameters[parameter].values;
    if (sweep_.parameters[parameter].is_random()) {
      const std::int64_t last = run_count(sweep_) - 1;
      return {run_of(sweep_, 0).values[parameter], run_of(sweep_, last).values[parameter]};
    }
    const std::size_t count = std::min(all.size(), most_values_tried);
    std::vector<std::string> tried;
    for (std::size_t i = 0; i < count; ++i) {
      tried.push_back(count == 1 ? all.front() : all[i * (all.size() - 1) / (count - 1)]);
    }
    return tried;
  }

  Sweep& sweep_;
  SweepValues values_;
  scenes::Report& report_;
  std::vector<scenes::Origin> scene_places_;
  std::vector<scenes::Origin> parameter_places_;
};

std::string read_file_text(const fs::path& path) {
  try {
    return base::read_text_file(path.string(), {.max_bytes = most_bytes, .what = "sweep file"});
  } catch (const base::ReadError& error) {
    throw scenes::SceneError({{path.string(), 0, 0, error.reason()}});
  }
}

}  // namespace

Sweep read_sweep(const fs::path& path) {
  Sweep sweep;
  sweep.file = fs::absolute(path);
  sweep.name = path.stem().string();
  sweep.text = read_file_text(path);
  scenes::Report report(path.string(), sweep.text, {});
  SweepReader reader(sweep, report);
  Table document;
  try {
    document = scenes::parse_document(sweep.text, -1);
    reader.read(document);
  } catch (const scenes::SyntaxError& error) {
    report.add(error.at, error.what());
  }
  report.throw_errors();
  reader.check_scenes(document);
  report.throw_errors();
  return sweep;
}

fs::path find_sweep(const std::string& name_or_path) {
  std::error_code ignored;
  if (fs::exists(name_or_path, ignored)) return name_or_path;
  const fs::path given(name_or_path);
  std::vector<std::string> searched;
  for (const fs::path& folder : data_folders("scenes/sweeps")) {
    if (given.has_parent_path()) break;
    for (const fs::path& name : {given, fs::path(given).concat(".toml")}) {
      if (fs::is_regular_file(folder / name, ignored)) return folder / name;
    }
    searched.push_back(folder.string());
  }
  throw scenes::SceneError(
      {{name_or_path, 0, 0,
        fmt::format("no such file{}", searched.empty()
                                          ? ""
                                          : fmt::format(", and no sweep of that name in {}",
                                                        fmt::join(searched, " or ")))}});
}

}  // namespace pneuma::app
