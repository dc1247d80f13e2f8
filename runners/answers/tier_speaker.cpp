#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <ricochet/measure/statistics/quantiles.hpp>

#include "runners/answers/measure_answer.hpp"

namespace ricochet::answers {

Sentence TierSpeaker::one_method() const {
  const Limit& one = limit(0);
  std::string text = capitalised(words_.words) + ": " + with_uncertainty(words_, one.value, one.uncertainty);
  if (one.status == LimitStatus::one)
    text += fmt::format(" at {}, the only step: how far a finer one would move it is not known", finest_words({0}));
  else if (one.status == LimitStatus::wanders)
    text += "; it wanders over the three finest steps";
  else
    text += mark({0});
  return {text + ".", {clause("value", {0})}};
}

Sentence TierSpeaker::together(const Members& firm, const Difference& far, double u) const {
  Clause said = clause("none", firm);
  said.value = far.value / scale_;
  said.uncertainty = far.uncertainty.value_or(0) / scale_;
  return {fmt::format("No difference: {} differs by {} ± {} between methods, though refinement still moves all of them "
                      "together by {}, from {}.",
                      words_.words, percent(far.value / scale_), percent(far.uncertainty.value_or(0) / scale_),
                      percent(u / scale_), values_of(firm)),
          {said}};
}

Sentence TierSpeaker::no_difference(const Members& firm, std::optional<double> u, double spread) const {
  std::vector<double> values = of(firm, [](const Limit& l) { return l.value; });
  const double middle = median(values);
  const std::string who = firm.size() == methods_.size() ? whichever() : "with " + names_.of(firm);
  Clause said = clause("none", firm);
  if (keeps_energy() && std::abs(middle - *words_.truth) <= keeps_within / 2) {
    double farthest_value = 0;
    std::size_t which = firm.front();
    for (const std::size_t k : firm)
      if (std::abs(limit(k).value - *words_.truth) > farthest_value)
        farthest_value = std::abs(limit(k).value - *words_.truth), which = k;
    said.form = "keeps";
    if (auto apart = kept_apart(firm)) return std::move(*apart);
    const std::string left = farthest_value < nothing_gained
                                 ? "all of the energy is left"
                                 : "all of the energy is left, to " + percent(farthest_value);
    return {fmt::format("All keep it: {} {}{}.", left, who,
                        farthest_value < nothing_gained ? "" : " (the farthest: " + names_.label(which) + ")"),
            {said}};
  }
  if (u && by_percent(spread / scale_) == by_percent(0) && by_percent(*u / scale_) == by_percent(0))
    return {fmt::format("No difference: {} is {} {}, at every step and mesh.", words_.words,
                        value_text(words_, middle, std::nullopt), who),
            {said}};
  if (!u)
    return {fmt::format(
                "No difference at {}, the only step: {} is {} {}; methods differ by {}. What a finer step would "
                "change is not known.",
                finest_words(firm), words_.words, value_text(words_, middle, spread), who, by_percent(spread / scale_)),
            {said, spread_clause(firm, spread)}};
  return {fmt::format("No difference: {} is {} {}; methods differ by {}, and refining {} still moves a result by {}.",
                      words_.words, value_text(words_, middle, std::max(*u, spread)), who, by_percent(spread / scale_),
                      refined_words(firm), by_percent(*u / scale_)),
          {said, spread_clause(firm, spread)}};
}

Sentence TierSpeaker::cannot_tell(const Members& firm, std::optional<double> u, double spread) const {
  std::vector<Clause> clauses = {clause("open", firm), spread_clause(firm, spread)};
  if (!u)
    return {fmt::format("{} differs by {} between methods at {}, the only step: it lies in {}. What a finer step would "
                        "change is not known.",
                        capitalised(words_.words), percent(spread / scale_), finest_words(firm), values_of(firm)),
            std::move(clauses)};
  const std::string refined = refined_words(firm);
  const double target = std::max(spread, tolerance * scale_) / 3;
  const std::string more = more_needed(firm, target, clauses);
  return {
      fmt::format("These steps cannot tell: {} differs by {} between methods, but {} still move{} it by up to {}{}; "
                  "it lies in {}.",
                  words_.words, percent(spread / scale_), refined, plural_s(refined == "step and mesh"),
                  percent(*u / scale_), more, values_of(firm)),
      std::move(clauses)};
}

void TierSpeaker::say_tiers(const std::vector<Members>& tiers, std::vector<Sentence>& out) const {
  const auto form = [&](const Members& members) {
    return keeps_energy() && std::abs(most(members) - *words_.truth) <= keeps_within ? "keeps" : "differ";
  };
  const SetNames::Name first = names_.found(tiers.front());
  const std::string value = values_of(tiers.front()), after = mark(tiers.front());
  Sentence said;
  said.clauses.push_back(clause(form(tiers.front()), tiers.front()));
  if (keeps_energy() && most(tiers.front()) > *words_.truth - keeps_within)
    said.text = fmt::format("{} keep{} it: {}{}", capitalised(first.text), plural_s(first.several),
                            kept_values(tiers.front()), after);
  else if (keeps_energy())
    said.text =
        fmt::format("None keeps it; {} come{} nearest with {}{}", first.text, plural_s(first.several), value, after);
  else if (words_.direction < 0)
    said.text = fmt::format("{}: least, {}, with {}{}", capitalised(words_.words), value, first.text, after);
  else
    said.text = fmt::format("{}: {} with {}{}", capitalised(words_.words), value, first.text, after);
  constexpr std::size_t told = 4;
  std::vector<Members> shown(tiers.begin() + 1,
                             tiers.begin() + static_cast<std::ptrdiff_t>(std::min(tiers.size(), told)));
  const bool ends = words_.decades && tiers.size() > 3;
  if (ends) shown = {tiers.back()};
  std::size_t more = 0;
  for (const Members& tier : tiers) more += tier.size();
  more -= tiers.front().size();
  for (const Members& tier : shown) {
    more -= tier.size();
    const SetNames::Name name = names_.found(tier);
    const std::string part =
        keeps_energy() ? fmt::format("{} keep{} {}{}", name.text, plural_s(name.several), values_of(tier), mark(tier))
                       : fmt::format("{}{}{} with {}{}", ends ? "most, " : "", values_of(tier), ends ? "," : "",
                                     name.text, mark(tier));
    constexpr std::size_t longest = 220;
    if (said.text.size() > longest) {
      said.text += ".";
      out.push_back(std::move(said));
      said = {keeps_energy() ? capitalised(part) : capitalised(words_.words) + ", further: " + part, {}};
    } else {
      said.text += "; " + part;
    }
    said.clauses.push_back(clause(form(tier), tier));
  }
  if (more > 0) said.text += fmt::format("; {} more in the table", more);
  said.text += ".";
  out.push_back(std::move(said));
}

Sentence TierSpeaker::nowhere(const Members& members, const Members& firm) const {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  std::optional<double> finest;
  for (const std::size_t k : members) {
    constexpr std::size_t last = 4;
    std::vector<std::pair<double, double>> values;
    for (const Valued& one : methods_[k]->done) values.emplace_back(study_.step(*one.record).value_or(0), one.value);
    std::sort(values.begin(), values.end());
    for (std::size_t i = 0; i < std::min(last, values.size()); ++i)
      low = std::min(low, values[i].second), high = std::max(high, values[i].second);
    if (const auto h = study_.step(*methods_[k]->finest)) finest = std::max(finest.value_or(*h), *h);
  }
  const SetNames::Name name = names_.found(members);
  Clause said = clause("open", members);
  said.low = low * words_.factor;
  said.high = high * words_.factor;
  said.status = "settles nowhere";
  std::vector<Clause> clauses = {said};
  // How far it is from the others at the finest step.
  std::string apart;
  if (!firm.empty() && !words_.decades) {
    const double middle = median(of(firm, [](const Limit& l) { return l.value; }));
    const double lowest = least(members) - middle, highest = most(members) - middle;
    const double size = words_.factor == 100 ? 1 : std::abs(middle);
    const bool beside = std::min(std::abs(lowest), std::abs(highest)) > tolerance * size && lowest * highest > 0;
    if (size > 0 && beside) {
      Clause distance = clause("differ", members);
      distance.low = 100 * std::min(std::abs(lowest), std::abs(highest)) / size;
      distance.high = 100 * std::max(std::abs(lowest), std::abs(highest)) / size;
      distance.unit = "%";
      distance.status = "of the others";
      clauses.push_back(std::move(distance));
      apart = fmt::format(", there {}{} {} than with the others",
                          percent(std::abs(lowest / size)) == percent(std::abs(highest / size))
                              ? ""
                              : percent(std::abs(lowest / size)) + " to ",
                          percent(std::abs(highest / size)), highest > 0 ? "more" : "less");
    }
  }
  return {fmt::format("{} settle{} nowhere: {}{}{}.", capitalised(name.text), plural_s(name.several),
                      range_text(words_, low, high), finest ? " down to " + study_.step_words(*finest) : "", apart),
          std::move(clauses)};
}

Sentence TierSpeaker::gains(const Members& members) const {
  const SetNames::Name name = names_.found(members);
  const bool of_energy = methods_[members.front()]->gains;
  // From fine to coarse, over all that gain: how often it grows or falls as the step is refined, and its ends.
  constexpr double infinite = std::numeric_limits<double>::infinity();
  double low = infinite, high = 0, lowest = infinite, highest = 0;
  bool falls = true, grows = true, several = false, driven = false;
  for (const std::size_t k : members) {
    std::vector<std::pair<double, double>> values;
    for (const Valued& one : methods_[k]->done) {
      const double kept = of_energy ? energy_kept(words_, *one.record).value_or(0) : one.value;
      values.emplace_back(study_.step(*one.record).value_or(0), kept);
      driven = driven || (of_energy && is_driven(*one.record));
    }
    std::sort(values.begin(), values.end());
    const double finest = of_energy ? values.front().second : limit(k).value;
    low = std::min(low, finest);
    high = std::max(high, finest);
    several = several || values.size() > 1;
    for (std::size_t i = 0; i < values.size(); ++i) {
      lowest = std::min(lowest, values[i].second);
      highest = std::max(highest, values[i].second);
      if (i > 0) falls = falls && values[i - 1].second < values[i].second;
      if (i > 0) grows = grows && values[i - 1].second >= values[i].second;
    }
  }
  const auto span = [](double from, double to) {
    return short_number(from, 2) == short_number(to, 2) ? short_number(to, 2)
                                                        : short_number(from, 2) + " to " + short_number(to, 2);
  };
  std::string rest;
  if (several) rest = falls ? ", less with finer steps" : grows ? ", and finer steps do not cure it" : "";
  if (several && of_energy && !falls)
    rest += fmt::format("; {} times {}", span(lowest, highest),
                        lowest > gains_above ? "at every step" : "over the steps, in no order");
  const std::string energy = of_energy ? " energy" : " in " + words_.words;
  return {
      fmt::format("{} gain{}{}: {}{} at {}{}.", capitalised(name.text), plural_s(name.several), energy, span(low, high),
                  of_energy             ? " times " + std::string(driven ? "what was brought in" : "the start")
                  : words_.unit.empty() ? ""
                                        : " " + words_.unit,
                  finest_words(members), rest),
      {clause("gains", members)}};
}

/// Equal steps tell apart what limits alone do not: the tier parts where its values are farthest from each other.
void TierSpeaker::split_at_widest_gap(std::vector<Members>& tiers) const {
  Members sorted = tiers.front();
  std::sort(sorted.begin(), sorted.end(),
            [&](std::size_t a, std::size_t b) { return limit(a).value < limit(b).value; });
  std::size_t cut = 1;
  for (std::size_t k = 1; k < sorted.size(); ++k)
    if (limit(sorted[k]).value - limit(sorted[k - 1]).value > limit(sorted[cut]).value - limit(sorted[cut - 1]).value)
      cut = k;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(cut);
  tiers = {Members(sorted.begin(), middle), Members(middle, sorted.end())};
}

/// Those that keep the energy are told from those that lose some, however small the gaps between them.
void TierSpeaker::split_keepers(std::vector<Members>& tiers) const {
  if (least(tiers.front()) >= *words_.truth - 2 * keeps_within) return;
  Members keep, lose;
  for (const std::size_t k : tiers.front()) (limit(k).value >= *words_.truth - keeps_within ? keep : lose).push_back(k);
  if (keep.empty()) return;
  tiers.front() = keep;
  tiers.insert(tiers.begin() + 1, lose);
}

TierSpeaker::Sorted TierSpeaker::sorted() const {
  Sorted out;
  Members rest;
  for (std::size_t k = 0; k < methods_.size(); ++k) {
    // What grows from nothing to next to nothing does not blow up.
    const bool grows =
        (limit(k).status == LimitStatus::blows_up && !words_.decades && std::abs(limit(k).value) > tolerance * scale_);
    (methods_[k]->gains ? out.gaining : grows ? out.blown : rest).push_back(k);
  }
  if (rest.empty()) return out;
  std::vector<Limit> limits;
  std::vector<double> values;
  for (const std::size_t k : rest) limits.push_back(limit(k)), values.push_back(limit(k).value);
  const double width = tolerance * scale_;
  out.found = words_.decades ? tiers_over_decades(values, nothing_gained) : tiers_of(limits, width);
  std::vector<Members>& tiers = out.found.tiers;
  const auto own = [&](Members& members) {
    for (std::size_t& k : members) k = rest[k];
  };
  for (Members& tier : tiers) own(tier);
  own(out.found.nowhere);
  for (const Members& tier : tiers) out.firm.insert(out.firm.end(), tier.begin(), tier.end());
  std::sort(out.firm.begin(), out.firm.end());
  if (out.firm.size() > 1) out.far = farthest(methods(out.firm));
  if (tiers.size() == 1 && !out.found.none_firm && out.far.uncertainty && out.far.value - *out.far.uncertainty > width)
    split_at_widest_gap(tiers);
  if (words_.direction > 0) std::reverse(tiers.begin(), tiers.end());
  if (keeps_energy() && !tiers.empty()) split_keepers(tiers);
  return out;
}

std::optional<Sentence> TierSpeaker::gaining() const {
  Members members;
  for (std::size_t k = 0; k < methods_.size(); ++k)
    if (methods_[k]->gains) members.push_back(k);
  return members.empty() ? std::nullopt : std::optional(gains(members));
}

std::vector<std::size_t> TierSpeaker::places() const {
  std::vector<std::size_t> out(methods_.size(), 0);
  const Sorted sets = sorted();
  for (std::size_t tier = 0; tier < sets.found.tiers.size(); ++tier)
    for (const std::size_t k : sets.found.tiers[tier]) out[k] = tier + 1;
  return out;
}

std::pair<std::string, std::vector<Sentence>> TierSpeaker::tiers() {
  std::vector<Sentence> out;
  if (methods_.size() == 1) return {"value", {one_method()}};
  const Sorted sets = sorted();
  const auto& [found, firm, blown, gaining, far] = sets;
  std::string kind = "none";
  const double width = tolerance * scale_;
  if (!firm.empty() || !found.nowhere.empty()) {
    const auto u = largest_uncertainty(firm);
    const double spread = firm.empty() ? 0 : most(firm) - least(firm);
    const std::size_t others = methods_.size() - blown.size() - gaining.size();
    const bool move_together = firm.size() > 1 && far.uncertainty && far.value + *far.uncertainty <= width &&
                               u.value_or(0) > 2 * width && firm.size() == others;
    if (move_together) {
      out.push_back(together(firm, far, *u));
    } else if (found.tiers.size() == 1 && firm.size() > 1 && !found.none_firm && spread <= width &&
               (!u || *u <= 2 * width)) {
      out.push_back(no_difference(firm, u, spread));
    } else if (found.tiers.size() == 1 && (found.none_firm || firm.size() > 1)) {
      kind = "open";
      out.push_back(cannot_tell(firm, u, spread));
    } else if (firm.size() == 1 && found.tiers.size() == 1 && found.nowhere.empty()) {
      kind = "differ";
      say_tiers(found.tiers, out);
    } else {
      kind = "differ";
      say_tiers(found.tiers, out);
      const bool single =
          std::all_of(firm.begin(), firm.end(), [&](std::size_t k) { return limit(k).status == LimitStatus::one; });
      if (single)
        out.push_back({fmt::format("All at {}, the only step: how much of this a finer step removes is not known.",
                                   finest_words(firm)),
                       {clause("status", {})}});
    }
    if (!found.nowhere.empty() && kind != "open") {
      kind = "differ";
      out.push_back(nowhere(found.nowhere, firm));
    }
  }
  if (!blown.empty()) {
    const auto place = out.begin() + (!out.empty() && kind == "differ" ? 1 : 0);
    out.insert(place, gains(blown));
    kind = "differ";
  }
  if (!gaining.empty()) out.insert(out.begin(), gains(gaining));
  return {kind, out};
}

}  // namespace ricochet::answers
