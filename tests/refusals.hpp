#pragma once
#include <algorithm>
#include <catch2/catch.hpp>
#include <ricochet/contract/errors.hpp>
#include <sstream>
#include <string>
#include <vector>

/// \file
/// What a refusal must be, so that whoever reads it can act on it.
namespace ricochet::testing {

/// Matches "what does not fit: what to take instead". First comes a clause of four words or more that ends in a colon,
/// a semicolon, a comma or a full stop. After it comes an order with its object ("use …", "Keep one", "lower `modes`").
class CauseAndRemedy final : public Catch::MatcherBase<std::string> {
 public:
  bool match(const std::string& sentence) const override {
    const std::vector<std::string> orders = {"use",   "choose", "take",  "give", "keep", "start",   "move",
                                             "lower", "raise",  "place", "drop", "add",  "shorten", "project"};
    std::istringstream text(sentence);
    int words = 0;
    bool cause = false;
    for (std::string word; text >> word;) {
      if (word[0] >= 'A' && word[0] <= 'Z') word[0] = static_cast<char>(word[0] - 'A' + 'a');
      const bool order = std::find(orders.begin(), orders.end(), word) != orders.end();
      if (cause && order) return static_cast<bool>(text >> word);
      cause = cause || (++words >= 4 && std::string(":;,.").find(word.back()) != std::string::npos);
    }
    return false;
  }
  std::string describe() const override { return "names a cause and a remedy"; }
};

/// What `action` is refused with: "pointer: message"; `accepted` where it is not.
template <class Action>
std::string input_error(Action action, const char* accepted = "no error") {
  try {
    action();
  } catch (const InputError& error) {
    return error.pointer() + ": " + error.what();
  }
  return accepted;
}

inline CauseAndRemedy names_cause_and_remedy() {
  return {};
}

}  // namespace ricochet::testing
