#include "tests/runners/command/page_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <map>
#include <memory>
#include <numeric>
#include <optional>
#include <set>
#include <stdexcept>
#include <utility>

namespace ricochet::tests {

std::string trimmed(const std::string& text) {
  const auto begin = text.find_first_not_of(" \t\n");
  return begin == std::string::npos ? "" : text.substr(begin, text.find_last_not_of(" \t\n") + 1 - begin);
}

std::vector<std::string> pieces_of(const std::string& text, char separator) {
  std::vector<std::string> pieces(1);
  bool quoted = false;
  int depth = 0;
  for (const char c : text) {
    if (c == '"') quoted = !quoted;
    if (!quoted) depth += c == '[' ? 1 : c == ']' ? -1 : 0;
    if (c == separator && !quoted && depth == 0)
      pieces.emplace_back();
    else
      pieces.back() += c;
  }
  return pieces;
}

std::vector<std::string> words_of(const std::string& text) {
  std::vector<std::string> words = pieces_of(text, ' ');
  std::erase_if(words, [](const std::string& word) { return word.empty(); });
  return words;
}

namespace {

std::optional<double> number_of(const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0') return std::nullopt;
  return value;
}

std::string unquoted(std::string text) {
  std::erase(text, '"');
  return text;
}

std::size_t column_of(const CsvTable& table, const std::string& name) {
  const auto found = std::find(table.columns.begin(), table.columns.end(), name);
  if (found == table.columns.end()) throw std::runtime_error("no column " + name);
  return static_cast<std::size_t>(found - table.columns.begin());
}

using Rows = std::vector<const std::vector<std::string>*>;

bool same_value(const std::string& cell, const std::string& wanted) {
  const auto a = number_of(cell), b = number_of(wanted);
  return a && b ? std::abs(*a - *b) <= 1e-9 * std::abs(*b) : cell == wanted;
}

Rows all_rows(const CsvTable& table) {
  Rows rows;
  for (const auto& row : table.rows) rows.push_back(&row);
  return rows;
}

void select(const CsvTable& table, const std::string& condition, Rows& rows) {
  const std::size_t sign = condition.find_first_of("=<>");
  if (sign == std::string::npos) throw std::runtime_error("expected column=value, found " + condition);
  const std::size_t column = column_of(table, unquoted(condition.substr(0, sign)));
  std::vector<std::string> values = pieces_of(condition.substr(sign + 1), ',');
  for (std::string& value : values) value = unquoted(value);
  std::erase_if(rows, [&](const std::vector<std::string>* row) {
    const std::string& cell = row->at(column);
    if (condition[sign] == '=')
      return std::none_of(values.begin(), values.end(),
                          [&](const std::string& value) { return same_value(cell, value); });
    const auto a = number_of(cell), b = number_of(values.front());
    return !a || !b || (condition[sign] == '<' ? *a >= *b : *a <= *b);
  });
}

double reduced(const CsvTable& table, const Rows& rows, const std::string& how, const std::string& column) {
  const std::size_t place = column_of(table, column);
  std::vector<double> values;
  for (const auto* row : rows)
    if (const auto value = number_of(row->at(place))) values.push_back(*value);
  if (values.empty()) throw std::runtime_error("no row has a value of " + column);
  std::sort(values.begin(), values.end());
  const double low = values.front(), high = values.back();
  const double sum = std::accumulate(values.begin(), values.end(), 0.0);
  const std::size_t half = values.size() / 2;
  if (how == "min") return low;
  if (how == "max") return high;
  if (how == "spread") return high - low;
  if (how == "sum") return sum;
  if (how == "mean") return sum / static_cast<double>(values.size());
  if (how == "median") return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
  if (how == "decades") return std::log10(high / low);
  throw std::runtime_error("unknown reduction " + how);
}

const std::set<std::string> reductions = {"min", "max", "spread", "sum", "mean", "median", "decades"};

const std::string& cell_of(const CsvTable& table, const Rows& rows, const std::string& column) {
  const std::size_t place = column_of(table, column);
  if (rows.size() != 1) throw std::runtime_error(fmt::format("{} rows; expected one", rows.size()));
  return rows.front()->at(place);
}

class Evaluation {
 public:
  Evaluation(const TablesOf& tables, const Source& source) : tables_(tables), source_(source) {}

  Rows rows() const { return rows(table(), {}); }
  const CsvTable& table() const { return tables_(source_.study, source_.table); }

  /// Products and quotients, from the left.
  double value(const std::string& expression) const {
    double result = 1;
    bool over = false, operand = true;
    std::vector<std::string> words = words_of(expression);
    for (std::size_t i = 0; i < words.size(); ++i) {
      if (!operand) {
        if (words[i] != "*" && words[i] != "/" && words[i] != "-")
          throw std::runtime_error("expected * or /, found " + words[i]);
        if (words[i] == "-") return result - value(joined(words, i + 1));
        over = words[i] == "/";
        operand = true;
        continue;
      }
      const double found = factor(words, i);
      result = over ? result / found : result * found;
      operand = false;
    }
    if (operand) throw std::runtime_error("an expression ends where a value is expected: " + expression);
    return result;
  }

 private:
  static std::string joined(const std::vector<std::string>& words, std::size_t from) {
    std::string text;
    for (std::size_t i = from; i < words.size(); ++i) text += words[i] + " ";
    return text;
  }

  Rows rows(const CsvTable& table, const std::vector<std::string>& others) const {
    Rows rows = all_rows(table);
    const auto name = [](const std::string& condition) { return condition.substr(0, condition.find_first_of("=<>")); };
    for (const std::string& condition : source_.conditions) {
      const bool replaced = std::any_of(others.begin(), others.end(),
                                        [&](const std::string& other) { return name(other) == name(condition); });
      if (!replaced) select(table, condition, rows);
    }
    for (const std::string& condition : others)
      if (!condition.ends_with("=*")) select(table, condition, rows);
    return rows;
  }

  double factor(const std::vector<std::string>& words, std::size_t& i) const {
    if (const auto number = number_of(words[i])) return *number;
    if (words[i] == "sqrt" && i + 1 < words.size()) return std::sqrt(factor(words, ++i));
    const CsvTable* table = &this->table();
    Rows chosen = rows();
    if (const std::size_t open = words[i].find('['); open != std::string::npos) {
      const std::vector<std::string> others = words_of(words[i].substr(open + 1, words[i].size() - open - 2));
      if (open > 0) {
        table = &tables_(source_.study, words[i].substr(0, open));
        chosen = all_rows(*table);
        for (const std::string& condition : others) select(*table, condition, chosen);
      } else {
        chosen = rows(*table, others);
      }
      if (++i == words.size()) throw std::runtime_error("nothing stands after [ ]");
    }
    if (words[i] == "count") return static_cast<double>(chosen.size());
    if (reductions.contains(words[i]) && i + 1 < words.size()) {
      ++i;
      return reduced(*table, chosen, words[i - 1], unquoted(words[i]));
    }
    const std::string& cell = cell_of(*table, chosen, unquoted(words[i]));
    if (const auto number = number_of(cell)) return *number;
    throw std::runtime_error(fmt::format("{} is \"{}\", no number", words[i], cell));
  }

  const TablesOf& tables_;
  const Source& source_;
};

}  // namespace

Source source_of(const std::string& text) {
  std::vector<std::string> words = words_of(text);
  if (words.size() < 2) throw std::runtime_error("expected a study and a table: " + text);
  return {words[0], words[1], {words.begin() + 2, words.end()}};
}

double value_of(const TablesOf& tables, const Source& source, const std::string& expression) {
  return Evaluation(tables, source).value(expression);
}

std::string text_of(const TablesOf& tables, const Source& source, const std::string& column) {
  const Evaluation evaluation(tables, source);
  return cell_of(evaluation.table(), evaluation.rows(), column);
}

std::string written(double value, const std::string& format) {
  char text[64];
  std::snprintf(text, sizeof text, format.c_str(), value);
  std::string out = text;
  if (const auto e = out.find('e'); e != std::string::npos) {
    const auto digit = out.find_first_not_of("+-0", e + 1);
    out =
        out.substr(0, e + 1) + (out[e + 1] == '-' ? "-" : "") + (digit == std::string::npos ? "0" : out.substr(digit));
  }
  // Of nothing no sign is written.
  if (out.starts_with("-") && out.find_first_of("123456789") == std::string::npos) out.erase(0, 1);
  return out;
}

std::string filled(const TablesOf& tables, const Source& source, const std::string& pattern) {
  const Evaluation evaluation(tables, source);
  std::string out;
  for (std::size_t at = 0; at < pattern.size();) {
    const std::size_t open = std::min(pattern.find('{', at), pattern.size());
    out += pattern.substr(at, open - at);
    if (open == pattern.size()) break;
    const std::size_t close = pattern.find('}', open);
    if (close == std::string::npos) throw std::runtime_error("a brace is not closed: " + pattern);
    const std::string inside = pattern.substr(open + 1, close - open - 1);
    const std::size_t format = inside.find('%');
    out += format == std::string::npos
               ? cell_of(evaluation.table(), evaluation.rows(), trimmed(inside))
               : written(evaluation.value(inside.substr(0, format)), trimmed(inside.substr(format)));
    at = close + 1;
  }
  return out;
}

CsvTable read_csv(const std::string& text) {
  std::vector<std::vector<std::string>> lines;
  std::vector<std::string> line(1);
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quoted) {
      if (c == '"' && i + 1 < text.size() && text[i + 1] == '"')
        line.back() += text[++i];
      else if (c == '"')
        quoted = false;
      else
        line.back() += c;
    } else if (c == '"') {
      quoted = true;
    } else if (c == ',') {
      line.emplace_back();
    } else if (c == '\n') {
      lines.push_back(std::exchange(line, std::vector<std::string>(1)));
    } else if (c != '\r') {
      line.back() += c;
    }
  }
  if (line.size() > 1 || !line.front().empty()) lines.push_back(line);
  if (lines.empty()) return {};
  CsvTable table{std::move(lines.front()), {}};
  for (std::size_t i = 1; i < lines.size(); ++i) {
    lines[i].resize(table.columns.size());
    table.rows.push_back(std::move(lines[i]));
  }
  return table;
}

TablesOf tables_in(const std::filesystem::path& folder, std::function<void(const std::string& study)> make) {
  const auto known = std::make_shared<std::map<std::string, CsvTable>>();
  return
      [folder, make = std::move(make), known](const std::string& study, const std::string& table) -> const CsvTable& {
        const std::filesystem::path file = folder / study / (table + ".csv");
        const auto found = known->find(file.string());
        if (found != known->end()) return found->second;
        if (!std::filesystem::exists(folder / study / "cases.csv")) make(study);
        std::ifstream stream(file, std::ios::binary);
        if (!stream) throw std::runtime_error("there is no table " + file.string());
        const std::string text{std::istreambuf_iterator<char>(stream), {}};
        return known->emplace(file.string(), read_csv(text)).first->second;
      };
}

}  // namespace ricochet::tests
