// Frames of a run beside those of an earlier one.
#pragma once

#include <cstdint>
#include <string>

#include "app/host/exit_code.h"
#include "app/render/log/run_folder.h"

namespace pneuma::app {

struct ReferencePictures {
  std::string folder;      // with pictures of the same names; empty: none
  double threshold = 0.0;  // mean difference over all channels of a picture, 0..255
};

/// Before the run, which may take long: throws base::IoError for a picture that is missing, is none
/// or is of another size than the run's.
void check_reference(const RunFolder& run, std::int64_t first, std::int64_t last, int width,
                     int height, const ReferencePictures& reference);

/// Prints the frames that are further from the reference than the threshold, and which of all is
/// furthest. Returns check_failed if there are any. Throws base::IoError for a picture that is
/// missing or of another size.
ExitCode compare_with_reference(const RunFolder& run, std::int64_t first, std::int64_t last,
                                const ReferencePictures& reference);

}  // namespace pneuma::app
