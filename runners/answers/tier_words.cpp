#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <ricochet/measure/statistics/quantiles.hpp>

#include "runners/answers/measure_answer.hpp"
#include "runners/study/axis_meaning.hpp"

namespace ricochet::answers {
namespace {

constexpr double small_share = 5e-3;

}  // namespace

Clause TierSpeaker::clause(const std::string& form, const Members& members) const {
  Clause out;
  out.form = form;
  out.measure = words_.measure;
  out.unit = words_.unit;
  if (members.empty()) return out;
  out.who = names_.of(members);
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const std::size_t k : members) {
    const Limit& one = limit(k);
    const bool restless = one.status == LimitStatus::wanders;
    low = std::min(low, restless ? one.low : one.value);
    high = std::max(high, restless ? one.high : one.value);
    out.methods += (out.methods.empty() ? "" : " ") + methods_[k]->finest->id;
    if (const auto h = study_.step(*methods_[k]->finest)) out.at_step = std::min(out.at_step.value_or(*h), *h);
    if (const auto N = study_.elements(*methods_[k]->finest)) out.at_mesh = std::max(out.at_mesh.value_or(*N), *N);
    if (out.status.empty())
      out.status = word(one.status);
    else if (out.status != word(one.status))
      out.status = "several";
  }
  out.low = low * words_.factor;
  out.high = high * words_.factor;
  std::vector<double> values = of(members, [](const Limit& l) { return l.value; });
  out.value = median(values) * words_.factor;
  if (const auto u = largest_uncertainty(members)) out.uncertainty = *u * words_.factor;
  return out;
}

Clause TierSpeaker::spread_clause(const Members& members, double spread) const {
  Clause out = clause("apart", members);
  out.value = 100 * spread / scale_;
  out.low = out.high = std::nullopt;
  if (const auto u = largest_uncertainty(members)) out.uncertainty = 100 * *u / scale_;
  out.unit = "%";
  return out;
}

std::string TierSpeaker::finest_words(const Members& members) const {
  std::optional<double> finest;
  for (const std::size_t k : members)
    if (const auto h = study_.step(*methods_[k]->finest)) finest = std::min(finest.value_or(*h), *h);
  return finest ? study_.step_words(*finest) : "the finest step";
}

std::string TierSpeaker::refined_words(const Members& members) const {
  bool step = false, mesh = false;
  for (const std::size_t k : members) {
    step = step || (methods_[k]->step && methods_[k]->step->sizes > 1);
    mesh = mesh || (methods_[k]->mesh && methods_[k]->mesh->sizes > 1);
  }
  return step && mesh ? "step and mesh" : mesh ? "the mesh" : "the step";
}

/// "; with h = 2e-6 s it would be told", where an order is evident and that is at most a hundred times finer.
std::string TierSpeaker::more_needed(const Members& members, double target, std::vector<Clause>& clauses) const {
  std::optional<double> needed;
  bool evident = true, restless = false;
  for (const std::size_t k : members) {
    const Method& method = *methods_[k];
    restless = restless || limit(k).status == LimitStatus::wanders;
    if (!method.step || !method.step->uncertainty || *method.step->uncertainty <= target) continue;
    const auto h = study_.step(*method.finest);
    if (!method.step->order || !h || !std::isfinite(*method.step->uncertainty)) {
      evident = false;
      continue;
    }
    constexpr double hundred = 100;
    const double step = *h * std::pow(target / *method.step->uncertainty, 1 / *method.step->order);
    if (step < *h / hundred) evident = false;
    needed = std::min(needed.value_or(step), step);
  }
  if (evident && needed) {
    const double unit = std::pow(10, std::floor(std::log10(*needed))), step = std::floor(*needed / unit) * unit;
    Clause said = clause("needs", {});
    said.at_step = step;
    clauses.push_back(std::move(said));
    return "; with " + study_.step_words(step) + " it would be told";
  }
  if (restless) return "; it wanders, so no finer step is sure to tell";
  return "; one more, finer step is needed";
}

/// "99.69 % (P1) and 99.51 % (P0)" of few that settle and are disjoint.
std::optional<std::string> TierSpeaker::told_apart(const Members& members) const {
  if (members.size() < 2 || members.size() > 3) return std::nullopt;
  Members sorted = members;
  std::sort(sorted.begin(), sorted.end(),
            [&](std::size_t a, std::size_t b) { return limit(a).value > limit(b).value; });
  for (const std::size_t k : sorted)
    if (!limit(k).settled()) return std::nullopt;
  for (std::size_t k = 1; k < sorted.size(); ++k) {
    const LimitInterval above = interval(limit(sorted[k - 1])), below = interval(limit(sorted[k]));
    if (below.high >= above.low) return std::nullopt;
  }
  // What they share is not said again.
  std::vector<std::vector<std::string>> parts;
  for (const std::size_t k : sorted) {
    std::vector<std::string> own;
    std::vector<std::string> choices;
    for (const std::string& column : columns_)
      if (const std::string choice = axis_role(column);
          std::find(choices.begin(), choices.end(), choice) == choices.end())
        choices.push_back(choice);
    for (const std::string& choice : choices) {
      std::string level = study_.level(methods_[k]->first(), choice);
      for (std::size_t at = 0; at < level.size();) {
        std::size_t space = level.find(' ', at);
        // "β = ½" is one word.
        while (space != std::string::npos &&
               (level.compare(space, 3, " = ") == 0 || (space >= 2 && level.compare(space - 2, 3, " = ") == 0)))
          space = level.find(' ', space + 1);
        own.push_back(level.substr(at, space == std::string::npos ? space : space - at));
        if (space == std::string::npos) break;
        at = space + 1;
      }
    }
    parts.push_back(std::move(own));
  }
  std::string out;
  for (std::size_t k = 0; k < sorted.size(); ++k) {
    std::string name;
    for (const std::string& part : parts[k]) {
      const bool shared = std::all_of(parts.begin(), parts.end(), [&](const auto& other) {
        return std::find(other.begin(), other.end(), part) != other.end();
      });
      if (!shared) name += (name.empty() ? "" : " ") + part;
    }
    constexpr std::size_t longest = 40;
    if (name.empty() || name.size() > longest) return std::nullopt;
    const Limit& one = limit(sorted[k]);
    out += fmt::format("{}{} ({})",
                       k == 0                   ? ""
                       : k + 1 == sorted.size() ? " and "
                                                : ", ",
                       value_text(words_, one.value, one.uncertainty), name);
  }
  return out;
}

/// "81 to 87 % (the consistent mass) and 76 to 78 % (the lumped mass)" of restless ones whose values so far are apart.
std::optional<std::string> TierSpeaker::ranges_apart(const Members& members) const {
  const bool restless = std::all_of(members.begin(), members.end(), [&](std::size_t k) { return limit(k).restless(); });
  if (!restless || members.size() < 2) return std::nullopt;
  const auto low = [&](std::size_t k) { return std::min(limit(k).low, limit(k).value); };
  const auto high = [&](std::size_t k) { return std::max(limit(k).high, limit(k).value); };
  Members sorted = members;
  std::sort(sorted.begin(), sorted.end(), [&](std::size_t a, std::size_t b) { return low(a) > low(b); });
  std::vector<Members> groups;
  double bottom = 0;
  for (const std::size_t k : sorted) {
    if (groups.empty() || bottom - high(k) > tolerance * scale_) groups.emplace_back();
    groups.back().push_back(k);
    bottom = low(k);
  }
  constexpr std::size_t most = 3, longest = 40;
  if (groups.size() < 2 || groups.size() > most) return std::nullopt;
  std::string out;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const SetNames::Name name = names_.found(groups[g]);
    if (!name.exact || name.text.size() > longest) return std::nullopt;
    double from = low(groups[g].front()), to = high(groups[g].front());
    for (const std::size_t k : groups[g]) from = std::min(from, low(k)), to = std::max(to, high(k));
    out += fmt::format("{}{} ({})",
                       g == 0                   ? ""
                       : g + 1 == groups.size() ? " and "
                                                : ", ",
                       range_text(words_, from, to), name.text);
  }
  return out;
}

std::string TierSpeaker::values_of(const Members& members) const {
  if (words_.decades) {
    if (most(members) <= nothing_gained) return "nothing (below 1e-11)";
    return range_text(words_, least(members), most(members));
  }
  if (auto apart = told_apart(members)) return *apart;
  if (auto apart = ranges_apart(members)) return *apart;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const std::size_t k : members) {
    const bool wanders = limit(k).status == LimitStatus::wanders;
    low = std::min(low, wanders ? limit(k).low : limit(k).value);
    high = std::max(high, wanders ? limit(k).high : limit(k).value);
  }
  const auto u = largest_uncertainty(members);
  const double small = small_share * std::max(std::abs(low), std::abs(high));
  return range_text(words_, low, high, u ? std::optional(std::min(*u, small)) : std::nullopt);
}

/// ", still rising", ", wandering", ", falling to zero with order 2".
std::string TierSpeaker::mark(const Members& members) const {
  const auto all = [&](const auto& holds) {
    return std::all_of(members.begin(), members.end(), [&](std::size_t k) { return holds(limit(k)); });
  };
  if (all([](const Limit& l) { return l.status == LimitStatus::vanishes; })) {
    std::vector<double> orders;
    for (const std::size_t k : members) orders.push_back(limit(k).order.value_or(0));
    return fmt::format(", falling to zero with order {:.1f}", median(orders));
  }
  if (keeps_energy() && all([](const Limit& l) { return l.status == LimitStatus::reaches_truth && l.order; })) {
    std::vector<double> orders;
    for (const std::size_t k : members) orders.push_back(*limit(k).order);
    return fmt::format(", and what is lacking falls with order {:.1f}", median(orders));
  }
  if (all([](const Limit& l) { return l.status == LimitStatus::wanders; })) return ", wandering";
  // What still moves by next to nothing is told to as many digits; near the truth that is all there is to tell.
  constexpr double next_to_nothing = 0.02;
  const auto still = [&](const Limit& one) {
    const bool near = keeps_energy() && std::abs(one.value - *words_.truth) <= keeps_within;
    return one.status == LimitStatus::moves &&
           (near || one.uncertainty.value_or(0) > next_to_nothing * tolerance * scale_);
  };
  int rising = 0, falling = 0, moving = 0;
  for (const std::size_t k : members)
    if (still(limit(k))) ++moving, rising += limit(k).trend > 0, falling += limit(k).trend < 0;
  if (moving == 0) {
    // Two steps tell methods apart before they tell where each goes.
    const double u = largest_uncertainty(members).value_or(0);
    const double size = std::max(std::abs(least(members)), std::abs(most(members)));
    constexpr double tenth = 0.1;
    if (!std::isfinite(u) || u <= small_share * scale_ || u <= tenth * size || u <= most(members) - least(members))
      return "";
    return fmt::format(", give or take {}", value_text(words_, u, u));
  }
  const std::string word = rising == moving ? "rising" : falling == moving ? "falling" : "moving";
  return static_cast<std::size_t>(moving) == members.size() ? ", still " + word : ", some still " + word;
}

/// "99.69 % (P1) and 99.51 % (P0) of the energy is left", "all of the energy is left, to 4e-5 %".
std::string TierSpeaker::kept_values(const Members& members) const {
  constexpr double all_of_it = 1e-4;
  double lacking = 0;
  for (const std::size_t k : members) lacking = std::max(lacking, std::abs(limit(k).value - *words_.truth));
  if (lacking > all_of_it) return values_of(members) + " of the energy is left";
  if (lacking < nothing_gained) return "all of the energy is left";
  return "all of the energy is left, to " + percent(lacking);
}

std::optional<Sentence> TierSpeaker::kept_apart(const Members& firm) const {
  std::vector<double> lacking;
  for (const std::size_t k : firm) lacking.push_back(std::abs(limit(k).value - *words_.truth));
  constexpr double told = 100, least = 1e-16;
  const auto [low, high] = std::minmax_element(lacking.begin(), lacking.end());
  if (*high < told * std::max(*low, least) || *high < nothing_gained) return std::nullopt;
  std::vector<Members> groups = tiers_over_decades(lacking, nothing_gained).tiers;
  constexpr std::size_t most = 4;
  if (groups.size() < 2 || groups.size() > most) return std::nullopt;
  Sentence out;
  for (Members& group : groups) {
    double worst = 0;
    for (std::size_t& k : group) {
      worst = std::max(worst, lacking[k]);
      k = firm[k];
    }
    std::sort(group.begin(), group.end());
    Clause said = clause("keeps", group);
    said.value = 100 * worst;
    said.unit = "%";
    out.text += fmt::format("{}{} with {}", out.text.empty() ? "" : "; ",
                            worst <= nothing_gained ? "to round-off" : "to " + percent(worst), said.who);
    out.clauses.push_back(std::move(said));
  }
  out.text = "All keep it: all of the energy is left, " + out.text + ".";
  return out;
}

/// "with either mass matrix", "whichever method".
std::string TierSpeaker::whichever() const {
  std::vector<std::string> choices;
  for (const std::string& column : columns_)
    if (const std::string choice = axis_role(column);
        std::find(choices.begin(), choices.end(), choice) == choices.end())
      choices.push_back(choice);
  static const std::map<std::string, std::string> nouns = {
      {"mass", "mass matrix"}, {"contact", "contact law"}, {"time", "scheme"}};
  const auto noun = choices.size() == 1 ? nouns.find(choices.front()) : nouns.end();
  if (noun == nouns.end()) return "whichever method";
  return (methods_.size() == 2 ? "with either " : "with every ") + noun->second;
}

}  // namespace ricochet::answers
