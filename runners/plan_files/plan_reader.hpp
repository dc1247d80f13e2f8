#pragma once
#include <optional>
#include <ricochet/contract/registry.hpp>
#include <ricochet/scene/formula.hpp>
#include <string>
#include <utility>
#include <vector>

#include "runners/json/json_text.hpp"

namespace ricochet {

/// A value of a JSON document and where it stands, for objects whose keys the document itself makes up (slots,
/// parameters). What it throws is an InputError with the pointer of the value.
class JsonPlace {
 public:
  JsonPlace(const Json& value, std::string pointer) : value_(&value), pointer_(std::move(pointer)) {}
  const Json& value() const { return *value_; }
  const std::string& pointer() const { return pointer_; }

  /// "expected …, found …".
  [[noreturn]] void unexpected(const std::string& expected) const;
  /// Throws unless the value is an object that has no other keys than these; the nearest one is named.
  void close(const std::vector<std::string>& keys) const;
  bool has(const std::string& key) const { return value_->is_object() && value_->contains(key); }
  /// The member of an object; throws "missing; …" where there is none.
  JsonPlace at(const std::string& key, const std::string& meaning = "this key is required") const;
  /// Where a member is or would be.
  std::string pointer_of(const std::string& key) const;
  /// All members in the order of the text; `expected` describes the object.
  std::vector<std::pair<std::string, JsonPlace>> members(const std::string& expected) const;
  /// The elements of a list.
  std::vector<JsonPlace> items(const std::string& expected) const;
  /// A text that is not empty.
  std::string text(const std::string& expected) const;
  /// One of some words.
  std::string word(const std::vector<std::string>& words) const;

 private:
  const Json* value_;
  std::string pointer_;
};

/// Formulas that are linear in some names ("q + h*v + beta*h*h*z" in slots and z), read as the weights of these names.
/// Each weight is what the formula gives where that name is 1 and the others are 0.
class LinearFormulas {
 public:
  /// The names in which formulas are linear.
  void span(std::vector<std::string> basis);
  const std::vector<std::string>& basis() const { return basis_; }
  /// Another value that formulas may use.
  void set(const std::string& name, double value) { formulas_.set(name, value); }
  /// A combination that formulas may use by name.
  void combine(const std::string& name, std::vector<double> weights);
  /// Whether a formula has a name of the basis, or of a combination, in it. Throws InputError as NamedFormulas::read().
  bool is_combination(const std::string& text, const std::string& pointer);
  /// One weight per name of the basis, not finite where the formula is not. Throws InputError where it is not linear.
  std::vector<double> weights(const std::string& text, const std::string& pointer);

 private:
  void place(const std::vector<double>& at);
  NamedFormulas formulas_;
  std::vector<std::string> basis_;
  std::vector<std::pair<std::string, std::vector<double>>> combined_;
};

/// Whether values that are not finite are errors (a plan is made) or let pass (only the text is checked).
enum class Finite { demanded, ignored };

/// The names of one plan and their values: h, what is known of the problem, parameters, "let". It reads the numbers,
/// combinations, weights of matrices and sentences that use them. What it throws are InputErrors with pointers.
class PlanValues {
 public:
  /// The names that no parameter, slot or let may take, apart from constants and functions.
  static const std::vector<std::string>& reserved();

  PlanValues(const JsonPlace& plan, double h, const ProblemFacts& facts, const Parameters& parameters, Finite finite);

  const std::vector<std::string>& slots() const { return slots_; }
  /// A number, or a formula.
  double number(const JsonPlace& place);
  /// The key of a member, which is a formula.
  double number(const std::string& formula, const std::string& pointer);
  /// true, false, or a formula that is not 0.
  bool truth(const JsonPlace& place);
  /// null, or a formula in which the name none may stand.
  std::optional<double> optional_number(const JsonPlace& place);
  /// A linear formula in slots, z and, in a plan some stage of which has an impulse, w; or an object of their weights.
  Combination combination(const JsonPlace& place);
  /// A linear formula in M, C and K, or an object of their weights.
  OperatorWeights matrices(const JsonPlace& place);
  /// A sentence in which {formula} stands for its value.
  Said sentence(const JsonPlace& place);

 private:
  void name(const std::string& name, const std::string& pointer, const char* what);
  void set(const std::string& name, double value);
  void read_let(const std::string& name, const JsonPlace& place);
  double finite(double value, const std::string& text, const std::string& pointer) const;
  std::vector<double> weights(LinearFormulas& formulas, const JsonPlace& place, const std::string& expected);

  std::vector<std::string> slots_;
  bool jumps_;         // whether w is a name
  std::string where_;  // "h = 0.001, beta = 0.25": the values, for messages
  Finite finite_;
  NamedFormulas numbers_, optionals_;
  LinearFormulas combinations_, matrices_;
  std::vector<std::pair<std::string, std::string>> taken_;  // name, what it is
};

/// What a plan says of itself: name, summary, text, source and parameters, as a plugin registers them; the keys of the
/// whole plan are checked. Throws InputError.
PluginManual read_plan_manual(const JsonPlace& plan);

/// The first refusal of a plan whose condition holds, or nothing. All of them are read.
std::optional<Refusal> plan_refusal(const JsonPlace& plan, PlanValues& values);

/// The slots, stages, energy, velocity and facts of a plan, as numbers. Throws InputError for whatever is no plan; that
/// the plan is well-formed is left to check_plan().
StepPlan read_step_plan(const JsonPlace& plan, PlanValues& values);

}  // namespace ricochet
