// Collects the errors of one scene.
#pragma once

#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "scenes/load_scene.h"

namespace pneuma::scenes {

/// Where something was written: a place in the file, or an override.
struct Origin {
  int line = 0;
  int column = 0;
  int override_index = -1;  // -1: in the file
};

/// A text that is not the TOML of a scene file.
struct SyntaxError : std::runtime_error {
  SyntaxError(Origin origin, const std::string& message)
      : std::runtime_error(message), at(origin) {}
  Origin at;
};

class Report {
 public:
  /// `overrides` must outlive the report.
  Report(std::string file, std::span<const std::string> overrides);

  void add(Origin origin, std::string message);
  bool empty() const { return entries_.empty(); }
  bool blames_override(int override_index) const;

  /// Throws SceneError with everything added, in order, the first of each override, if anything
  /// was.
  void throw_errors();

 private:
  struct Entry {
    Origin origin;
    std::string message;
  };
  Diagnostic diagnostic(const Entry& entry) const;

  std::string file_;
  std::span<const std::string> overrides_;
  std::vector<Entry> entries_;
};

}  // namespace pneuma::scenes
