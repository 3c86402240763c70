#include "benchmarks/peer/bullet_settings.h"

#include <gtest/gtest.h>

namespace pneuma::benchmarks {
namespace {

TEST(BulletSettings, EveryComparedSceneHasItsOwn) {
  for (const char* scene :
       {"one_sphere", "one_torus", "two_spheres", "two_spheres_contact", "three_spheres",
        "three_spheres_contact", "sphere_in_torus", "torus_four_cubes", "cubes_on_torus"}) {
    EXPECT_TRUE(has_bullet_setting(scene)) << scene;
  }
}

TEST(BulletSettings, AnyOtherWorldHasThatChosenByHand) {
  EXPECT_FALSE(has_bullet_setting("tower of 20"));
  EXPECT_EQ(bullet_setting("tower of 20"),
            (BulletOptions{.position_iterations = 2, .gas_fraction = 0.05}));
}

TEST(BulletSettings, TheTextNamesAllOfASetting) {
  EXPECT_EQ(setting_text({.position_iterations = 2,
                          .substeps = 4,
                          .link_stiffness = 0.05,
                          .gas_fraction = 1.8964,
                          .margin = 0.1,
                          .voxel_size = 2.0,
                          .ground = BulletGround::plane,
                          .drag = 0.02}),
            "4 x 2 iterations, kLST 0.05, gas 1.9, margin 0.1 m, plane, voxels of 2 m, drag 0.02");
  EXPECT_EQ(setting_text({}), "1 x 1 iterations, kLST 1, gas 1, margin 0.25 m, box, voxels of 1 m");
}

}  // namespace
}  // namespace pneuma::benchmarks
