// The script of a heat map for gnuplot.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "app/sweep/sweep_plots.h"

namespace pneuma::app {
namespace {

/// Each value with the ends of its cell.
struct Extent {
  double value, low, high;
};

std::vector<Extent> extents(std::vector<double> values, bool logarithmic) {
  std::ranges::sort(values);
  values.erase(std::unique(values.begin(), values.end()), values.end());
  const auto to = [&](double v) { return logarithmic ? std::log(v) : v; };
  const auto from = [&](double v) { return logarithmic ? std::exp(v) : v; };
  std::vector<Extent> all;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double here = to(values[i]);
    const double before = i > 0 ? here - to(values[i - 1]) : 0.0;
    const double after = i + 1 < values.size() ? to(values[i + 1]) - here : 0.0;
    const double low = i > 0 ? before : after, high = i + 1 < values.size() ? after : before;
    all.push_back({values[i], from(here - 0.5 * low), from(here + 0.5 * high)});
  }
  return all;
}

const Extent& extent_of(const std::vector<Extent>& all, double value) {
  return *std::ranges::lower_bound(all, value, {}, &Extent::value);
}

HeatMap with_extents(HeatMap map) {
  std::vector<double> x, y;
  for (const MapCell& cell : map.cells) {
    x.push_back(cell.x);
    y.push_back(cell.y);
  }
  const std::vector<Extent> columns = extents(x, map.x.logarithmic),
                            rows = extents(y, map.y.logarithmic);
  for (MapCell& cell : map.cells) {
    const Extent& column = extent_of(columns, cell.x);
    const Extent& row = extent_of(rows, cell.y);
    cell.x_low = column.low;
    cell.x_high = column.high;
    cell.y_low = row.low;
    cell.y_high = row.high;
  }
  return map;
}

std::string quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text) {
    if (c == '\'') result += '\'';
    result += c == '\n' || c == '\r' ? ' ' : c;
  }
  return result + "'";
}

std::string axis(const char* name, const DiagramAxis& settings) {
  std::string text = fmt::format("set {}label {} noenhanced\n", name, quoted(settings.label));
  if (settings.logarithmic)
    text += fmt::format("set logscale {0}\nset format {0} '10^{{%T}}'\n", name);
  return text;
}

std::string data(const HeatMap& map) {
  std::string text = "$cells << END\n";
  for (const MapCell& cell : map.cells) {
    // gnuplot leaves out what is no number: the cell stays white.
    const std::string value = std::isfinite(cell.value) ? fmt::format("{}", cell.value) : "NaN";
    text += fmt::format("{} {} {} {} {} {} {}\n", cell.x, cell.y, cell.x_low, cell.x_high,
                        cell.y_low, cell.y_high, value);
  }
  return text + "END\n";
}

/// Several orders of magnitude are told apart by their logarithm only.
bool needs_logarithm(const HeatMap& map) {
  double low = std::numeric_limits<double>::infinity(), high = 0.0;
  for (const MapCell& cell : map.cells) {
    if (!std::isfinite(cell.value)) continue;
    low = std::min(low, cell.value);
    high = std::max(high, cell.value);
  }
  return low > 0.0 && high > 1e3 * low;
}

}  // namespace

std::string heat_map_script(const HeatMap& given, const std::string& name) {
  if (given.cells.empty()) throw std::invalid_argument("a map without a cell");
  const HeatMap map = given.random ? given : with_extents(given);
  std::string text = "# Draws this data by gnuplot.\n" + data(map);
  text += fmt::format("set title {} noenhanced\n", quoted(map.title)) + axis("x", map.x) +
          axis("y", map.y);
  // Viridis (van der Walt and Smith 2015): even steps of brightness, also for people who confuse
  // red and green.
  text += "set palette defined (0 '#440154', 1 '#3b528b', 2 '#21908c', 3 '#5dc963', 4 '#fde725')\n";
  text += fmt::format("set cblabel {} noenhanced\n", quoted(map.value_label));
  if (needs_logarithm(map))
    text += "set logscale cb\nset format cb '10^{%T}'\n";
  else
    text += "set format cb '%.4g'\n";
  // Beside the map there is room for the colour bar, its numbers and what they mean.
  text += "set rmargin at screen 0.8\n";
  text += "unset key\nset tics out\nset grid noxtics noytics\n";
  text += fmt::format(
      "set terminal svg size 960,600 background rgb 'white' font 'sans,14'\nset output {}\n",
      quoted(name + ".svg"));
  if (map.random) {
    text += "plot $cells using 1:2:7 with points pt 7 ps 1 lc palette\n";
  } else {
    text += fmt::format("set xrange [{}:{}]\nset yrange [{}:{}]\n",
                        std::ranges::min(map.cells, {}, &MapCell::x_low).x_low,
                        std::ranges::max(map.cells, {}, &MapCell::x_high).x_high,
                        std::ranges::min(map.cells, {}, &MapCell::y_low).y_low,
                        std::ranges::max(map.cells, {}, &MapCell::y_high).y_high);
    text +=
        "set style fill solid noborder\n"
        "plot $cells using 1:2:3:4:5:6:7 with boxxyerror lc palette\n";
  }
  text += fmt::format(
      "set terminal pngcairo size 1440,900 background rgb 'white' font 'sans,15'\nset output {}\n"
      "replot\nset output\n",
      quoted(name + ".png"));
  return text;
}

}  // namespace pneuma::app
