#include "app/study/choices/damping_steps.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/worlds.h"

namespace pneuma::app {
namespace {

sim::SoftBody damped_sphere() {
  sim::SoftBody body = sim::make_body(sim::make_sphere(3.0, 8, 8));
  body.material.n = 5.0;
  return body;
}

const std::vector<int> rates = {60, 120, 480};

DampingStudy damping_study() { return study_damping(damped_sphere(), rates, 0.5); }

TEST(StudyDamping, FindsTheFallOfTheEquationAtEveryStepUnderDashpot) {
  const DampingStudy study = damping_study();
  const double gamma = -60.0 * std::log(1.0 - damped_sphere().material.rho_g);
  const double exact = 9.81 / gamma * (1.0 - std::exp(-0.5 * gamma));
  EXPECT_NEAR(study.exact_fall_speed, exact, 1e-12);
  for (std::size_t i = 0; i < rates.size(); ++i) {
    EXPECT_EQ(study.runs[i].damping, sim::Damping::dashpot);
    // rk4's error of e^(-gamma h), gamma h = 0.01, is (gamma h)^5 / 120 = 8e-13 a step: of the
    // final speed of 16 m/s, over 30 steps, 4e-10.
    EXPECT_NEAR(*study.runs[i].fall_speed, exact, 4e-10);
  }
}

TEST(StudyDamping, FindsThatLiteralHoldsAFallingBodyBackTheMoreTheShorterTheStep) {
  const DampingStudy study = damping_study();
  const sim::SoftMaterial material = damped_sphere().material;
  const double rho = material.rho_g + (1.0 - material.rho_g) * material.k / material.k_max;
  for (std::size_t i = 0; i < rates.size(); ++i) {
    const DampingRun& run = study.runs[rates.size() + i];
    EXPECT_EQ(run.damping, sim::Damping::literal);
    // v' = (v + g h)(1 - rho), a geometric series.
    const double h = 1.0 / rates[i], keep = 1.0 - rho;
    const double steps = 0.5 * rates[i];
    const double expected = 9.81 * h * keep * (1.0 - std::pow(keep, steps)) / rho;
    EXPECT_NEAR(*run.fall_speed, expected, 1e-10);
    if (i > 0) {
      EXPECT_LT(*run.fall_speed, 0.7 * *study.runs[rates.size() + i - 1].fall_speed);
    }
  }
}

TEST(StudyDamping, FindsThatTheSwingDependsOnTheStepUnderLiteralOnly) {
  const DampingStudy study = study_damping(damped_sphere(), {120, 240, 960}, 1.0);
  const auto swing = [&](std::size_t i) { return *study.runs[i].swing_left; };
  // Looked at once a step, a peak of the kinetic energy is missed by half a step at most.
  EXPECT_NEAR(swing(0), swing(2), 0.03 * swing(2));
  EXPECT_NEAR(swing(1), swing(2), 0.03 * swing(2));
  EXPECT_GT(std::abs(std::log(swing(3) / swing(5))), std::log(2.0));
}

TEST(StudyDamping, SaysWhatDiverges) {
  sim::SoftBody body = damped_sphere();
  body.material.k = 1e7;
  body.material.k_max = 1e9;
  const DampingStudy study = study_damping(body, {15}, 0.5);
  EXPECT_FALSE(study.runs[0].fall_speed);
  EXPECT_EQ(damping_sentences(study)[0], "dashpot: no step is stable");
}

TEST(DampingSentences, GiveBothEndsOfTheSteps) {
  DampingStudy study;
  study.seconds = 2.0;
  study.exact_fall_speed = 11.4;
  for (const sim::Damping damping : {sim::Damping::dashpot, sim::Damping::literal}) {
    const double factor = damping == sim::Damping::dashpot ? 1.0 : 0.1;
    for (const int rate : {15, 60, 240}) {
      study.runs.push_back({damping, rate, 10.0 * std::pow(factor, rate / 60), 0.25});
    }
  }
  EXPECT_EQ(damping_sentences(study)[1],
            "literal: after falling for 2 s the body has 10 m/s at 1/15 s and 0.001 m/s at 1/240 s "
            "(the equation: 11.4); of its swing 0.25 is left at 1/15 s and 0.25 at 1/240 s");
}

}  // namespace
}  // namespace pneuma::app
