#include <fmt/format.h>
#include <fmt/ranges.h>
#include <muParser.h>

#include <algorithm>
#include <limits>
#include <map>
#include <numbers>
#include <ricochet/contract/errors.hpp>
#include <ricochet/scene/formula.hpp>
#include <ricochet/scene/named_formulas.hpp>
#include <set>

namespace ricochet {

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
