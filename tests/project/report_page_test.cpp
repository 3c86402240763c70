// The script of the report's page, in a real browser: tables are read and sorted, diagrams tell
// their values.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <sstream>
#include <string>

#include "tests/support/paths.h"
#include "tests/support/temporary_folder.h"

namespace pneuma {
namespace {

constexpr const char* body = R"(
<nav id="contents"></nav>
<h2>One part</h2>
<section class="printed"><details><summary>command</summary><pre>
What it means.

       -- speed, m/s --
scene    first   second
-----  -------  -------
b        1,200     1/60
a       2.5x        7 %
         &gt; 1
c            -     3e-5

- a finding
</pre></details></section>
<figure class="diagram"><img alt=""><script type="text/x-gnuplot">
$series0 << END
1 10
100 1000
END
set title 'A diagram' noenhanced
set xlabel 'size' noenhanced
set xrange [*:*]
set logscale x
set ylabel 'time, s' noenhanced
set yrange [0:*]
plot $series0 using 1:2 with linespoints lw 2 dt 1 lc rgb '#d55e00' pt 7 ps 0.8 title 'ours' noenhanced
set terminal pngcairo
</script></figure>
)";

constexpr const char* questions = R"(
const rows = (column) => [...document.querySelectorAll("tbody tr")].map((row) => row.cells[column].textContent);
const say = (...words) => console.log(`said: ${words.join(" ")}`);
say(...[...document.querySelectorAll("th")].map((head) => JSON.stringify(head.textContent)));
say(JSON.stringify(rows(1)[1]), document.querySelectorAll("p.text").length);
const heads = document.querySelectorAll("th button");
heads[1].click();
say(...rows(0));
heads[2].click();
say(...rows(0));
heads[2].click();
say(...rows(0));
say(document.querySelector("nav a").textContent);
const svg = document.querySelector("figure svg"), box = svg.getBoundingClientRect();
const dots = svg.querySelectorAll("circle"), scale = box.width / svg.viewBox.baseVal.width;
svg.dispatchEvent(new PointerEvent("pointermove", { clientX: box.left + scale * dots[1].getAttribute("cx"),
  clientY: box.top + scale * dots[1].getAttribute("cy") }));
say(JSON.stringify(document.querySelector(".value").textContent));
)";

TEST(LongReportPage, ReadsTablesAndDiagrams) {
  if (std::system("command -v chromium >/dev/null") != 0)
    GTEST_SKIP() << "chromium is not installed";
  const TemporaryFolder folder;
  const auto page = folder / "page.html";
  write_text(page,
             fmt::format("<!doctype html><body>{}<script>{}{}</script>", body,
                         read_text(project_folder() / "scripts/report.d/page.js"), questions));
  const std::string command = fmt::format(
      "chromium --headless=new --no-sandbox --disable-gpu --window-size=900,900 "
      "--enable-logging=stderr "
      "--user-data-dir='{}' --screenshot='{}' 'file://{}' 2>'{}'",
      (folder / "profile").string(), (folder / "shown.png").string(), page.string(),
      (folder / "log").string());
  ASSERT_EQ(std::system(command.c_str()), 0) << read_text(folder / "log");
  std::string said;
  std::istringstream lines(read_text(folder / "log"));
  for (std::string line; std::getline(lines, line);) {
    if (line.find("CONSOLE") == std::string::npos) continue;
    const std::size_t begin = line.find("said: ");
    ASSERT_NE(begin, std::string::npos) << line;
    said += line.substr(begin + 6, line.rfind("\", source") - begin - 6) + '\n';
  }
  EXPECT_EQ(said,
            "\"scene\" \"speed, m/s\\nfirst\" \"speed, m/s\\nsecond\"\n"
            "\"2.5x\\n> 1\" 2\n"
            "a b c\n"
            "c b a\n"
            "a b c\n"
            "One part\n"
            "\"ours\\nsize: 100\\ntime, s: 1000\"\n");
}

}  // namespace
}  // namespace pneuma
