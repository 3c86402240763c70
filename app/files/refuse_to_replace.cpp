#include "app/files/refuse_to_replace.h"

#include <fmt/format.h>

#include <system_error>

#include "sim/base/file.h"

namespace pneuma::app {

namespace fs = std::filesystem;

void refuse_to_replace(const fs::path& file, const std::string& other_place) {
  std::error_code ignored;
  // A link that leads nowhere is there, too.
  if (!fs::exists(fs::symlink_status(file, ignored))) return;
  throw base::IoError(fmt::format("{} is there already; replace it with --overwrite, or {}",
                                  file.string(), other_place));
}

void refuse_to_replace(const fs::path& folder, const std::vector<std::string>& files,
                       const std::string& other_place) {
  for (const std::string& file : files) refuse_to_replace(folder / file, other_place);
}

}  // namespace pneuma::app
