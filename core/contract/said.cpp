#include <ricochet/contract/said.hpp>
#include <stdexcept>
#include <utility>

namespace ricochet {

Said& Said::operator+=(const Said& more) {
  const std::size_t shift = text.size();
  text += more.text;
  for (Mark mark : more.marks) {
    mark.begin += shift;
    marks.push_back(std::move(mark));
  }
  return *this;
}

Said Said::with_numbers(const std::vector<std::string>& words) const {
  if (words.size() != marks.size()) throw std::invalid_argument("a text with another count of numbers");
  Said out;
  std::size_t at = 0;
  for (std::size_t k = 0; k < marks.size(); ++k) {
    out.text.append(text, at, marks[k].begin - at);
    out.marks.push_back({out.text.size(), words[k].size(), marks[k].unit});
    out.text += words[k];
    at = marks[k].begin + marks[k].size;
  }
  out.text.append(text, at);
  return out;
}

std::string Said::without_numbers() const {
  return with_numbers(std::vector<std::string>(marks.size(), "\x1f")).text;
}

Said as_number(std::string digits, std::string unit) {
  Said out;
  out.marks.push_back({0, digits.size(), unit});
  out.text = std::move(digits);
  if (!unit.empty()) out.text += " " + unit;
  return out;
}

}  // namespace ricochet
