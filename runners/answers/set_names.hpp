#pragma once
#include <optional>
#include <ricochet/measure/statistics/tiers.hpp>
#include <string>
#include <vector>

#include "runners/report/choices.hpp"

namespace ricochet::answers {

/// Names of sets of methods: the shortest rule over choices that picks exactly the set out of all that are compared.
class SetNames {
 public:
  /// `methods`: a case of each; told apart by `columns`.
  SetNames(const Choices& study, Cases methods, std::vector<std::string> columns);
  SetNames(const Choices& study, Cases methods) : SetNames(study, methods, study.columns()) {}

  /// A rule of one to three attributes ("the singular mass with β = ½"), or an end of a number ("stiffness 1e6 N/m and
  /// more"). A union of at most three rules, four where nothing else is exact. Up to three labels. All but such a set.
  /// The levels of the largest choice that are wholly in. Else the nearest rule with its exceptions. Never empty.
  std::string of(const Members& chosen) const { return found(chosen, true).text; }
  /// The same, with whether it is one thing (a verb then has an s).
  struct Name {
    std::string text;
    bool several = false;
    bool exact = true;  ///< picks the set and nothing else
  };
  Name found(const Members& chosen, bool may_turn = true) const;
  /// What all of these have in common: "7 of 68 methods, all of them with explicit evaluation".
  std::string shared(const Members& chosen) const;
  /// The label of one method.
  std::string label(std::size_t method) const;
  std::size_t size() const { return methods_.size(); }

 private:
  struct Attribute {
    std::string column;               // a choice, or one of its columns
    bool whole = false;               // a choice of several columns
    std::vector<std::string> levels;  // of each method, as texts or as labels of a whole choice
    std::vector<std::string> all;     // in order of appearance
    std::string owner = {};           // of a parameter: the one method among several that has it
  };
  using Picked = std::vector<char>;
  /// One level of each of some attributes, and whom it picks.
  struct Rule {
    std::vector<std::size_t> attributes;
    std::vector<std::string> levels;
    Members members;
  };

  void add(std::string column, bool whole, std::vector<std::string> levels);
  std::optional<std::string> words(const Attribute& attribute, const std::vector<std::string>& levels) const;
  std::optional<std::string> end_of_number(const Attribute& attribute, const std::vector<std::string>& levels) const;
  /// The cheapest conjunction that picks exactly the set, and its cost.
  std::optional<std::pair<double, std::string>> rule(const Picked& chosen) const;
  bool has(const Rule& rule, std::size_t method) const;
  /// Of one or two attributes, those that pick none but the set.
  std::vector<Rule> rules_within(const Picked& chosen) const;
  std::optional<std::string> cover(const Picked& chosen, std::size_t count, std::size_t most_rules) const;
  std::optional<std::string> whole_levels(const Picked& chosen, std::size_t count) const;
  std::optional<std::string> nearest(const Picked& chosen, std::size_t count, double least_worth) const;
  /// All levels that the set has, of the two choices that leave the fewest others in.
  std::optional<std::string> all_levels(const Picked& chosen, std::size_t count) const;
  /// By the levels of the choice that tells most: "most with the lumped mass (15 of 19); Newmark and WBZ with …".
  std::optional<std::string> by_levels(const Picked& chosen) const;
  /// The choice of methods with the most levels, as whole as it is; none of fewer than `levels`.
  const Attribute* widest(std::size_t levels, const std::string& but = "") const;
  std::string common(const Picked& chosen, std::size_t count) const;

  const Choices& study_;
  Cases methods_;
  std::vector<std::string> columns_;
  std::vector<Attribute> attributes_;
};

/// A name without its count: "all of them with explicit evaluation" of "44 of 88 methods, all of them with …"; "" of a
/// count alone.
std::string without_count(const std::string& name);

/// "a, b and c".
std::string and_list(const std::vector<std::string>& items);
/// "a, and b and c": of names that hold "and" themselves.
std::string and_names(const std::vector<std::string>& names);

}  // namespace ricochet::answers
