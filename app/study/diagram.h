// Diagrams, drawn by gnuplot where it is installed.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/study/study_folder.h"

namespace pneuma::app {

struct DiagramPoint {
  double x = 0.0;
  double y = 0.0;
};

/// Points that belong together. A point that is not finite draws nothing and breaks the line.
struct DiagramSeries {
  enum class Style { line_with_marks, dashed_with_marks, line, dashed, marks, hollow_marks };

  std::string name = {};  // in the legend; empty: not in it
  std::vector<DiagramPoint> points;
  Style style = Style::line_with_marks;
  std::optional<int> look = {};  // colour and mark, 0, 1, ...: equal looks are equal in every
                                 // diagram; by default the series' place in it
};

struct DiagramAxis {
  std::string label;  // with its unit
  bool logarithmic = false;
  std::optional<double> low = {};  // by default as the points need
  std::optional<double> high = {};
};

struct Diagram {
  std::string title;
  std::string subtitle = {};
  DiagramAxis x;
  DiagramAxis y;
  std::vector<DiagramSeries> series;
  std::vector<std::string> commands = {};  // gnuplot's own, just before the plot
};

/// The script NAME.gp as text: complete with the data, it writes NAME.svg and NAME.png to where it
/// is run. Throws std::invalid_argument for a point without a place on a logarithmic axis, and when
/// no series has a point.
std::string gnuplot_script(const Diagram& diagram, const std::string& name);

/// Script and pictures of a diagram of this name.
std::vector<std::string> diagram_files(const std::string& name);

/// What write_diagram left in the folder.
struct DiagramFiles {
  std::filesystem::path script;
  bool drawn = false;   // NAME.svg and NAME.png too
  std::string command;  // that draws them (again), for a shell
};

/// Writes NAME.gp and runs gnuplot on it. Without gnuplot says on standard error how to. Throws
/// base::IoError, also when gnuplot fails, and Interrupted.
DiagramFiles write_diagram(const StudyFolder& folder, const std::string& name,
                           const Diagram& diagram);
/// The same of a script that writes NAME.svg and NAME.png.
DiagramFiles write_script(const StudyFolder& folder, const std::string& name,
                          const std::string& text);

}  // namespace pneuma::app
