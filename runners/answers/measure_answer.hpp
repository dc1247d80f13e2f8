#pragma once
#include <optional>
#include <ricochet/measure/statistics/tiers.hpp>
#include <string>
#include <utility>
#include <vector>

#include "runners/answers/answer.hpp"
#include "runners/answers/limits.hpp"
#include "runners/answers/set_names.hpp"

namespace ricochet::answers {

/// All choices ranked by what they move, the one asked for first.
std::vector<Sentence> say_choices(const Compared& study, const MeasureLimits& limits,
                                  std::vector<ChoiceEffect> effects);

/// What each level of a choice gives: "1.2 to 1.3 N with penalty, 1.5 N with rigid stops". Told where these values are
/// farther apart than all other choices move any of them. Nothing otherwise, nor of more than six levels.
std::optional<Sentence> apart_levels(const Compared& study, const MeasureLimits& limits, const std::string& choice);

/// Of a compared choice: which levels agree with its first level, the reference, and how far the others are. Where none
/// agrees, the levels in tiers of their values. Empty of fewer than five levels, and of a number.
std::vector<Sentence> say_levels(const Compared& study, const MeasureLimits& limits);

/// What each level of the compared choice gives, the best first (the largest, where no direction is better). Nothing
/// where the first and the last overlap, nor of more than eight levels.
std::optional<Sentence> say_level_values(const Compared& study, const MeasureLimits& limits);

/// Of a compared number that matters: the end of its range in which it hardly moves the measure, "from stiffness 1e6
/// N/m on". It moves it there by a tenth of what matters at most. Nothing of fewer than four values, nor where no two
/// values at an end are so near.
std::optional<Sentence> say_steady_end(const Compared& study, const MeasureLimits& limits);

/// Methods that ran and have no value of a measure, with the reason: a sentence for each set of them.
std::vector<Sentence> say_without_value(const Compared& study, const std::vector<MeasureLimits>& measures);

/// That no case touched a stop, with the largest displacement against the gap. Nothing where one did, or has no stops.
std::optional<Sentence> say_untouched(const Compared& study);

/// A gain below this share of the energy is round-off.
inline constexpr double nothing_gained = 1e-11;
/// What keeps the energy is within this share of it.
inline constexpr double keeps_within = 0.01;

/// Methods of one measure with what is needed to speak of them.
class TierSpeaker {
 public:
  TierSpeaker(const Compared& study, const MeasureLimits& limits, std::vector<std::string> columns)
      : study_(study),
        words_(limits.words),
        methods_(limits.with_limit()),
        columns_(std::move(columns)),
        names_(study, firsts(), columns_) {
    scale_ = scale_of(words_, methods_);
    if (scale_ <= 0) scale_ = 1;
  }

  std::pair<std::string, std::vector<Sentence>> tiers();
  double scale() const { return scale_; }
  /// The tier of each method, 1 the best or least; 0 of those that grow or belong to none.
  std::vector<std::size_t> places() const;
  /// Who gains energy; nothing where none does, and of another measure.
  std::optional<Sentence> gaining() const;

 private:
  /// The tiers, those of all of them, those that grow, those that gain energy, and the two of all tiers that are
  /// farthest apart.
  struct Sorted {
    Tiers found = {};
    Members firm = {}, blown = {}, gaining = {};
    Difference far = {};
  };
  Sorted sorted() const;

  Cases firsts() const {
    Cases out;
    for (const Method* method : methods_) out.push_back(&method->first());
    return out;
  }
  const Limit& limit(std::size_t k) const { return *methods_[k]->limit; }

  std::vector<double> of(const Members& members, double (*read)(const Limit&)) const {
    std::vector<double> out;
    for (const std::size_t k : members) out.push_back(read(limit(k)));
    return out;
  }
  double least(const Members& members) const {
    const auto values = of(members, [](const Limit& l) { return l.value; });
    return *std::min_element(values.begin(), values.end());
  }
  double most(const Members& members) const {
    const auto values = of(members, [](const Limit& l) { return l.value; });
    return *std::max_element(values.begin(), values.end());
  }
  std::optional<double> largest_uncertainty(const Members& members) const {
    std::optional<double> out;
    for (const std::size_t k : members)
      if (const auto u = limit(k).uncertainty; u && std::isfinite(*u)) out = std::max(out.value_or(0), *u);
    return out;
  }
  std::vector<const Method*> methods(const Members& members) const {
    std::vector<const Method*> out;
    for (const std::size_t k : members) out.push_back(methods_[k]);
    return out;
  }

  void split_at_widest_gap(std::vector<Members>& tiers) const;
  void split_keepers(std::vector<Members>& tiers) const;
  Clause clause(const std::string& form, const Members& members) const;
  /// How far these are apart, and what refinement leaves of each, as shares of the scale.
  Clause spread_clause(const Members& members, double spread) const;
  std::string finest_words(const Members& members) const;
  std::string refined_words(const Members& members) const;
  std::string more_needed(const Members& members, double target, std::vector<Clause>& clauses) const;
  std::string values_of(const Members& members) const;
  std::string mark(const Members& members) const;
  std::string kept_values(const Members& members) const;
  std::string whichever() const;
  /// The measure is a share of energy that an exact method keeps.
  bool keeps_energy() const { return words_.truth == 1.0; }
  std::optional<std::string> told_apart(const Members& members) const;
  std::optional<std::string> ranges_apart(const Members& members) const;

  Sentence one_method() const;
  Sentence no_difference(const Members& firm, std::optional<double> u, double spread) const;
  Sentence together(const Members& firm, const Difference& far, double u) const;
  /// What keeps the energy, by how well, where that differs by a hundred times and has at most four groups.
  std::optional<Sentence> kept_apart(const Members& firm) const;
  Sentence cannot_tell(const Members& firm, std::optional<double> u, double spread) const;
  void say_tiers(const std::vector<Members>& tiers, std::vector<Sentence>& out) const;
  Sentence nowhere(const Members& members, const Members& firm) const;
  Sentence gains(const Members& members) const;

  const Compared& study_;
  MeasureWords words_;
  std::vector<const Method*> methods_;
  std::vector<std::string> columns_;
  SetNames names_;
  double scale_ = 1;
};

}  // namespace ricochet::answers
