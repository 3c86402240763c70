#include "scenes/loader/load_scene.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "scenes/loader/apply_method.h"
#include "scenes/loader/check_scene.h"
#include "scenes/loader/document.h"
#include "scenes/loader/overrides.h"
#include "scenes/loader/reader.h"
#include "scenes/loader/sections.h"
#include "scenes/loader/tables.h"
#include "sim/base/file.h"

namespace pneuma::scenes {
namespace {

/// Reads one document into one scene, which must not move while the loader exists.
class Loader {
 public:
  Loader(const Table& document, Scene& scene, Report& report)
      : document_(document), scene_(scene), report_(report), reader_(report) {}

  void load(const ModelCheck& check_model) {
    for (const SectionMaker make : section_makers()) read_section(make);
    const std::vector<Origin> headers = read_bodies();
    read_list("valve", scene_.valves, valve_section);
    read_list("spring", scene_.springs, spring_section);
    reader_.report_idle_overrides();
    apply_method(scene_, reader_, report_);
    fit_step_to_frames();
    check_scene(scene_, reader_, headers, report_);
    if (!report_.empty() && check_model) check_models(check_model);
  }

 private:
  /// A frame takes whole steps: where only frames are named, the next number of steps that fits.
  /// The paper's damping is by the step, so that its steps stay.
  void fit_step_to_frames() {
    int& steps = scene_.settings.steps_per_second;
    const int& frames = scene_.picture.frames_per_second;
    scene_.names_step = reader_.has_origin(&steps);
    if (scene_.names_step || !reader_.valid({&frames})) return;
    if (!sim::is_as_printed(scene_.settings)) steps = default_steps_per_second(frames);
  }

  /// Made twice, because the selectors decide which other keys apply.
  void read_section(SectionMaker make) {
    const Section section = make(scene_);
    const Table* table = find_table(section.table);
    if (table == nullptr) return;
    reader_.read_selectors(*table, section);
    reader_.read_others(*table, make(scene_), child_tables(section.table));
  }

  /// Null when the file leaves it out, or has something else in its place.
  const Table* find_table(std::string_view path) {
    const std::size_t dot = path.rfind('.');
    const std::string_view key = dot == path.npos ? path : path.substr(dot + 1);
    const Table* parent = &document_;
    if (dot != path.npos) parent = tables_[path.substr(0, dot)];
    return tables_[path] = path.empty() ? parent : table_at(parent, key, path);
  }

  const Table* table_at(const Table* parent, std::string_view key, std::string_view title) {
    const Member* member = parent == nullptr ? nullptr : find(*parent, key);
    if (member == nullptr) return nullptr;
    const Table* result = std::get_if<Table>(&member->value.data);
    if (result == nullptr) {
      report_.add(member->at, fmt::format("{} must be a table, written [{}]; got {}", key, title,
                                          describe(member->value)));
    }
    return result;
  }

  /// The places of the [[body]] lines.
  std::vector<Origin> read_bodies() {
    const Member* member = find(document_, "body");
    if (member == nullptr) {
      // A misspelt [[body]] was refused with its right name already.
      const bool misspelt = std::ranges::any_of(document_, [](const Member& other) {
        return std::holds_alternative<Array>(other.value.data) && holds_tables(other.value) &&
               !is_listed(other.key);
      });
      if (!misspelt) report_.add(whole_file, "a scene needs at least one [[body]]");
      return {};
    }
    const Array* bodies = std::get_if<Array>(&member->value.data);
    const bool only_tables =
        bodies != nullptr && std::all_of(bodies->begin(), bodies->end(), [](const Value& value) {
          return std::holds_alternative<Table>(value.data);
        });
    if (!only_tables || bodies->empty()) {
      report_.add(member->at,
                  "a scene needs at least one body, and each is written [[body]], with "
                  "two brackets");
      return {};
    }
    std::vector<Origin> headers;
    scene_.bodies.resize(bodies->size());
    for (std::size_t i = 0; i < bodies->size(); ++i) {
      const Value& value = (*bodies)[i];
      headers.push_back(value.at);
      BodyScene& body = scene_.bodies[i] = default_body(i);
      read_body(std::get<Table>(value.data), body, value.at);
      body.place = report_.place(value.at);
      const auto place_of_key = [&](const void* key) {
        return report_.place(reader_.origin({key}, value.at));
      };
      body.rest_place = place_of_key(&body.rest);
      body.position_place = place_of_key(&body.position);
      body.model_place = place_of_key(&body.model.file);
      body.pinned_place = place_of_key(&body.pinned);
      body.still_place = place_of_key(&body.still);
    }
    return headers;
  }

  /// Those that a scene may do without.
  template <class Item>
  void read_list(std::string_view name, std::vector<Item>& items, Section (*section)(Item&)) {
    const Member* member = find(document_, name);
    if (member == nullptr) return;
    const Array* list = std::get_if<Array>(&member->value.data);
    if (list == nullptr || !std::ranges::all_of(*list, [](const Value& value) {
          return std::holds_alternative<Table>(value.data);
        })) {
      report_.add(member->at, fmt::format("each {0} is written [[{0}]], with two brackets; got {1}",
                                          name, describe(member->value)));
      return;
    }
    items.resize(list->size());
    for (std::size_t i = 0; i < list->size(); ++i) {
      const Table& table = std::get<Table>((*list)[i].data);
      items[i].place = report_.place((*list)[i].at);
      reader_.read_selectors(table, section(items[i]));
      reader_.read_others(table, section(items[i]));
      for (const auto& [key, end] : {std::pair("from", &items[i].from), {"to", &items[i].to}}) {
        if (!end->empty() || !reader_.valid({end})) continue;
        report_.add((*list)[i].at, fmt::format("a {} needs the names of two bodies; write {} = "
                                               "\"...\"",
                                               name, key));
      }
    }
  }

  void check_models(const ModelCheck& check_model) {
    for (const BodyScene& body : scene_.bodies) {
      const ModelScene& model = body.model;
      if (is_box(body) || body.shape != Shape::model || model.file.empty()) continue;
      if (!reader_.valid({&body.kind, &model.file, &model.component, &model.scale, &model.rotation,
                          &model.centre, &model.repair, &model.vertices})) {
        continue;
      }
      const std::string reason = check_model(scene_, body);
      if (reason.empty()) continue;
      report_.add(reader_.origin({&model.file}, whole_file),
                  fmt::format("body '{}': {}", body.name, reason));
    }
  }

  void read_body(const Table& table, BodyScene& body, Origin header) {
    reader_.read_selectors(table, body_section(body));
    if (body.kind != BodyKind::soft) {
      body.skin_mass.reset();  // read before its kind was known
      make_box(table, body, header);
    }
    reader_.read_others(table, body_section(body));
  }

  /// Its other keys are then judged as a box's.
  void make_box(const Table& table, BodyScene& body, Origin header) {
    const bool is_given = find(table, "shape") != nullptr && reader_.valid({&body.shape});
    if (is_given && body.kind != BodyKind::rigid) return;
    if (is_given && body.shape != Shape::box) {
      report_.add(reader_.origin({&body.shape}, header),
                  "a rigid body is always a box; leave shape out, or make the body soft, static or "
                  "moved");
    }
    body.shape = Shape::box;
  }

  const Table& document_;
  Scene& scene_;
  Report& report_;
  Reader reader_;
  std::map<std::string_view, const Table*> tables_;  // those read so far, by path
};

/// "write supply.n = VALUE; its keys: supply.n, supply.smooth": a table's first key is its main
/// one.
std::string how_to_write(std::string_view table) {
  const std::vector<const Key*> keys = keys_of_body_table(table);
  std::vector<std::string_view> names;
  for (const Key* key : keys) names.push_back(key->name);
  const std::string_view beside = keys.front()->made_one_by;
  return fmt::format("write {} = VALUE{}{}; its keys: {}", names.front(),
                     beside.empty() ? "" : " beside ", beside, fmt::join(names, ", "));
}

/// The keys of a table within a body become keys of the body: "file" in [body.model] becomes
/// "model.file".
Table flattened(Table body, Report& report) {
  Table flat;
  for (Member& member : body) {
    auto* inner_table = std::get_if<Table>(&member.value.data);
    if (!is_body_table(member.key)) {
      flat.push_back(std::move(member));
    } else if (inner_table == nullptr) {
      report.add(member.at, fmt::format("{} must be a table; {}; got {}", member.key,
                                        how_to_write(member.key), describe(member.value)));
    } else {
      for (Member& inner : *inner_table) {
        inner.key = fmt::format("{}.{}", member.key, inner.key);
        flat.push_back(std::move(inner));
      }
    }
  }
  return flat;
}

void flatten_bodies(Table& document, Report& report) {
  Member* member = find(document, "body");
  auto* bodies = member == nullptr ? nullptr : std::get_if<Array>(&member->value.data);
  if (bodies == nullptr) return;
  for (Value& value : *bodies) {
    if (auto* body = std::get_if<Table>(&value.data)) *body = flattened(std::move(*body), report);
  }
}

[[noreturn]] void throw_unreadable(const std::filesystem::path& path, const std::string& why) {
  throw SceneError({{path.string(), 0, 0, why}});
}

constexpr double bytes_per_mib = 1024.0 * 1024.0;

/// The limit that holds before a file is read.
double most_mib(std::span<const std::string> overrides) {
  const auto raised = number_override(overrides, "limits.scene_file_mib");
  const bool in_range = raised && *raised > 0.0 && *raised <= max_scene_file_mib;
  return in_range ? *raised : Limits{}.scene_file_mib;  // out of range: refused with the other keys
}

std::size_t whole_bytes(double mib) { return static_cast<std::size_t>(mib * bytes_per_mib); }

[[noreturn]] void refuse_size(const std::filesystem::path& path, const std::string& size,
                              double bytes, double limit) {
  throw_unreadable(path, fmt::format("{} are more than the limit of {} MiB for a scene file; make "
                                     "many bodies of one [[body]] with copies, or raise the limit "
                                     "with --set limits.scene_file_mib={}",
                                     size, limit, std::ceil(bytes / bytes_per_mib)));
}

void check_size(const std::filesystem::path& path, std::size_t bytes, double limit) {
  if (bytes <= whole_bytes(limit)) return;
  refuse_size(path, fmt::format("{} bytes", bytes), static_cast<double>(bytes), limit);
}

std::string read_scene_file(const std::filesystem::path& path, double limit) {
  try {
    return base::read_text_file(path.string(),
                                {.max_bytes = whole_bytes(limit), .what = "scene file"});
  } catch (const base::FileTooLarge& error) {
    refuse_size(path, error.size_text(), static_cast<double>(error.bytes()), limit);
  } catch (const base::ReadError& error) {
    throw_unreadable(path, error.reason());
  }
}

}  // namespace

Scene parse_scene(std::string_view text, const std::filesystem::path& file,
                  std::span<const std::string> overrides, const ModelCheck& check_model) {
  check_size(file, text.size(), most_mib(overrides));
  Report report(file.string(), text, overrides);
  Scene scene;
  scene.name = file.stem().string();
  scene.folder = file.parent_path();
  try {
    Table document = parse_document(text, -1);
    flatten_bodies(document, report);
    apply_overrides(overrides, document, report);
    Loader(document, scene, report).load(check_model);
    check_size(file, text.size(), scene.limits.scene_file_mib);
  } catch (const SyntaxError& error) {
    report.add(error.at, error.what());
  }
  report.throw_errors();
  scene.warnings = report.warnings();
  return scene;
}

Scene load_scene(const std::filesystem::path& path, std::span<const std::string> overrides,
                 const ModelCheck& check_model) {
  return parse_scene(read_scene_file(path, most_mib(overrides)), path, overrides, check_model);
}

std::vector<SceneInfo> list_scenes(const std::filesystem::path& folder) {
  std::error_code error;
  std::vector<SceneInfo> scenes;
  for (auto entry = std::filesystem::directory_iterator(folder, error);
       !error && entry != std::filesystem::directory_iterator(); entry.increment(error)) {
    if (entry->path().extension() != ".toml") continue;
    SceneInfo info;
    info.path = entry->path();
    info.name = info.path.stem().string();
    try {
      const Scene scene = load_scene(entry->path());
      info.title = scene.title;
      info.figure = scene.figure;
      info.paper_fps = scene.paper_fps;
      info.has_flow_or_springs = !scene.valves.empty() || !scene.springs.empty() ||
                                 std::ranges::any_of(scene.bodies, has_supply);
    } catch (const SceneError& invalid) {
      info.error = to_string(invalid.diagnostics().front());
    }
    scenes.push_back(std::move(info));
  }
  if (error) throw_unreadable(folder, fmt::format("cannot be listed: {}", error.message()));
  std::sort(scenes.begin(), scenes.end(),
            [](const SceneInfo& a, const SceneInfo& b) { return a.name < b.name; });
  return scenes;
}

}  // namespace pneuma::scenes
