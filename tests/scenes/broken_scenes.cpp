#include "tests/scenes/broken_scenes.h"

#include <initializer_list>

namespace pneuma::scenes {
namespace {

std::string lines(std::initializer_list<std::string> texts) {
  std::string result;
  for (const std::string& text : texts) result.append(text).append("\n");
  return result;
}
/// One line of a soft sphere; it stands in line 2.
std::string sphere(const std::string& line) { return lines({"[[body]]", line}); }
/// One line of a body of this kind or shape; it stands in line 3.
std::string rigid(const std::string& line) { return lines({"[[body]]", "kind = \"rigid\"", line}); }
std::string shaped(const std::string& shape, const std::string& line) {
  return lines({"[[body]]", std::string("shape = \"").append(shape).append("\""), line});
}
/// Lines above a body.
std::string before_body(const std::string& text) { return lines({text, "[[body]]"}); }

std::string nested_arrays(int depth) {
  const auto count = static_cast<std::size_t>(depth);
  return std::string("x = ").append(count, '[').append(count, ']').append("\n");
}

std::string dotted(int depth) {
  std::string key;
  for (int i = 0; i < depth; ++i) key += "a.";
  return key + "a = 1\n";
}

const std::vector<BrokenScene> documents = {
    {"empty_file", "", 1, 1, {"at least one [[body]]"}},
    {"no_body", "title = \"x\"\n", 1, 1, {"at least one [[body]]"}},
    {"no_value", "[[body]]\nk =\n", 2, 4, {}},
    {"unclosed_string", "title = \"x\n[[body]]\n", 1, 11, {}},
    {"unclosed_table", "[camera\n[[body]]\n", 1, 8, {}},
    {"key_twice", sphere("k = 1\nk = 2"), 3, 5, {"k"}},
    {"table_twice", before_body("[camera]\n[picture]\n[camera]\n"), 3, 1, {"camera"}},
    {"not_utf8", "title = \"\xff\"\n[[body]]\n", 1, 10, {"ASCII but for comments"}},
    {"beyond_ascii_in_a_string", "title = \"x\xc3\xa4\"\n[[body]]\n", 1, 11, {"ASCII"}},
    {"beyond_ascii_in_an_open_string", "[[body]]\nk = 22'\xcd\x92\n", 2, 8, {"ASCII"}},
    {"form_feed_in_a_comment", "[[body]] # x\fk = 1\n", 1, 13, {"control character 0x0c"}},
    {"lone_carriage_return", "[[body]] # x\rk = 1\n", 1, 13, {"control character 0x0d"}},
    {"zero_byte", std::string("a\0b", 3), 1, 2, {"control character 0x00"}},
    {"values_nested_deep", nested_arrays(1000) + "[[body]]\n", 1, 21, {"depth"}},
    {"keys_nested_deep", dotted(200'000), 1, 202, {"100 dots", "nest a table"}},
    {"key_beyond_ascii", "gr\xc3\xb6sse = 1\n[[body]]\n", 1, 3, {"ASCII"}},
    {"string_of_several_lines", "title = \"\"\"\\\nx\"\"\"\n[[body]]\n", 1, 9, {"several lines"}},
    {"literal_of_several_lines", "title = '''\nx'''\n[[body]]\n", 1, 9, {"several lines"}},
    {"tab_in_a_word", "shadows = tru\te\n[[body]]\n", 1, 14, {"saw 'tru\\x09'"}},
    {"header_without_a_name", "[[body]]\n [ &", 2, 4, {"table's name"}},
    {"header_of_nothing", "[[body]]\n[]", 2, 2, {"blank"}},
    {"body_with_one_bracket", "[body]\nk = 1\n", 1, 2, {"[[body]]", "two brackets"}},
    {"body_is_a_number", "body = 5\n", 1, 1, {"[[body]]"}},
    {"body_holds_numbers", "body = [5]\n", 1, 1, {"[[body]]"}},
    {"no_bodies", "body = []\n", 1, 1, {"at least one"}},
    {"key_that_the_method_sets",
     before_body("[simulation]\nmethod = \"paper\"\nintegrator = \"rk4\""),
     3,
     14,
     {"integrator = \"rk4\"", "simulation.method = \"paper\" sets it", "to \"martin\""}},
    {"particles_that_the_method_sets",
     before_body("[simulation]\nmethod = \"paper\"\nparticles.per_vertex = 0.5"),
     3,
     24,
     {"per_vertex = 0.5", "method = \"paper\"", "to 0.125"}},
    {"body_key_that_the_method_sets",
     before_body("[simulation]\nmethod = \"paper\"") + "damping = \"literal\"\n",
     4,
     11,
     {"damping = \"literal\"", "method = \"paper\""}},
    {"camera_is_a_number", "camera = 5\n[[body]]\n", 1, 1, {"camera must be a table", "integer 5"}},
    {"particles_is_true",
     before_body("[simulation]\nparticles = true"),
     2,
     1,
     {"[simulation.particles]", "got true"}},
};

const std::vector<BrokenScene> unknown_keys = {
    {"misspelt_key",
     sphere("raduis = 3.0"),
     2,
     1,
     {"unknown key 'raduis' in [[body]]", "did you mean 'radius'?", "allowed: name, kind"}},
    {"misspelt_table",
     before_body("[simulatoin]\nseed = 1"),
     1,
     2,
     {"unknown key 'simulatoin'", "did you mean 'simulation'?"}},
    {"misspelt_particles",
     before_body("[simulation.partciles]"),
     1,
     13,
     {"did you mean 'particles'?"}},
    {"old_name_of_pressure_weighting",
     sphere("pressure = \"valence\""),
     2,
     1,
     {"body.pressure is now body.pressure_weighting"}},
    {"old_name_of_relaxation_time",
     before_body("[simulation]\nseparation_time = 0.1"),
     2,
     1,
     {"simulation.separation_time is now simulation.relaxation_time"}},
    {"old_name_of_contact_iterations",
     before_body("[simulation]\nimpulse_sweeps = 5"),
     2,
     1,
     {"simulation.impulse_sweeps is now simulation.contact_iterations"}},
    {"american_colors", sphere("colors = [\"#ffffff\"]"), 2, 1, {"did you mean 'colours'?"}},
    {"nothing_near",
     before_body("wavelength = 1"),
     1,
     1,
     {"unknown key 'wavelength' at the top", "allowed: title"}},
    {"duration_below_a_table",
     before_body("[camera]\nduration = 2"),
     2,
     1,
     {"unknown key 'duration' in [camera]", "belongs at the top, above the first [table]"}},
    {"gravity_of_a_body", sphere("gravity = [0, 0, 0]"), 2, 1, {"belongs in [simulation]"}},
    {"key_with_dots", sphere("k.spring = 1"), 2, 1, {"k: expected a number, got a table"}},
    {"strange_key", sphere("\"a\\u001bb\" = 1"), 2, 1, {"'a\\x1bb'"}},
};

const std::vector<BrokenScene> inapplicable_keys = {
    {"k_of_a_rigid_body", rigid("k = 10"), 3, 1, {"k applies to soft bodies only", "a rigid box"}},
    {"mass_of_a_soft_body",
     sphere("mass = 1"),
     2,
     1,
     {"mass applies to rigid bodies only", "a soft sphere"}},
    {"stacks_of_a_box",
     shaped("box", "stacks = 8"),
     3,
     1,
     {"stacks applies to spheres and tori only", "a soft box"}},
    {"tube_of_a_sphere", sphere("tube_radius = 1"), 2, 1, {"tori only"}},
    {"size_of_a_sphere", sphere("size = [1, 1, 1]"), 2, 1, {"boxes only"}},
    {"radius_of_a_box", rigid("radius = 1"), 3, 1, {"spheres, icospheres and tori only"}},
    {"subdivisions_of_a_torus", shaped("torus", "subdivisions = 1"), 3, 1, {"icospheres only"}},
    {"divisions_of_a_rigid_box", rigid("divisions = 2"), 3, 1, {"soft boxes only"}},
    {"axis_of_one_colour",
     sphere("colours = [\"#ffffff\"]\ncolour_axis = [1, 0, 0]"),
     3,
     1,
     {"bodies with two colours only"}},
    {"friction_of_no_ground",
     before_body("[ground]\npresent = false\nfriction = 1"),
     3,
     1,
     {"a ground that is present only", "present = false"}},
    {"azimuth_of_a_placed_camera",
     before_body("[camera]\neye = [9, 0, 1]\ntarget = [0, 0, 1]\nazimuth = 3"),
     4,
     1,
     {"a camera without eye and target only"}},
    {"rigid_sphere", rigid("shape = \"sphere\""), 3, 9, {"a rigid body is always a box"}},
};

const std::vector<BrokenScene> wrong_types = {
    {"string_for_a_number", sphere("k = \"x\""), 2, 5, {"k: expected a number, got string \"x\""}},
    {"flag_for_a_number", sphere("k = true"), 2, 5, {"expected a number, got true"}},
    {"date_for_a_number", sphere("k = 2009-05-01"), 2, 5, {"expected a number, got a date"}},
    {"table_for_a_number", sphere("k = {a = 1}"), 2, 5, {"expected a number, got a table"}},
    {"number_for_a_whole_number",
     sphere("stacks = 8.0"),
     2,
     10,
     {"stacks: expected a whole number, got number 8"}},
    {"number_for_a_flag",
     before_body("[picture]\nshadows = 1"),
     2,
     11,
     {"expected true or false, got integer 1"}},
    {"flag_for_a_string", before_body("title = true"), 1, 9, {"expected a string in quotes"}},
    {"number_for_a_word", sphere("kind = 1"), 2, 8, {"expected a word in quotes, got integer 1"}},
    {"number_for_a_vector", sphere("position = 3"), 2, 12, {"expected an array of 3 numbers"}},
    {"two_for_three",
     sphere("position = [1, 2]"),
     2,
     12,
     {"expected an array of 3 numbers, got an array of 2"}},
    {"four_for_three",
     sphere("copies = [1, 2, 3, 4]"),
     2,
     10,
     {"expected an array of 3 whole numbers, got an array of 4"}},
    {"string_in_a_vector",
     sphere("position = [1, \"x\", 3]"),
     2,
     16,
     {"position y: expected a number, got string \"x\""}},
    {"number_in_copies", sphere("copies = [1, 2.5, 3]"), 2, 14, {"copies y", "a whole number"}},
    {"no_colours", sphere("colours = []"), 2, 11, {"1 to 3 strings, got an array of 0"}},
    {"colour_that_is_none", sphere("colours = [\"red\"]"), 2, 12, {"'red'", "#rrggbb"}},
    {"unknown_word",
     before_body("[simulation]\nintegrator = \"rk5\""),
     2,
     14,
     {"unknown word 'rk5'", "did you mean 'rk4'?", "allowed: martin, symplectic_euler"}},
    {"unknown_shape", sphere("shape = \"cube\""), 2, 9, {"allowed: sphere, torus, box, icosphere"}},
};

const std::vector<BrokenScene> out_of_range = {
    {"negative_k",
     sphere("k = -5"),
     2,
     5,
     {"k = -5 N/m is out of range", "allowed: k >= 0 N/m", "spring constant"}},
    {"no_vertex_mass", sphere("vertex_mass = 0"), 2, 15, {"allowed: vertex_mass > 0 kg"}},
    {"rho_g_of_one", sphere("rho_g = 1"), 2, 9, {"allowed: 0 <= rho_g < 1"}},
    {"restitution_of_two", rigid("restitution = 2"), 3, 15, {"allowed: 0 <= restitution <= 1"}},
    {"sphere_of_one_vertex",
     sphere("stacks = 1"),
     2,
     10,
     {"stacks = 1 is out of range", "allowed: 2 <= stacks", "one fewer, between its poles"}},
    {"torus_of_two_circles", shaped("torus", "stacks = 2"), 3, 10, {"allowed: 3 <= stacks"}},
    {"two_slices", sphere("slices = 2"), 2, 10, {"allowed: 3 <= slices"}},
    {"negative_size", rigid("size = [1, -2, 3]"), 3, 12, {"size y = -2 m", "allowed: 0 < size"}},
    {"three_samples", before_body("[picture]\nsamples = 3"), 2, 11, {"samples = 1, 2 or 4"}},
    {"picture_too_wide", before_body("[picture]\nwidth = 16385"), 2, 9, {"16 <= width <= 16384"}},
    {"endless_gravity",
     before_body("[simulation]\ngravity = [0, 0, -inf]"),
     2,
     18,
     {"gravity z = -inf is not finite"}},
    {"nan_position", sphere("position = [nan, 0, 0]"), 2, 13, {"not finite", "of m"}},
    {"nan_k", sphere("k = nan"), 2, 5, {"k = nan is not finite"}},
    {"number_beyond_int", sphere("stacks = 4294967298"), 2, 10, {"out of range"}},
    {"negative_seed", before_body("[simulation]\nseed = -1"), 2, 8, {"allowed: seed >= 0"}},
    {"no_duration", before_body("duration = 0"), 1, 12, {"allowed: 0 < duration"}},
    {"many_copies", sphere("copies = [1, 1000001, 1]"), 2, 14, {"copies <= 1000000"}},
    {"name_with_a_space", sphere("name = \"a b\""), 2, 8, {"'a b' is not a name", "letters"}},
    {"name_of_a_table", sphere("name = \"camera\""), 2, 8, {"name of a table"}},
    {"title_of_two_lines", before_body("title = \"a\\nb\""), 1, 9, {"printable ASCII"}},
    {"title_escaped_beyond_ascii", before_body("title = \"\\u00e4\""), 1, 9, {"printable ASCII"}},
    {"long_title",
     before_body(std::string("title = \"").append(201, 'x').append("\"")),
     1,
     9,
     {"201 characters", "at most 200"}},
};

const std::vector<BrokenScene> across_keys = {
    {"torus_without_a_hole",
     shaped("torus", "tube_radius = 3.0"),
     3,
     15,
     {"tube_radius = 3 m must be less than radius = 3 m"}},
    {"frames_that_do_not_divide",
     before_body("[picture]\nframes_per_second = 25"),
     2,
     21,
     {"frames_per_second = 25 does not divide steps_per_second = 60", "20"}},
    {"steps_that_frames_do_not_divide",
     before_body("[simulation]\nsteps_per_second = 50"),
     2,
     20,
     {"frames_per_second = 30 does not divide steps_per_second = 50", "25"}},
    {"more_frames_than_steps",
     before_body("[picture]\nframes_per_second = 120"),
     2,
     21,
     {"does not divide", "60"}},
    {"part_of_a_frame", before_body("duration = 1.99"), 1, 12, {"59.7 frames of 1/30 s", "whole"}},
    {"nearly_whole_frames", before_body("duration = 2.0001"), 1, 12, {"60.003 frames"}},
    {"less_than_a_frame", before_body("duration = 0.01"), 1, 12, {"whole number", "0.0333"}},
    {"valence_by_an_implicit_integrator",
     before_body("[simulation]\nintegrator = \"sdirk2\"") + "pressure_weighting = \"valence\"",
     4,
     22,
     {"minimises an energy", "uniform", "rk4"}},
    {"eye_without_target", before_body("[camera]\neye = [1, 2, 3]"), 2, 7, {"eye without target"}},
    {"target_without_eye",
     before_body("[camera]\ntarget = [1, 2, 3]"),
     2,
     10,
     {"target without eye"}},
    {"eye_in_target",
     before_body("[camera]\neye = [1, 2, 3]\ntarget = [1, 2, 3.0]"),
     2,
     7,
     {"the same point"}},
    {"two_of_a_name",
     "[[body]]\nname = \"a\"\n[[body]]\nname = \"a\"\n",
     4,
     8,
     {"two bodies are called 'a'", "1 and 2"}},
    {"name_that_is_anothers_default",
     "[[body]]\nname = \"body2\"\n[[body]]\n",
     3,
     1,
     {"two bodies are called 'body2'"}},
    {"axis_without_direction", sphere("colour_axis = [0, 0, 0]"), 2, 15, {"no direction"}},
    {"copies_in_one_place",
     sphere("copies = [1, 1, 5]\nspacing = [3, 3, 0]"),
     3,
     11,
     {"5 copies along z", "set spacing"}},
};

}  // namespace

std::vector<BrokenScene> broken_scenes() {
  std::vector<BrokenScene> all;
  for (const auto* some :
       {&documents, &unknown_keys, &inapplicable_keys, &wrong_types, &out_of_range, &across_keys}) {
    all.insert(all.end(), some->begin(), some->end());
  }
  return all;
}

}  // namespace pneuma::scenes
