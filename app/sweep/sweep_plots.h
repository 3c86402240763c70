// Diagrams of a sweep: a curve over one parameter, a heat map over two.
#pragma once

#include <string>
#include <vector>

#include "app/study/diagram.h"
#include "app/study/study_folder.h"
#include "app/sweep/sweep_journal.h"

namespace pneuma::app {

/// A coloured cell of a map.
struct MapCell {
  double x = 0.0, x_low = 0.0, x_high = 0.0;
  double y = 0.0, y_low = 0.0, y_high = 0.0;
  double value = 0.0;
};

struct HeatMap {
  std::string title;
  std::string value_label;
  DiagramAxis x;
  DiagramAxis y;
  bool random = false;  // points in place of cells
  std::vector<MapCell> cells;
};

/// The cells of points of a grid reach half way to the next, in the logarithm on such an axis.
/// Throws std::invalid_argument for a map without cells.
std::string heat_map_script(const HeatMap& map, const std::string& name);

/// Writes NAME_MEASURE.gp, .svg and .png of every measure with numbers, for each scene, if one or
/// two parameters have numbers: of one, a curve for each choice of the others; of two, a map for
/// each. Returns the paths without their ending. Throws base::IoError and
/// Interrupted.
std::vector<std::string> write_sweep_plots(const StudyFolder& folder, const Sweep& sweep,
                                           const SweepRows& rows);

}  // namespace pneuma::app
