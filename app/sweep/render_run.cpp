#include "app/sweep/render_run.h"

#include <fmt/format.h>

#include <string_view>
#include <vector>

#include "app/host/own_program.h"
#include "app/host/run_command.h"
#include "app/terminal/number_text.h"

namespace pneuma::app {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view run_prefix = "run_";

}  // namespace

fs::path picture_folder(const fs::path& folder, std::int64_t run) {
  return folder / "pictures" / fmt::format("{}{}", run_prefix, run);
}

void remove_pictures(const fs::path& folder) {
  const fs::path pictures = folder / "pictures";
  if (!fs::is_directory(pictures)) return;
  std::vector<fs::path> runs;
  for (const fs::directory_entry& entry : fs::directory_iterator(pictures)) {
    const std::string name = entry.path().filename().string();
    const bool is_run = name.starts_with(run_prefix) &&
                        whole_number(std::string_view(name).substr(run_prefix.size()));
    if (is_run) runs.push_back(entry.path());
  }
  for (const fs::path& run : runs) fs::remove_all(run);
  if (fs::is_empty(pictures)) fs::remove(pictures);
}

void render_run(const Sweep& sweep, const SweepRun& run, const std::string& frames,
                const fs::path& into) {
  std::vector<std::string> arguments = {"pneuma",      "render",   run.scene_path, "--out",
                                        into.string(), "--resume", "--quiet"};
  if (!frames.empty()) arguments.insert(arguments.end(), {"--frames", frames});
  for (const std::string& override : run.overrides(sweep)) {
    arguments.insert(arguments.end(), {"--set", override});
  }
  run_command(own_program(), arguments);
}

}  // namespace pneuma::app
