#include "app/render/turntable.h"

#include <fmt/format.h>

#include "app/host/interrupt.h"
#include "app/picture/camera_motion.h"
#include "render/image/png.h"
#include "sim/base/file.h"

namespace pneuma::app {

RunFolder turntable_folder(const RunFolder& run) {
  return RunFolder(run.path() / "turntable", run.name());
}

void draw_turntable(const Simulation& simulation, const render::Camera& camera,
                    const FrameBuilder& builder, const Show& show, int pictures,
                    const RunFolder& folder, render::Renderer& renderer, Progress& progress) {
  render::Frame frame = builder.build(simulation.world(), camera, simulation.contacts(), show);
  render::Image image;
  for (int i = 0; i < pictures; ++i) {
    throw_if_interrupted();
    frame.camera = turned(camera, 360.0 * i / pictures);
    renderer.draw(frame, image);
    base::write_file_atomically(folder.frame(i).string(), render::encode_png(image));
    progress.show(fmt::format("turntable: {} of {} pictures", i + 1, pictures));
  }
}

}  // namespace pneuma::app
