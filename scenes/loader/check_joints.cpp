#include "scenes/loader/check_joints.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <string_view>
#include <vector>

#include "sim/base/nearest.h"

namespace pneuma::scenes {
namespace {

/// Names in a message.
constexpr std::size_t most_ends_named = 10;

/// As the copies of a body are called: by its name, or by NAME.NUMBER where there are several.
std::string copy_name(const BodyScene& body, std::int64_t index) {
  return copy_count(body) == 1 ? body.name : fmt::format("{}.{}", body.name, index + 1);
}

/// Counts no copies, of which a scene that is refused may have any number.
bool is_copy(const BodyScene& body, std::string_view name) {
  if (copy_count(body) == 1) return name == body.name;
  const std::string_view number = name.substr(std::min(body.name.size() + 1, name.size()));
  std::int64_t index = 0;
  std::from_chars(number.data(), number.data() + number.size(), index);
  return index >= 1 && index <= copy_count(body) && name == copy_name(body, index - 1);
}

class JointChecks {
 public:
  JointChecks(const Scene& scene, const Reader& reader, Report& report)
      : scene_(scene), reader_(reader), report_(report) {
    knows_names_ = std::ranges::all_of(scene.bodies, [&](const BodyScene& body) {
      return reader_.valid({&body.name, &body.kind, &body.shape, &body.copies});
    });
  }

  void run() {
    for (std::size_t i = 0; i < scene_.valves.size(); ++i) check_valve(i);
    for (std::size_t i = 0; i < scene_.springs.size(); ++i) {
      what_ = fmt::format("spring {}", i + 1);
      const SpringScene& spring = scene_.springs[i];
      find_ends(spring.from, spring.to, "vertices for a spring",
                "name a soft body, or a static or moved one of another shape, as shape = "
                "\"icosphere\"");
    }
  }

 private:
  /// Two bodies, or none where something is wrong with one of them.
  struct Ends {
    const BodyScene* from = nullptr;
    const BodyScene* to = nullptr;
  };

  void check_valve(std::size_t index) {
    what_ = fmt::format("valve {}", index + 1);
    const ValveScene& valve = scene_.valves[index];
    const Ends ends = find_ends(valve.from, valve.to, "gas", "name a soft body");
    if (ends.from == nullptr) return;
    for (const auto& [body, name] : {std::pair(ends.from, &valve.from), {ends.to, &valve.to}}) {
      if (body->kind == BodyKind::soft) continue;
      refuse(*name, fmt::format("'{}' is static or moved and has no gas; name a soft body", *name));
      return;
    }
    const double& one = ends.from->material.gas_exponent;
    const double& other = ends.to->material.gas_exponent;
    if (one == other || !reader_.valid({&one, &other})) return;
    refuse(valve.from, fmt::format("'{}' has gas_exponent = {}, '{}' has {}: it is one gas that "
                                   "flows; give both the same",
                                   valve.from, one, valve.to, other));
  }

  Ends find_ends(const std::string& from, const std::string& to, std::string_view lacking,
                 std::string_view remedy) {
    const Ends ends = {find("from", from, lacking, remedy), find("to", to, lacking, remedy)};
    if (ends.from == nullptr || ends.to == nullptr) return {};
    if (from != to) return ends;
    refuse(from, "from and to are the same body; name two");
    return {};
  }

  const BodyScene* find(std::string_view key, const std::string& name, std::string_view lacking,
                        std::string_view remedy) {
    if (name.empty() || !knows_names_ || !reader_.valid({&name})) return nullptr;
    const auto found = std::ranges::find_if(
        scene_.bodies, [&](const BodyScene& body) { return is_copy(body, name); });
    if (found == scene_.bodies.end()) {
      refuse(name, fmt::format("{} = {} names no body that has {}{}", key, base::in_quotes(name),
                               lacking, all()));
      return nullptr;
    }
    if (!is_box(*found)) return &*found;
    refuse(name,
           fmt::format("{} = \"{}\" is a box, which has no {}; {}", key, name, lacking, remedy));
    return nullptr;
  }

  /// "; there are a.1, a.2, b".
  std::string all() const {
    std::vector<std::string> names;
    for (const BodyScene& body : scene_.bodies) {
      if (is_box(body)) continue;
      for (std::int64_t i = 0; i < copy_count(body) && names.size() <= most_ends_named; ++i) {
        names.push_back(copy_name(body, i));
      }
    }
    if (names.empty()) return "; there is none";
    if (names.size() > most_ends_named) names.back() = "...";
    return fmt::format("; there are {}", fmt::join(names, ", "));
  }

  void refuse(const std::string& end, const std::string& why) {
    report_.add(reader_.origin({&end}, whole_file), fmt::format("{}: {}", what_, why));
  }

  const Scene& scene_;
  const Reader& reader_;
  Report& report_;
  bool knows_names_;
  std::string what_;  // "valve 1"
};

}  // namespace

void check_joints(const Scene& scene, const Reader& reader, Report& report) {
  JointChecks(scene, reader, report).run();
}

}  // namespace pneuma::scenes
