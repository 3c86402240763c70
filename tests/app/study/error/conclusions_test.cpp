// What is concluded from numbers that are made up: each case by hand.
#include "app/study/error/conclusions.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/app/study/error/small_study.h"

namespace pneuma::app {
namespace {

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// rk4 with error = 2000 step^4 from 1/15 s on, but for one that is not there yet and one at the
/// floor.
ErrorStudy study_of_rk4() {
  ErrorStudy study = made_up_study();
  study.reference.uncertainty = 1e-12;
  study.runs.push_back(made_up_unstable_run("rk4", 15));
  study.runs.push_back(made_up_run("rk4", 30, 0.09, 1e-4));
  for (const int rate : {60, 120, 240, 480}) {
    study.runs.push_back(made_up_run("rk4", rate, 2000.0 * std::pow(rate, -4), 1e-6 * rate));
  }
  study.runs.push_back(made_up_run("rk4", 960, 5e-12, 1e-3));
  return study;
}

TEST(ObservedOrders, AreFittedWhereAPowerLawIsReached) {
  const auto orders = observed_orders(study_of_rk4());
  ASSERT_EQ(orders.size(), 1u);
  EXPECT_EQ(orders[0].method, "rk4");
  EXPECT_EQ(orders[0].theory, 4.0);
  ASSERT_TRUE(orders[0].law);
  EXPECT_NEAR(orders[0].law->exponent, 4.0, 1e-12);
  EXPECT_NEAR(orders[0].law->factor, 2000.0, 1e-8);
  EXPECT_EQ(orders[0].first_steps_per_second, 60);
  EXPECT_EQ(orders[0].last_steps_per_second, 480);
  EXPECT_EQ(orders[0].points, 4u);
}

TEST(ObservedOrders, AreNotMadeUpWhereThereIsNone) {
  ErrorStudy study = made_up_study();
  for (const int rate : {15, 30, 60}) study.runs.push_back(made_up_unstable_run("martin", rate));
  study.runs.push_back(made_up_run("martin", 120, 0.05, 1e-3));
  study.runs.push_back(made_up_run("martin", 240, 0.02, 1e-3));
  study.runs.push_back(made_up_peer_run(1e-3, 1e-3, 1e-3, 100.0));
  const auto orders = observed_orders(study);
  ASSERT_EQ(orders.size(), 1u);
  EXPECT_FALSE(orders[0].law);
}

TEST(ObservedOrders, HaveNoTheoryForContactsAndUnknownMethods) {
  ErrorStudy study = study_of_rk4();
  study.runs.push_back(made_up_run("a_new_one", 60, 1e-3, 1e-3));
  EXPECT_FALSE(observed_orders(study)[1].theory);
  study.flight.contacts = true;
  EXPECT_FALSE(observed_orders(study)[0].theory);
}

TEST(ObservedOrders, OfContactsAreOverAllSteps) {
  ErrorStudy study = made_up_study();
  study.flight.contacts = true;
  for (const auto& [rate, error] : {std::pair{60, 0.08}, {120, 0.01}, {240, 0.009}, {480, 0.002}}) {
    study.runs.push_back(made_up_run("rk4", rate, error, 1e-3));
  }
  EXPECT_EQ(observed_orders(study)[0].points, 4u);
}

/// Two of ours and two of SUNDIALS'.
ErrorStudy study_of_four() {
  ErrorStudy study = made_up_study();
  study.runs = {made_up_run("martin", 960, 8e-3, 5e-3), made_up_run("rk4", 60, 2e-3, 400e-6),
                made_up_peer_run(1e-2, 9e-3, 1440e-6, 80.0),
                made_up_peer_run(1e-4, 5e-5, 3000e-6, 150.0)};
  return study;
}

TEST(Choose, TakesTheCheapestThatIsGoodEnough) {
  const Choice loose = choose(study_of_four(), 1e-2);
  ASSERT_TRUE(loose.ours && loose.peer);
  EXPECT_EQ(loose.ours->method, "rk4");
  EXPECT_EQ(loose.peer->tolerance, 1e-2);
  EXPECT_NEAR(*loose.ratio(), 3.6, 1e-12);

  const Choice tight = choose(study_of_four(), 1e-3);
  EXPECT_FALSE(tight.ours);
  ASSERT_TRUE(tight.peer);
  EXPECT_EQ(tight.peer->tolerance, 1e-4);
  EXPECT_FALSE(tight.ratio());
  EXPECT_FALSE(choose(study_of_four(), 1e-5).peer);
}

TEST(Choose, TakesNoUnstableRunAndNoneBeyondWhatIsKnown) {
  ErrorStudy study = study_of_four();
  study.runs.push_back(made_up_unstable_run("symplectic_euler", 15));
  EXPECT_EQ(choose(study, 1e-2).ours->method, "rk4");
  study.reference.uncertainty = 2e-3;
  EXPECT_FALSE(choose(study, 1e-2).known);
  EXPECT_FALSE(choose(study, 1e-2).ours);
  EXPECT_TRUE(choose(study, 1e-1).known);
}

TEST(Recommendation, IsASentence) {
  ErrorStudy study = study_of_four();
  EXPECT_EQ(recommendation(choose(study, 1e-2)),
            "for an error of 1e-2 take rk4 at step 1/60 s: 400 microseconds per simulated second "
            "(its error: 2.0e-03)");
  EXPECT_EQ(recommendation(choose(study, 1e-3)),
            "an error of 1e-3 is reached by none of the steps studied");
  study.reference.uncertainty = 1e-3;
  EXPECT_TRUE(contains(recommendation(choose(study, 1e-4)), "not known that well"));
}

/// The same, with theirs in a quarter of the time: ours is behind at 1e-2.
ErrorStudy study_of_four_behind() {
  ErrorStudy study = study_of_four();
  study.runs[2].run_time = 360e-6;
  return study;
}

TEST(Shortfalls, SayHowFarBehindAndWhy) {
  const auto sentences = shortfalls(study_of_four_behind());
  // From 1e-3 on none of ours.
  ASSERT_EQ(sentences.size(), 6u);
  EXPECT_TRUE(
      contains(sentences[1], "at an error of 1e-2 ours is behind SUNDIALS, 0.9 times as fast"));
  EXPECT_TRUE(contains(sentences[1], "evaluates the forces 80.0 times"));
  // 360 us less 80 times 2 us.
  EXPECT_TRUE(contains(sentences[1], "spends 56 % of its time"));
  EXPECT_TRUE(contains(sentences[1], "as long as 200 evaluations, theirs as long as 180."));
  EXPECT_TRUE(contains(sentences[2], "at an error of 1e-3 SUNDIALS is ahead"));
  EXPECT_TRUE(contains(sentences[3], "at an error of 1e-4 SUNDIALS is ahead"));
}

TEST(Shortfalls, SayWhenNeitherIsGoodEnough) {
  const auto sentences = shortfalls(study_of_four_behind());
  EXPECT_TRUE(contains(sentences[4], "at an error of 1e-5 neither can be chosen"));
}

TEST(Shortfalls, SayWhyNotTheNextLongerStep) {
  ErrorStudy study = study_of_four_behind();
  study.runs.push_back(made_up_run("rk4", 30, 0.025, 200e-6));
  EXPECT_TRUE(contains(shortfalls(study)[0], "200 evaluations (at 1/30 s its error is 2.5e-02),"));
  study.runs.back().status = ErrorRun::Status::unstable;
  EXPECT_TRUE(contains(shortfalls(study)[0], "200 evaluations (at 1/30 s it is unstable),"));
}

TEST(Shortfalls, AreNoneWhereOursIsAhead) {
  ErrorStudy study = made_up_study();
  study.runs = {made_up_run("rk4", 60, 1e-7, 1e-4), made_up_peer_run(1e-8, 1e-7, 1.1e-4, 50.0)};
  EXPECT_TRUE(shortfalls(study).empty());
  study.runs[1].run_time = 0.9e-4;
  EXPECT_EQ(shortfalls(study).size(), compared_errors.size());
}

}  // namespace
}  // namespace pneuma::app
