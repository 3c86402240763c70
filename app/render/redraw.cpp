#include "app/render/redraw.h"

#include <fmt/format.h>

#include <filesystem>
#include <iterator>

#include "app/host/interrupt.h"
#include "app/record/world_json.h"
#include "app/terminal/table.h"
#include "render/image/png.h"
#include "sim/base/file.h"
#include "sim/inspect/inspect.h"

namespace pneuma::app {
namespace {

void draw(const Simulation& simulation, const render::Camera& camera, const Show& show,
          const FrameOutput& output, const std::filesystem::path& file) {
  render::Image image;
  output.renderer.draw(output.builder.build(simulation.world(), camera, simulation.contacts(),
                                            output.fields.with_end(show)),
                       image);
  base::write_file_atomically(file.string(), render::encode_png(image));
}

void require_state(const Simulation& simulation, const Json& line, const RunFolder& folder) {
  if (line.value("state_hash", "") == hex(sim::state_hash(simulation.world()))) return;
  throw base::IoError(
      fmt::format("{}: frame {} comes to another state than its record says; draw the run again "
                  "with --overwrite",
                  folder.path().string(), simulation.frame()));
}

}  // namespace

void redraw_lost(Simulation& simulation, const FrameOutput& output, Progress& progress) {
  const RunFolder& folder = output.log.folder();
  for (const Json& line : output.log.lost()) {
    const auto frame = line.at("frame").get<std::int64_t>();
    while (simulation.frame() < frame) {
      throw_if_interrupted();
      progress.show(fmt::format("stepping to the lost frame {}: t = {:.2f} s", frame,
                                sim::time(simulation.world())));
      output.camera.see(simulation.world());
      output.fields.see(simulation.world());
      simulation.advance_frame();
    }
    require_state(simulation, line, folder);
    const render::Camera camera = output.camera.at(simulation.world());
    output.fields.see(simulation.world());
    draw(simulation, camera, output.pictures.show, output, folder.frame(frame));
    if (output.pictures.overlay) {
      draw(simulation, camera, *output.pictures.overlay, output, folder.overlay(frame));
    }
  }
  progress.say(counted(std::ssize(output.log.lost()), "lost picture") + " drawn again");
}

}  // namespace pneuma::app
