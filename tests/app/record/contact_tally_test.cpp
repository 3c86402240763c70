#include "app/record/contact_tally.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace pneuma::app {
namespace {

using sim::ContactKind;
using sim::SideKind;

sim::Contact contact(SideKind first, SideKind second) {
  sim::Contact result;
  result.first.kind = first;
  result.second.kind = second;
  return result;
}

TEST(ContactTally, KnowsTheKindWhicheverSideComesFirst) {
  const struct {
    SideKind a, b;
    ContactKind kind;
  } cases[] = {{SideKind::soft, SideKind::ground, ContactKind::soft_ground},
               {SideKind::rigid, SideKind::ground, ContactKind::rigid_ground},
               {SideKind::soft, SideKind::soft, ContactKind::soft_soft},
               {SideKind::soft, SideKind::rigid, ContactKind::soft_rigid},
               {SideKind::rigid, SideKind::rigid, ContactKind::rigid_rigid}};
  for (const auto& [a, b, kind] : cases) {
    EXPECT_EQ(kind_of(contact(a, b)), kind);
    EXPECT_EQ(kind_of(contact(b, a)), kind);
  }
}

TEST(ContactTally, CountsPerStepAndByKind) {
  const sim::Contact ground = contact(SideKind::soft, SideKind::ground);
  const sim::Contact pair = contact(SideKind::soft, SideKind::rigid);
  ContactTally tally;
  tally.add({});
  tally.add(std::vector{ground, ground, ground});
  tally.add(std::vector{ground, pair, pair});
  tally.add(std::vector{pair});

  EXPECT_EQ(tally.steps, 4);
  EXPECT_EQ(tally.all.most, 3);
  EXPECT_DOUBLE_EQ(tally.mean(tally.all), 7.0 / 4.0);
  EXPECT_DOUBLE_EQ(tally.mean(tally.of(ContactKind::soft_ground)), 1.0);
  EXPECT_EQ(tally.of(ContactKind::soft_rigid).most, 2);
  EXPECT_DOUBLE_EQ(tally.mean_between_bodies(), 3.0 / 4.0);
  EXPECT_DOUBLE_EQ(tally.touching_share(), 0.5);  // the ground is no body
  EXPECT_EQ(tally.of(ContactKind::rigid_rigid).sum, 0);
}

TEST(ContactTally, CountsContactsWithObstaclesByThemselves) {
  const sim::Contact pair = contact(SideKind::soft, SideKind::soft);
  ContactTally tally;
  tally.add(std::vector{pair, pair, pair}, 2);
  EXPECT_EQ(tally.of(ContactKind::soft_soft).most, 1);
  EXPECT_EQ(tally.with_obstacles.most, 2);
  EXPECT_EQ(tally.all.most, 3);
  EXPECT_DOUBLE_EQ(tally.mean_between_bodies(), 3.0);
  EXPECT_EQ(contacts_per_step_json(tally)["soft_obstacle"]["max"], 2);
}

TEST(ContactTally, IsZeroBeforeTheFirstStep) {
  EXPECT_EQ(ContactTally{}.mean_between_bodies(), 0.0);
  EXPECT_EQ(ContactTally{}.touching_share(), 0.0);
}

}  // namespace
}  // namespace pneuma::app
