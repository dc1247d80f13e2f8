#pragma once
#include <cstddef>
#include <string>
#include <vector>

namespace ricochet {

/// Where a number stands in a text, and the unit that follows it after a space.
struct Mark {
  std::size_t begin = 0, size = 0;  ///< of the number, bytes
  std::string unit = {};            ///< "" for none

  bool operator==(const Mark&) const = default;
};

/// A text that knows where its numbers stand. One made of a text alone knows none.
struct Said {
  std::string text;
  std::vector<Mark> marks = {};  ///< in the order of the text

  Said() = default;
  Said(std::string words) : text(std::move(words)) {}  // NOLINT(google-explicit-constructor)
  Said(const char* words) : text(words) {}             // NOLINT(google-explicit-constructor)

  bool operator==(const Said&) const = default;
  bool empty() const { return text.empty(); }
  /// Appends a text with its numbers.
  Said& operator+=(const Said& more);
  friend Said operator+(Said a, const Said& b) { return std::move(a += b); }
  /// The digits of a number.
  std::string number(std::size_t mark) const { return text.substr(marks[mark].begin, marks[mark].size); }
  /// The text with other words in the place of its numbers, in their order. Throws std::invalid_argument for another
  /// count of words.
  Said with_numbers(const std::vector<std::string>& words) const;
  /// Equal for two texts that differ in numbers alone: a character that no text has stands for each.
  std::string without_numbers() const;
};

/// Values in a row are one number: "1e-8, 1e-9 and 3 more".
Said as_number(std::string digits, std::string unit = {});

}  // namespace ricochet
