// What the volume of a soft body does over a run.
#pragma once

#include <limits>
#include <string>
#include <vector>

namespace pneuma::app {

/// Of a body in a frame.
struct Volume {
  double value = 0.0;           // m^3
  bool crosses_itself = false;  // such a surface has no inside, so its volume says little
};

struct VolumeRange {
  std::string body;
  Volume start = {};
  Volume least = {std::numeric_limits<double>::infinity()};
  Volume greatest = {};
  Volume end = {};
  double shape_deviation = 0.0;  // at the end (app/record/shape_deviation.h)
  bool is_obstacle = false;      // static or moved: it keeps volume and shape
  bool keeps_gas = false;        // it has some, which neither comes nor goes
};

/// To the least and the greatest.
void add_volume(const Volume& now, VolumeRange& range);

/// A line for each body but obstacles.
std::string volume_ranges_text(const std::vector<VolumeRange>& volumes);

}  // namespace pneuma::app
