#include "app/check/check_model.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "app/record/vector_json.h"
#include "app/terminal/table.h"

namespace pneuma::app {
namespace {

using nlohmann::json;

/// More are worth a word.
constexpr int usual_steps_per_second = 5000;
/// Of the mean: so many springs on a vertex make its motion the fastest.
constexpr double many_springs = 2.0;

std::string component_text(const assets::Component& component, std::size_t number, bool kept) {
  return fmt::format("{}{}: {} vertices, {} triangles, {} boundary edges, {} non-manifold edges{}",
                     number, component.name.empty() ? "" : fmt::format(" '{}'", component.name),
                     grouped(component.vertices), grouped(component.triangles),
                     grouped(component.boundary_edges), grouped(component.non_manifold_edges),
                     kept ? "" : "; left out");
}

/// "(0, 0, 1)", to a thousandth of about the size.
std::string place_text(const sim::Vec3& place, double size) {
  const double grain = std::pow(10.0, std::floor(std::log10(size)) - 3.0);
  const sim::Vec3 at = grain * (place / grain).array().round() + 0.0;  // of -0 it makes 0
  return fmt::format("({:.4g}, {:.4g}, {:.4g})", at.x(), at.y(), at.z());
}

json component_json(const assets::Component& component) {
  return {{"name", component.name},
          {"vertices", component.vertices},
          {"triangles", component.triangles},
          {"boundary_edges", component.boundary_edges},
          {"non_manifold_edges", component.non_manifold_edges},
          {"size", vector_json(component.size)}};
}

}  // namespace

ModelCheck check_model(const std::filesystem::path& path, const ModelChoice& choice) {
  ModelCheck check;
  check.path = path;
  check.model = chosen_model(path, choice);
  check.report = report_on(check.model);
  return check;
}

std::string model_check_text(const ModelCheck& check) {
  const ModelReport& report = check.report;
  std::string text = fmt::format("{}: fit for a soft body\n", check.path.string());
  std::string vertices = grouped(report.vertices);
  if (report.vertices_before != report.vertices || report.vertices_welded != report.vertices) {
    vertices += fmt::format("; {} in the file, {} after welding", grouped(report.vertices_before),
                            grouped(report.vertices_welded));
  }
  text += named_line("vertices", vertices);
  text += named_line("springs", fmt::format("{}; per vertex {} to {}, {:.3g} on average",
                                            grouped(report.edges), report.fewest_springs,
                                            report.most_springs, report.springs_per_vertex));
  text += named_line("triangles", fmt::format("{}, smallest angle {:.3g} degrees",
                                              grouped(report.triangles), report.smallest_angle));
  text += named_line("boundary edges", grouped(report.boundary_edges));
  text += named_line("non-manifold edges", grouped(report.non_manifold_edges));
  text += named_line("genus", grouped(report.genus));
  text += named_line("volume",
                     fmt::format("{:.6g} m^3, with one unit of the file a metre", report.volume));
  text += named_line("area", fmt::format("{:.6g} m^2", report.area));
  text += named_line("extent", fmt::format("{:.6g} x {:.6g} x {:.6g} m", report.size.x(),
                                           report.size.y(), report.size.z()));
  text += named_line("edge lengths",
                     fmt::format("{:.4g} m (5th percentile), {:.4g} m (median), {:.4g} m "
                                 "(95th)",
                                 report.edge_5th, report.edge_median, report.edge_95th));
  for (std::size_t i = 0; i < check.model.components.size(); ++i) {
    text += named_line(i == 0 ? "components" : "", component_text(check.model.components[i], i + 1,
                                                                  sim::at(check.model.kept) == i));
  }
  for (const std::string& cleaned : check.model.cleaned) {
    text += named_line(&cleaned == &check.model.cleaned.front() ? "cleaned" : "", cleaned);
  }
  for (const std::string& done : check.model.repaired) {
    text += named_line(&done == &check.model.repaired.front() ? "repaired" : "", done);
  }
  if (!check.model.simplified.empty()) text += named_line("simplified", check.model.simplified);
  return text;
}

std::string many_steps_text(const ModelReport& report, int steps_per_second) {
  if (steps_per_second <= usual_steps_per_second) return "";
  // The springs on a vertex are alike whatever their lengths, and so are the masses of vertices.
  const bool has_hub = report.most_springs > many_springs * report.springs_per_vertex;
  const std::string cause =
      has_hub ? fmt::format("the {} springs at the vertex {}, where about {:.0f} would do",
                            grouped(report.most_springs),
                            place_text(report.most_springs_at, report.size.maxCoeff()),
                            report.springs_per_vertex)
              : fmt::format("{} vertices, each with little mass; a coarser mesh needs fewer",
                            grouped(report.vertices));
  return named_line("steps", fmt::format("{} per second are many: because of {}",
                                         grouped(steps_per_second), cause));
}

json model_check_json(const ModelCheck& check) {
  const ModelReport& report = check.report;
  json components = json::array();
  for (const auto& component : check.model.components) {
    components.push_back(component_json(component));
  }
  return {{"model", check.path.string()},
          {"vertices_in_file", report.vertices_before},
          {"vertices_welded", report.vertices_welded},
          {"vertices", report.vertices},
          {"edges", report.edges},
          {"triangles", report.triangles},
          {"boundary_edges", report.boundary_edges},
          {"non_manifold_edges", report.non_manifold_edges},
          {"genus", report.genus},
          {"volume_m3", report.volume},
          {"area_m2", report.area},
          {"extent_m", vector_json(report.size)},
          {"edge_length_m",
           {{"percentile_5", report.edge_5th},
            {"median", report.edge_median},
            {"percentile_95", report.edge_95th}}},
          {"smallest_angle_degrees", report.smallest_angle},
          {"springs_per_vertex",
           {{"mean", report.springs_per_vertex},
            {"least", report.fewest_springs},
            {"greatest", report.most_springs}}},
          {"components", std::move(components)},
          {"component_kept", check.model.kept + 1},
          {"cleaned", check.model.cleaned},
          {"repaired", check.model.repaired},
          {"simplified", check.model.simplified}};
}

}  // namespace pneuma::app
