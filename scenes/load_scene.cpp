#include "scenes/load_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <functional>

#include "scenes/check_scene.h"
#include "scenes/document.h"
#include "scenes/overrides.h"
#include "scenes/reader.h"
#include "scenes/sections.h"

namespace pneuma::scenes {
namespace {

constexpr Origin whole_file = {1, 1, -1};

/// One document into one scene, which must not move meanwhile.
class Loader {
 public:
  Loader(const Table& document, Scene& scene, Report& report)
      : document_(document), scene_(scene), report_(report), reader_(report) {}

  void load() {
    sim::Settings& settings = scene_.settings;
    reader_.read_others(document_, top_section(scene_),
                        {"simulation", "ground", "camera", "picture", "limits", "body"});
    if (const Table* simulation = table_at(document_, "simulation", "simulation")) {
      reader_.read_others(*simulation, simulation_section(settings), {"particles"});
      if (const Table* particles = table_at(*simulation, "particles", "simulation.particles")) {
        reader_.read_others(*particles, particles_section(settings.particles));
      }
    }
    read_table("ground", [&] { return ground_section(settings); });
    read_table("camera", [&] { return camera_section(scene_.camera); });
    read_table("picture", [&] { return picture_section(scene_.picture); });
    read_table("limits", [&] { return limits_section(scene_.limits); });
    const std::vector<Origin> headers = read_bodies();
    reader_.report_idle_overrides();
    check_scene(scene_, reader_, headers, report_);
  }

 private:
  const Table* table_at(const Table& table, std::string_view key, std::string_view title) {
    const Member* member = find(table, key);
    if (member == nullptr) return nullptr;
    const Table* result = std::get_if<Table>(&member->value.data);
    if (result == nullptr) {
      report_.add(member->at, fmt::format("{} must be a table, written [{}]; got {}", key, title,
                                          describe(member->value)));
    }
    return result;
  }

  void read_table(std::string_view key, const std::function<Section()>& section) {
    const Table* table = table_at(document_, key, key);
    if (table == nullptr) return;
    reader_.read_selectors(*table, section());
    reader_.read_others(*table, section());
  }

  /// The places of the [[body]] lines.
  std::vector<Origin> read_bodies() {
    const Member* member = find(document_, "body");
    if (member == nullptr) {
      report_.add(whole_file, "a scene needs at least one [[body]]");
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
      scene_.bodies[i].name = default_name(i);
      read_body(std::get<Table>(value.data), scene_.bodies[i]);
    }
    return headers;
  }

  void read_body(const Table& table, BodyScene& body) {
    reader_.read_selectors(table, body_section(body));
    if (body.kind == BodyKind::rigid && find(table, "shape") == nullptr) body.shape = Shape::box;
    reader_.read_others(table, body_section(body));
  }

  const Table& document_;
  Scene& scene_;
  Report& report_;
  Reader reader_;
};

/// The keys of a body's table `model` become keys of the body, "model.file" and so on: it is a
/// table for people only.
void flatten_models(Table& document, Report& report) {
  Member* member = find(document, "body");
  auto* bodies = member == nullptr ? nullptr : std::get_if<Array>(&member->value.data);
  if (bodies == nullptr) return;
  for (Value& value : *bodies) {
    auto* body = std::get_if<Table>(&value.data);
    if (body == nullptr) continue;
    Table flat;
    for (Member& key : *body) {
      auto* model = std::get_if<Table>(&key.value.data);
      if (key.key != "model") {
        flat.push_back(std::move(key));
      } else if (model == nullptr) {
        report.add(key.at, fmt::format("model must be a table, with keys such as model.file; got "
                                       "{}",
                                       describe(key.value)));
      } else {
        for (Member& inner : *model) {
          inner.key = "model." + inner.key;
          flat.push_back(std::move(inner));
        }
      }
    }
    *body = std::move(flat);
  }
}

[[noreturn]] void throw_unreadable(const std::filesystem::path& path, const std::string& why) {
  throw SceneError({{path.string(), 0, 0, why}});
}

constexpr double bytes_per_mib = 1024.0 * 1024.0;

/// The limit that holds before a file is read.
double most_mib(std::span<const std::string> overrides) {
  const auto raised = number_override(overrides, "limits.scene_file_mib");
  const bool in_range = raised && *raised > 0.0 && *raised <= greatest_scene_file_mib;
  return in_range ? *raised : Limits{}.scene_file_mib;  // out of range: refused with the other keys
}

void check_size(const std::filesystem::path& path, std::uintmax_t bytes, double limit,
                std::string_view and_more = "") {
  const double mib = static_cast<double>(bytes) / bytes_per_mib;
  if (mib <= limit) return;
  throw_unreadable(path,
                   fmt::format("{} bytes{} are more than the limit of {} MiB for a scene file; "
                               "make many bodies of one [[body]] with copies, or raise the "
                               "limit with --set limits.scene_file_mib={}",
                               bytes, and_more, limit, std::ceil(mib)));
}

std::string read_file(const std::filesystem::path& path, double limit) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) {
    throw_unreadable(path, "is a folder; name a scene file in it");
  }
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    throw_unreadable(path, fmt::format("cannot be opened: {}", std::strerror(errno)));
  }
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (!error) check_size(path, size, limit);
  // One byte more than is allowed, because the size of a pipe is not known beforehand.
  std::string text(static_cast<std::size_t>(limit * bytes_per_mib) + 1, '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (file.bad()) throw_unreadable(path, fmt::format("cannot be read: {}", std::strerror(errno)));
  text.resize(static_cast<std::size_t>(file.gcount()));
  if (error) check_size(path, text.size(), limit, " and more");
  return text;
}

}  // namespace

Scene parse_scene(std::string_view text, const std::filesystem::path& file,
                  std::span<const std::string> overrides) {
  check_size(file, text.size(), most_mib(overrides));
  Report report(file.string(), overrides);
  Scene scene;
  scene.name = file.stem().string();
  scene.folder = file.parent_path();
  try {
    Table document = parse_document(text, -1);
    flatten_models(document, report);
    apply_overrides(overrides, document, report);
    Loader(document, scene, report).load();
    check_size(file, text.size(), scene.limits.scene_file_mib);
  } catch (const SyntaxError& error) {
    report.add(error.at, error.what());
  }
  report.throw_errors();
  return scene;
}

Scene load_scene(const std::filesystem::path& path, std::span<const std::string> overrides) {
  return parse_scene(read_file(path, most_mib(overrides)), path, overrides);
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
