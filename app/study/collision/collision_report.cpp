#include "app/study/collision/collision_report.h"

#include <fmt/format.h>

#include <map>
#include <nlohmann/json.hpp>

#include "app/record/vector_json.h"
#include "app/study/csv.h"
#include "app/terminal/table.h"

namespace pneuma::app {
namespace {

bool is_exact(const SearchResult& result) {
  return result.setting.search == sim::SoftSearch::exact;
}

/// Particles per vertex are a fraction of the same body in every row of a scene, so that what
/// belongs together in the diagram is one series each.
std::string series_name(const SearchResult& result) {
  if (is_exact(result)) return "exact";
  if (result.setting.particles.attraction != sim::ParticleSettings{}.attraction) {
    return "1/8, attraction 1, 4, 8";
  }
  const std::string name = result.setting.name();
  return name.substr(0, name.find(','));
}

}  // namespace

std::string collision_text(const CollisionStudy& study) {
  Table table({{"search", Table::Align::left},
               {"us per\nstep"},
               {"times\nexact"},
               {"contacts"},
               {"regions\nfound %"},
               {"vertices\nfound %"},
               {"deepest\nmissed m"},
               {"max.\npenetration m"}});
  for (const SearchResult& result : study.results) {
    table.add_row({result.setting.name(), readable(1e6 * result.step_seconds),
                   readable(result.step_seconds / study.exact().step_seconds),
                   readable(result.contacts),
                   fmt::format("{:.2f}", 100.0 * result.score.region_share()),
                   fmt::format("{:.2f}", 100.0 * result.score.vertex_share()),
                   fmt::format("{:.3f}", result.score.greatest_missed),
                   result.penetration ? fmt::format("{:.3f}", *result.penetration) : ""});
  }
  std::string text = fmt::format(
      "{}: {:g} s, {} steps with bodies near each other, reach {:g} m\n\n{}\n", study.scene,
      study.seconds, study.steps, 2.0 * study.skin_thickness, table.text());
  for (const std::string& sentence : conclusions(study)) text += sentence + '\n';
  return text;
}

std::string collision_csv(std::span<const CollisionStudy> studies) {
  Csv csv({"scene", "search", "per_vertex", "max_sweeps", "attraction", "step_s", "contacts",
           "regions", "regions_found", "vertices", "vertices_found", "deepest_missed_m",
           "penetration_own_run_m"});
  for (const CollisionStudy& study : studies) {
    for (const SearchResult& result : study.results) {
      const sim::ParticleSettings& particles = result.setting.particles;
      const bool exact = is_exact(result);
      csv.add_row({csv_cell(study.scene), csv_cell(exact ? "exact" : "particles"),
                   exact ? "" : csv_cell(particles.per_vertex),
                   exact ? "" : csv_cell(particles.max_sweeps),
                   exact ? "" : csv_cell(particles.attraction), csv_cell(result.step_seconds),
                   csv_cell(result.contacts), csv_cell(result.score.regions),
                   csv_cell(result.score.regions_found), csv_cell(result.score.vertices),
                   csv_cell(result.score.vertices_found), csv_cell(result.score.greatest_missed),
                   result.penetration ? csv_cell(*result.penetration) : ""});
    }
  }
  return csv.text();
}

nlohmann::json collision_json(std::span<const CollisionStudy> studies) {
  nlohmann::json all = nlohmann::json::array();
  for (const CollisionStudy& study : studies) {
    nlohmann::json searches = nlohmann::json::array();
    for (const SearchResult& result : study.results) {
      searches.push_back(
          {{"search", result.setting.name()},
           {"step_s", number_json(result.step_seconds)},
           {"contacts", result.contacts},
           {"region_share", result.score.region_share()},
           {"vertex_share", result.score.vertex_share()},
           {"deepest_missed_m", result.score.greatest_missed},
           {"penetration_own_run_m",
            result.penetration ? nlohmann::json(*result.penetration) : nlohmann::json()},
           {"finds_what_touches", finds_what_touches(result, study.skin_thickness)}});
    }
    all.push_back({{"scene", study.scene},
                   {"skin_thickness_m", study.skin_thickness},
                   {"seconds", study.seconds},
                   {"steps", study.steps},
                   {"searches", std::move(searches)},
                   {"conclusions", conclusions(study)}});
  }
  return all;
}

Diagram collision_diagram(const CollisionStudy& study) {
  std::map<std::string, DiagramSeries> by_name;
  std::vector<std::string> order;
  for (const SearchResult& result : study.results) {
    const std::string name = series_name(result);
    const auto [entry, added] = by_name.try_emplace(name);
    if (added) {
      order.push_back(name);
      entry->second.name = name;
      if (is_exact(result)) entry->second.style = DiagramSeries::Style::marks;
    }
    entry->second.points.push_back(
        {1e6 * result.step_seconds, 100.0 * result.score.vertex_share()});
  }
  Diagram diagram;
  diagram.title = fmt::format("Vertices within reach that are found: {}", study.scene);
  diagram.subtitle = "particles with 1, 2, 5, 10 and 20 sweeps a step";
  diagram.x = {.label = "time of the search per step, us", .logarithmic = true};
  diagram.y = {.label = "vertices found, %", .low = 0.0, .high = 105.0};
  for (const std::string& name : order) diagram.series.push_back(by_name.at(name));
  return diagram;
}

}  // namespace pneuma::app
