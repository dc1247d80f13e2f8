#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <ricochet/measure/orbits/regime.hpp>

namespace ricochet {

namespace {

constexpr double longest_told = 1e9;  // forcing periods; beyond, a cell holds no period

bool says_period(std::optional<Regime> regime) {
  return regime && MotionClass{*regime}.repeats();
}

}  // namespace

std::string text(const MotionClass& motion) {
  const std::string said = word(motion.regime);
  return motion.repeats() ? said + " " + std::to_string(motion.period) : said;
}

std::optional<MotionClass> motion_class(std::string_view words) {
  // No word of a regime ends in a digit: what follows the last space is a period where it is a number.
  const std::size_t space = words.rfind(' ');
  if (space != std::string_view::npos) {
    const char *begin = words.data() + space + 1, *end = words.data() + words.size();
    int period = 0;
    if (const auto read = std::from_chars(begin, end, period); read.ec == std::errc() && read.ptr == end)
      return says_period(of_word<Regime>(words.substr(0, space))) ? motion_class(words.substr(0, space), period)
                                                                  : std::nullopt;
  }
  return motion_class(words, std::nullopt);
}

std::optional<MotionClass> motion_class(std::string_view regime, std::optional<double> period) {
  const auto known = of_word<Regime>(regime);
  if (!known) return std::nullopt;
  if (!says_period(known)) return MotionClass{*known, 0};
  if (!period || !(*period >= 1) || !(*period < longest_told)) return std::nullopt;
  return MotionClass{*known, static_cast<int>(*period)};
}

int cycle_of(const MotionClass& motion, int period) {
  const bool linear = motion.regime == Regime::no_contact || motion.regime == Regime::at_rest;
  return linear ? std::max(period, 1) : motion.period;
}

namespace {

constexpr double regular_below = 0.2, chaotic_above = 0.8;
constexpr double seen_growth = 2;   // of a deviation over the window
constexpr double approached = 0.5;  // of the first distance at the end of the window

std::string count_text(int n, const char* what) {
  return n == 1 ? fmt::format("every {}", what) : fmt::format("every {} {}s", n, what);
}

std::string exponent_text(const Interval& e) {
  if (std::isinf(e.value)) return "superstable (exponent −∞)";
  return fmt::format("exponent {:.3g} 1/s in [{:.3g}, {:.3g}]", e.value, e.low, e.high);
}

std::string zero_one_text(const RegimeInput& input) {
  return input.zero_one ? fmt::format("K = {:.2f}", *input.zero_one)
                        : fmt::format("no 0–1 test ({} kept periods are needed)", zero_one_readings);
}

std::string distance_text(const RegimeInput& input) {
  const Recurrence& r = input.recurrence;
  if (r.window == 0) return "too few periods were kept to see a recurrence";
  return fmt::format("no recurrence within {:.1g} in {} periods (nearest {:.2g})", input.tolerance, r.window,
                     r.distance);
}

std::string repeats_text(const RegimeInput& input) {
  const Recurrence& r = input.recurrence;
  const std::string lag = count_text(r.period, "forcing period");
  if (r.distance > input.tolerance)
    return fmt::format("settles {} (distances, {:.2g} at most, shrink by {:.4g} per period towards less than {:.1g})",
                       lag, r.distance, r.contraction, input.tolerance);
  std::string text = fmt::format("repeats {} within {:.2g} over {} periods", lag, r.distance, r.window);
  if (input.placed > 0) text += fmt::format(" (the step places its impacts to {:.2g} per period)", input.placed);
  return text;
}

// Growth of a deviation over the window, at the lower end of the exponent's interval: its logarithm. Nothing without T.
std::optional<double> least_growth(const RegimeInput& input) {
  if (input.forcing_period <= 0) return std::nullopt;
  return input.exponent->low * input.forcing_period * input.recurrence.window;
}

// Whether the exponent's interval lies above zero by what the window would show.
bool grows(const RegimeInput& input) {
  if (!input.exponent || input.exponent->low <= 0) return false;
  const std::optional<double> growth = least_growth(input);
  return !growth || *growth >= std::log(seen_growth);
}

// Whether a deviation grows by more than neighbours of a regular orbit may part: N-fold over N periods (shear).
bool outgrows_shear(const RegimeInput& input) {
  const std::optional<double> growth = least_growth(input);
  return !growth || *growth > std::log(input.recurrence.window);
}

bool regular(const RegimeInput& input) {
  return input.zero_one && *input.zero_one < regular_below;
}

bool distances_halve(const Recurrence& r) {
  return r.window > 0 && r.contraction < 1 && std::pow(r.contraction, r.window) < approached;
}

bool ranges_shrink(const RegimeInput& input) {
  return input.shrunk < 1;
}

bool still_arriving(const RegimeInput& input) {
  return distances_halve(input.recurrence) || ranges_shrink(input);
}

std::string arriving_text(const RegimeInput& input) {
  if (ranges_shrink(input))
    return fmt::format("ranges shrink from third to third of the window, to {:.3g}", input.shrunk);
  return fmt::format("distances shrink by {:.4g} per period", input.recurrence.contraction);
}

// What is missing, or what contradicts, where nothing is decided.
std::string undecided_text(const RegimeInput& input) {
  std::string text = distance_text(input);
  const std::string settling = ", " + arriving_text(input) + ": still settling";
  if (input.exponent) {
    text += ", " + exponent_text(*input.exponent);
    if (input.exponent->high < 0) {
      text += fmt::format(" and {}", zero_one_text(input));
      return text + (input.settled ? ": neighbours approach each other, the period may exceed the longest looked for"
                                   : ": neighbours approach each other, a longer transient may settle");
    }
    if (grows(input))
      return text + fmt::format(", but {}: neighbours of a regular orbit part as far in {} periods; keep more periods",
                                regular(input) ? zero_one_text(input) + " is regular" : arriving_text(input),
                                input.recurrence.window);
    if (!input.zero_one) return text + ": " + zero_one_text(input) + " tells regular from chaotic";
    if (regular(input)) return text + " and " + zero_one_text(input) + settling;
    return text + fmt::format(" and {}: neither regular (below {}) nor an exponent above zero; keep more periods",
                              zero_one_text(input), regular_below);
  }
  text += fmt::format(", no exponent, {}", zero_one_text(input));
  if (!input.zero_one) return text + ": keep more periods or ask for an exponent";
  const bool decides = *input.zero_one > chaotic_above ? ranges_shrink(input) : regular(input);
  if (decides && still_arriving(input)) return text + settling;
  return text + ": ask for an exponent or keep more periods";
}

}  // namespace

RegimeVerdict classify(const RegimeInput& input) {
  const Recurrence& r = input.recurrence;
  const std::string cut = input.settled ? "" : "; the transient was cut at its cap";
  const std::string linear = (r.period > 0 ? "; the motion " + repeats_text(input) : std::string()) + cut;
  if (!input.contact) return {{Regime::no_contact}, r.period, "no stop was touched" + linear};
  if (input.rests) return {{Regime::at_rest}, r.period, "the contact with the stop never opened" + linear};
  if (input.doubtful > 0)
    return {{Regime::undecided},
            0,
            fmt::format("not resolved by the step: readings {} period{} apart differ by {:.2g} at most, and the step "
                        "places impacts to {:.2g} per period. Take more steps per period",
                        input.doubtful, input.doubtful == 1 ? "" : "s", input.doubtful_distance, input.placed)};
  if (r.period > 0) {
    std::string text = repeats_text(input) + fmt::format(", {:.4g} impacts per period", input.impacts_per_period);
    if (input.exponent) text += ", " + exponent_text(*input.exponent);
    if (grows(input))
      return {{Regime::undecided}, r.period, text + ": an orbit that repeats and grows is contradictory"};
    if (input.sticks) text += "; a point that rebounds comes to rest on its stop, so the step counts its impacts";
    return {{input.sticks ? Regime::chattering : Regime::periodic, r.period}, r.period, text + cut};
  }
  const std::string impacts = fmt::format(", {:.4g} impacts per period", input.impacts_per_period);
  if (input.exponent) {
    const std::string text = exponent_text(*input.exponent) + ", " + zero_one_text(input) + ", " + distance_text(input);
    const bool doubted = regular(input) || ranges_shrink(input);
    if (grows(input)) {
      if (!doubted || outgrows_shear(input)) return {{Regime::chaotic}, 0, text + impacts};
    } else if (input.exponent->high >= 0 && regular(input) && !still_arriving(input)) {
      return {{Regime::quasi_periodic}, 0, text + impacts};
    }
  } else if (input.zero_one) {
    const std::string text = zero_one_text(input) + " without an exponent, " + distance_text(input);
    if (*input.zero_one > chaotic_above && !ranges_shrink(input)) return {{Regime::chaotic}, 0, text + impacts};
    if (r.window > 0 && regular(input) && !still_arriving(input)) return {{Regime::quasi_periodic}, 0, text + impacts};
  }
  return {{Regime::undecided}, 0, undecided_text(input) + cut};
}

}  // namespace ricochet
