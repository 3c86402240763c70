// Which setting of Bullet each scene is run with, and how to find it again.
#pragma once

#include <string>
#include <string_view>

#include "benchmarks/peer/bullet_world.h"

namespace pneuma::benchmarks {

/// For a scene of the table what `pneuma_peer_benchmark --search SCENE` found: the cheapest setting
/// that simulates it as well as ours, or where none does the nearest. For any other world a setting
/// with which spheres rest on the ground, chosen by hand.
const BulletOptions& bullet_setting(std::string_view scene);

/// Whether the scene is in the table.
bool has_bullet_setting(std::string_view scene);

/// For people, on one line: what is not Bullet's default and what costs time.
std::string setting_text(const BulletOptions& options);

}  // namespace pneuma::benchmarks
