#pragma once
#include <memory>
#include <string>
#include <vector>

namespace ricochet {

/// Formulas over one set of named values: "(0.5-beta)*h*h", "gamma == 0.5 ? 2 : 1". A formula is evaluated in double
/// precision in the order in which it is written, products from left to right, so that it gives what the same text
/// gives in C++; nothing is merged or reordered. For one thread at a time.
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
