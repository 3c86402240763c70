#include "app/study/diagram.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <string_view>

#include "app/host/command_line.h"
#include "app/host/find_program.h"
#include "app/host/run_command.h"
#include "app/host/standard_streams.h"

namespace pneuma::app {
namespace {

using Style = DiagramSeries::Style;

// Okabe and Ito's colours, which people who confuse red and green can tell apart (Color Universal
// Design, 2008), without the yellow that is too light on white; marks as gnuplot numbers them, the
// hollow one of each after the filled one.
struct Look {
  std::string_view colour;
  int filled;
  int hollow;
};
constexpr std::array looks = {
    Look{"#d55e00", 7, 6},   Look{"#e69f00", 5, 4},   Look{"#009e73", 9, 8},
    Look{"#0072b2", 13, 12}, Look{"#cc79a7", 11, 10}, Look{"#56b4e9", 15, 14},
    Look{"#000000", 7, 6},   Look{"#777777", 5, 4},
};

/// A line break would end what gnuplot takes for a comment or a string: a command would follow.
std::string on_one_line(std::string text) {
  std::ranges::replace_if(
      text, [](char c) { return c == '\n' || c == '\r'; }, ' ');
  return text;
}

/// A string of gnuplot's in which nothing is special: one in single quotes, on one line.
std::string quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : on_one_line(text)) {
    if (c == '\'') result += '\'';
    result += c;
  }
  return result + "'";
}

bool finite(const DiagramPoint& point) { return std::isfinite(point.x) && std::isfinite(point.y); }

void check(const Diagram& diagram) {
  bool any = false;
  for (const DiagramSeries& series : diagram.series) {
    for (const DiagramPoint& point : series.points) {
      if (!finite(point)) continue;
      any = true;
      if ((diagram.x.logarithmic && point.x <= 0.0) || (diagram.y.logarithmic && point.y <= 0.0)) {
        throw std::invalid_argument(fmt::format(
            "({}, {}) of '{}' has no place on a logarithmic axis", point.x, point.y, series.name));
      }
    }
  }
  if (!any) throw std::invalid_argument("a diagram without a point");
}

std::string axis_commands(const std::string& axis, const DiagramAxis& settings) {
  std::string text = fmt::format("set {}label {} noenhanced\n", axis, quoted(settings.label));
  const auto end = [](const std::optional<double>& value) {
    return value ? fmt::format("{}", *value) : std::string("*");
  };
  text += fmt::format("set {}range [{}:{}]\n", axis, end(settings.low), end(settings.high));
  if (settings.logarithmic) {
    text += fmt::format("set logscale {0}\nset format {0} '10^{{%T}}'\n", axis);
  }
  return text;
}

/// A block of lines "x y"; an empty line is gnuplot's sign for a break in a line.
std::string data_block(std::size_t index, const DiagramSeries& series) {
  std::string text = fmt::format("$series{} << END\n", index);
  for (const DiagramPoint& point : series.points) {
    text += finite(point) ? fmt::format("{} {}\n", point.x, point.y) : "\n";
  }
  return text + "END\n";
}

std::string style_of(const DiagramSeries& series, std::size_t index) {
  const auto number = static_cast<std::size_t>(series.look.value_or(static_cast<int>(index)));
  const Look& look = looks[number % looks.size()];
  // Beyond so many series the colours come again, and so that they can be told apart, dotted.
  const bool again = number >= looks.size();
  const bool dashed = series.style == Style::dashed || series.style == Style::dashed_with_marks;
  const std::string line = fmt::format("lw 2 dt {} lc rgb '{}'",
                                       again    ? 3
                                       : dashed ? 2
                                                : 1,
                                       look.colour);
  const auto mark = [](int kind) { return fmt::format("pt {} ps 0.8", kind); };
  switch (series.style) {
    case Style::line:
    case Style::dashed:
      return "with lines " + line;
    case Style::marks:
      return fmt::format("with points {} lc rgb '{}'", mark(look.filled), look.colour);
    case Style::hollow_marks:
      return fmt::format("with points {} lw 2 lc rgb '{}'", mark(look.hollow), look.colour);
    case Style::line_with_marks:
    case Style::dashed_with_marks:
      break;
  }
  return fmt::format("with linespoints {} {}", line, mark(look.filled));
}

bool has_points(const DiagramSeries& series) { return std::ranges::any_of(series.points, finite); }

std::string plot_command(const Diagram& diagram) {
  std::string text;
  for (std::size_t i = 0; i < diagram.series.size(); ++i) {
    const DiagramSeries& series = diagram.series[i];
    if (!has_points(series)) continue;
    const std::string title =
        series.name.empty() ? "notitle" : fmt::format("title {} noenhanced", quoted(series.name));
    text += text.empty() ? "plot " : ", \\\n     ";
    text += fmt::format("$series{} using 1:2 {} {}", i, style_of(series, i), title);
  }
  return text + '\n';
}

}  // namespace

std::string gnuplot_script(const Diagram& diagram, const std::string& name) {
  check(diagram);
  std::string text =
      fmt::format("# Draws {0}.svg and {0}.png: gnuplot {0}.gp\n", on_one_line(name));
  for (std::size_t i = 0; i < diagram.series.size(); ++i) {
    if (has_points(diagram.series[i])) text += data_block(i, diagram.series[i]);
  }
  text += "set title " + quoted(diagram.title);
  // The only kind of string in which a backslash means something.
  if (!diagram.subtitle.empty()) text += " . \"\\n\" . " + quoted(diagram.subtitle);
  text += " noenhanced\n";
  text += axis_commands("x", diagram.x) + axis_commands("y", diagram.y);
  text +=
      "set key outside right top Left reverse samplen 2\n"
      "set grid xtics ytics lc rgb '#d0d0d0' lw 1\n"
      "set border lc rgb '#404040'\n"
      "set tics textcolor rgb '#202020'\n";
  for (const std::string& command : diagram.commands) text += command + '\n';
  text += fmt::format(
      "set terminal svg size 960,600 background rgb 'white' font 'sans,14'\nset output {}\n",
      quoted(name + ".svg"));
  text += plot_command(diagram);
  text += fmt::format(
      "set terminal pngcairo size 1440,900 background rgb 'white' font 'sans,15' linewidth 1.3 "
      "pointscale 1.4\n"
      "set output {}\nreplot\nset output\n",
      quoted(name + ".png"));
  return text;
}

std::vector<std::string> diagram_files(const std::string& name) {
  return {name + ".gp", name + ".svg", name + ".png"};
}

DiagramFiles write_diagram(const StudyFolder& folder, const std::string& name,
                           const Diagram& diagram) {
  return write_script(folder, name, gnuplot_script(diagram, name));
}

DiagramFiles write_script(const StudyFolder& folder, const std::string& name,
                          const std::string& text) {
  DiagramFiles files;
  const std::string script = name + ".gp";
  files.script = folder.write(script, text);
  const std::vector<std::string> arguments = {"gnuplot", script};
  files.command =
      "cd " + shell_line(std::vector{folder.path().string()}) + " && " + shell_line(arguments);
  if (const auto gnuplot = find_program("gnuplot")) {
    run_command(std::filesystem::absolute(*gnuplot).string(), arguments, folder.path());
    files.drawn = true;
  } else {
    print_message(
        "gnuplot is not installed (apt-get install gnuplot-nox). The command for {}.svg and "
        "{}.png:\n{}\n",
        name, name, files.command);
  }
  return files;
}

}  // namespace pneuma::app
