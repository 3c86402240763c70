#include "app/study/study_folder.h"

#include <cstdint>
#include <span>
#include <utility>

#include "app/render/log/run_folder.h"
#include "sim/base/file.h"

namespace pneuma::app {

StudyFolder::StudyFolder(std::filesystem::path folder) : folder_(std::move(folder)) {
  RunFolder(folder_, "study").make();
}

std::filesystem::path StudyFolder::write(const std::string& name, const std::string& text) const {
  std::filesystem::path path = folder_ / name;
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(text.data());
  base::write_file_atomically(path.string(), std::span(bytes, text.size()));
  return path;
}

}  // namespace pneuma::app
