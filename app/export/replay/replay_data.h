// A recording as the replay page carries it: a header, and one block of bytes.
#pragma once

#include <cstdint>
#include <vector>

#include "app/export/replay/recording.h"
#include "app/record/ordered_json.h"

namespace pneuma::app {

/// `header["streams"][NAME]` has the place and the kind of each series in `bytes`, which the page
/// holds deflated: u8, u16, u32, f32 (little-endian), or differences_by_row or _by_line
/// (quantise.h) of u16 rows. `header["lattice"]` says how far from the simulation's a position may
/// be.
struct ReplayData {
  Json header;
  std::vector<std::uint8_t> bytes;
};

/// The largest block that browsers are sure to unpack.
inline constexpr std::size_t max_replay_bytes = std::size_t{512} << 20;

/// Throws UsageError for a run that is too long for one page.
void check_replay_size(std::int64_t vertices, std::int64_t frames);

/// Of a recording that has one frame at least. Throws UsageError when contacts and particles, whose
/// number nobody knows before, make more than `allowed_bytes` of it.
ReplayData replay_data(const Recording& recording, std::size_t allowed_bytes = max_replay_bytes);

}  // namespace pneuma::app
