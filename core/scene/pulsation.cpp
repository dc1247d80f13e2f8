#include <cctype>
#include <cmath>
#include <numbers>
#include <ricochet/contract/errors.hpp>
#include <ricochet/scene/pulsation.hpp>
#include <ricochet/scene/semi_discrete.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace ricochet {
namespace {

struct OpenParenthesis {
  std::string function;  // "": of a group
  std::size_t begin = 0;
  bool of_t = false;  // whether t stands inside
};

bool is_circular(const OpenParenthesis& one) {
  return one.function == "sin" || one.function == "cos";
}

// A number as it is written, with its exponent, or a name.
std::string_view word_at(std::string_view text, std::size_t at) {
  std::size_t end = at;
  const auto digit = [&](std::size_t i) {
    return i < text.size() && std::isdigit(static_cast<unsigned char>(text[i]));
  };
  if (!digit(at) && text[at] != '.') {
    while (end < text.size() && (std::isalnum(static_cast<unsigned char>(text[end])) || text[end] == '_')) ++end;
    return text.substr(at, end - at);
  }
  while (digit(end) || (end < text.size() && text[end] == '.')) ++end;
  if (end < text.size() && (text[end] == 'e' || text[end] == 'E')) {
    const std::size_t sign = end + 1 < text.size() && (text[end + 1] == '+' || text[end + 1] == '-') ? 1 : 0;
    if (digit(end + 1 + sign)) end += 1 + sign;
    while (digit(end)) ++end;
  }
  return text.substr(at, end - at);
}

// What each sine and cosine of t is of; none where t stands elsewhere, or something compares.
std::optional<std::vector<std::string>> arguments_of_t(std::string_view text) {
  std::vector<std::string> arguments;
  std::vector<OpenParenthesis> open;
  std::string before;  // the name that a parenthesis follows
  for (std::size_t at = 0; at < text.size();) {
    const char c = text[at];
    if (std::isalnum(static_cast<unsigned char>(c)) || c == '.' || c == '_') {
      const std::string word(word_at(text, at));
      at += word.size();
      before = word;
      if (word != "t") continue;
      int functions = 0, circular = 0;
      for (OpenParenthesis& one : open) {
        functions += one.function.empty() ? 0 : 1;
        circular += is_circular(one) ? 1 : 0;
        one.of_t = true;
      }
      if (functions != 1 || circular != 1) return std::nullopt;
      continue;
    }
    ++at;
    if (c == '(') {
      open.push_back({before, at});
    } else if (c == ')') {
      if (open.empty()) return std::nullopt;
      if (open.back().of_t && is_circular(open.back()))
        arguments.emplace_back(text.substr(open.back().begin, at - 1 - open.back().begin));
      open.pop_back();
    } else if (std::string_view("+-*/^, \t\r\n").find(c) == std::string_view::npos) {
      return std::nullopt;
    }
    if (!std::isspace(static_cast<unsigned char>(c))) before.clear();
  }
  return arguments;
}

// Of an argument Ωt + ψ(x). Of a power of two, only the sum rounds.
std::optional<double> rate_of(const std::string& argument) {
  constexpr double far = 0x1p20;
  std::optional<double> rate;
  const Formula phase(argument, "");
  for (const double x : {0.0, 0.61803398874989485}) {
    const double start = phase.value(x, 0), own = (phase.value(x, far) - start) / far;
    for (const double t : {1.0, 0.375, 1234.5}) {
      const double expected = start + own * t, size = std::abs(start) + std::abs(own * t);
      if (!(std::abs(phase.value(x, t) - expected) <= 4 * 0x1p-52 * size)) return std::nullopt;
    }
    if (rate && *rate != own) return std::nullopt;
    rate = own;
  }
  return rate;
}

}  // namespace

std::optional<double> pulsation_of(const Formula& formula) {
  if (!formula.is_written() || !formula.uses_t()) return std::nullopt;
  if (const auto& one = formula.harmonic()) return std::abs(one->pulsation);
  const auto arguments = arguments_of_t(formula.text());
  std::optional<double> pulsation;
  if (!arguments) return std::nullopt;
  for (const std::string& argument : *arguments) {
    const auto rate = rate_of(argument);
    if (!rate || *rate == 0 || (pulsation && *pulsation != std::abs(*rate))) return std::nullopt;
    pulsation = std::abs(*rate);
  }
  return pulsation;
}

HarmonicParts harmonic_parts(const Eigen::VectorXd& start, const Eigen::VectorXd& quarter,
                             const Eigen::VectorXd& half) {
  HarmonicParts parts{0.5 * (start + half), {}, 0.5 * (start - half)};
  parts.along = quarter - parts.constant;
  return parts;
}

std::optional<double> DistributedLoad::pulsation() const {
  std::optional<double> pulsation;
  const auto takes = [&](const Formula& formula) {
    if (!formula.uses_t()) return true;
    const auto own = pulsation_of(formula);
    if (!own || (pulsation && *pulsation != *own)) return false;
    pulsation = own;
    return true;
  };
  if (!takes(formula_)) return std::nullopt;
  for (const Term& term : terms_)
    if (!takes(term.history)) return std::nullopt;
  if (!pulsation) return std::nullopt;
  // Products of sines have other pulsations, too: values over one period show it.
  const auto at = [&](double turns) {
    Eigen::VectorXd load(unknowns());
    assemble(turns * 2 * std::numbers::pi / *pulsation, load.data());
    return load;
  };
  const auto [constant, along, across] = harmonic_parts(at(0), at(0.25), at(0.5));
  const double size =
      constant.lpNorm<Eigen::Infinity>() + along.lpNorm<Eigen::Infinity>() + across.lpNorm<Eigen::Infinity>();
  constexpr double round_off = 1e-13;
  for (double turns = 0.07; turns < 1; turns += 0.0813) {
    const double angle = 2 * std::numbers::pi * turns;
    const Eigen::VectorXd told = constant + std::sin(angle) * along + std::cos(angle) * across;
    if (!((at(turns) - told).lpNorm<Eigen::Infinity>() <= round_off * size)) return std::nullopt;
  }
  return pulsation;
}

}  // namespace ricochet
