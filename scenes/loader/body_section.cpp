#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "scenes/loader/make_keys.h"
#include "scenes/loader/palette.h"
#include "scenes/loader/sections.h"
#include "scenes/loader/text_checks.h"

namespace pneuma::scenes {
namespace {

constexpr std::array pressures = {
    Named<sim::PressureWeighting>{sim::PressureWeighting::uniform, "uniform"},
    Named<sim::PressureWeighting>{sim::PressureWeighting::valence, "valence"},
};
constexpr std::array dampings = {
    Named<sim::Damping>{sim::Damping::dashpot, "dashpot"},
    Named<sim::Damping>{sim::Damping::literal, "literal"},
};
constexpr std::array kinds = {
    Named<BodyKind>{BodyKind::soft, "soft"},
    Named<BodyKind>{BodyKind::rigid, "rigid"},
    Named<BodyKind>{BodyKind::fixed, "static"},
    Named<BodyKind>{BodyKind::moved, "moved"},
};
constexpr std::array ways_to_draw = {
    Named<Drawn>{Drawn::surface, "surface"},
    Named<Drawn>{Drawn::edges, "edges"},
    Named<Drawn>{Drawn::nothing, "nothing"},
};
constexpr std::array rests = {
    Named<Rest>{Rest::shape, "shape"},
    Named<Rest>{Rest::equilibrium, "equilibrium"},
};
constexpr std::array shapes = {
    Named<Shape>{Shape::sphere, "sphere"}, Named<Shape>{Shape::torus, "torus"},
    Named<Shape>{Shape::box, "box"},       Named<Shape>{Shape::icosphere, "icosphere"},
    Named<Shape>{Shape::model, "model"},
};

}  // namespace

std::string kind_name(BodyKind kind) {
  return std::string(std::ranges::find(kinds, kind, &Named<BodyKind>::first)->second);
}

Section body_section(BodyScene& body) {
  const bool soft = body.kind == BodyKind::soft;
  const bool rigid = body.kind == BodyKind::rigid;
  const bool sphere = !rigid && body.shape == Shape::sphere;
  const bool torus = !rigid && body.shape == Shape::torus;
  const bool icosphere = !rigid && body.shape == Shape::icosphere;
  const bool box = rigid || body.shape == Shape::box;
  const bool model = !rigid && body.shape == Shape::model;

  // A rigid body has no other shape to be given.
  const auto by_shape = [&](std::string_view shape) { return rigid ? std::string_view() : shape; };

  const Applicability round{.only_for = "spheres, icospheres and tori",
                            .applies = sphere || torus || icosphere,
                            .by_shape = true,
                            .made_one_by = by_shape("shape = \"sphere\"")};
  const Applicability tori{.only_for = "tori",
                           .applies = torus,
                           .by_shape = true,
                           .made_one_by = by_shape("shape = \"torus\"")};
  const Applicability stacked{"spheres and tori", sphere || torus, true};
  const Applicability icospheres{.only_for = "icospheres",
                                 .applies = icosphere,
                                 .by_shape = true,
                                 .made_one_by = by_shape("shape = \"icosphere\"")};
  const Applicability soft_boxes{"soft boxes", soft && box, true};
  const Applicability boxes{"boxes", box, true};
  const Applicability models{.only_for = "models",
                             .applies = model,
                             .by_shape = true,
                             .made_one_by = by_shape("shape = \"model\"")};
  const Applicability soft_bodies{"soft bodies", soft};
  const Applicability with_k{.only_for = soft ? "soft bodies without stiffness" : "soft bodies",
                             .applies = soft && !body.stiffness,
                             .rivals = {&body.stiffness}};
  const Applicability with_vertex_mass{
      .only_for = soft ? "soft bodies without mass and density" : "soft bodies",
      .applies = soft && !body.skin_mass && !body.density,
      .rivals = {&body.skin_mass, &body.density}};
  const Applicability without_mass{.only_for = soft ? "soft bodies without mass" : "soft bodies",
                                   .applies = soft && !body.skin_mass,
                                   .rivals = {&body.skin_mass}};
  const Applicability with_density{"soft bodies with density", soft && body.density};
  const Applicability filled_by_n{
      .only_for = "soft bodies without gauge_pressure, inflation and supply.n",
      .applies = soft && !body.gauge_pressure && !body.inflation && body.supply_n.empty(),
      .rivals = {&body.gauge_pressure, &body.inflation, &body.supply_n}};
  const Applicability of_one_temperature{
      .only_for = soft ? "soft bodies without supply.temperature" : "soft bodies",
      .applies = soft && body.supply_temperature.empty(),
      .rivals = {&body.supply_temperature}};
  const Applicability supplied{"soft bodies with supply.n or supply.temperature",
                               soft && !(body.supply_n.empty() && body.supply_temperature.empty())};
  const Applicability leaking{"soft bodies with leak.area", soft && body.leak.area > 0.0};
  const Applicability bending{"soft bodies with bending", soft && body.material.bending > 0.0};
  const Applicability free_bodies{"soft and rigid bodies", soft || rigid};
  const bool handled = soft && !body.pinned.empty();
  const Applicability moved_bodies{"moved bodies, and soft bodies with pinned,",
                                   body.kind == BodyKind::moved || handled};
  const Applicability handled_bodies{"soft bodies with pinned and a motion",
                                     handled && !body.motion.empty()};
  const bool by_keys = body.kind == BodyKind::moved && !body.motion.empty();
  const Applicability of_own_velocity{"bodies that are not static and have no motion",
                                      body.kind != BodyKind::fixed && !by_keys};
  const Applicability two_colours{"bodies with two colours", body.colours.size() == 2};

  const Word kind = word(body.kind, kinds);
  const Word shape = word(body.shape, shapes);
  sim::SoftMaterial& material = body.material;
  sim::ContactMaterial& surface = soft ? material.surface : body.surface;
  double& rho_g = soft ? material.rho_g : body.rho_g;
  return {
      .table = "body",
      .what = fmt::format("a {} {}", kind.words[kind.get()], shape.words[shape.get()]),
      .keys = {
          {"name", &body.name, any(), "", "of this body alone", check_body_name},
          selector({"kind", kind, any(), "",
                    "gas-filled membrane; rigid box; obstacle: fixed, or moved as its keys say"}),
          of_shape(
              selector({"shape", shape, any(), "",
                        "rigid: always a box; static and moved: a box unless told otherwise"})),
          only(round, {"radius", &body.radius, length(), "m",
                       "of a sphere; of the centre line of a torus"}),
          only(tori, {"tube_radius", &body.tube_radius, length(), "m", "less than radius"}),
          only(stacked,
               {"stacks", &body.stacks, between(torus ? 3 : 2, 10'000), "",
                "circles; of a sphere one fewer, between its poles; of a torus 3 or more"}),
          only(stacked,
               {"slices", &body.slices, between(3, 10'000), "", "vertices of each circle"}),
          only(icospheres, {"subdivisions", &body.subdivisions, between(0, 11), "",
                            "10 * 4^subdivisions + 2 vertices"}),
          only(soft_boxes, {"divisions", &body.divisions, between(1, 4'000), "",
                            "squares along each side of a face"}),
          only(boxes, {"size", &body.size, length(), "m", "full lengths along x, y, z"}),
          only(models, {"model.file", &body.model.file, any(), "",
                        "a triangle model, beside the scene file or in assets/", check_file}),
          only(models, or_number({"model.component", &body.model.component, any(), "",
                                  "of several in the file, by name or number", check_line})),
          only(models,
               {"model.scale", &body.model.scale, above_to(0, 1e30), "m", "per unit of the file"}),
          only(models, {"model.rotation", &body.model.rotation, between(-360, 360), "degrees",
                        "sets the model upright: about x, then y, then z"}),
          only(models, {"model.centre", &body.model.centre, any(), "",
                        "its middle is the body's position, not the file's origin"}),
          only(models, {"model.repair", &body.model.repair, any(), "",
                        "closes cracks and small holes, splits what meets in a point, parts a "
                        "surface from itself"}),
          only(models, {"model.vertices", &body.model.vertices,
                        between(min_model_vertices, max_model_vertices), "",
                        "at most; a finer model is simplified to so many, after repairs"}),

          only(soft_bodies, {"rest", word(body.rest, rests), any(), "",
                             "of the springs: in the shape, or so that it holds its gas"}),
          only(with_k, {"k", &material.k, at_least(0), "N/m", "spring constant"}),
          only(soft_bodies, selector({"stiffness", &body.stiffness, at_least(0), "N/m",
                                      "of the skin, whatever its mesh: Young's modulus times "
                                      "thickness; instead of k, which is 0.866 times that"})),
          only(soft_bodies,
               selector(of_method(
                   {"bending", &material.bending, at_least(0), "N m",
                    "rigidity of the surface as a plate: holds flat and concave faces"}))),
          only(bending, of_method({"bending_damping", &material.bending_damping, at_least(0), "s",
                                   "relaxation time of bending: a motion of w rad/s dies away at "
                                   "w^2 times half of it"})),
          only(filled_by_n, {"n", &material.n, at_least(0), "mol",
                             "amount of gas; or give gauge_pressure, or inflation"}),
          only(soft_bodies, selector({"gauge_pressure", &body.gauge_pressure, any(), "Pa",
                                      "of the gas at the start, above simulation.ambient_pressure; "
                                      "instead of n"})),
          only(soft_bodies,
               selector({"inflation", &body.inflation, at_least(1), "",
                         "volume at rest, without weight, over that of the shape; instead of n"})),
          only(of_one_temperature, {"temperature", &material.temperature, at_least(0), "K",
                                    "of the gas, at the start"}),
          only(soft_bodies, selector({"supply.n", &body.supply_n, at_least(0), "mol",
                                      "keys in time: the amount of gas; what is pumped in, if some "
                                      "leaks or flows through a valve"})),
          only(soft_bodies,
               selector({"supply.temperature", &body.supply_temperature, at_least(0), "K",
                         "keys in time: of the gas; only with a gas_exponent of 1"})),
          only(supplied, {"supply.smooth", &body.supply_smooth, any(), "",
                          "between keys cubics that do not overshoot (Fritsch and Butland "
                          "1984), level at both ends; false: an even change"}),
          only(soft_bodies, selector({"leak.area", &body.leak.area, between(0, max_hole), "m^2",
                                      "of a hole through which gas flows out; 0: none"})),
          only(leaking, {"leak.discharge", &body.leak.discharge, above_to(0, 1), "",
                         "coefficient of the hole: 0.61 has sharp edges, 1 loses nothing"}),
          only(soft_bodies,
               of_method({"gas_exponent", &material.gas_exponent, between(1, 10), "",
                          "g of P V^g = constant: 1 isothermal, 1.4 air without heat exchange"})),
          only(with_vertex_mass,
               {"vertex_mass", &material.vertex_mass, above(0), "kg", "per vertex"}),
          only(without_mass, selector({"density", &body.density, above(0), "kg/m^3",
                                       "of the skin, whatever its mesh; instead of vertex_mass"})),
          only(with_density,
               {"thickness", &body.thickness, length(), "m", "of the skin, for its mass"}),
          only(soft_bodies,
               of_method({"pressure_weighting", word(material.pressure_weighting, pressures), any(),
                          "", "uniform: conservative; valence: the paper's"})),
          only(soft_bodies, of_method({"damping", word(material.damping, dampings), any(), "",
                                       "dashpot: continuous; literal: the paper's"})),
          only(soft_bodies, {"k_max", &material.k_max, above(0), "N/m",
                             "springs of this k or more are damped most"}),
          only(free_bodies,
               soft ? selector({"mass", &body.skin_mass, above(0), "kg",
                                "of the whole body, 1 kg of a rigid one; of a soft one instead of "
                                "vertex_mass"})
                    : Key{"mass", &body.mass, above(0), "kg", "of the whole box"}),
          only(free_bodies,
               {"rho_g", &rho_g, from_below(0, 1), "", "fraction of velocity lost per 1/60 s"}),
          {"restitution", &surface.restitution, between(0, 1), "",
           "0 keeps no normal velocity, 1 keeps all; of two surfaces the greater counts; of a soft "
           "body its vertices', which then ring: as a whole it bounces by gas and springs"},
          {"friction", &surface.friction, at_least(0), "",
           "Coulomb's coefficient; of two surfaces the geometric mean counts"},

          {"position", &body.position, place(), "m",
           "of the shape's centre; with copies, of the first one's"},
          {"rotation", &body.rotation, place(), "degrees", "about world x, then y, then z"},
          only(of_own_velocity, {"velocity", &body.velocity, place(), "m/s",
                                 "at the start; of a moved body always, unless motion has keys"}),
          only(of_own_velocity, {"angular_velocity", &body.angular_velocity, place(), "rad/s",
                                 "about world axes; likewise"}),
          only(soft_bodies, selector({"pinned", &body.pinned, place(), "m",
                                      "vertices that start in one of these boxes, in world "
                                      "coordinates, stay there or follow motion"})),
          only(moved_bodies,
               selector({"motion.path", &body.motion.path, place(), "m",
                         "keys in time: how far it, or what is pinned, is from its start"})),
          only(moved_bodies,
               selector({"motion.rotation", &body.motion.rotation, place(), "degrees",
                         "likewise: turned about its position: world x, then y, then z"})),
          only(moved_bodies, {"motion.smooth", &body.motion.smooth, any(), "",
                              "between keys cubics that do not overshoot (Fritsch and Butland "
                              "1984), at rest at both ends; false: even speed"}),
          only(handled_bodies, {"motion.still", &body.still, place(), "m",
                                "pinned vertices that start in these boxes stay where they are"}),

          {"copies", &body.copies, between(1, 1'000'000), "", "along x, y, z"},
          {"spacing", &body.spacing, place(), "m", "between copies along x, y, z"},
          {"jitter", &body.jitter, between(0, farthest), "m",
           "each copy is moved at random by up to this"},
          {"tumble", &body.tumble, any(), "", "each copy starts turned at random"},
          selector({"colours", &body.colours, any(), "",
                    "one to three: plain, along colour_axis, along x, y, z; else of a palette",
                    check_colour}),
          only(two_colours,
               {"colour_axis", &body.colour_axis, any(), "", "of two colours' gradient"}),
          {"roughness", &body.roughness, between(0.1, 1), "",
           "of the drawn surface: 0.1 shines like glass, 1 is dull"},
          {"drawn", word(body.drawn, ways_to_draw), any(), "",
           "what is seen of it: edges, as bars, show what is inside, and nothing also hides it"},
      }};
}

std::string default_name(std::size_t index) { return fmt::format("body{}", index + 1); }

BodyScene default_body(std::size_t index) {
  BodyScene body;
  body.name = default_name(index);
  body.colours = palette_colours(index);
  return body;
}

}  // namespace pneuma::scenes
