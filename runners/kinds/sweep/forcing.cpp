#include "runners/kinds/sweep/forcing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <ricochet/contract/errors.hpp>
#include <ricochet/scene/checks.hpp>
#include <ricochet/scene/formula.hpp>
#include <ricochet/scene/whole_load.hpp>
#include <string>
#include <vector>

#include "runners/json/json_text.hpp"

namespace ricochet {
namespace {

constexpr double tolerance = 1e-9;  // of numbers that a study rounds to ten digits or more
constexpr int most_periods = 10;    // of the slowest wave in that of all

double of_period(double period) {
  return 2 * std::numbers::pi / period;
}

/// Something that changes with time, and how fast it repeats.
struct Wave {
  std::string pointer, what;
  double pulsation = 0;  // rad/s; 0 of a history that says no period
};

std::vector<Wave> histories_of(const SceneSpec& scene) {
  std::vector<Wave> out;
  const auto add = [&](std::string pointer, std::string what, double period) {
    out.push_back({std::move(pointer), std::move(what), period > 0 ? of_period(period) : 0});
  };
  for (GivenMotion& one : given_motions(scene)) add(std::move(one.pointer), std::move(one.what), one.motion->period);
  for (std::size_t i = 0; i < scene.load.terms.size(); ++i)
    if (const LoadTerm& term = scene.load.terms[i]; term.table)
      add(pointer_to("/scene/load", i) + (term.force ? "/force" : "/time"), "the table of the load",
          term.table->period);
  return out;
}

/// Where the parenthesis that opens at `open` closes; npos: nowhere.
std::size_t closing(const std::string& text, std::size_t open) {
  int depth = 0;
  for (std::size_t i = open; i < text.size(); ++i) {
    if (text[i] == '(') ++depth;
    if (text[i] == ')' && --depth == 0) return i;
  }
  return std::string::npos;
}

// a of an argument a t + b, b of x alone; nothing where it is no such.
std::optional<double> rate_of(const std::string& argument) {
  try {
    const Formula formula(argument, "");
    if (!formula.uses_t()) return std::nullopt;
    const double begins = formula(0.37, 0), rate = formula(0.37, 1) - begins;
    for (const double t : {0.013, 0.61, 7.3, 229.0})
      if (std::abs(formula(0.37, t) - begins - rate * t) > 1e-11 * (std::abs(begins) + std::abs(rate) * (1 + t)))
        return std::nullopt;
    return rate != 0 ? std::optional(std::abs(rate)) : std::nullopt;
  } catch (const InputError&) {
    return std::nullopt;
  }
}

/// Pulsations of the waves in a formula: those of its sin, cos and tan of multiples of t.
std::vector<double> pulsations_in(const std::string& text) {
  const auto is_letter = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
  };
  std::vector<double> found;
  for (const std::string name : {"sin", "cos", "tan"})
    for (std::size_t at = text.find(name); at != std::string::npos; at = text.find(name, at + 1)) {
      if (at > 0 && is_letter(text[at - 1])) continue;
      const std::size_t open = text.find_first_not_of(' ', at + name.size());
      if (open == std::string::npos || text[open] != '(') continue;
      const std::size_t close = closing(text, open);
      if (close == std::string::npos) continue;
      if (const auto rate = rate_of(text.substr(open, close - open + 1))) found.push_back(*rate);
    }
  return found;
}

/// A part of the load that is a formula in t.
struct LoadFormula {
  Formula formula;
  std::string pointer, unit;
  double length = 0;  // m, along which it is looked at
};

std::vector<LoadFormula> formulas_of(const SceneSpec& scene) {
  std::vector<LoadFormula> out;
  if (scene.load.formula.uses_t()) out.push_back({scene.load.formula, "/scene/load", "N/m", structure_length(scene)});
  for (std::size_t i = 0; i < scene.load.terms.size(); ++i) {
    const LoadTerm& term = scene.load.terms[i];
    if (term.history.uses_t())
      out.push_back(
          {term.history, pointer_to("/scene/load", i) + (term.force ? "/force" : "/time"), term.force ? "N" : "", 0});
  }
  return out;
}

std::vector<Wave> waves_in_formulas(const SceneSpec& scene) {
  std::vector<Wave> out;
  for (const LoadFormula& load : formulas_of(scene))
    for (const double pulsation : pulsations_in(load.formula.text()))
      out.push_back({load.pointer, fmt::format("the load \"{}\"", shortened(load.formula.text())), pulsation});
  return out;
}

/// The support that moves and the forces that push; `still`: those of amplitude 0 that have a pulsation.
std::vector<Wave> harmonics_of(const SceneSpec& scene, bool still) {
  std::vector<Wave> out;
  const auto add = [&](double amplitude, double pulsation, const std::string& pointer, std::string what) {
    if ((amplitude == 0) == still && pulsation > 0) out.push_back({pointer, std::move(what), pulsation});
  };
  add(scene.support.amplitude, scene.support.pulsation, "/scene/support/pulsation", "the support");
  for (const auto& [force, body, pointer] : harmonic_forces(scene))
    add(force.amplitude, force.pulsation, pointer + "/pulsation",
        body.empty() ? std::string("the force") : "the force on " + body);
  return out;
}

/// The pulsation with which all repeats, and what does not repeat with the rest.
struct Forcing {
  double pulsation = 0;
  std::optional<std::pair<std::size_t, std::size_t>> apart = {};  // two waves without a common period
};

// Whole numbers a, b with first/second = a/b, b up to most_periods; nothing: there are none.
std::optional<std::pair<double, int>> ratio_of(double first, double second) {
  for (int b = 1; b <= most_periods; ++b) {
    const double a = std::round(first / second * b);
    if (a >= 1 && std::abs(first / second * b - a) <= tolerance * a) return std::pair(a, b);
  }
  return std::nullopt;
}

Forcing common_period(const std::vector<Wave>& waves) {
  Forcing out;
  std::size_t slowest = 0;
  for (std::size_t k = 0; k < waves.size(); ++k) {
    const double one = waves[k].pulsation;
    if (!(one > 0)) continue;
    if (out.pulsation == 0) {
      out.pulsation = one;
      slowest = k;
      continue;
    }
    const auto ratio = ratio_of(one, out.pulsation);
    // The number that a study gives, in all its digits, where that is the slowest.
    const double common = !ratio ? 0 : ratio->first == 1 ? one : out.pulsation / ratio->second;
    const double least = std::min(waves[slowest].pulsation, one);
    if (!ratio || least / common > most_periods + 0.5) {
      out.apart.emplace(k, slowest);
      return out;
    }
    out.pulsation = common;
    if (one == least) slowest = k;
  }
  return out;
}

// A formula may repeat sooner than its waves: sin² twice as soon.
double shortest(const std::vector<LoadFormula>& loads, double pulsation) {
  constexpr int most = 12, phases = 64;
  const auto repeats = [&](const LoadFormula& load, double period) {
    double largest = 0, worst = 0;
    for (int j = 0; j < phases; ++j)
      for (const double x : {0.37 * load.length, load.length}) {
        const double t = 2 * std::numbers::pi / pulsation * (j + 0.5 * std::numbers::inv_pi) / phases;
        const double value = load.formula.value(x, t);
        largest = std::max(largest, std::abs(value));
        worst = std::max(worst, std::abs(load.formula.value(x, t + period) - value));
      }
    return worst <= tolerance * largest;
  };
  for (int k = most; k > 1; --k)
    if (std::all_of(loads.begin(), loads.end(),
                    [&](const LoadFormula& load) { return repeats(load, of_period(pulsation * k)); }))
      return pulsation * k;
  return pulsation;
}

std::vector<Wave> driving(const SceneSpec& scene) {
  std::vector<Wave> waves = harmonics_of(scene, false);
  if (waves.empty()) {
    waves = harmonics_of(scene, true);
    if (!waves.empty()) waves.resize(1);
  }
  for (Wave& one : histories_of(scene)) waves.push_back(std::move(one));
  for (Wave& one : waves_in_formulas(scene)) waves.push_back(std::move(one));
  return waves;
}

/// The period that a study states beside what moves; 0: none.
double stated(const SceneSpec& scene) {
  const std::vector<Wave> still = harmonics_of(scene, true);
  return harmonics_of(scene, false).empty() && !still.empty() ? still.front().pulsation : 0;
}

}  // namespace

double forcing_pulsation(const SceneSpec& scene) {
  if (const double said = stated(scene); said > 0) return said;
  const double common = common_period(driving(scene)).pulsation;
  if (common == 0 || !harmonics_of(scene, false).empty() || !histories_of(scene).empty()) return common;
  return shortest(formulas_of(scene), common);
}

std::string forcing_note(const SceneSpec& scene) {
  const std::vector<Wave> waves = driving(scene);
  const Forcing forcing = common_period(waves);
  if (forcing.apart || forcing.pulsation == 0 || stated(scene) > 0) return "";
  const double pulsation = forcing_pulsation(scene);
  std::string periods;
  for (const Wave& one : waves) {
    const double count = std::round(one.pulsation / pulsation);
    if (count <= 1) return "";
    periods += fmt::format("{}{:.0f} of {}", periods.empty() ? "" : ", ", count, one.what);
  }
  return fmt::format("the forcing repeats after {:.6g} s: {}", of_period(pulsation), periods);
}

bool is_forced(const SceneSpec& scene) {
  return !harmonics_of(scene, false).empty() || scene.load.uses_t() || !given_motions(scene).empty();
}

namespace {

// That a part of the load repeats with the period of the forcing, wherever it is looked at.
void check_repeats(const LoadFormula& load, double period) {
  constexpr int places = 9, phases = 64;
  double largest = 0, worst = 0, worst_x = 0, worst_t = 0, worst_k = 0;
  for (int i = 0; i < places; ++i)
    for (int j = 0; j < phases; ++j) {
      const double x = load.length * i / (places - 1);
      const double t = period * (j + 0.5 * std::numbers::inv_pi) / phases;
      const double value = load.formula(x, t);
      largest = std::max(largest, std::abs(value));
      for (const double k : {1.0, 2.0, 7.0, 50.0, 300.0, 2000.0}) {
        const double change = std::abs(load.formula(x, t + k * period) - value);
        if (change <= worst) continue;
        worst = change, worst_x = x, worst_t = t, worst_k = k;
      }
    }
  if (worst > tolerance * largest)
    throw InputError(
        load.pointer,
        fmt::format("the load \"{}\" does not repeat with the forcing period of {:.6g} s. At x = {:.6g} m it differs "
                    "by {:.3g}{} between t = {:.6g} s and {:g} period{} later. Expected f(x, t + T) = f(x, t)",
                    shortened(load.formula.text()), period, worst_x, worst, load.unit.empty() ? "" : " " + load.unit,
                    worst_t, worst_k, worst_k == 1 ? "" : "s"));
}

}  // namespace

void check_forcing(const SceneSpec& scene) {
  const std::vector<Wave> histories = histories_of(scene);
  for (const Wave& one : histories)
    if (one.pulsation == 0)
      throw InputError(
          one.pointer,
          "says no period, and steps per period need one: expected \"period\" (s) of a table that repeats, or "
          "\"pulsation\" (rad/s) of a formula that does. A displacement may have an amplitude and a pulsation instead");
  const std::vector<Wave> waves = driving(scene);
  if (waves.empty()) {
    const auto forces = harmonic_forces(scene);
    const auto of_force =
        std::find_if(forces.begin(), forces.end(), [](const auto& one) { return one.force.amplitude != 0; });
    const bool shaken = scene.support.amplitude != 0 || of_force == forces.end();
    throw InputError(shaken ? "/scene/support/pulsation" : of_force->pointer + "/pulsation",
                     fmt::format("no forcing has a period (the pulsation is 0), and steps per period need one. "
                                 "Expected: a pulsation above 0 of the support{}, the period of a motion or a table, "
                                 "or sin(ωt) and cos(ωt) in a load",
                                 forces.empty() ? "" : " or of a force"));
  }
  const double said = stated(scene);
  if (const auto apart = common_period(waves).apart) {
    const Wave &one = waves[apart->first], &other = waves[apart->second];
    throw InputError(
        one.pointer,
        fmt::format("{} does not repeat with {}: {:.9g} rad/s and {:.9g} rad/s ({:.9g} s and {:.9g} s) have no common "
                    "period of at most {} times the longer. Expected pulsations whose ratio is one of small whole "
                    "numbers",
                    one.what, other.what, one.pulsation, other.pulsation, of_period(one.pulsation),
                    of_period(other.pulsation), most_periods));
  }
  const double period = of_period(forcing_pulsation(scene));
  for (const Wave& one : histories)
    if (const double ratio = period / of_period(one.pulsation);
        said > 0 && std::abs(ratio - std::round(ratio)) > tolerance * ratio)
      throw InputError(one.pointer,
                       fmt::format("repeats after {:.9g} s, and the period is stated as {:.9g} s; expected "
                                   "a whole fraction of that",
                                   of_period(one.pulsation), period));
  for (const LoadFormula& load : formulas_of(scene)) check_repeats(load, period);  // of its own copies
}

}  // namespace ricochet
