#include "app/record/contact_tally.h"

#include <algorithm>

#include "app/record/world_json.h"

namespace pneuma::app {
namespace {

using sim::ContactKind;
using sim::SideKind;

double ratio(std::int64_t count, std::int64_t steps) {
  return steps == 0 ? 0.0 : static_cast<double>(count) / static_cast<double>(steps);
}

}  // namespace

ContactKind kind_of(const sim::Contact& contact) {
  const SideKind a = contact.first.kind, b = contact.second.kind;
  const bool soft = a == SideKind::soft || b == SideKind::soft;
  const bool rigid = a == SideKind::rigid || b == SideKind::rigid;
  if (a == SideKind::ground || b == SideKind::ground) {
    return soft ? ContactKind::soft_ground : ContactKind::rigid_ground;
  }
  if (soft && rigid) return ContactKind::soft_rigid;
  return soft ? ContactKind::soft_soft : ContactKind::rigid_rigid;
}

ContactCounts count_by_kind(std::span<const sim::Contact> contacts) {
  ContactCounts counts = {};
  for (const sim::Contact& contact : contacts) ++counts[static_cast<std::size_t>(kind_of(contact))];
  return counts;
}

std::int64_t count_with_obstacles(std::span<const sim::Contact> contacts, const sim::World& world) {
  const auto is_obstacle = [&](const sim::ContactSide& side) {
    return side.kind == SideKind::soft && sim::is_kinematic(world, side.body);
  };
  return std::ranges::count_if(contacts, [&](const sim::Contact& contact) {
    return kind_of(contact) == ContactKind::soft_soft &&
           (is_obstacle(contact.first) || is_obstacle(contact.second));
  });
}

void ContactTally::add(std::span<const sim::Contact> contacts, std::int64_t obstacle_contacts) {
  ContactCounts counts = count_by_kind(contacts);
  counts[static_cast<std::size_t>(ContactKind::soft_soft)] -= obstacle_contacts;
  const auto enter = [](Count& count, std::int64_t value) {
    count.sum += value;
    count.most = std::max(count.most, value);
  };
  for (std::size_t k = 0; k < counts.size(); ++k) enter(by_kind[k], counts[k]);
  enter(with_obstacles, obstacle_contacts);
  const auto total = static_cast<std::int64_t>(contacts.size());
  enter(all, total);

  const std::int64_t with_ground = counts[static_cast<std::size_t>(ContactKind::soft_ground)] +
                                   counts[static_cast<std::size_t>(ContactKind::rigid_ground)];
  if (total > with_ground) ++touching_steps;
  ++steps;
}

double ContactTally::mean(const Count& count) const { return ratio(count.sum, steps); }

double ContactTally::mean_between_bodies() const {
  return ratio(of(ContactKind::soft_soft).sum + of(ContactKind::soft_rigid).sum +
                   of(ContactKind::rigid_rigid).sum + with_obstacles.sum,
               steps);
}

double ContactTally::touching_share() const { return ratio(touching_steps, steps); }

nlohmann::json contacts_per_step_json(const ContactTally& contacts) {
  const auto count_json = [&](const ContactTally::Count& count) -> nlohmann::json {
    return {{"mean", contacts.mean(count)}, {"max", count.most}};
  };
  auto json = json_by_contact_kind([&](ContactKind kind) { return count_json(contacts.of(kind)); });
  json["soft_obstacle"] = count_json(contacts.with_obstacles);
  json["all"] = count_json(contacts.all);
  json["mean_between_bodies"] = contacts.mean_between_bodies();
  json["share_of_steps_with_bodies_touching"] = contacts.touching_share();
  return json;
}

}  // namespace pneuma::app
