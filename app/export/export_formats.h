// What `pneuma export --format` takes, and where each puts the frames.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string_view>

#include "app/export/sink/frame_sink.h"
#include "app/terminal/progress.h"
#include "scenes/loader/scene.h"

namespace pneuma::app {

/// What is to be exported, and where to.
struct ExportJob {
  const scenes::Scene& scene;
  const sim::World& start;
  std::int64_t frames;  // how many
  std::filesystem::path folder;
  int threads;
  Progress& progress;
};

struct ExportFormat {
  std::string_view name;
  bool animated;           // what --animated chooses: all frames in one file, or in two
  bool written_last;       // all files at once, from finish()
  bool shows_particles;    // which then walk in every step
  std::string_view files;  // of a scene: what follows its name, as a regular expression
  /// Throws UsageError when they are too much for it.
  std::unique_ptr<FrameSink> (*open)(const ExportJob& job);
};

std::span<const ExportFormat> export_formats();

/// Throws UsageError when there is no such format.
const ExportFormat& export_format(std::string_view name, bool animated);

}  // namespace pneuma::app
