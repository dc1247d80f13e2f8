#include <algorithm>
#include <array>
#include <charconv>
#include <ricochet/measure/orbits/motion_class.hpp>

namespace ricochet {
namespace {

// In the order of Regime.
constexpr std::array<const char*, 7> regime_words = {"no contact", "at rest",   "periodic", "quasi-periodic",
                                                     "chaotic",    "undecided", "failed"};
constexpr double longest_told = 1e9;  // forcing periods; beyond, a cell holds no period

std::optional<Regime> regime_of(std::string_view word) {
  for (std::size_t k = 0; k < regime_words.size(); ++k)
    if (word == regime_words[k]) return static_cast<Regime>(k);
  return std::nullopt;
}

}  // namespace

const char* text(Regime regime) {
  return regime_words[static_cast<std::size_t>(regime)];
}

std::string text(const MotionClass& motion) {
  const std::string word = text(motion.regime);
  return motion.regime == Regime::periodic ? word + " " + std::to_string(motion.period) : word;
}

std::optional<MotionClass> motion_class(std::string_view words) {
  // No word of a regime ends in a digit: what follows the last space is a period where it is a number.
  const std::size_t space = words.rfind(' ');
  if (space != std::string_view::npos) {
    const char *begin = words.data() + space + 1, *end = words.data() + words.size();
    int period = 0;
    if (const auto read = std::from_chars(begin, end, period); read.ec == std::errc() && read.ptr == end)
      return regime_of(words.substr(0, space)) == Regime::periodic ? motion_class("periodic", period) : std::nullopt;
  }
  return motion_class(words, std::nullopt);
}

std::optional<MotionClass> motion_class(std::string_view regime, std::optional<double> period) {
  const auto known = regime_of(regime);
  if (!known) return std::nullopt;
  if (*known != Regime::periodic) return MotionClass{*known, 0};
  if (!period || !(*period >= 1) || !(*period < longest_told)) return std::nullopt;
  return MotionClass{*known, static_cast<int>(*period)};
}

int cycle_of(const MotionClass& motion, int period) {
  const bool linear = motion.regime == Regime::no_contact || motion.regime == Regime::at_rest;
  return linear ? std::max(period, 1) : motion.period;
}

}  // namespace ricochet
