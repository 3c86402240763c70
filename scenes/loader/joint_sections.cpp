// The keys of what joins bodies: [[valve]] and [[spring]].
#include "scenes/loader/make_keys.h"
#include "scenes/loader/sections.h"
#include "scenes/loader/text_checks.h"

namespace pneuma::scenes {

Section valve_section(ValveScene& valve) {
  return {.table = "valve",
          .what = "a valve",
          .keys = {
              {"from", &valve.from, any(), "", "a soft body with gas; of copies NAME.NUMBER",
               check_line},
              {"to", &valve.to, any(), "", "the other one; gas flows either way", check_line},
              {"area", &valve.orifice.area, above_to(0, max_hole), "m^2", "of the opening"},
              {"discharge", &valve.orifice.discharge, above_to(0, 1), "",
               "coefficient of the opening: 0.61 has sharp edges, 1 loses nothing"},
          }};
}

Section spring_section(SpringScene& spring) {
  const Applicability without_region{"ends without a region", spring.from_region.empty()};
  const Applicability without_other{"ends without a region", spring.to_region.empty()};
  return {
      .table = "spring",
      .what = "a spring",
      .keys = {
          {"from", &spring.from, any(), "",
           "a soft body, or a static or moved shape that is no box; of copies NAME.NUMBER",
           check_line},
          {"to", &spring.to, any(), "", "another one", check_line},
          only(without_region,
               {"from_point", &spring.from_point, place(), "m",
                "in world coordinates: the nearest vertex is the end; by default that nearest to "
                "the other end"}),
          only(without_other,
               {"to_point", &spring.to_point, place(), "m", "likewise of the other body"}),
          selector({"from_region", &spring.from_region, place(), "m",
                    "instead of a point: the middle of the vertices that start in these boxes, all "
                    "of which it pulls alike"}),
          selector({"to_region", &spring.to_region, place(), "m", "likewise of the other body"}),
          {"k", &spring.k, at_least(0), "N/m", "spring constant"},
          {"damping", &spring.damping, at_least(0), "N s/m", "of the dashpot along it"},
          {"rest_length", &spring.rest_length, at_least(0), "m",
           "by default the distance of its ends at the start"},
      }};
}

}  // namespace pneuma::scenes
