#include "runners/kinds/sweep/motion_asks.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <set>

#include "runners/answers/numbers_in_words.hpp"
#include "runners/asks/kind_verbs.hpp"
#include "runners/asks/lines.hpp"
#include "runners/json/json_text.hpp"
#include "runners/study/axis_meaning.hpp"
#include "runners/table/in_order_met.hpp"

namespace ricochet {

std::string motion_words(const std::string& motion) {
  if (motion.starts_with("periodic ")) return "period " + motion.substr(9);
  if (motion.starts_with("chattering ")) return "period " + motion.substr(11) + " with chatter";
  return motion == "chaotic" ? "chaos" : motion;
}

std::string motion_words(const MotionClass& motion) {
  return motion_words(text(motion));
}

MotionCounts compare_motions(const std::vector<GridCell>& one, const std::vector<GridCell>& other) {
  // Places that two motions of one class share.
  std::map<std::pair<int, int>, int> shared;
  const std::size_t places = std::min(one.size(), other.size());
  for (std::size_t k = 0; k < places; ++k)
    if (one[k].present && other[k].present && one[k].motion.decided() && one[k].motion == other[k].motion &&
        one[k].attractor >= 0 && other[k].attractor >= 0)
      ++shared[{one[k].attractor, other[k].attractor}];
  std::vector<std::pair<int, std::pair<int, int>>> most;
  for (const auto& [pair, count] : shared) most.emplace_back(-count, pair);
  std::sort(most.begin(), most.end());
  std::map<int, int> partner;
  std::set<int> taken;
  for (const auto& [count, pair] : most)
    if (!partner.contains(pair.first) && taken.insert(pair.second).second) partner.emplace(pair.first, pair.second);
  MotionCounts out;
  for (std::size_t k = 0; k < places; ++k) {
    const GridCell &a = one[k], &b = other[k];
    if (!a.present || !b.present) continue;
    if (a.motion.regime == Regime::failed && b.motion.regime == Regime::failed) continue;
    if (!a.motion.decided() || !b.motion.decided()) {
      ++out.open;
      continue;
    }
    ++out.both;
    const auto known = partner.find(a.attractor);
    out.changed += !(a.motion == b.motion) ||
                   (known != partner.end() && taken.contains(b.attractor) && known->second != b.attractor);
  }
  return out;
}

namespace {

/// Two levels of the choice, all else the same.
struct MotionPair {
  const CaseRecord *first = nullptr, *second = nullptr;
  MotionCounts counts;
  double share = 0, low = 0, high = 0;          ///< of the places
  asks::Verdict verdict = asks::Verdict::open;  ///< whether it changes as much as asked
  bool one_step = false;                        ///< what the step changes is not known
  std::string reason;
};

class MotionEffect {
 public:
  MotionEffect(const asks::Ask& ask, const asks::Evidence& evidence, const MotionsOf& motions, std::string places)
      : ask_(ask),
        study_(evidence.study()),
        motions_(motions),
        places_(std::move(places)),
        own_(evidence.columns_of(ask.subject())),
        cases_(evidence.cases(ask)) {
    agrees_ = ask.has("within");
    from_ = ask.share_asked();
    for (const std::string& column : evidence.varying(cases_))
      if (!is_refinement(column) && std::find(own_.begin(), own_.end(), column) == own_.end())
        others_.push_back(column);
    find_pairs();
  }

  asks::Answered answer() const {
    asks::Answered out;
    Cases left;
    for (const CaseRecord* one : cases_)
      if (!motions_(*one)) left.push_back(one);
    out.cases = cases_.size() - left.size();
    asks::leave_out(out, left);
    if (alone_ > 0)
      out.aside.push_back(fmt::format("Left out: {} levels that agree with no other in all else.", alone_));
    std::vector<asks::Verdict> verdicts;
    std::vector<const MotionPair*> yes, no, open;
    Json bars = Json::array();
    for (const MotionPair& one : pairs_) {
      add_row(out, one);
      bars.push_back({{"name", pair_words(one)}, {"group", place(one)}});
      if (one.counts.both > 0)
        bars.back().update({{"value", asks::per_cent * one.share},
                            {"low", asks::per_cent * one.low},
                            {"high", asks::per_cent * one.high}});
      (one.verdict == asks::Verdict::yes ? yes : one.verdict == asks::Verdict::no ? no : open).push_back(&one);
    }
    say(out, yes, no, open);
    out.figure = {{"form", "bars"},
                  {"measure", places_ + " of another motion"},
                  {"unit", "%"},
                  {"rows", bars},
                  {"at", Json::array({asks::per_cent * from_})}};
    return out;
  }

 private:
  bool owns(const char* column) const { return std::find(own_.begin(), own_.end(), column) != own_.end(); }
  /// A refinement that is the choice is no size.
  asks::Size size(const CaseRecord& one) const {
    const bool step = !owns("steps_per_period") && !owns("step"), mesh = !owns("elements") && !owns("modes");
    return {step ? study_.step(one).value_or(1) : 1, mesh ? study_.elements(one).value_or(1) : 1};
  }

  void find_pairs() {
    // Of each combination of the others each level, in the study's order, with its cases by size.
    InOrderMet<std::string, InOrderMet<std::string, Cases>> groups;
    for (const CaseRecord* one : cases_)
      if (motions_(*one)) groups[study_.key(*one, others_)][study_.key(*one, own_)].push_back(one);
    const bool refined = own_.size() == 1 && is_refinement(own_.front());
    for (const auto& [others, levels] : groups.list()) {
      std::vector<std::pair<std::string, Cases>> list = levels.list();
      alone_ += list.size() == 1;
      // Of a refinement each level against the one before it.
      if (refined)
        std::stable_sort(list.begin(), list.end(), [&](const auto& a, const auto& b) {
          return study_.finer(*b.second.front(), *a.second.front());
        });
      for (std::size_t a = 0; a < list.size(); ++a)
        for (std::size_t b = a + 1; b < (refined ? std::min(a + 2, list.size()) : list.size()); ++b)
          add_pair(list[a].second, list[b].second);
    }
  }

  void add_pair(const Cases& one, const Cases& other) {
    MotionPair pair;
    for (const CaseRecord* a : one)
      for (const CaseRecord* b : other)
        if (size(*a) == size(*b) && (!pair.first || study_.finer(*a, *pair.first))) pair.first = a, pair.second = b;
    if (!pair.first) {
      pair.first = one.front();
      pair.second = other.front();
      pair.reason = "they have no step and mesh in common";
      pairs_.push_back(std::move(pair));
      return;
    }
    pair.counts = compare_motions(*motions_(*pair.first), *motions_(*pair.second));
    const double all = static_cast<double>(pair.counts.both + pair.counts.open);
    if (pair.counts.both == 0) {
      pair.reason = "none of the " + places_ + " is decided in both";
      pairs_.push_back(std::move(pair));
      return;
    }
    pair.share = static_cast<double>(pair.counts.changed) / static_cast<double>(pair.counts.both);
    // Shares of places that differ are a distance: what refinement moves on both sides may add to it or take from it.
    const auto first = moved_by_refinement(*pair.first, one), second = moved_by_refinement(*pair.second, other);
    const double moved = first.value_or(0) + second.value_or(0), decided = static_cast<double>(pair.counts.both),
                 changed = static_cast<double>(pair.counts.changed);
    pair.low = std::max(0.0, changed - moved * decided) / all;
    pair.high = std::min(1.0, (changed + static_cast<double>(pair.counts.open) + moved * decided) / all);
    if (pair.low >= from_ && pair.share > 0)
      pair.verdict = asks::Verdict::yes;
    else if (pair.high < from_ || pair.high == 0)
      pair.verdict = asks::Verdict::no;
    std::vector<std::string> parts = {fmt::format("{} of {} {}", pair.counts.changed, pair.counts.both, places_)};
    if (pair.counts.open > 0) parts.push_back(fmt::format("{} open", pair.counts.open));
    if (moved > 0) parts.push_back("refinement moves " + answers::percent(moved));
    if (!owns("steps_per_period") && !owns("step") && !(first && second)) {
      pair.verdict = asks::Verdict::open;
      pair.one_step = true;
      parts.emplace_back("one number of steps per period: what it changes is not known");
    } else if (agrees_ && pair.verdict == asks::Verdict::no && untouched(*pair.first) && untouched(*pair.second)) {
      pair.verdict = asks::Verdict::open;
      parts.emplace_back("no stop is touched: nothing tells them apart");
    }
    pair.reason = fmt::format("{}", fmt::join(parts, "; "));
    pairs_.push_back(std::move(pair));
  }

  bool untouched(const CaseRecord& one) const {
    const std::vector<GridCell>& places = *motions_(one);
    return std::none_of(places.begin(), places.end(), [](const GridCell& cell) {
      return cell.present && cell.motion.decided() && cell.motion.regime != Regime::no_contact;
    });
  }

  /// Share of the places that the last refinement of step and of mesh changes; nothing where no step is coarser.
  std::optional<double> moved_by_refinement(const CaseRecord& finest, const Cases& of) const {
    const auto moved = [&](bool step) -> std::optional<double> {
      const CaseRecord* before = nullptr;
      for (const CaseRecord* one : of) {
        const bool coarser = step ? size(*one).second == size(finest).second && size(*one).first > size(finest).first
                                  : size(*one).first == size(finest).first && size(*one).second < size(finest).second;
        if (coarser && (!before || study_.finer(*one, *before))) before = one;
      }
      if (!before) return std::nullopt;
      const MotionCounts counts = compare_motions(*motions_(*before), *motions_(finest));
      if (counts.both == 0) return std::nullopt;
      return static_cast<double>(counts.changed) / static_cast<double>(counts.both);
    };
    std::optional<double> out = moved(true);
    if (out) *out += moved(false).value_or(0);
    return out;
  }

  std::string own_level(const CaseRecord& one) const { return study_.words(one, own_); }
  std::string pair_words(const MotionPair& one) const {
    return own_level(*one.second) + " against " + own_level(*one.first);
  }
  /// The same of one number without its name: "0.9 against 0.3".
  std::string short_pair(const MotionPair& one) const {
    if (own_.size() != 1 || study_.numbers_of(own_.front()).size() < 2) return pair_words(one);
    return study_.text(*one.second, own_.front()) + " against " + study_.text(*one.first, own_.front());
  }
  std::string place(const MotionPair& one) const { return study_.words(*one.first, others_); }

  void add_row(asks::Answered& out, const MotionPair& one) const {
    asks::VerdictRow row;
    row.measure = "motions";
    row.level = pair_words(one) + (place(one).empty() ? "" : ", " + place(one));
    row.unit = "%";
    if (one.counts.both > 0) {
      row.value = asks::per_cent * one.share;
      row.low = asks::per_cent * std::min(one.low, one.share);
      row.high = asks::per_cent * std::max(one.high, one.share);
    }
    const asks::Verdict shown = one.verdict == asks::Verdict::open               ? one.verdict
                                : (one.verdict == asks::Verdict::yes) != agrees_ ? asks::Verdict::yes
                                                                                 : asks::Verdict::no;
    row.verdict = ricochet::word(shown);
    row.reason = one.reason;
    row.cases = 2;
    row.left_out = 0;
    out.rows.push_back(std::move(row));
  }

  /// "30 of 625 starts (e = 0.6 against 0.3)", then the counts of others.
  std::string each(const std::vector<const MotionPair*>& list) const {
    std::string out;
    for (const MotionPair* one : list)
      out += fmt::format("{}{}{} ({}{})", out.empty() ? "" : ", ", one->counts.changed,
                         out.empty() ? fmt::format(" of {} {}", one->counts.both, places_) : "", short_pair(*one),
                         place(*one).empty() ? "" : ", " + place(*one));
    return out;
  }
  std::string range(const std::vector<const MotionPair*>& list) const {
    const auto [low, high] = std::minmax_element(
        list.begin(), list.end(), [](const MotionPair* a, const MotionPair* b) { return a->share < b->share; });
    const std::string a = answers::percent((*low)->share), b = answers::percent((*high)->share);
    return fmt::format("{} of the {}", a == b ? a : a + " to " + b, places_);
  }

  void say(asks::Answered& out, const std::vector<const MotionPair*>& yes, const std::vector<const MotionPair*>& no,
           const std::vector<const MotionPair*>& open) const {
    const std::string choice = study_.spoken(ask_.subject()), least = answers::percent(from_);
    const std::size_t all = pairs_.size();
    const auto word = [&](asks::Verdict changes) {
      const asks::Verdict shown = changes == asks::Verdict::open               ? changes
                                  : (changes == asks::Verdict::yes) != agrees_ ? asks::Verdict::yes
                                                                               : asks::Verdict::no;
      out.passes = shown;
      out.verdict = ricochet::word(shown);
      return std::string(shown == asks::Verdict::yes ? "Yes" : "No") + (!agrees_ ? ""
                                                                        : shown == asks::Verdict::yes
                                                                            ? ", they agree"
                                                                            : ", they do not agree");
    };
    // Of what changes less than asked.
    const std::string under = from_ > 0 ? fmt::format(", {} {}", agrees_ ? "within" : "less than", least) : "";
    if (all == 0) {
      word(asks::Verdict::open);
      out.reason = "no two cases differ in it alone";
      out.sentence = fmt::format("Open: whether {} changes motions is not told: {}.", choice, out.reason);
    } else if (!yes.empty() && yes.size() == all) {
      const std::string first = word(asks::Verdict::yes);
      out.sentence = asks::fitting(
          {fmt::format("{}: {} changes the motion of {}.", first, choice, each(yes)),
           fmt::format("{}: {} changes the motion of {}, in all {} pairs.", first, choice, range(yes), all)});
    } else if (no.size() == all) {
      const std::string first = word(asks::Verdict::no);
      const bool none =
          std::all_of(no.begin(), no.end(), [](const MotionPair* one) { return one->counts.changed == 0; });
      const std::string pairs = all == 1 ? "" : fmt::format(" in {} pairs", all);
      out.sentence = asks::fitting(
          {none ? fmt::format("{}: {} changes the motion of none of the {} {}{}.", first, choice,
                              no.front()->counts.both, places_, pairs)
                : fmt::format("{}: {} changes the motion of {}{}.", first, choice, each(no), under),
           fmt::format(
               "{}: {} changes the motion of {} at most, in {} pairs{}.", first, choice,
               range({*std::max_element(no.begin(), no.end(),
                                        [](const MotionPair* a, const MotionPair* b) { return a->share < b->share; })}),
               all, under)});
    } else if (!yes.empty()) {
      // Agreement is asked of all pairs; a change that shows somewhere is one in part.
      word(agrees_ ? asks::Verdict::yes : no.empty() ? asks::Verdict::open : asks::Verdict::yes);
      if (!agrees_) {
        out.passes = no.empty() ? asks::Verdict::open : asks::Verdict::no;
        out.verdict = "in part";
      }
      const std::string first = agrees_ ? "No, they do not agree" : "In part",
                        rest = open.empty() ? "" : fmt::format("; {} open", open.size());
      out.sentence = asks::fitting({fmt::format("{}: {} changes the motion of {}{}.", first, choice, each(yes), rest),
                                    fmt::format("{}: {} changes the motion of {} in {} of {} pairs{}.", first, choice,
                                                range(yes), yes.size(), all, rest)});
    } else {
      word(asks::Verdict::open);
      const bool one_step = std::all_of(open.begin(), open.end(), [](const MotionPair* one) { return one->one_step; });
      out.reason = one_step ? "one number of steps per period" : open.front()->reason;
      out.sentence = asks::fitting(
          {fmt::format("Open: whether {} changes the motion of {} of the {} is not told: {}{}.", choice, least, places_,
                       out.reason, one_step ? "" : " (" + pair_words(*open.front()) + ")"),
           fmt::format("Open: whether {} changes the motion of {} of the {} is not told: {}.", choice, least, places_,
                       out.reason),
           fmt::format("Open: whether {} changes the motion of {} of the {} is not told in {} of {} pairs.", choice,
                       least, places_, open.size(), all)});
    }
  }

  const asks::Ask& ask_;
  const Choices& study_;
  const MotionsOf& motions_;
  std::string places_;
  std::vector<std::string> own_, others_;
  Cases cases_;
  double from_ = 0;
  bool agrees_ = false;
  std::size_t alone_ = 0;
  std::vector<MotionPair> pairs_;
};

}  // namespace

asks::Answered effect_on_motions(const asks::Ask& ask, const asks::Evidence& evidence, const MotionsOf& motions,
                                 const std::string& places) {
  return MotionEffect(ask, evidence, motions, places).answer();
}

Json default_motion_asks(const Json& resolved, const std::string& subject) {
  Json out = Json::array({{{"motions", subject}}});
  const auto ask_of_choice = [&](const std::string& choice) { out.push_back({{"effect", choice}, {"on", "motions"}}); };
  const auto key = [&](const char* name) { return resolved.contains(name) ? resolved[name] : Json(); };
  if (const Json compare = key("compare"); compare.is_string() && compare != "all") {
    ask_of_choice(compare.get<std::string>());
    return out;
  }
  for (const std::string& role : method_roles()) {
    const Json entries = key("methods").contains(role) ? key("methods")[role] : Json::array();
    const bool lists = std::any_of(entries.begin(), entries.end(), [](const Json& entry) {
      return std::any_of(entry.begin(), entry.end(),
                         [](const Json& value) { return value.is_array() && value.size() > 1; });
    });
    if (entries.size() > 1 || lists) ask_of_choice(role);
  }
  if (const Json steps = key("steps_per_period"); steps.is_array() && steps.size() > 1)
    ask_of_choice("steps_per_period");
  return out;
}

void check_effect_on_motions(const Study& study, const Json& keys, const std::string& pointer) {
  const asks::Ask ask = asks::ask_at(keys, pointer);
  asks::check_choice(ask, study, "effect", ask.subject());
  if (ask.has("from") && ask.has("within"))
    throw InputError(ask.pointer("within"), "does not go together with \"from\"; expected one of them");
}

}  // namespace ricochet
