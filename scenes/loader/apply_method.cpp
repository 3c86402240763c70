#include "scenes/loader/apply_method.h"

#include <fmt/format.h>

#include "scenes/loader/sections.h"
#include "sim/world/paper_method.h"

namespace pneuma::scenes {
namespace {

class RefusedKeys {
 public:
  RefusedKeys(const sim::Method& method, const Reader& reader, Report& report)
      : by_override_(reader.origin({&method}, {}).override_index >= 0),
        reader_(reader),
        report_(report) {}

  /// `set`: the same section as the method leaves it.
  void refuse(const Section& given, const Section& set) {
    for (std::size_t i = 0; i < given.keys.size(); ++i) {
      if (given.keys[i].of_method) refuse(given.keys[i], set.keys[i]);
    }
  }

 private:
  void refuse(const Key& given, const Key& set) {
    const void* member = member_of(given.slot);
    const Origin at = reader_.origin({member}, {});
    const bool was_given = at.line > 0;
    const bool gives_way = by_override_ && at.override_index < 0;
    if (!was_given || gives_way || !reader_.valid({member})) return;
    report_.add(at, fmt::format("{} = {}: simulation.method = \"paper\" sets it itself, to {}; "
                                "leave out one of the two",
                                given.name, value_text(given.slot), value_text(set.slot)));
  }

  bool by_override_;
  const Reader& reader_;
  Report& report_;
};

}  // namespace

void use_paper_method(Scene& scene) {
  sim::use_paper_method(scene.settings);
  scene.ambient_pressure = 0.0;
  for (BodyScene& body : scene.bodies) sim::use_paper_method(body.material);
}

void apply_method(Scene& scene, const Reader& reader, Report& report) {
  if (!sim::is_as_printed(scene.settings)) return;
  Scene set = scene;
  use_paper_method(set);
  RefusedKeys refused(scene.settings.method, reader, report);
  const std::vector<Section> given = fixed_sections(scene), after = fixed_sections(set);
  for (std::size_t i = 0; i < given.size(); ++i) refused.refuse(given[i], after[i]);
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    refused.refuse(body_section(scene.bodies[i]), body_section(set.bodies[i]));
  }
  use_paper_method(scene);
}

}  // namespace pneuma::scenes
