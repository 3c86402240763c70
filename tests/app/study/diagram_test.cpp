#include "app/study/diagram.h"

#include <gtest/gtest.h>
#include <stdlib.h>

#include <cmath>
#include <set>
#include <stdexcept>

#include "app/host/find_program.h"
#include "render/image/png.h"
#include "sim/base/file.h"
#include "tests/support/temporary_folder.h"

namespace pneuma::app {
namespace {

Diagram falling_line() {
  Diagram diagram;
  diagram.title = "it's a_title";
  diagram.x = {.label = "x, s", .logarithmic = true};
  diagram.y = {.label = "y", .logarithmic = true, .low = 1e-3, .high = 1.0};
  diagram.series.push_back({.name = "a_name", .points = {{1e-3, 0.1}, {1e-2, 0.01}, {0.1, 0.002}}});
  diagram.series.push_back(
      {.points = {{1e-3, 1.0}}, .style = DiagramSeries::Style::hollow_marks, .look = 0});
  return diagram;
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(GnuplotScript, HoldsTheDataAndTheAxes) {
  const std::string script = gnuplot_script(falling_line(), "fall");
  EXPECT_TRUE(contains(script, "\n0.001 0.1\n0.01 0.01\n0.1 0.002\n"));
  EXPECT_TRUE(contains(script, "set logscale x\n"));
  EXPECT_TRUE(contains(script, "set yrange [0.001:1]\n"));
  EXPECT_TRUE(contains(script, "set output 'fall.svg'\n"));
  EXPECT_TRUE(contains(script, "set output 'fall.png'\n"));
}

TEST(GnuplotScript, TakesTextAsItIs) {
  Diagram diagram = falling_line();
  diagram.subtitle = "`reboot` \"x\" \\n";
  const std::string script = gnuplot_script(diagram, "fall");
  EXPECT_TRUE(contains(script, "set title 'it''s a_title' . \"\\n\" . '`reboot` \"x\" \\n'"));
}

TEST(GnuplotScript, HasNoCommandThatIsPartOfAName) {
  for (const char* name : {"x\nsystem 'touch pwned'\n#", "x\rsystem 'touch pwned'\r#"}) {
    const std::string script = gnuplot_script(falling_line(), name);
    EXPECT_FALSE(contains(script, "\nsystem")) << script;
    EXPECT_FALSE(contains(script, "\r")) << script;
  }
}

TEST(GnuplotScript, BreaksALineWhereThereIsNoPoint) {
  Diagram diagram = falling_line();
  diagram.series[0].points[1].y = std::nan("");
  EXPECT_TRUE(contains(gnuplot_script(diagram, "fall"), "\n0.001 0.1\n\n0.1 0.002\n"));
}

TEST(GnuplotScript, RefusesWhatCannotBeDrawn) {
  Diagram diagram = falling_line();
  diagram.series[0].points[1].y = 0.0;
  EXPECT_THROW(gnuplot_script(diagram, "fall"), std::invalid_argument);
  diagram.y.logarithmic = false;
  EXPECT_NO_THROW(gnuplot_script(diagram, "fall"));
  diagram.series.clear();
  EXPECT_THROW(gnuplot_script(diagram, "fall"), std::invalid_argument);
}

TEST(WriteDiagram, DrawsBothPictures) {
  if (!find_program("gnuplot")) GTEST_SKIP() << "gnuplot is not installed";
  const TemporaryFolder temporary;
  const StudyFolder folder(temporary / "it's here");
  const DiagramFiles files = write_diagram(folder, "fall", falling_line());
  EXPECT_TRUE(files.drawn);
  EXPECT_EQ(read_text(files.script), gnuplot_script(falling_line(), "fall"));
  EXPECT_TRUE(contains(read_text(folder.path() / "fall.svg"), "a_name"));  // not "a" with a low "n"

  // The first series' colour (#d55e00) is in the picture, and the background is white.
  const render::Image image = render::read_png((folder.path() / "fall.png").string());
  std::set<std::array<int, 3>> colours;
  for (std::size_t i = 0; i + 2 < image.pixels.size(); i += 3) {
    colours.insert({image.pixels[i], image.pixels[i + 1], image.pixels[i + 2]});
  }
  EXPECT_TRUE(colours.contains({0xd5, 0x5e, 0x00}));
  EXPECT_TRUE(colours.contains({255, 255, 255}));
}

TEST(WriteDiagram, DrawsWhateverTextThereIs) {
  if (!find_program("gnuplot")) GTEST_SKIP() << "gnuplot is not installed";
  const TemporaryFolder temporary;
  Diagram diagram = falling_line();
  diagram.title = "100 % of {it} ^ 'x' \"y\" \\ `date` \n $HOME @x";
  diagram.subtitle = diagram.x.label = diagram.series[0].name = diagram.title;
  EXPECT_TRUE(write_diagram(StudyFolder(temporary.path()), "fall", diagram).drawn);
}

TEST(WriteDiagram, ReportsWhatGnuplotSays) {
  if (!find_program("gnuplot")) GTEST_SKIP() << "gnuplot is not installed";
  const TemporaryFolder temporary;
  Diagram diagram = falling_line();
  diagram.commands = {"no_such_command"};
  EXPECT_THROW(write_diagram(StudyFolder(temporary.path()), "fall", diagram), base::IoError);
}

TEST(WriteDiagram, LeavesTheScriptWithoutGnuplot) {
  const TemporaryFolder temporary;
  const std::string path = getenv("PATH");
  setenv("PATH", "/nonexistent", 1);
  const DiagramFiles files =
      write_diagram(StudyFolder(temporary / "a folder"), "fall", falling_line());
  setenv("PATH", path.c_str(), 1);
  EXPECT_FALSE(files.drawn);
  EXPECT_TRUE(std::filesystem::exists(files.script));
  EXPECT_EQ(files.command, "cd '" + (temporary / "a folder").string() + "' && gnuplot fall.gp");
}

}  // namespace
}  // namespace pneuma::app
