// The cheapest setting of Bullet that simulates a scene as well as ours does.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "benchmarks/peer/quality.h"

namespace pneuma::benchmarks {

struct Candidate {
  BulletOptions options;
  Trial trial;
};

struct SettingSearch {
  Trial ours;                       // by rk4
  std::vector<Candidate> reaching;  // what reaches ours, the cheapest first
  std::vector<Candidate> nearest;   // what misses least, the cheapest of those
  int tried = 0;                    // settings
};

/// What is tried.
struct SearchGrid {
  /// Substeps and iterations, the cheapest first: a substep costs about three iterations besides
  /// those that it makes.
  std::vector<std::pair<int, int>> efforts;
  std::vector<double> stiffnesses;  // kLST, from 1 downwards
  std::vector<double> margins;      // m
  std::vector<double> drags;        // per 1/60 s
  std::vector<double> voxel_sizes;  // m
};

/// Finer for one body alone, whose runs are short.
SearchGrid search_grid(const sim::World& world);

/// From `world`, for `seconds` a setting; for each point of the grid the gas that inflates the
/// bodies as ours are is searched for. An effort all of whose settings cost more than the best so
/// far is left. Then voxels and ground of the cheapest are varied, and their times measured again,
/// alternately. Throws app::DivergenceError if ours diverges.
SettingSearch search_setting(const std::string& name, const sim::World& world, double seconds,
                             const SearchGrid& grid);

}  // namespace pneuma::benchmarks
