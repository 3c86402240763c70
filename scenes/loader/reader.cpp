#include "scenes/loader/reader.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "scenes/loader/assign.h"
#include "scenes/loader/other_names.h"
#include "scenes/loader/sections.h"
#include "scenes/loader/tables.h"
#include "sim/base/nearest.h"

namespace pneuma::scenes {
namespace {

/// A key that earlier versions called otherwise; its meaning and its values are the same.
struct RenamedKey {
  std::string_view table, before, now;
};
constexpr std::array<RenamedKey, 3> renamed_keys = {{
    {"simulation", "separation_time", "relaxation_time"},
    {"simulation", "impulse_sweeps", "contact_iterations"},
    {"body", "pressure", "pressure_weighting"},
}};

const RenamedKey* find_renamed(std::string_view table, std::string_view key) {
  const auto found = std::find_if(
      renamed_keys.begin(), renamed_keys.end(),
      [&](const RenamedKey& renamed) { return renamed.table == table && renamed.before == key; });
  return found == renamed_keys.end() ? nullptr : &*found;
}

/// For the last part of a dotted key: "; did you mean 'motion.path'?", or nothing.
std::string whole_name(const std::string& part, const std::vector<std::string_view>& allowed) {
  const auto whole = std::ranges::find_if(
      allowed, [&](std::string_view key) { return key.ends_with("." + part); });
  return whole == allowed.end() ? std::string() : fmt::format("; did you mean '{}'?", *whole);
}

/// For a key that is known, but in another table: "; it belongs in [camera]", or nothing. What
/// joins bodies is thought of last.
std::string belongs_elsewhere(std::string_view key) {
  const Section* found = nullptr;
  for (const Section& section : default_sections()) {
    const bool here = std::any_of(section.keys.begin(), section.keys.end(),
                                  [&](const Key& known) { return known.name == key; });
    const bool joins = is_listed(section.table) && section.table != "body";
    if (!here || (joins && found != nullptr)) continue;
    found = &section;
    if (!joins) break;
  }
  return found == nullptr ? std::string() : fmt::format("; it belongs {}", place_of(found->table));
}

/// "simulation" of "simulation.particles"; of a table at the top itself.
std::string_view table_around(std::string_view table) { return table.substr(0, table.find('.')); }

/// "suply.n" of a table that no body has: its keys are not the body's then.
std::string dotted_name(const Member& member) {
  const Table* inner = std::get_if<Table>(&member.value.data);
  if (inner == nullptr || inner->empty()) return member.key;
  return fmt::format("{}.{}", member.key, inner->front().key);
}

bool overridden(const Table& table, const Section& section) {
  return std::any_of(section.keys.begin(), section.keys.end(), [&](const Key& key) {
    const Member* member = key.selects ? find(table, key.name) : nullptr;
    return member != nullptr && member->value.at.override_index >= 0;
  });
}

}  // namespace

void Reader::read_selectors(const Table& table, const Section& section) {
  for (const Key& key : section.keys) {
    const Member* member = key.selects ? find(table, key.name) : nullptr;
    if (member != nullptr) read_key(key, *member);
  }
}

void Reader::read_others(const Table& table, const Section& section,
                         const std::vector<std::string_view>& children) {
  const bool overridden_here = overridden(table, section);
  if (overridden_here) selected_by_override_.insert(section.table);
  const std::string_view around = table_around(section.table);
  const bool selectors_overridden =
      overridden_here || (around != section.table && selected_by_override_.contains(around));
  const bool selector_refused = std::ranges::any_of(section.keys, [&](const Key& key) {
    return key.selects && refused_.contains(member_of(key.slot));
  });
  std::vector<const Member*> silenced;
  for (const Member& member : table) {
    if (std::find(children.begin(), children.end(), member.key) != children.end()) continue;
    const auto key = std::find_if(section.keys.begin(), section.keys.end(),
                                  [&](const Key& known) { return known.name == member.key; });
    if (key == section.keys.end()) {
      refuse_unknown(section, member, children);
    } else if (!key->applies) {
      if (selector_refused) continue;  // by its right value the key may apply
      const bool from_file = member.value.at.override_index < 0;
      if (selectors_overridden && from_file) {
        if (!given_rival(section, *key)) silenced.push_back(&member);
        continue;
      }
      if (!is_idle(section, *key, member)) refuse_inapplicable(section, *key, member);
    } else if (!key->selects) {
      read_key(*key, member);
    }
  }
  warn_of_silenced(section, silenced);
}

void Reader::read_key(const Key& key, const Member& member) {
  const void* target = member_of(key.slot);
  origins_[target] = member.value.at;
  if (member.value.at.override_index >= 0) used_overrides_.insert(member.value.at.override_index);
  if (const auto complaint = assign(key, member.value)) {
    // What was read before the kind of body was known is read again.
    const bool is_first = refused_members_.insert(&member).second;
    if (is_first) report_.add(complaint->at, complaint->message);
    refused_.insert(target);
  }
}

bool Reader::is_idle(const Section& section, const Key& key, const Member& member) {
  const bool from_file = member.value.at.override_index < 0;
  if (!from_file || key.decided_by == nullptr || origins_.contains(key.decided_by)) return false;
  report_.warn(member.at, fmt::format("{} has no effect: it applies to {} only; this is {}",
                                      key.name, key.only_for, section.what));
  return true;
}

const Key* Reader::given_rival(const Section& section, const Key& key) const {
  const auto is_given = [&](const Key& other) {
    const void* member = member_of(other.slot);
    return std::ranges::find(key.rivals, member) != key.rivals.end() && has_origin(member);
  };
  const auto found = std::ranges::find_if(section.keys, is_given);
  return found == section.keys.end() ? nullptr : &*found;
}

void Reader::warn_of_silenced(const Section& section, const std::vector<const Member*>& silenced) {
  if (section.table != "body" || silenced.empty()) return;
  std::vector<std::string_view> names;
  for (const Member* member : silenced) names.push_back(member->key);
  report_.warn(silenced.front()->at, fmt::format("no effect of {}: --set has made this {}",
                                                 fmt::join(names, ", "), section.what));
}

void Reader::refuse_inapplicable(const Section& section, const Key& key, const Member& member) {
  const std::string only_for = fmt::format("{} applies to {} only", key.name, key.only_for);
  if (member.where_it_applies) {
    idle_overrides_[member.value.at.override_index] =
        fmt::format("{}, and this scene has none", only_for);
  } else if (const Key* rival = given_rival(section, key)) {
    report_.add(member.at, fmt::format("both {} and {} ({}) are given; drop one of the two",
                                       key.name, rival->name, where(member_of(rival->slot))));
  } else {
    report_.add(member.at, fmt::format("{}; this is {}{}{}", only_for, section.what,
                                       key.made_one_by.empty() ? "" : "; write ", key.made_one_by));
  }
}

void Reader::refuse_unknown(const Section& section, const Member& member,
                            const std::vector<std::string_view>& children) {
  if (const RenamedKey* renamed = find_renamed(section.table, member.key)) {
    report_.add(member.at, fmt::format("{0}.{1} is now {0}.{2}", renamed->table, renamed->before,
                                       renamed->now));
    return;
  }
  with_unknown_.insert(section.table);
  if (section.table.empty() && holds_tables(member.value)) {
    report_.add(member.at, fmt::format("unknown table {}{}", base::in_quotes(member.key),
                                       table_suggestion(member.key)));
    return;
  }
  std::vector<std::string_view> allowed;
  for (const Key& key : section.keys) {
    if (key.applies) allowed.push_back(key.name);
  }
  allowed.insert(allowed.end(), children.begin(), children.end());
  std::string hint = whole_name(member.key, allowed);
  if (hint.empty()) hint = belongs_elsewhere(member.key);
  const std::vector<std::string_view>& tables = table_names();
  if (hint.empty() && section.table == "body" &&
      std::ranges::find(tables, member.key) != tables.end()) {
    hint = fmt::format("; a table of the scene: write it above the first [[body]], or as [{}]",
                       member.key);
  }
  if (hint.empty()) hint = meant_key(member.key);
  const bool belongs_here = hint.empty();
  const std::string name =
      belongs_here && section.table == "body" ? dotted_name(member) : member.key;
  if (belongs_here) hint = base::suggestion_and_all(name, allowed);
  report_.add(member.at, fmt::format("unknown key {} {}{}", base::in_quotes(name),
                                     place_of(section.table), hint));
}

void Reader::report_idle_overrides() {
  for (const auto& [index, message] : idle_overrides_) {
    if (used_overrides_.count(index) == 0) report_.add({0, 0, index}, message);
  }
}

bool Reader::valid(std::initializer_list<const void*> members) const {
  return std::none_of(members.begin(), members.end(),
                      [&](const void* member) { return refused_.count(member) > 0; });
}

std::string Reader::where(const void* member) const {
  const Origin at = origin({member}, whole_file);
  return at.override_index < 0 ? fmt::format("line {}", at.line) : report_.place(at).file;
}

Origin Reader::origin(std::initializer_list<const void*> members, Origin otherwise) const {
  for (const void* member : members) {
    const auto found = origins_.find(member);
    if (found != origins_.end()) return found->second;
  }
  return otherwise;
}

}  // namespace pneuma::scenes
