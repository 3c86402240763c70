#include "app/sweep/render_run.h"

#include <fmt/format.h>

#include <vector>

#include "app/host/own_program.h"
#include "app/host/run_command.h"

namespace pneuma::app {

namespace fs = std::filesystem;

fs::path picture_folder(const fs::path& folder, std::int64_t run) {
  return folder / "pictures" / fmt::format("run_{}", run);
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
