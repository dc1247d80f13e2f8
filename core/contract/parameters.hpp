#pragma once
#include <array>
#include <cstddef>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace ricochet {

/// Points [x, y] of a graph made of straight lines, from [0, 0] on: x grows, y does not fall. Empty: there is none.
using ParameterTable = std::vector<std::array<double, 2>>;

/// A parameter value: real, integer, boolean, one of a list of words, or a table.
using ParameterValue = std::variant<double, long long, bool, std::string, ParameterTable>;

/// An interval of admissible reals; each end is open or closed.
struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_open = false;
  bool high_open = false;
  bool contains(double value) const;
  /// Mathematical notation: "[0, 1]", "]0, ∞[".
  std::string text() const;
};

/// What a parameter is to whoever does not know its plugin. A reference needs the restitution of a scheme and the
/// stiffness of a law, and a stop may have its own. They are found by role, never by key. Of a law, `stiffness` is in
/// N/m and `damping` in N s/m.
enum class ParameterRole { none, restitution, stiffness, damping };

/// One parameter of a plugin, declared once; checking, `describe` and the JSON Schema all read this.
struct ParameterSpec {
  enum class Type { real, integer, boolean, word, table };
  std::string key;  ///< [a-z][a-z0-9_]*
  Type type = Type::real;
  std::string unit;                          ///< SI, "1" when dimensionless; of a table "N against m"
  std::optional<ParameterValue> fallback;    ///< default; absent means the study must give it
  Range range;                               ///< for real and integer
  std::vector<std::string> words;            ///< for word
  std::string text;                          ///< one sentence of manual, with the symbol of the equation
  bool per_lane = false;                     ///< may differ between lanes that share one factorisation
  ParameterRole role = ParameterRole::none;  ///< at most one parameter of a plugin has each role
};

ParameterSpec real_parameter(std::string key, std::string unit, std::optional<double> fallback, Range range,
                             std::string text);
ParameterSpec integer_parameter(std::string key, std::optional<long long> fallback, Range range, std::string text);
ParameterSpec word_parameter(std::string key, std::vector<std::string> words, std::optional<std::string> fallback,
                             std::string text);
/// A table that may be left out where it is optional; the default is then none.
ParameterSpec table_parameter(std::string key, std::string unit, bool optional, std::string text);
/// The same parameter, with a role: with_role(real_parameter("e", …), ParameterRole::restitution).
ParameterSpec with_role(ParameterSpec spec, ParameterRole role);

/// Checked values of one plugin's parameters, complete (defaults filled in).
class Parameters {
 public:
  Parameters() = default;
  explicit Parameters(std::map<std::string, ParameterValue> values) : values_(std::move(values)) {}
  double real(const std::string& key) const;
  long long integer(const std::string& key) const;
  bool flag(const std::string& key) const;
  const std::string& word(const std::string& key) const;
  const ParameterTable& table(const std::string& key) const;
  void set(const std::string& key, ParameterValue value) { values_[key] = std::move(value); }
  const std::map<std::string, ParameterValue>& values() const { return values_; }

 private:
  std::map<std::string, ParameterValue> values_;
};

/// The value of the number that has this role among the parameters declared, or nothing where none has it.
std::optional<double> value_of_role(const std::vector<ParameterSpec>& declared, const Parameters& values,
                                    ParameterRole role);

/// What is wrong with a table, and in which row of it; the first such row.
struct TableFault {
  std::size_t row = 0;
  std::string text;
};
/// Of a table that is there: at least two rows, the first [0, 0], x growing, y never falling, all finite.
std::optional<TableFault> check_table(const ParameterTable& table);
/// What a table is expected to be, for sentences.
inline constexpr const char* table_words = "rows [x, y] from [0, 0] on, x growing, y never falling";

/// Checks one value against its declaration; returns the sentence that says what was expected, or nothing when it fits.
/// An integer is accepted where a real is expected; nothing is ever clamped.
std::optional<std::string> check_parameter(const ParameterSpec& spec, const ParameterValue& value);

}  // namespace ricochet
