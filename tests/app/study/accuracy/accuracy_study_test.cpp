#include "app/study/accuracy/accuracy_study.h"

#include <gtest/gtest.h>

namespace pneuma::app {
namespace {

TEST(AccuracyStudy, MeasuresWhatIsChosenBesideTheScenesOwn) {
  const AccuracyStudy study = study_accuracy(
      "one_sphere", {}, {.seconds = 0.4, .finest_steps_per_second = 960, .repeats = 1},
      [](const std::string&) {});
  ASSERT_EQ(study.rows.size(), 4u);
  EXPECT_EQ(study.rows[0].run.method, "rk4");
  EXPECT_EQ(study.rows[0].run.steps_per_second, 60);
  EXPECT_EQ(study.rows[3].asked_for, "1e-3");
  for (std::size_t i = 1; i < study.rows.size(); ++i) {
    EXPECT_TRUE(study.rows[i].is_reached()) << study.rows[i].asked_for;
    EXPECT_GT(study.rows[i].run.run_time, 0.0);
  }
  EXPECT_GT(study.rows[3].run.steps_per_second, study.rows[1].run.steps_per_second);
}

TEST(AccuracyStudy, KeepsWhatIsOverridden) {
  const AccuracyStudy study = study_accuracy(
      "one_sphere", {"simulation.integrator=velocity_verlet"},
      {.seconds = 0.2, .finest_steps_per_second = 960, .repeats = 1}, [](const std::string&) {});
  for (const AccuracyRow& row : study.rows) EXPECT_EQ(row.run.method, "velocity_verlet");
}

// The ball starts above the ground.
TEST(AccuracyStudy, SaysWhetherAnythingTouched) {
  const auto study_of = [](double seconds) {
    return study_accuracy("one_sphere", {},
                          {.seconds = seconds, .finest_steps_per_second = 960, .repeats = 1},
                          [](const std::string&) {});
  };
  const AccuracyStudy falling = study_of(0.2), landed = study_of(0.8);
  EXPECT_EQ(falling.max_contacts, 0);
  EXPECT_NE(contacts_text(falling).find("nothing touched"), std::string::npos);
  EXPECT_GT(landed.max_contacts, 0);
  EXPECT_NE(contacts_text(landed).find("contacts at a time in the"), std::string::npos);
}

TEST(AccuracyStudy, AnUnstableRunReachesNothing) {
  AccuracyRow row;
  row.max_error = 5e-2;
  row.run.errors.greatest.position = 1e-3;
  EXPECT_TRUE(row.is_reached());
  row.run.status = ErrorRun::Status::unstable;
  EXPECT_FALSE(row.is_reached());
}

}  // namespace
}  // namespace pneuma::app
