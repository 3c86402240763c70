// `pneuma compare`: where two runs part.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/host/exit_code.h"
#include "app/runs/recorded_run.h"

namespace pneuma::app {

struct CompareRequest {
  std::string first;  // folders
  std::string second;
  std::string out;  // a PNG file; empty: out/compare/A_B.png, by the folders' names
  std::optional<std::int64_t> frame;  // to be shown; by default the first that differs
  bool expect_equal = false;
};

/// A number of the two runs' records in one frame.
struct ComparedNumber {
  std::string name;
  double first = 0.0;
  double second = 0.0;
};

struct RunComparison {
  std::int64_t common_frames = 0;  // that both runs have
  std::int64_t first_common = 0;
  std::int64_t last_common = 0;
  std::int64_t only_first = 0;  // frames that the other run lacks
  std::int64_t only_second = 0;
  std::optional<std::int64_t> state_differs;    // the first frame with another state
  std::optional<std::int64_t> picture_differs;  // with another picture, or one only
  /// Of the effective scenes, those that only one has: "A: body 1, k = 50"; and the cameras of the
  /// first common frame.
  std::vector<std::string> settings;

  bool equal() const { return !state_differs && !picture_differs && only_first + only_second == 0; }
};

/// Throws base::IoError when no frame is common to both.
RunComparison compare_runs(const RecordedRun& first, const RecordedRun& second);

/// Energies, volumes, penetration and contacts of a frame that both have.
std::vector<ComparedNumber> numbers_of(const RecordedRun& first, const RecordedRun& second,
                                       std::int64_t frame);

/// Prints the comparison and writes both pictures side by side with their difference. Throws
/// base::IoError and UsageError.
ExitCode compare_run_folders(const CompareRequest& request);

}  // namespace pneuma::app
