#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/study/error/conclusions.h"
#include "app/study/error/error_report.h"

namespace pneuma::app {
namespace {

using Status = ErrorRun::Status;
using Style = DiagramSeries::Style;

// A run whose error is exactly zero still has a place on a logarithmic axis.
constexpr double least_error = 1e-16;
// Errors end here. Above it is a row for each method's unstable runs, so that none hides another.
constexpr double greatest_error = 10.0;
constexpr double row_height = 1.8;  // as a factor

double place_of_row(std::size_t row) {
  return greatest_error * std::pow(row_height, static_cast<double>(row + 1));
}

double height(const ErrorRun& run) {
  return std::clamp(error_of(run), least_error, greatest_error);
}

struct Looks {
  int ours = 0;
  int peer = 6;  // black and grey
};

/// One series per method, and another for its unstable runs.
template <class Place, class Name>
std::vector<DiagramSeries> series_of(const ErrorStudy& study, bool with_peers, const Place& place,
                                     const Name& name) {
  std::vector<DiagramSeries> all;
  std::string method;
  Looks next;
  for (const ErrorRun& run : study.runs) {
    if (!run.ours && !with_peers) continue;
    if (std::exchange(method, run.method) != run.method) {
      const int look = run.ours ? next.ours++ : next.peer++;
      all.push_back({.name = name(method),
                     .points = {},
                     .style = run.ours ? Style::line_with_marks : Style::dashed_with_marks,
                     .look = look});
      all.push_back({.points = {}, .style = Style::hollow_marks, .look = look});
    }
    DiagramSeries& stable = all[all.size() - 2];
    DiagramSeries& unstable = all.back();
    if (run.status == Status::stable) stable.points.push_back({place(run), height(run)});
    if (run.status == Status::unstable) {
      unstable.points.push_back({place(run), place_of_row(all.size() / 2 - 1)});
    }
  }
  return all;
}

Diagram diagram_of(const ErrorStudy& study, const std::string& over, const std::string& x_label) {
  Diagram diagram;
  diagram.title = fmt::format("{}: error over {}", study.name, over);
  diagram.subtitle =
      fmt::format("{}, {:.3g} s; hollow marks above the line: unstable",
                  study.flight.contacts ? "with contacts" : "free flight", study.reference.seconds);
  diagram.x = {.label = x_label, .logarithmic = true};
  diagram.y = {.label = "max. position error / rest radius", .logarithmic = true};
  return diagram;
}

void close_at_the_top(Diagram& diagram) {
  diagram.y.high = place_of_row(diagram.series.size() / 2);
  diagram.commands = {
      fmt::format("set arrow from graph 0, first {0} to graph 1, first {0} nohead lc rgb '#404040'",
                  greatest_error),
      // No tick where there is no error.
      fmt::format("set ytics 1e-20, 10, {}", greatest_error)};
}

}  // namespace

Diagram work_diagram(const ErrorStudy& study) {
  Diagram diagram = diagram_of(study, "run time", "run time of a simulated second, microseconds");
  diagram.series = series_of(
      study, true, [](const ErrorRun& run) { return 1e6 * run.run_time; },
      [](const std::string& method) { return method; });
  close_at_the_top(diagram);
  return diagram;
}

Diagram step_diagram(const ErrorStudy& study) {
  Diagram diagram = diagram_of(study, "step", "step, s");
  const std::vector<ObservedOrder> orders = observed_orders(study);
  const auto name = [&](const std::string& method) {
    const auto order = std::ranges::find(orders, method, &ObservedOrder::method);
    return order->law ? fmt::format("{} ({:.2f})", method, order->law->exponent) : method;
  };
  diagram.subtitle += "; in brackets: the order";
  diagram.series = series_of(
      study, false, [](const ErrorRun& run) { return run.step(); }, name);
  close_at_the_top(diagram);
  return diagram;
}

}  // namespace pneuma::app
