// Tables of a document into the structs of a scene.
#pragma once

#include <functional>
#include <initializer_list>
#include <map>
#include <set>
#include <string_view>
#include <vector>

#include "scenes/loader/document.h"
#include "scenes/loader/keys.h"

namespace pneuma::scenes {

/// Reads sections, and remembers where each member's value was written. Members are known by their
/// addresses, so the scene must stay where it is.
class Reader {
 public:
  explicit Reader(Report& report) : report_(report) {}

  /// The keys that decide which others apply. Make the section again afterwards.
  void read_selectors(const Table& table, const Section& section);

  /// All other keys. `children` are the tables within this one. A key that does not apply is an
  /// error, unless an override of this table's selectors is what made it so, or of those of the
  /// table around it, which is read before. It is idle, with a warning, where the file does not
  /// write what decides about it (Key::decided_by).
  void read_others(const Table& table, const Section& section,
                   const std::vector<std::string_view>& children = {});

  /// Overrides of every body to which a key applies, that met none.
  void report_idle_overrides();

  /// False when the value of one of the members was refused: checks across keys then say nothing.
  bool valid(std::initializer_list<const void*> members) const;

  /// Whether a key of the table was refused because there is none of its name.
  bool has_unknown(std::string_view table) const { return with_unknown_.contains(table); }

  /// Whether the member was given a value.
  bool has_origin(const void* member) const { return origins_.contains(member); }

  /// Where the member got its value, as words in a line: "line 3", "--set body.n=1".
  std::string where(const void* member) const;

  /// Where the first of the members that was given a value got it; `otherwise` when none was.
  Origin origin(std::initializer_list<const void*> members, Origin otherwise) const;

 private:
  void read_key(const Key& key, const Member& member);
  /// Whether it is a key of the file that the default makes idle; then warns of it.
  bool is_idle(const Section& section, const Key& key, const Member& member);
  /// What the file or an override gives in place of the key; null: nothing.
  const Key* given_rival(const Section& section, const Key& key) const;
  /// Of the keys of a body's file that an override made idle, but those that it replaces.
  void warn_of_silenced(const Section& section, const std::vector<const Member*>& silenced);
  void refuse_inapplicable(const Section& section, const Key& key, const Member& member);
  void refuse_unknown(const Section& section, const Member& member,
                      const std::vector<std::string_view>& children);

  Report& report_;
  std::map<const void*, Origin> origins_;
  std::set<const void*> refused_;              // by the scene's members
  std::set<const Member*> refused_members_;    // by the document's
  std::map<int, std::string> idle_overrides_;  // the message if it stays idle
  std::set<int> used_overrides_;
  std::set<std::string_view> selected_by_override_;  // tables
  std::set<std::string_view> with_unknown_;          // tables
};

}  // namespace pneuma::scenes
