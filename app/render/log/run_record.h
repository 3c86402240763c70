// What a run writes down: once, per launch, and per frame. A journal has it line by line, run.json
// as a whole.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/picture/build_frame.h"
#include "app/picture/field_scale.h"
#include "app/render/log/journal.h"
#include "app/terminal/frame_range.h"
#include "app/world/simulation.h"
#include "render/frame/camera.h"
#include "scenes/loader/scene.h"

namespace pneuma::app {

/// Seconds that one frame took, outside the stages of its steps.
struct FrameSeconds {
  double mesh = 0.0;  // while the frame before is drawn
  double draw = 0.0;
  double png = 0.0;
  double write = 0.0;
  double total = 0.0;  // since the frame before was drawn; the last frame's png and write go on
  // For which the first frame of a launch waited until an automatic camera had looked ahead; not in
  // the total.
  std::optional<double> look_ahead;
};

/// Sizes of a frame's files, by which a run that is continued knows them to be whole.
struct PictureBytes {
  std::size_t frame = 0;
  std::optional<std::size_t> overlay;
};

/// What decides the bytes of a run's frames. Only a run of the same identity can be continued (but
/// see resume.h).
struct RunIdentity {
  const scenes::Scene& scene;
  const sim::World& start;  // the scene's world, in which its models are
  Frames frames;
  Pictures pictures;
  OnDivergence on_divergence = OnDivergence::automatic;
  std::string gl;  // what draws
};

Json identity_json(const RunIdentity& run);

/// The first line of a journal.
Json run_header(const Json& identity, const scenes::Scene& scene);

/// What a frame is seen with.
struct FrameCamera {
  render::Camera camera;
  std::optional<render::ViewFit::Seen> seen;  // see RunCamera
  FieldScale::Seen fields = {};
};

/// What an automatic camera had seen up to a frame's line, exactly as it was; none of another
/// camera. Throws base::IoError when it cannot be read.
std::optional<render::ViewFit::Seen> seen_in(const Json& line);

/// The greatest values up to a frame's line of what its pictures show as colours.
FieldScale::Seen fields_in(const Json& line);

/// A line per time that the run is started or continued: where, when and how. `video`: the whole
/// path of that which it is to make; empty: none.
Json launch_line(const std::vector<std::string>& command_line, const std::string& video,
                 int threads, std::int64_t from);

/// That the run has come to a step that diverges.
Json divergence_line(const std::string& message);

/// That a run that diverged, for this `reason`, goes on with other settings from a frame on: what
/// of its header is different then.
Json change_line(const Json& identity, const scenes::Scene& scene, std::int64_t from,
                 const std::string& reason);

/// The header as the last change has left it.
Json present_header(const JournalContents& journal);

/// What a line says of a frame's state, taken before the simulation goes on.
struct FrameState {
  Json line;
  Json stage_seconds;
  std::string bodies_that_cross;  // the first two, "torus and cube.3"; beyond a touch; empty: none
  std::string crosses_itself;     // the first body that does; empty: none
};

/// Of the present frame; with the parts of the steps that were done in parts, if any.
FrameState frame_state(const Simulation& simulation, const FrameCamera& camera);

/// The whole line, once the frame's files are there.
Json frame_line(FrameState state, const PictureBytes& bytes, const FrameSeconds& seconds);

/// run.json.
Json whole_record(const JournalContents& journal);

}  // namespace pneuma::app
