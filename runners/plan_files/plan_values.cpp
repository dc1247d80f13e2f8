#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <ricochet/contract/said_format.hpp>

#include "runners/json/json_text.hpp"
#include "runners/plan_files/plan_reader.hpp"

namespace ricochet {
namespace {

// What the name none stands for: no formula comes by it.
constexpr double none = std::numeric_limits<double>::lowest();

double as_number(const ParameterValue& value) {
  if (const auto* real = std::get_if<double>(&value)) return *real;
  if (const auto* whole = std::get_if<long long>(&value)) return static_cast<double>(*whole);
  if (const auto* flag = std::get_if<bool>(&value)) return *flag ? 1 : 0;
  return std::numeric_limits<double>::quiet_NaN();
}

std::vector<std::string> slot_names(const JsonPlace& plan) {
  const JsonPlace place = plan.at("slots", "a plan names its slots, {\"q\": [1, 0], \"v\": [0, 1]}");
  std::vector<std::string> names;
  for (const auto& [name, ignored] :
       place.members("an object of slots, each with its weights of q₀ and v₀: {\"q\": [1, 0], \"v\": [0, 1]}"))
    names.push_back(name);
  if (names.empty() || names.front() != "q")
    throw InputError(place.pointer(), "expected the position \"q\" as the first slot, found " +
                                          (names.empty() ? std::string("none") : "\"" + names.front() + "\""));
  return names;
}

std::vector<std::string> with(std::vector<std::string> names, const char* last) {
  names.emplace_back(last);
  return names;
}

// Whether w is a name of the plan: some stage of it has an impulse.
bool has_impulse(const JsonPlace& plan) {
  for (const char* key : {"start", "stages"})
    if (plan.has(key) && plan.at(key).value().is_array())
      for (const Json& stage : plan.at(key).value())
        if (stage.is_object() && stage.contains("impulse")) return true;
  return false;
}

std::string none_or(double value) {
  return std::isnan(value) ? "no number (NaN)" : "an infinite value";
}

}  // namespace

void LinearFormulas::span(std::vector<std::string> basis) {
  basis_ = std::move(basis);
  for (const std::string& name : basis_) formulas_.set(name, 0);
}

void LinearFormulas::combine(const std::string& name, std::vector<double> weights) {
  combined_.emplace_back(name, std::move(weights));
  formulas_.set(name, 0);
}

void LinearFormulas::place(const std::vector<double>& at) {
  for (std::size_t j = 0; j < basis_.size(); ++j) formulas_.set(basis_[j], at[j]);
  for (const auto& [name, weights] : combined_) {
    double value = 0;
    for (std::size_t j = 0; j < weights.size(); ++j)
      if (at[j] != 0) value += weights[j] * at[j];
    formulas_.set(name, value);
  }
}

bool LinearFormulas::is_combination(const std::string& text, const std::string& pointer) {
  formulas_.read(text, pointer);
  return std::any_of(basis_.begin(), basis_.end(), [&](const auto& name) { return formulas_.uses(name); }) ||
         std::any_of(combined_.begin(), combined_.end(), [&](const auto& one) { return formulas_.uses(one.first); });
}

std::vector<double> LinearFormulas::weights(const std::string& text, const std::string& pointer) {
  const std::size_t count = basis_.size();
  std::vector<double> weights(count), at(count, 0.0);
  formulas_.read(text, pointer);
  for (std::size_t j = 0; j < count; ++j) {
    at[j] = 1;
    place(at);
    weights[j] = formulas_.value() + 0.0;  // −0 reads as 0
    at[j] = 0;
  }
  // Linear: nothing where all names are 0, and as much as the weights say elsewhere, of either sign.
  for (const double scale : {0.0, 1.0, -1.0}) {
    double expected = 0, size = 0;
    for (std::size_t j = 0; j < count; ++j) {
      at[j] = scale * (2.0 + 1.5 * static_cast<double>(j));
      expected += weights[j] * at[j];
      size += std::abs(weights[j] * at[j]);
    }
    place(at);
    const double found = formulas_.value();
    constexpr double round_off = 1e-9;
    if (std::isfinite(size) && !(std::abs(found - expected) <= round_off * size))
      throw InputError(pointer, fmt::format("the formula \"{}\" is not linear in {}; expected a sum of terms, each a "
                                            "coefficient times one of them",
                                            shortened(text), quoted_list(basis_)));
  }
  return weights;
}

const std::vector<std::string>& PlanValues::reserved() {
  static const std::vector<std::string> names = {"h", "massless", "damped", "contact", "none", "z", "M", "C", "K"};
  return names;
}

PlanValues::PlanValues(const JsonPlace& plan, double h, const ProblemFacts& facts, const Parameters& parameters,
                       Finite finite)
    : slots_(slot_names(plan)), jumps_(has_impulse(plan)), finite_(finite) {
  optionals_.set("none", none);
  set("h", h);
  set("massless", facts.mass_kernel_dimension > 0 ? 1 : 0);
  set("damped", facts.damped ? 1 : 0);
  set("contact", facts.contact ? 1 : 0);
  where_ = fmt::format("h = {:g}", h);
  if (jumps_) taken_.emplace_back("w", "the unknown of an impulse");
  for (const auto& [key, value] : parameters.values()) {
    name(key, plan.pointer_of("parameters") + "/" + key, "a parameter");
    set(key, as_number(value));
    where_ += fmt::format(", {} = {:g}", key, as_number(value));
  }
  for (const std::string& slot : slots_) name(slot, pointer_to(plan.pointer_of("slots"), slot), "a slot");
  combinations_.span(jumps_ ? with(with(slots_, "z"), "w") : with(slots_, "z"));
  matrices_.span({"M", "C", "K"});
  if (!plan.has("let")) return;
  for (const auto& [key, place] : plan.at("let").members("an object of named formulas, {\"lag\": \"(1-gamma)*h\"}")) {
    name(key, place.pointer(), "another name of let");
    read_let(key, place);
  }
}

void PlanValues::name(const std::string& name, const std::string& pointer, const char* what) {
  if (!is_formula_name(name))
    throw InputError(pointer, "the name \"" + shortened(name) +
                                  "\" cannot stand in a formula; expected a letter, then letters, digits and '_'");
  if (std::find(reserved().begin(), reserved().end(), name) != reserved().end() || numbers_.is_taken(name))
    throw InputError(pointer, "the name \"" + shortened(name) + "\" is taken: formulas know " +
                                  quoted_list(reserved()) + ", pi, e and the functions; choose another");
  for (const auto& [other, is] : taken_)
    if (other == name)
      throw InputError(pointer, "the name \"" + shortened(name) + "\" is that of " + is + " already; choose another");
  taken_.emplace_back(name, what);
}

void PlanValues::set(const std::string& name, double value) {
  numbers_.set(name, value);
  optionals_.set(name, value);
  combinations_.set(name, value);
  matrices_.set(name, value);
}

void PlanValues::read_let(const std::string& name, const JsonPlace& place) {
  if (place.value().is_number()) return set(name, place.value().get<double>());
  if (place.value().is_object()) return combinations_.combine(name, weights(combinations_, place, ""));
  if (!place.value().is_string()) place.unexpected("a number, a formula or an object of weights of slots and z");
  const auto text = place.value().get<std::string>();
  // Where the plan is refused a value may be infinite; whatever uses it will tell.
  if (combinations_.is_combination(text, place.pointer()))
    return combinations_.combine(name, combinations_.weights(text, place.pointer()));
  numbers_.read(text, place.pointer());
  set(name, numbers_.value());
}

double PlanValues::finite(double value, const std::string& text, const std::string& pointer) const {
  if (std::isfinite(value)) return value;
  if (finite_ == Finite::ignored) return 0;
  throw InputError(pointer, fmt::format("the formula \"{}\" gives {} where {}; expected a finite number",
                                        shortened(text), none_or(value), where_));
}

double PlanValues::number(const JsonPlace& place) {
  if (place.value().is_number()) return place.value().get<double>();
  if (!place.value().is_string()) place.unexpected("a number or a formula");
  return number(place.value().get<std::string>(), place.pointer());
}

double PlanValues::number(const std::string& formula, const std::string& pointer) {
  numbers_.read(formula, pointer);
  return finite(numbers_.value(), formula, pointer);
}

bool PlanValues::truth(const JsonPlace& place) {
  if (place.value().is_boolean()) return place.value().get<bool>();
  if (!place.value().is_string()) place.unexpected("true, false or a formula such as \"2*beta < gamma\"");
  return number(place) != 0;
}

std::optional<double> PlanValues::optional_number(const JsonPlace& place) {
  if (place.value().is_null()) return std::nullopt;
  if (place.value().is_number()) return place.value().get<double>();
  if (!place.value().is_string()) place.unexpected("a number, a formula or null");
  const auto text = place.value().get<std::string>();
  optionals_.read(text, place.pointer());
  const double value = optionals_.value();
  if (value == none) return std::nullopt;
  return finite(value, text, place.pointer());
}

std::vector<double> PlanValues::weights(LinearFormulas& formulas, const JsonPlace& place, const std::string& expected) {
  const std::vector<std::string>& basis = formulas.basis();
  if (place.value().is_string()) {
    const auto text = place.value().get<std::string>();
    std::vector<double> found = formulas.weights(text, place.pointer());
    for (double& weight : found) weight = finite(weight, text, place.pointer());
    return found;
  }
  if (!place.value().is_object()) place.unexpected(expected);
  place.close(basis);
  std::vector<double> found(basis.size(), 0.0);
  for (std::size_t j = 0; j < basis.size(); ++j)
    if (place.has(basis[j])) found[j] = number(place.at(basis[j]));
  return found;
}

Combination PlanValues::combination(const JsonPlace& place) {
  std::vector<double> all = weights(combinations_, place,
                                    "a combination of slots and z: a formula such as \"q + h*v\", or an object of "
                                    "weights such as {\"q\": 1, \"v\": \"h\"}");
  Combination result;
  if (jumps_) {
    result.w = all.back();
    all.pop_back();
  }
  result.z = all.back();
  all.pop_back();
  while (!all.empty() && all.back() == 0) all.pop_back();
  result.slots = std::move(all);
  return result;
}

OperatorWeights PlanValues::matrices(const JsonPlace& place) {
  const std::vector<double> all = weights(matrices_, place,
                                          "weights of M, C and K: a formula such as \"M + gamma*h*C\", or an object "
                                          "such as {\"M\": 1, \"C\": \"gamma*h\"}");
  return {all[0], all[1], all[2]};
}

Said PlanValues::sentence(const JsonPlace& place) {
  const std::string text = place.text("a sentence that says why, and what to do");
  Said result;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t open = std::min(text.find('{', at), text.size());
    result += text.substr(at, open - at);
    if (open == text.size()) break;
    const std::size_t close = text.find('}', open);
    if (close == std::string::npos)
      throw InputError(place.pointer(), "a brace opens a formula and none closes it; expected {formula}");
    numbers_.read(text.substr(open + 1, close - open - 1), place.pointer());
    result += said("{:g}", numbers_.value());
    at = close + 1;
  }
  return result;
}

void JsonPlace::unexpected(const std::string& expected) const {
  throw InputError(pointer_, "expected " + expected + ", found " + quote(*value_));
}

void JsonPlace::close(const std::vector<std::string>& keys) const {
  if (!value_->is_object()) unexpected("an object with the keys " + quoted_list(keys));
  for (const auto& [key, ignored] : value_->items())
    if (std::find(keys.begin(), keys.end(), key) == keys.end())
      throw InputError(pointer_of(key), "unknown key \"" + shortened(key) + "\"" + did_you_mean(key, keys) +
                                            " (keys here: " + quoted_list(keys) + ")");
}

JsonPlace JsonPlace::at(const std::string& key, const std::string& meaning) const {
  const auto found = value_->find(key);
  if (found == value_->end()) throw InputError(pointer_of(key), "missing; " + meaning);
  return {*found, pointer_of(key)};
}

std::string JsonPlace::pointer_of(const std::string& key) const {
  return pointer_to(pointer_, key);
}

std::vector<std::pair<std::string, JsonPlace>> JsonPlace::members(const std::string& expected) const {
  if (!value_->is_object()) unexpected(expected);
  std::vector<std::pair<std::string, JsonPlace>> members;
  for (const auto& item : value_->items())
    members.emplace_back(item.key(), JsonPlace(item.value(), pointer_of(item.key())));
  return members;
}

std::vector<JsonPlace> JsonPlace::items(const std::string& expected) const {
  if (!value_->is_array()) unexpected(expected);
  std::vector<JsonPlace> items;
  for (std::size_t i = 0; i < value_->size(); ++i) items.emplace_back((*value_)[i], pointer_to(pointer_, i));
  return items;
}

std::string JsonPlace::text(const std::string& expected) const {
  if (!value_->is_string() || value_->get<std::string>().find_first_not_of(" \t\r\n") == std::string::npos)
    unexpected(expected);
  return value_->get<std::string>();
}

std::string JsonPlace::word(const std::vector<std::string>& words) const {
  if (value_->is_string() && std::find(words.begin(), words.end(), value_->get<std::string>()) != words.end())
    return value_->get<std::string>();
  unexpected("one of " + quoted_list(words));
}

}  // namespace ricochet
