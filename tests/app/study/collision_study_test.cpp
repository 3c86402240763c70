// The collision study: what it counts, against cases counted by hand, and what it concludes.
#include "app/study/collision/collision_study.h"

#include <gtest/gtest.h>

#include "app/files/find_scene.h"
#include "app/study/collision/collision_report.h"
#include "scenes/loader/load_scene.h"
#include "sim/mesh/primitives.h"
#include "tests/support/worlds.h"

namespace pneuma::app {
namespace {

using sim::Contact;
using sim::FeatureKind;
using sim::SideKind;
using sim::Vec3;

sim::SurfaceView view(const sim::SoftBody& body) { return {body.mesh->topology, body.positions}; }

/// Two unit cubes, the upper one `gap` m above the lower one.
struct Cubes {
  sim::SoftBody lower = sim::make_body(sim::make_box({1.0, 1.0, 1.0}, 1));
  sim::SoftBody upper;

  explicit Cubes(double gap)
      : upper(sim::make_body(sim::make_box({1.0, 1.0, 1.0}, 1), {0.0, 0.0, 1.0 + gap})) {}
};

TEST(ContactTruth, OfTwoCubesIsTheirFacingSides) {
  const Cubes cubes(0.1);
  const ContactTruth truth = find_truth(view(cubes.lower), view(cubes.upper), 0.25);
  EXPECT_EQ(truth.regions, 1);
  ASSERT_EQ(truth.first_vertices.size(), 4U);
  ASSERT_EQ(truth.second_vertices.size(), 4U);
  for (const auto& [vertex, depth] : truth.first_vertices) {
    EXPECT_GT(cubes.lower.positions[vertex].z(), 0.0);
    EXPECT_NEAR(depth, 0.15, 1e-12);  // rounding
  }
}

TEST(ContactTruth, CountsWhatIsBehindAsDeeper) {
  const sim::SoftBody cube = sim::make_body(sim::make_box({1.0, 1.0, 1.0}, 1));
  const sim::SoftBody plate =
      sim::make_body(sim::make_box({3.0, 3.0, 1.0}, 1), {0.0, 0.0, 0.9});  // from 0.4 m upwards
  const ContactTruth truth = find_truth(view(cube), view(plate), 0.25);
  double deepest = 0.0;
  for (const auto& [vertex, depth] : truth.first_vertices) deepest = std::max(deepest, depth);
  EXPECT_NEAR(deepest, 0.35, 1e-12);  // rounding
}

TEST(ContactTruth, SeesTwoRegionsOfABodyThatTouchesInTwoPlaces) {
  // A plate laid across a ring.
  const sim::SoftBody torus = sim::make_body(sim::make_torus(4.0, 1.0, 24, 12));
  const sim::SoftBody plate = sim::make_body(sim::make_box({12.0, 1.0, 0.5}, 8), {0.0, 0.0, 1.3});
  const ContactTruth truth = find_truth(view(torus), view(plate), 0.2);
  EXPECT_EQ(truth.regions, 2) << "the plate crosses the ring twice, 8 m apart";
}

Contact contact(FeatureKind first, int first_index, FeatureKind second, int second_index) {
  Contact result;
  result.first = {SideKind::soft, 0, {first, first_index}};
  result.second = {SideKind::soft, 1, {second, second_index}};
  return result;
}

TEST(DetectionScore, CountsFoundAndMissed) {
  const Cubes cubes(0.1);
  const auto& mesh = cubes.lower.mesh->topology;
  const ContactTruth truth = find_truth(view(cubes.lower), view(cubes.upper), 0.25);
  DetectionScore nothing;
  add_score(truth, mesh, mesh, {}, nothing);
  EXPECT_EQ(nothing.regions, 1);
  EXPECT_EQ(nothing.regions_found, 0);
  EXPECT_EQ(nothing.vertices, 8);
  EXPECT_EQ(nothing.vertices_found, 0);
  EXPECT_NEAR(nothing.greatest_missed, 0.15, 1e-12);  // rounding

  DetectionScore some;
  const Contact found = contact(FeatureKind::vertex, truth.first_vertices[0].vertex,
                                FeatureKind::vertex, truth.second_vertices[0].vertex);
  add_score(truth, mesh, mesh, std::vector{found}, some);
  EXPECT_EQ(some.regions_found, 1);
  EXPECT_EQ(some.vertices_found, 2);
  EXPECT_DOUBLE_EQ(some.region_share(), 1.0);
  EXPECT_DOUBLE_EQ(some.vertex_share(), 0.25);
  EXPECT_EQ(DetectionScore{}.vertex_share(), 1.0) << "nothing to find, nothing missed";
}

CollisionStudy small_collision_study() {
  const scenes::Scene scene = scenes::load_scene(find_scene("two_spheres_contact"));
  return study_collision(scene, {.seconds = 4.0, .few = true});
}

TEST(CollisionStudy, ExactFindsEverythingAndParticlesDoNot) {
  const CollisionStudy study = small_collision_study();
  ASSERT_EQ(study.results.size(), 5U);
  EXPECT_GT(study.steps, 60);
  EXPECT_GT(study.exact().score.vertices, 100);
  EXPECT_EQ(study.exact().score.regions_found, study.exact().score.regions);
  EXPECT_EQ(study.exact().score.vertices_found, study.exact().score.vertices);
  EXPECT_EQ(study.exact().score.greatest_missed, 0.0);
  for (const SearchResult& result : study.results) {
    EXPECT_EQ(result.score.regions, study.exact().score.regions) << "all look at the same";
    EXPECT_EQ(result.score.vertices, study.exact().score.vertices);
    EXPECT_GT(result.step_seconds, 0.0);
  }
  // 1/8 of 58 vertices are 7 particles a body: too few for all the vertices of a patch.
  EXPECT_LT(study.results[2].score.vertex_share(), 1.0);
  EXPECT_GT(study.results[2].score.vertex_share(), 0.1);
}

SearchResult result(sim::SoftSearch search, double per_vertex, double seconds, std::int64_t found,
                    double missed) {
  SearchResult made;
  made.setting.search = search;
  made.setting.particles.per_vertex = per_vertex;
  made.step_seconds = seconds;
  made.score = {.regions = 1000,
                .regions_found = found,
                .vertices = 10,
                .vertices_found = 5,
                .greatest_missed = missed};
  return made;
}

CollisionStudy made_up(double exact_seconds, std::int64_t found, double missed) {
  CollisionStudy study;
  study.skin_thickness = 0.5;
  study.results = {result(sim::SoftSearch::exact, 1.0, exact_seconds, 1000, 0.0),
                   result(sim::SoftSearch::particles, 0.125, 2e-6, found, missed),
                   result(sim::SoftSearch::particles, 0.5, 8e-6, 1000, 0.1)};
  return study;
}

TEST(CollisionStudy, ConcludesFromTheCheapestThatFindsWhatTouches) {
  CollisionStudy study = made_up(4e-6, 995, 0.3);
  EXPECT_EQ(cheapest_sufficient(study), &study.results[1]);
  EXPECT_NE(conclusions(study)[1].find("Particles win here"), std::string::npos);
  EXPECT_NE(conclusions(study)[1].find(": 2 times as long"), std::string::npos);

  study = made_up(4e-6, 980, 0.3);  // too few regions: the next is dearer than exact
  EXPECT_EQ(cheapest_sufficient(study), &study.results[2]);
  EXPECT_NE(conclusions(study)[1].find("Particles lose here"), std::string::npos);
  EXPECT_NE(conclusions(study)[1].find(": 0.5 times as long"), std::string::npos);

  study = made_up(4e-6, 1000, 0.51);  // a vertex in the zone of separation is missed
  EXPECT_EQ(cheapest_sufficient(study), &study.results[2]);

  study.results.pop_back();
  EXPECT_EQ(cheapest_sufficient(study), nullptr);
  EXPECT_NE(conclusions(study)[1].find("no setting finds"), std::string::npos);
}

TEST(CollisionStudy, ConcludesNothingFromNothing) {
  CollisionStudy study = made_up(4e-6, 995, 0.3);
  for (SearchResult& one : study.results) one.score = {};
  ASSERT_EQ(conclusions(study).size(), 1U);
  EXPECT_NE(conclusions(study)[0].find("Nothing came within reach"), std::string::npos);
}

TEST(CollisionStudy, SaysWhatThePapersSettingFinds) {
  const std::string sentence = conclusions(made_up(4e-6, 980, 0.3))[0];
  EXPECT_NE(sentence.find("1/8 per vertex, 10 sweeps, attraction 2"), std::string::npos);
  EXPECT_NE(sentence.find("takes 2 us per step, 0.5 times exact"), std::string::npos) << sentence;
  EXPECT_NE(sentence.find("98.0 % of the regions and 50.0 % of the vertices"), std::string::npos);
}

TEST(CollisionReport, HasARowPerSetting) {
  const CollisionStudy study = made_up(4e-6, 980, 0.3);
  const std::string csv = collision_csv(std::span(&study, 1));
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 4);
  const std::string text = collision_text(study);
  EXPECT_NE(text.find("1/2 per vertex"), std::string::npos);
}

}  // namespace
}  // namespace pneuma::app
