#include <fmt/format.h>

#include <cmath>
#include <ricochet/contract/parameters.hpp>
#include <stdexcept>

namespace ricochet {
namespace {

std::string number(double value) {
  if (std::isinf(value)) return value > 0 ? "∞" : "−∞";
  return fmt::format("{:g}", value);
}

template <class T>
const T& get(const std::map<std::string, ParameterValue>& values, const std::string& key) {
  const auto found = values.find(key);
  if (found == values.end()) throw std::logic_error("parameter '" + key + "' was never declared");
  const T* value = std::get_if<T>(&found->second);
  if (!value) throw std::logic_error("parameter '" + key + "' has another type than the plugin asks for");
  return *value;
}

}  // namespace

bool Range::contains(double value) const {
  if (std::isnan(value)) return false;
  return (low_open ? value > low : value >= low) && (high_open ? value < high : value <= high);
}

std::string Range::text() const {
  const bool left_open = low_open || std::isinf(low), right_open = high_open || std::isinf(high);
  return (left_open ? "]" : "[") + number(low) + ", " + number(high) + (right_open ? "[" : "]");
}

ParameterSpec real_parameter(std::string key, std::string unit, std::optional<double> fallback, Range range,
                             std::string text) {
  ParameterSpec spec;
  spec.key = std::move(key);
  spec.type = ParameterSpec::Type::real;
  spec.unit = std::move(unit);
  if (fallback) spec.fallback = *fallback;
  spec.range = range;
  spec.text = std::move(text);
  return spec;
}

ParameterSpec integer_parameter(std::string key, std::optional<long long> fallback, Range range, std::string text) {
  ParameterSpec spec;
  spec.key = std::move(key);
  spec.type = ParameterSpec::Type::integer;
  spec.unit = "1";
  if (fallback) spec.fallback = *fallback;
  spec.range = range;
  spec.text = std::move(text);
  return spec;
}

ParameterSpec word_parameter(std::string key, std::vector<std::string> words, std::optional<std::string> fallback,
                             std::string text) {
  ParameterSpec spec;
  spec.key = std::move(key);
  spec.type = ParameterSpec::Type::word;
  spec.unit = "1";
  if (fallback) spec.fallback = *fallback;
  spec.words = std::move(words);
  spec.text = std::move(text);
  return spec;
}

ParameterSpec table_parameter(std::string key, std::string unit, bool optional, std::string text) {
  ParameterSpec spec;
  spec.key = std::move(key);
  spec.type = ParameterSpec::Type::table;
  spec.unit = std::move(unit);
  if (optional) spec.fallback = ParameterTable();
  spec.text = std::move(text);
  return spec;
}

ParameterSpec with_role(ParameterSpec spec, ParameterRole role) {
  spec.role = role;
  return spec;
}

double Parameters::real(const std::string& key) const {
  const auto found = values_.find(key);
  if (found != values_.end())
    if (const auto* whole = std::get_if<long long>(&found->second)) return static_cast<double>(*whole);
  return get<double>(values_, key);
}
long long Parameters::integer(const std::string& key) const {
  return get<long long>(values_, key);
}
bool Parameters::flag(const std::string& key) const {
  return get<bool>(values_, key);
}
const std::string& Parameters::word(const std::string& key) const {
  return get<std::string>(values_, key);
}
const ParameterTable& Parameters::table(const std::string& key) const {
  return get<ParameterTable>(values_, key);
}

std::optional<double> value_of_role(const std::vector<ParameterSpec>& declared, const Parameters& values,
                                    ParameterRole role) {
  for (const ParameterSpec& spec : declared)
    if (spec.role == role && values.values().count(spec.key) > 0) return values.real(spec.key);
  return std::nullopt;
}

std::optional<TableFault> check_table(const ParameterTable& table) {
  const auto row = [&](std::size_t i) { return fmt::format("[{}, {}]", table[i][0], table[i][1]); };
  for (std::size_t i = 0; i < table.size(); ++i) {
    if (!std::isfinite(table[i][0]) || !std::isfinite(table[i][1])) return TableFault{i, row(i) + " is not finite"};
    if (i == 0 && (table[0][0] != 0 || table[0][1] != 0)) return TableFault{0, "the first row is " + row(0)};
    if (i > 0 && !(table[i][0] > table[i - 1][0]))
      return TableFault{i, "x does not grow from " + row(i - 1) + " to " + row(i)};
    if (i > 0 && !(table[i][1] >= table[i - 1][1]))
      return TableFault{i, "y falls from " + row(i - 1) + " to " + row(i)};
  }
  if (table.size() < 2) return TableFault{0, table.empty() ? "there is no row" : "there is one row"};
  return std::nullopt;
}

std::optional<std::string> check_parameter(const ParameterSpec& spec, const ParameterValue& value) {
  const auto out_of_range = [&](double x) -> std::optional<std::string> {
    if (spec.range.contains(x)) return std::nullopt;
    return fmt::format("{} is outside {}", number(x), spec.range.text());
  };
  switch (spec.type) {
    case ParameterSpec::Type::real:
      if (const auto* x = std::get_if<double>(&value)) return out_of_range(*x);
      if (const auto* i = std::get_if<long long>(&value)) return out_of_range(static_cast<double>(*i));
      return "expected a number in " + spec.range.text();
    case ParameterSpec::Type::integer:
      if (const auto* i = std::get_if<long long>(&value)) return out_of_range(static_cast<double>(*i));
      return "expected a whole number in " + spec.range.text();
    case ParameterSpec::Type::boolean:
      if (std::holds_alternative<bool>(value)) return std::nullopt;
      return std::string("expected true or false");
    case ParameterSpec::Type::table: {
      const auto* table = std::get_if<ParameterTable>(&value);
      if (!table) return std::string("expected ") + table_words;
      const bool none = table->empty() && spec.fallback == ParameterValue(ParameterTable());
      const auto fault = none ? std::nullopt : check_table(*table);
      if (!fault) return std::nullopt;
      return fmt::format("expected {}; row {}: {}", table_words, fault->row + 1, fault->text);
    }
    case ParameterSpec::Type::word:
      break;
  }
  const auto* word = std::get_if<std::string>(&value);
  if (word)
    for (const std::string& known : spec.words)
      if (*word == known) return std::nullopt;
  std::string expected;
  for (const std::string& known : spec.words) expected += (expected.empty() ? "\"" : ", \"") + known + "\"";
  return "expected one of " + expected;
}

}  // namespace ricochet
