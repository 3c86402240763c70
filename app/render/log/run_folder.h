// The files of a run:
//   NAME_00042.png          frames
//   NAME_overlay_00042.png  their second pictures, with particles, contacts or wireframe
//   NAME_sheet.png          contact sheet
//   run.json                the record of a finished run
//   NAME.journal            the record of an unfinished run, a line per frame
//   NAME.state              the state of the world at an unfinished run's last frame; a finished
//   run
//                           keeps none: for more frames it is stepped again from the start
// and, for moments, any of these with ".NUMBER-NUMBER.tmp" after it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace pneuma::app {

class RunFolder {
 public:
  RunFolder(std::filesystem::path folder, std::string name);

  const std::filesystem::path& path() const { return folder_; }
  const std::string& name() const { return name_; }

  std::filesystem::path frame(std::int64_t index) const;
  std::filesystem::path overlay(std::int64_t index) const;
  std::filesystem::path sheet() const { return folder_ / (name_ + "_sheet.png"); }
  std::filesystem::path scene() const { return folder_ / (name_ + ".toml"); }
  std::filesystem::path record() const { return folder_ / "run.json"; }
  std::filesystem::path journal() const { return folder_ / (name_ + ".journal"); }
  std::filesystem::path state() const { return folder_ / (name_ + ".state"); }

  /// Makes the folder where it is missing. Throws base::IoError when that fails or no file can be
  /// made in it.
  void make() const;

  /// The names of all runs, finished or not, that the folder has a record or journal of.
  std::vector<std::string> runs() const;
  /// Files that are called as this run's pictures, in their order.
  std::vector<std::string> pictures() const;

  /// Removes the files of all of those runs: of their pictures those frames that record or journal
  /// name, and sheets. Throws base::IoError.
  void remove_runs() const;

  /// Removes what killed runs of this name left half written.
  void remove_temporary_files() const;

 private:
  std::filesystem::path folder_;
  std::string name_;
};

/// Whether a file of that name belongs to the run `run`, run.json aside.
bool is_file_of_run(const std::string& file, const std::string& run);

/// `file` without the ending that a file has while it is written; empty when it has none.
std::string without_temporary_ending(const std::string& file);

}  // namespace pneuma::app
