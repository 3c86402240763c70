// What the peer benchmark prints, as text.
#pragma once

#include <string>
#include <vector>

#include "benchmarks/peer/paired_run.h"
#include "benchmarks/peer/search_setting.h"

namespace pneuma::benchmarks {

/// Compilers, their flags and the precision of both sides, a line each.
std::string builds_text();

/// Times and ratios, what each side simulated for them, and Bullet's settings: three tables.
std::string runs_text(const std::vector<PairedRun>& runs);

/// Ours, and the settings that reach it or come nearest.
std::string search_text(const std::string& scene, const SettingSearch& search);

/// "as ours", or in what a peer's run falls short.
std::string verdict(const Quality& peer, const Quality& ours);

}  // namespace pneuma::benchmarks
