#include "app/picture/field_scale.h"

#include <algorithm>

#include "app/picture/colour_field.h"

namespace pneuma::app {
namespace {

bool needs_end(const Show& show) { return show.field != ColourField::none && !show.field_end; }

}  // namespace

FieldScale::FieldScale(const Pictures& pictures) {
  if (needs_end(pictures.show)) seen_[field_name(pictures.show.field)] = 0.0;
  if (pictures.overlay && needs_end(*pictures.overlay)) {
    seen_[field_name(pictures.overlay->field)] = 0.0;
  }
}

void FieldScale::see(const sim::World& world) {
  for (const ColourField field :
       {ColourField::strain, ColourField::velocity, ColourField::pressure}) {
    const auto found = seen_.find(field_name(field));
    if (found == seen_.end()) continue;
    found->second = std::max(found->second, greatest(field_values(world, field)));
  }
}

void FieldScale::go_on(const Seen& seen) {
  for (auto& [field, value] : seen_) {
    const auto found = seen.find(field);
    if (found != seen.end()) value = std::max(value, found->second);
  }
}

Show FieldScale::with_end(Show show) const {
  if (!needs_end(show)) return show;
  show.field_end = round_end(seen_.at(field_name(show.field)));
  show.field_end_grows = true;
  return show;
}

}  // namespace pneuma::app
