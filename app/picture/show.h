// What a picture shows beside the surfaces, as in `--show`.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace pneuma::app {

/// What colours the surfaces in place of the bodies' own colours.
enum class ColourField {
  none,
  strain,    // of a vertex: the largest of its springs' |l - L| / L
  velocity,  // of a vertex: its speed, m/s
  pressure,  // of a body: of its gas above the pressure outside, Pa
};

struct Show {
  bool wireframe = false;
  bool particles = false;  // collision particles
  bool contacts = false;   // contact points and normals
  bool impulses = false;   // of contacts, as arrows
  bool ghost = false;      // soft bodies' rest shapes as lines, where the bodies are
  bool labels = false;     // names of bodies
  bool scale = false;      // a scale bar
  std::optional<double> arrow_scale = std::nullopt;  // N s per metre; none: of each picture its own
  ColourField field = ColourField::none;
  std::optional<double> field_end = std::nullopt;  // of its colours; none: of each picture its own
  bool field_end_grows = false;                    // in a run: see FieldScale
};

/// What pictures of a run show. With an overlay each frame is drawn twice, in two files.
struct Pictures {
  Show show;
  std::optional<Show> overlay;
};

/// The names of what is shown, as in `--show`.
std::vector<std::string> shown_names(const Show& show);

/// "strain", "velocity" or "pressure"; "" for none.
std::string field_name(ColourField field);

/// Reads the list of `option`, --show or --overlay: names separated by commas; a field may have the
/// end of its colours, as velocity=5, and impulses the N s of an arrow of one metre. Throws
/// UsageError.
Show parse_show(const std::string& option, const std::string& list);

}  // namespace pneuma::app
