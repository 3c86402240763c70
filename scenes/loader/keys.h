// What a key of a scene file is: the member it sets, what it accepts, unit and meaning.
#pragma once

#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "scenes/loader/scene.h"

namespace pneuma::scenes {

/// The numbers a key accepts; of an array's key, each element.
struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_open = false;       // low itself is refused
  bool high_open = false;      // high itself is refused
  std::vector<int> only = {};  // when not empty, nothing but these

  bool contains(double value) const;
  /// "0 <= rho_g < 1", "samples = 1, 2 or 4"; empty when every finite number is accepted.
  std::string text(std::string_view name) const;
};

/// A member that holds one of a few words: an enumeration.
struct Word {
  const void* member = nullptr;
  std::vector<std::string_view> words;
  std::function<std::size_t()> get;  // an index into words
  std::function<void(std::size_t)> set;
};

/// The member that a key sets. An optional surface is set by a boolean: there or not. Nothing when
/// the key does not apply and its member does not exist.
using Slot =
    std::variant<std::monostate, double*, int*, std::uint64_t*, bool*, std::string*, Vec3*,
                 std::optional<int>*, std::optional<double>*, std::optional<Vec3>*,
                 std::array<int, 3>*, std::vector<std::string>*, std::vector<sim::KeyFrame>*,
                 std::vector<Region>*, std::vector<TimedValue>*, std::vector<CameraKey>*,
                 std::optional<sim::ContactMaterial>*, Word>;

/// The address that identifies a slot's member.
const void* member_of(const Slot& slot);

/// What a slot takes, in words: "3 numbers".
std::string type_text(const Slot& slot);

/// A slot's value as TOML; empty for an optional member without a value.
std::string value_text(const Slot& slot);

/// Why a text is refused; empty when it is accepted.
using TextCheck = std::string (*)(std::string_view text);

struct Key {
  std::string_view name;
  Slot slot;
  Range range = {};
  std::string_view unit = {};  // of each number, but of times before them; empty: none
  std::string_view meaning;
  TextCheck check = nullptr;          // of strings
  std::string_view only_for = {};     // "soft bodies"; empty: for all
  std::string_view made_one_by = {};  // "shape = \"torus\"": what makes the struct at hand such
  bool applies = true;                // to the struct at hand
  bool of_shape = false;              // decides a soft body's mesh
  bool of_method = false;             // set by simulation.method = "paper", and refused beside it
  const void* decided_by = nullptr;   // the member that decides whether the key applies, where a
                                      // file's key is only idle while that is not written
  std::vector<const void*> rivals = {};  // members that say the same otherwise, in place of the key
  bool selects = false;                  // decides which other keys apply, so it is read first
  bool or_number = false;  // a string's key that also takes a whole number as its digits
};

/// Of the times that rows of values begin with.
inline constexpr std::string_view time_unit = "s";

/// The units of all that a key takes: "s, mol" of rows of a time and an amount; empty: none.
std::string units_text(const Key& key);

/// One table of a scene file.
struct Section {
  std::string_view
      table;         // "", "simulation", "simulation.particles", ..., "valve", "spring", "body"
  std::string what;  // "a soft sphere": what decides which keys apply
  std::vector<Key> keys;
};

/// Whether a scene may have several of it, each written [[NAME]].
bool is_listed(std::string_view table);

/// "[camera]", "[[body]]": the line that starts a table.
std::string header_of(std::string_view table);

/// "in [camera]", "in [[body]]", "at the top, above the first [table]".
std::string place_of(std::string_view table);

}  // namespace pneuma::scenes
