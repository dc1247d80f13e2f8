#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace ricochet {

/// Plain text in aligned columns; the last column is not padded, and empty columns are left out.
class TextTable {
 public:
  explicit TextTable(std::vector<std::string> header) : rows_{std::move(header)} {}
  /// One cell per column of the header.
  void add(std::vector<std::string> cells) { rows_.push_back(std::move(cells)); }
  /// Each line starts with `indent` blanks.
  std::string text(std::size_t indent = 0) const;

 private:
  std::vector<std::vector<std::string>> rows_;
};

/// A value of an axis as a person reads it: words bare, numbers in their shortest form, null as "none".
std::string plain(const nlohmann::ordered_json& value);

/// A span of time: "0.8 s", "3 min 20 s", "2 h 5 min".
std::string plain_seconds(double seconds);

}  // namespace ricochet
