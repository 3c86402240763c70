// The folder that a study leaves its files in: CSV, JSON, diagrams.
#pragma once

#include <filesystem>
#include <string>

namespace pneuma::app {

class StudyFolder {
 public:
  /// Makes the folder where it is missing, so that what cannot be written is known before anything
  /// is measured. Throws base::IoError.
  explicit StudyFolder(std::filesystem::path folder);

  const std::filesystem::path& path() const { return folder_; }

  /// Writes a whole file or nothing, in place of an older one, and returns its path. Throws
  /// base::IoError.
  std::filesystem::path write(const std::string& name, const std::string& text) const;

 private:
  std::filesystem::path folder_;
};

}  // namespace pneuma::app
