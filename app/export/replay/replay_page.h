// The replay page: one HTML file that plays a run in a browser, without a network.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "app/export/replay/recording.h"
#include "app/export/sink/frame_sink.h"

namespace pneuma::app {

std::string replay_page(const Recording& recording);

/// Keeps the run in memory and writes the page in the end.
class ReplaySink : public FrameSink {
 public:
  ReplaySink(const scenes::Scene& scene, const sim::World& start, int threads, CameraEvents events,
             std::filesystem::path file);

  void pass(const Simulation& simulation) override { recorder_.pass(simulation); }
  void add(const Simulation& simulation) override { recorder_.add(simulation); }
  std::optional<SimulatedFrame> take_simulated(std::int64_t frame) override {
    return recorder_.take_simulated(frame);
  }
  std::filesystem::path finish() override;

 private:
  Recorder recorder_;
  std::filesystem::path file_;
};

}  // namespace pneuma::app
