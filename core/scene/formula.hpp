#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace mu {
class Parser;
class ParserError;
}  // namespace mu

namespace ricochet {

/// Throws InputError (with the pointer) for a text that is no expression: empty, too long, or an assignment. The
/// parser (muParser) reads "x = 3" as an assignment, which would change the variable unseen.
void require_expression(const std::string& text, const std::string& pointer);

/// Throws InputError (with the pointer) that says what a parser did not understand. Of an unknown name it tells the
/// nearest of `names`, the constants and the functions, and `names_in_words`, which says what may appear. Else it gives
/// the parser's own message.
[[noreturn]] void explain_formula(const mu::Parser& parser, const mu::ParserError& error, const std::string& text,
                                  const std::string& pointer, std::vector<std::string> names,
                                  const std::string& names_in_words);

/// a cos(Ωt + φ).
struct HarmonicTerm {
  double amplitude = 0, pulsation = 0, phase = 0;  ///< a; Ω, rad/s; φ, rad
};

/// A number or a formula in x (m) and t (s), as a study writes it: "0.04*x^2", "sin(pi*x)*cos(10*t)", pi and e defined.
/// Throws InputError (with the pointer given) when the text does not parse, names an unknown variable, or a value is
/// not finite. A copy costs next to nothing; copies may be evaluated by several threads at the same time, one may not.
class Formula {
 public:
  Formula();  ///< the constant 0
  explicit Formula(double constant);
  /// `variables` is the subset of "xt" that may appear; or "f" (Hz), which stands in the place of t.
  Formula(const std::string& text, const std::string& pointer, const std::string& variables = "xt");
  /// a cos(Ωt + φ), with the values of its text in digits.
  Formula(const HarmonicTerm& term, const std::string& pointer);
  /// A function of t that is given otherwise: a table, a random load. `text` names it for people.
  Formula(std::function<double(double)> of_t, const std::string& text, const std::string& pointer);
  Formula(const Formula&);
  Formula(Formula&&) noexcept;
  Formula& operator=(const Formula&);
  Formula& operator=(Formula&&) noexcept;
  ~Formula();

  double operator()(double x, double t = 0) const;
  /// The same, not finite where the formula is not; does not throw.
  double value(double x, double t) const;
  /// values[i] = f(x[i], t); one call, no allocation. A non-finite value is left in `values` for the caller to judge.
  void evaluate(std::span<const double> x, double t, std::span<double> values) const;
  /// df/dx by a seven-point stencil that stays inside [low, high]: exact to round-off for polynomials of degree ≤ 6.
  double slope(double x, double low, double high, double t = 0) const;

  bool uses_x() const;
  bool uses_t() const;
  /// A constant that equals zero: what it feeds is left out.
  bool is_zero() const;
  /// What an evaluation takes, in operators of its text: each of them one, a function eight. 0 of a constant.
  double operations() const;
  const std::string& text() const;
  /// Whether its text is what is evaluated; else that only names it.
  bool is_written() const;
  /// Of a formula that was made of one; else none.
  const std::optional<HarmonicTerm>& harmonic() const;

 private:
  struct Source;
  struct Compiled;
  double evaluated(double x, double t) const;
  std::shared_ptr<Source> source_;         ///< shared by copies
  mutable std::unique_ptr<Compiled> own_;  ///< made, or taken over from a copy that is gone, when first evaluated
};

/// Formulas over one set of named values: "(0.5-beta)*h*h", "gamma == 0.5 ? 2 : 1". A formula is evaluated in double
/// precision in the order in which it is written, products from left to right. It gives what the same text gives in
/// C++; nothing is merged or reordered. For one thread at a time.
class NamedFormulas {
 public:
  NamedFormulas();
  ~NamedFormulas();
  NamedFormulas(const NamedFormulas&) = delete;
  NamedFormulas& operator=(const NamedFormulas&) = delete;

  /// Gives a name its value; a new name is known from now on.
  void set(const std::string& name, double value);
  /// The names given so far, sorted.
  std::vector<std::string> names() const;
  /// Whether no value may have this name: it is a constant (pi, e) or a function.
  bool is_taken(const std::string& name) const;

  /// Reads a formula; value() and uses() are of the last one read. Throws InputError (with the pointer) when it is
  /// empty, does not parse, assigns, gives several values or has an unknown name, the nearest one named.
  void read(const std::string& text, const std::string& pointer);
  /// With the values as they are now; not finite where the formula is not.
  double value();
  bool uses(const std::string& name) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Whether a name can stand in a formula: a letter, then letters, digits and underscores.
bool is_formula_name(const std::string& name);

}  // namespace ricochet
