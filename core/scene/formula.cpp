#include <fmt/format.h>
#include <fmt/ranges.h>
#include <muParser.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cctype>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <mutex>
#include <numbers>
#include <ricochet/contract/errors.hpp>
#include <ricochet/scene/formula.hpp>
#include <set>
#include <vector>

namespace ricochet {

namespace {

std::string variables_in_words(const std::string& variables) {
  if (variables.empty()) return "no variable may appear";
  if (variables == "x") return "the only variable is x";
  if (variables == "t" || variables == "f") return "the only variable is " + variables;
  return "the variables are x and t";
}

std::vector<std::string> letters(const std::string& variables) {
  std::vector<std::string> names;
  for (const char variable : variables) names.emplace_back(1, variable);
  return names;
}

/// Of a text that is a decimal number alone, which needs no parser.
std::optional<double> written_number(const std::string& text) {
  const std::size_t first = text.starts_with('-') ? 1 : 0;
  if (first == text.size() || std::isdigit(static_cast<unsigned char>(text[first])) == 0) return std::nullopt;
  double number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
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

/// What is evaluated: a parser and the variables that it reads, for one thread at a time.
struct Formula::Compiled {
  double x = 0, t = 0;
  mu::Parser parser;

  explicit Compiled(const std::string& variables) {
    parser.DefineConst("pi", std::numbers::pi);
    parser.DefineConst("e", std::numbers::e);
    if (variables.find('x') != std::string::npos) parser.DefineVar("x", &x);
    if (variables.find('t') != std::string::npos) parser.DefineVar("t", &t);
    if (variables.find('f') != std::string::npos) parser.DefineVar("f", &t);
  }
  Compiled(const Compiled&) = delete;
  Compiled& operator=(const Compiled&) = delete;
};

/// What is known of a formula, and what copies of it left compiled: parsing costs more than a few hundred evaluations.
struct Formula::Source {
  std::string text, pointer, variables;
  bool uses_x = false, uses_t = false;
  double constant = 0;
  std::function<double(double)> given;
  std::optional<HarmonicTerm> harmonic;

  bool varies() const { return uses_x || uses_t; }

  std::unique_ptr<Compiled> take() {
    {
      const std::lock_guard guard(mutex);
      for (auto& one : idle)
        if (one) return std::move(one);
    }
    auto made = std::make_unique<Compiled>(variables);
    made->parser.SetExpr(text);
    made->parser.Eval();  // the first call parses
    return made;
  }
  /// Where there is no place, it goes.
  void put_back(std::unique_ptr<Compiled> one) {
    const std::lock_guard guard(mutex);
    for (auto& place : idle)
      if (!place) {
        place = std::move(one);
        return;
      }
  }

 private:
  std::mutex mutex;
  std::array<std::unique_ptr<Compiled>, 8> idle;
};

Formula::Formula() : Formula(0.0) {}

Formula::Formula(double constant) : source_(std::make_shared<Source>()) {
  source_->constant = constant;
  source_->text = fmt::format("{}", constant);
  if (!std::isfinite(constant)) throw InputError("", fmt::format("{} is not a finite number", constant));
}

Formula::Formula(const std::string& text, const std::string& pointer, const std::string& variables)
    : source_(std::make_shared<Source>()) {
  source_->text = text;
  source_->pointer = pointer;
  source_->variables = variables;
  if (const auto number = written_number(text)) {
    source_->constant = *number;
    return;
  }
  require_expression(text, pointer);
  auto compiled = std::make_unique<Compiled>(variables);
  mu::Parser& parser = compiled->parser;
  try {
    parser.SetExpr(text);
    source_->constant = parser.Eval();  // first: unlike GetUsedVar() it names an unknown word as such
    const auto& used = parser.GetUsedVar();
    source_->uses_x = used.contains("x");
    source_->uses_t = used.contains("t") || used.contains("f");
    parser.Eval();
    if (parser.GetNumResults() != 1)
      throw InputError(pointer, fmt::format("the formula \"{}\" gives {} values; expected one (decimals take a point)",
                                            shortened(text), parser.GetNumResults()));
  } catch (const mu::ParserError& error) {
    explain_formula(parser, error, text, pointer, letters(variables), variables_in_words(variables));
  }
  if (source_->varies())
    own_ = std::move(compiled);
  else if (!std::isfinite(source_->constant))
    throw InputError(pointer, fmt::format("the formula \"{}\" gives {}; expected a finite number", shortened(text),
                                          std::isnan(source_->constant) ? "no number (NaN)" : "an infinite value"));
}

Formula::Formula(const HarmonicTerm& term, const std::string& pointer) : source_(std::make_shared<Source>()) {
  source_->text = fmt::format("({})*cos(({})*t + ({}))", term.amplitude, term.pulsation, term.phase);
  source_->pointer = pointer;
  source_->uses_t = true;
  source_->harmonic = term;
}

Formula::Formula(std::function<double(double)> of_t, const std::string& text, const std::string& pointer)
    : source_(std::make_shared<Source>()) {
  source_->text = text;
  source_->pointer = pointer;
  source_->uses_t = true;
  source_->given = std::move(of_t);
}

Formula::Formula(const Formula& other) : source_(other.source_) {}

Formula::Formula(Formula&&) noexcept = default;

Formula& Formula::operator=(Formula&& other) noexcept {
  std::swap(source_, other.source_);
  std::swap(own_, other.own_);
  return *this;
}

Formula::~Formula() {
  if (own_) source_->put_back(std::move(own_));
}

Formula& Formula::operator=(const Formula& other) {
  if (this != &other) *this = Formula(other);
  return *this;
}

double Formula::evaluated(double x, double t) const {
  if (!source_->varies()) return source_->constant;
  if (source_->given) return source_->given(t);
  if (const auto& one = source_->harmonic) return one->amplitude * std::cos(one->pulsation * t + one->phase);
  if (!own_) own_ = source_->take();
  own_->x = x;
  own_->t = t;
  try {
    return own_->parser.Eval();
  } catch (const mu::ParserError&) {
    return std::numeric_limits<double>::quiet_NaN();
  }
}

double Formula::operator()(double x, double t) const {
  const double value = evaluated(x, t);
  if (std::isfinite(value)) return value;
  throw InputError(source_->pointer,
                   fmt::format("the formula \"{}\" gives {} at x = {:.6g} m{}; expected a finite number",
                               shortened(source_->text), std::isnan(value) ? "no number (NaN)" : "an infinite value", x,
                               source_->uses_t ? fmt::format(", t = {:.6g} s", t) : ""));
}

double Formula::value(double x, double t) const {
  return evaluated(x, t);
}

void Formula::evaluate(std::span<const double> x, double t, std::span<double> values) const {
  assert(x.size() == values.size());
  if (!source_->uses_x) {
    std::fill(values.begin(), values.end(), evaluated(0, t));
    return;
  }
  for (std::size_t i = 0; i < x.size(); ++i) values[i] = evaluated(x[i], t);
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
  return source_->uses_x;
}
bool Formula::uses_t() const {
  return source_->uses_t;
}
bool Formula::is_zero() const {
  return !source_->varies() && source_->constant == 0;
}
const std::string& Formula::text() const {
  return source_->text;
}
bool Formula::is_written() const {
  return !source_->given;
}
const std::optional<HarmonicTerm>& Formula::harmonic() const {
  return source_->harmonic;
}

double Formula::operations() const {
  // A table or a random load looks one piece up.
  constexpr double of_function = 8;
  if (!source_->varies()) return 0;
  if (source_->given) return of_function;
  const std::string& text = source_->text;
  double count = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool called = text[i] == '(' && i > 0 && std::isalnum(static_cast<unsigned char>(text[i - 1])) != 0;
    count += called ? of_function : std::string("+-*/^?<>=&|").find(text[i]) != std::string::npos ? 1 : 0;
  }
  return count;
}

namespace {

bool has_assignment(const std::string& text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '=') continue;
    if (i + 1 < text.size() && text[i + 1] == '=') {
      ++i;
    } else if (i == 0 || std::string("<>!").find(text[i - 1]) == std::string::npos) {
      return true;
    }
  }
  return false;
}

}  // namespace

void require_expression(const std::string& text, const std::string& pointer) {
  if (text.find_first_not_of(" \t\r\n") == std::string::npos)
    throw InputError(pointer, "the formula is empty; expected a number or a formula such as \"0.04*x^2\"");
  constexpr std::size_t longest = mu::MaxLenExpression - 1;
  if (text.size() > longest)
    throw InputError(
        pointer, fmt::format("the formula \"{}\" has {} characters; expected at most {}: shorten it{}", shortened(text),
                             text.size(), longest,
                             pointer.starts_with("/scene/load") ? ", or give a list of several loads" : ""));
  if (has_assignment(text))
    throw InputError(
        pointer, fmt::format("the formula \"{}\" assigns with =; expected an expression, comparisons are written ==",
                             shortened(text)));
}

void explain_formula(const mu::Parser& parser, const mu::ParserError& error, const std::string& text,
                     const std::string& pointer, std::vector<std::string> names, const std::string& names_in_words) {
  if (error.GetCode() == mu::ecUNASSIGNABLE_TOKEN) {
    names.insert(names.end(), {"pi", "e"});
    for (const auto& function : parser.GetFunDef()) names.push_back(function.first);
    // A single letter is near every other one: no guess.
    const std::string nearest = error.GetToken().size() > 1 ? nearest_name(error.GetToken(), names) : "";
    throw InputError(pointer, fmt::format("unknown name \"{}\" in the formula \"{}\"; {}, the constants are pi and e{}",
                                          shortened(error.GetToken()), shortened(text), names_in_words,
                                          nearest.empty() ? "" : fmt::format("; did you mean \"{}\"?", nearest)));
  }
  std::string message = error.GetMsg();
  // It quotes what it met.
  const std::string token = error.GetToken();
  if (const auto at = message.find(token); !token.empty() && at != std::string::npos)
    message.replace(at, token.size(), shortened(token));
  while (!message.empty() && (message.back() == '.' || message.back() == ' ')) message.pop_back();
  const bool product = error.GetCode() == mu::ecUNEXPECTED_VAR || error.GetCode() == mu::ecUNEXPECTED_FUN ||
                       error.GetCode() == mu::ecUNEXPECTED_VAL || error.GetCode() == mu::ecUNEXPECTED_PARENS;
  throw InputError(pointer, fmt::format("the formula \"{}\" does not parse: {}{}", shortened(text), message,
                                        product ? "; a product is written with *" : ""));
}

struct NamedFormulas::State {
  mu::Parser parser;
  std::map<std::string, double> values;  // the parser points at them
  std::set<std::string> used;
};

NamedFormulas::NamedFormulas() : state_(std::make_unique<State>()) {
  state_->parser.DefineConst("pi", std::numbers::pi);
  state_->parser.DefineConst("e", std::numbers::e);
  // It would merge 2*h*3 into 6*h and the like: other roundings than those of what is written.
  state_->parser.EnableOptimizer(false);
}

NamedFormulas::~NamedFormulas() = default;

void NamedFormulas::set(const std::string& name, double value) {
  const auto [place, fresh] = state_->values.insert_or_assign(name, value);
  if (fresh) state_->parser.DefineVar(name, &place->second);
}

std::vector<std::string> NamedFormulas::names() const {
  std::vector<std::string> names;
  for (const auto& [name, ignored] : state_->values) names.push_back(name);
  return names;
}

bool NamedFormulas::is_taken(const std::string& name) const {
  return state_->parser.GetConst().contains(name) || state_->parser.GetFunDef().contains(name);
}

void NamedFormulas::read(const std::string& text, const std::string& pointer) {
  require_expression(text, pointer);
  try {
    state_->parser.SetExpr(text);
    state_->parser.Eval();  // first: unlike GetUsedVar() it names an unknown word as such
    const int results = state_->parser.GetNumResults();
    state_->used.clear();
    for (const auto& [name, ignored] : state_->parser.GetUsedVar()) state_->used.insert(name);
    if (results != 1)
      throw InputError(pointer, fmt::format("the formula \"{}\" gives {} values; expected one (decimals take a point)",
                                            shortened(text), results));
  } catch (const mu::ParserError& error) {
    const std::vector<std::string> known = names();
    explain_formula(state_->parser, error, text, pointer, known,
                    known.empty() ? "no name may appear" : fmt::format("the names are {}", fmt::join(known, ", ")));
  }
}

double NamedFormulas::value() {
  try {
    return state_->parser.Eval();
  } catch (const mu::ParserError&) {
    return std::numeric_limits<double>::quiet_NaN();
  }
}

bool NamedFormulas::uses(const std::string& name) const {
  return state_->used.contains(name);
}

bool is_formula_name(const std::string& name) {
  const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  const auto inside = [&](char c) { return letter(c) || (c >= '0' && c <= '9') || c == '_'; };
  return !name.empty() && letter(name.front()) && std::all_of(name.begin(), name.end(), inside);
}

}  // namespace ricochet
