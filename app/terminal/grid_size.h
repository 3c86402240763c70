// "COLUMNSxROWS", as --size and --sheet have it.
#pragma once

#include <string>
#include <vector>

namespace pneuma::app {

struct GridSize {
  int columns = 0;
  int rows = 0;
};

/// "4x3". Throws UsageError. Each from 1 to `greatest`; `option` is named in messages.
GridSize parse_grid(const std::string& option, const std::string& text, int greatest);

/// The size of pictures in pixels, "640x480", as what --set would say: the scene stays the one
/// place that has it, and so does a run's record. Throws UsageError.
void append_size(const std::string& size, std::vector<std::string>& overrides);

}  // namespace pneuma::app
