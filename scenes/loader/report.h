// Collects the errors of one scene.
#pragma once

#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/loader/load_scene.h"

namespace pneuma::scenes {

/// Where something was written: a place in the file, or an override.
struct Origin {
  int line = 0;
  int column = 0;
  int override_index = -1;     // -1: in the file
  bool of_whole_file = false;  // the line is a place to jump to and not to blame
};

/// What no line of the file is to blame for.
inline constexpr Origin whole_file = {1, 1, -1, true};

/// A text that is not the TOML of a scene file.
struct SyntaxError : std::runtime_error {
  SyntaxError(Origin origin, const std::string& message)
      : std::runtime_error(message), at(origin) {}
  Origin at;
};

class Report {
 public:
  /// `text`, the file's, and `overrides` must outlive the report.
  Report(std::string file, std::string_view text, std::span<const std::string> overrides);

  void add(Origin origin, std::string message);
  /// What is no error.
  void warn(const Origin& origin, std::string message);
  /// As "file:line:column: message", in the order in which they came.
  const std::vector<std::string>& warnings() const { return warnings_; }
  bool empty() const { return entries_.empty(); }
  bool blames_override(int override_index) const;
  Place place(const Origin& origin) const;

  /// Throws SceneError with everything added, in order, the first of each override, if anything
  /// was.
  void throw_errors();

 private:
  struct Entry {
    Origin origin;
    std::string message;
  };

  std::string file_;
  std::string_view text_;
  std::span<const std::string> overrides_;
  std::vector<Entry> entries_;
  std::vector<std::string> warnings_;
};

/// Errors that come up one by one after a scene was loaded, such as those of its models.
class Refusals {
 public:
  /// Does the work, and keeps what it throws as SceneError.
  template <class Work>
  void attempt(const Work& work) {
    try {
      work();
    } catch (const SceneError& error) {
      add(error);
    }
  }

  /// Throws SceneError with all of them in the order of the file, if there are any.
  void throw_errors();

 private:
  void add(const SceneError& error);

  std::vector<Diagnostic> diagnostics_;
};

}  // namespace pneuma::scenes
