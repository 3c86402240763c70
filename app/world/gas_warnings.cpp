#include "app/world/gas_warnings.h"

#include <fmt/format.h>

#include <cmath>

#include "app/world/distinct_bodies.h"
#include "app/world/fill_body.h"
#include "sim/base/text.h"

namespace pneuma::app {
namespace {

/// Of the ambient pressure: gas that lacks more than this gives way to it rather than to a weight.
constexpr double most_below = 0.25;
/// Times the gas that there is: if a body needs more, it has next to none, as where flat faces have
/// given way before the springs were stretched.
constexpr double far_too_little_gas = 10.0;

}  // namespace

std::string volumes_text(const GasAdvice& advice) {
  const std::string start =
      base::text(advice.volume) + " m^3 at the start, " +
      (advice.filled_at ? fmt::format("with its gas of {:g} s, {:g} mol at {:g} K, ",
                                      *advice.filled_at, advice.n, advice.temperature)
                        : "");
  if (advice.left_out) {
    return fmt::format("{}at rest not predicted: with {} vertices that takes long", start,
                       advice.vertices);
  }
  if (!advice.settled) return start + "no balance of springs and gas was found";
  if (std::isinf(*advice.settled)) return start + "growing for ever: its gas meets no springs";
  const std::string times = fmt::format("{:.3g}", *advice.settled / advice.volume);
  return fmt::format("{}{} m^3{} at rest without weight", start, base::text(*advice.settled),
                     times == "1" ? "" : fmt::format(" ({} times)", times));
}

std::string gas_warning(const GasAdvice& advice) {
  const std::string grows =
      fmt::format("{}: gas blows {} up: {}", body_and_alike(advice.body, advice.count),
                  advice.count > 1 ? "them" : "it", volumes_text(advice));
  if (advice.k == 0.0) return grows + "; springs need a k above 0 N/m, or the body n = 0";
  if (advice.filled_at) return grows + "; let its keys give it less, or give it a greater k";
  if (!advice.max_held) return grows + "; inflation = 1.5 alone would make it 1.5 times";
  const bool carries = !advice.held_mass || *advice.held_mass >= advice.mass;
  return fmt::format(
      "{}; to keep its size use rest = \"equilibrium\" with n of at most {} mol, which is what "
      "springs of k = {:g} N/m hold{}",
      grows, base::text_below(*advice.max_held), advice.k,
      carries
          ? ""
          : fmt::format(", and mass = {} kg, which that carries (now {:.3g} kg), or a greater k",
                        base::text_below(*advice.held_mass), advice.mass));
}

std::string shape_warning(const GasAdvice& advice) {
  const std::string body = body_and_alike(advice.body, advice.count);
  if (!advice.steady_k) {
    const bool is_much = advice.gas_over_held() > 1.0;
    return fmt::format(
        "{}: with rest = \"equilibrium\" springs of {} leave a part of the pressure unbalanced: "
        "{}; {} keeps its shape better",
        body, is_much ? fmt::format("k = {:g} N/m", advice.k) : "this mesh", volumes_text(advice),
        is_much ? fmt::format("n of at most {} mol, or a greater k,",
                              base::text_below(*advice.max_held))
                : "a greater k or a coarser mesh");
  }
  const std::string folds = fmt::format(
      "{}: with rest = \"equilibrium\" springs of k = {:g} N/m balance its gas, but the slightest "
      "push folds it; ",
      body, advice.k);
  if (std::isinf(*advice.steady_k)) return folds + "give it bending, or a rounder shape";
  return fmt::format("{}use at least k = {} N/m", folds, base::text_above(*advice.steady_k));
}

std::string start_warning(const GasAdvice& advice) {
  const double speed = std::sqrt(2.0 * advice.set_free / advice.mass);
  return fmt::format(
      "{}: starts far from rest: on its way to {:.3g} times its volume gas sets free {:.3g} J, "
      "which moves its {:.3g} kg at {:.3g} m/s and shatters its shape; give it gauge_pressure = "
      "{:.3g} Pa, which is what is left there, in place of n or inflation",
      body_and_alike(advice.body, advice.count), *advice.settled / advice.volume, advice.set_free,
      advice.mass, speed, advice.settled_pressure);
}

std::string weight_warning(const GasAdvice& advice) {
  if (advice.limp) {
    return fmt::format(
        "{}: without gas (n = 0) its springs of k = {:g} N/m hardly carry its weight of {:.3g} N: "
        "it falls flat; give it gauge_pressure = {:.3g} Pa and rest = \"equilibrium\", or bending",
        body_and_alike(advice.body, advice.count), advice.k, advice.weight,
        advice.carrying_pressure);
  }
  if (advice.pressure_at_start < -most_below * advice.ambient_pressure) {
    return fmt::format(
        "{}: its n = {:g} mol of gas{} presses with {:.3g} Pa from inside, ambient_pressure with "
        "{:g} Pa from outside, which crushes it to {:.3g} m^3 of its {:.3g} m^3; give it "
        "gauge_pressure = {:.3g} Pa or a little more instead",
        body_and_alike(advice.body, advice.count), advice.n,
        advice.filled_at ? fmt::format(" of {:g} s", *advice.filled_at) : "",
        advice.ambient_pressure + advice.pressure_at_start, advice.ambient_pressure,
        *advice.pressed, advice.volume, advice.carrying_pressure);
  }
  const std::string crushed = fmt::format(
      "{}: too heavy for its gas, which would carry its weight in {:.3g} m^3 of its {:.3g} m^3; ",
      body_and_alike(advice.body, advice.count), *advice.pressed, advice.volume);
  const std::string lighter =
      advice.light_mass > 0.0
          ? fmt::format("make it lighter, with a mass of at most {} kg in place of {:.3g} kg, or ",
                        base::text_below(advice.light_mass), advice.mass)
          : "";
  if (!advice.strengthened || advice.k == 0.0) {
    return fmt::format("{}{}give it gauge_pressure = {:.3g} Pa, and springs that hold that",
                       crushed, lighter, advice.carrying_pressure);
  }
  // Springs that leave their shape already must be stronger than the gas.
  const double stronger = *advice.strengthened * advice.gas_over_held();
  const double k = stronger * advice.k;
  const std::string hinges =
      advice.bending > 0.0 ? fmt::format(", bending = {:.3g}", stronger * advice.bending) : "";
  const std::string more_gas =
      *advice.strengthened > far_too_little_gas ? "; a greater inflation may do as well" : "";
  return fmt::format(
      "{}{}give it springs {:.3g} times as strong, k = {:.3g} N/m (stiffness = {:.3g} N/m){}, and "
      "{:.3g} times the gas, n = {:.4g} mol, or gauge_pressure = {:.3g} Pa, or the inflation that "
      "it has{}",
      crushed, lighter, stronger, k, k / k_per_stiffness, hinges, *advice.strengthened,
      *advice.strengthened * advice.n, advice.carrying_pressure, more_gas);
}

}  // namespace pneuma::app
