#include <fmt/format.h>
#include <muParser.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <ricochet/contract/errors.hpp>
#include <ricochet/scene/formula.hpp>
#include <ricochet/scene/formula_errors.hpp>
#include <vector>

namespace ricochet {
namespace {

std::string variables_in_words(const std::string& variables) {
  if (variables.empty()) return "no variable may appear";
  if (variables == "x") return "the only variable is x";
  if (variables == "t") return "the only variable is t";
  return "the variables are x and t";
}

std::vector<std::string> letters(const std::string& variables) {
  std::vector<std::string> names;
  for (const char variable : variables) names.emplace_back(1, variable);
  return names;
}

/// Derivative at s of the Lagrange polynomials on the nodes −3 … 3.
std::array<double, 7> derivative_weights(double s) {
  std::array<double, 7> weights{};
  for (int j = 0; j < 7; ++j) {
    for (int m = 0; m < 7; ++m) {
      if (m == j) continue;
      double product = 1.0 / (j - m);
      for (int k = 0; k < 7; ++k)
        if (k != j && k != m) product *= (s + 3 - k) / (j - k);
      weights[j] += product;
    }
  }
  return weights;
}

}  // namespace

struct Formula::State {
  std::string text, pointer, variables;
  bool uses_x = false, uses_t = false;
  double constant = 0;
  double x = 0, t = 0;  // what the parser reads
  std::optional<mu::Parser> parser;

  bool varies() const { return uses_x || uses_t; }

  void compile() {
    parser.emplace();
    parser->DefineConst("pi", std::numbers::pi);
    parser->DefineConst("e", std::numbers::e);
    if (variables.find('x') != std::string::npos) parser->DefineVar("x", &x);
    if (variables.find('t') != std::string::npos) parser->DefineVar("t", &t);
    parser->SetExpr(text);
    constant = parser->Eval();  // first: unlike GetUsedVar() it names an unknown word as such
    const auto& used = parser->GetUsedVar();
    uses_x = used.contains("x");
    uses_t = used.contains("t");
    parser->Eval();
    if (parser->GetNumResults() != 1)
      throw InputError(pointer, fmt::format("the formula \"{}\" gives {} values; expected one (decimals take a point)",
                                            text, parser->GetNumResults()));
  }

  double value(double at_x, double at_t) {
    if (!varies()) return constant;
    x = at_x;
    t = at_t;
    try {
      return parser->Eval();
    } catch (const mu::ParserError&) {
      return std::numeric_limits<double>::quiet_NaN();
    }
  }
};

Formula::Formula() : Formula(0.0) {}

Formula::Formula(double constant) : state_(std::make_unique<State>()) {
  state_->constant = constant;
  state_->text = fmt::format("{}", constant);
  if (!std::isfinite(constant)) throw InputError("", fmt::format("{} is not a finite number", constant));
}

Formula::Formula(const std::string& text, const std::string& pointer, const std::string& variables)
    : state_(std::make_unique<State>()) {
  state_->text = text;
  state_->pointer = pointer;
  state_->variables = variables;
  require_expression(text, pointer);
  try {
    state_->compile();
  } catch (const mu::ParserError& error) {
    explain_formula(*state_->parser, error, text, pointer, letters(variables), variables_in_words(variables));
  }
  if (state_->varies()) return;
  if (!std::isfinite(state_->constant))
    throw InputError(pointer, fmt::format("the formula \"{}\" gives {}; expected a finite number", text,
                                          std::isnan(state_->constant) ? "no number (NaN)" : "an infinite value"));
  state_->parser.reset();
}

Formula::Formula(const Formula& other) : state_(std::make_unique<State>()) {
  // The parser points at its own State's x and t, so a copy compiles its own.
  state_->text = other.state_->text;
  state_->pointer = other.state_->pointer;
  state_->variables = other.state_->variables;
  state_->constant = other.state_->constant;
  if (other.state_->varies()) state_->compile();
}

Formula::Formula(Formula&&) noexcept = default;
Formula& Formula::operator=(Formula&&) noexcept = default;
Formula::~Formula() = default;

Formula& Formula::operator=(const Formula& other) {
  if (this != &other) *this = Formula(other);
  return *this;
}

double Formula::operator()(double x, double t) const {
  const double value = state_->value(x, t);
  if (std::isfinite(value)) return value;
  throw InputError(state_->pointer,
                   fmt::format("the formula \"{}\" gives {} at x = {:.6g} m{}; expected a finite number", state_->text,
                               std::isnan(value) ? "no number (NaN)" : "an infinite value", x,
                               state_->uses_t ? fmt::format(", t = {:.6g} s", t) : ""));
}

double Formula::value(double x, double t) const {
  return state_->value(x, t);
}

void Formula::evaluate(std::span<const double> x, double t, std::span<double> values) const {
  assert(x.size() == values.size());
  if (!state_->uses_x) {
    std::fill(values.begin(), values.end(), state_->value(0, t));
    return;
  }
  for (std::size_t i = 0; i < x.size(); ++i) values[i] = state_->value(x[i], t);
}

double Formula::slope(double x, double low, double high, double t) const {
  assert(low < high && low <= x && x <= high);
  if (!uses_x()) return 0;
  // 1/256 of the interval: for waves as long as the interval, truncation (~d⁶) and round-off (~1/d) both stay near
  // 1e-13.
  const double spacing = (high - low) / 256;
  const double centre = std::clamp(x, low + 3 * spacing, high - 3 * spacing);
  const auto weights = derivative_weights((x - centre) / spacing);
  double sum = 0;
  for (int j = 0; j < 7; ++j) sum += weights[j] * (*this)(std::clamp(centre + (j - 3) * spacing, low, high), t);
  return sum / spacing;
}

bool Formula::uses_x() const {
  return state_->uses_x;
}
bool Formula::uses_t() const {
  return state_->uses_t;
}
bool Formula::is_zero() const {
  return !state_->varies() && state_->constant == 0;
}
const std::string& Formula::text() const {
  return state_->text;
}

}  // namespace ricochet
