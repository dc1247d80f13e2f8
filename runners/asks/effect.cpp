#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "runners/answers/set_names.hpp"
#include "runners/asks/lines.hpp"
#include "runners/asks/pairs.hpp"
#include "runners/asks/verbs.hpp"
#include "runners/json/json_text.hpp"
#include "runners/study/axis_meaning.hpp"
#include "runners/table/in_order_met.hpp"

namespace ricochet::asks {
namespace {

/// One combination of all other choices.
struct Combination {
  std::string stop, level;  // of the others
  std::vector<const Line*> lines;
};

/// What is told of two levels of one combination.
struct Told {
  const Combination* where = nullptr;
  const Line *a = nullptr, *b = nullptr;
  std::string first, second;  // their levels
  std::optional<Pair> pair = {};
  Verdict verdict = Verdict::open;
  std::string reason = {};
  bool between = false;  // open, for the size asked lies within its interval
  bool applies = true;   // neither level is refused throughout
};

/// Whether some of its cases met a stop.
bool touched(const Point& point) {
  return std::any_of(point.behind.begin(), point.behind.end(),
                     [](const CaseRecord* one) { return measure(*one, "contact_instants").value_or(0) > 0; });
}

/// Whether the difference is as large as asked. Nothing in both is no agreement.
void judge(Told& told, double from) {
  if (!told.pair) {
    told.reason = "they have no step and mesh in common";
    return;
  }
  const Pair& pair = *told.pair;
  // What is the same to the last bit needs no scale.
  if (pair.identical) {
    told.verdict = Verdict::no;
    return;
  }
  if (pair.least) {
    const bool larger = pair.share && std::abs(*pair.share) > from;
    told.verdict = larger ? Verdict::yes : Verdict::open;
    told.reason = !pair.share ? pair.unknown
                  : larger    ? "at least, one lies beyond the range"
                              : "one lies beyond the range";
    return;
  }
  const double floor = std::max(pair.first->floor, pair.second->floor);
  if (!pair.share) {
    const std::string first =
        std::abs(pair.base) <= floor ? "the first is zero, or round-off" : "the first is not told from zero";
    if (pair.apart) {
      told.verdict = Verdict::yes;
      told.reason = "apart at every size, though neither settles";
    } else if (std::abs(pair.base) <= floor && std::abs(pair.base + pair.difference) <= floor) {
      // Zero after contact is a result.
      if (touched(*pair.first) && touched(*pair.second)) told.verdict = Verdict::no;
      told.reason = "both are zero, or round-off";
    } else if (!pair.u) {
      told.reason = pair.unknown;
    } else if (std::abs(pair.difference) > pair.u_most.value_or(*pair.u)) {
      told.verdict = Verdict::yes;
      told.reason = first;
    } else {
      told.reason = first + ", and the second not told from it";
    }
    return;
  }
  if (!pair.share_u) {
    told.reason = pair.unknown;
    return;
  }
  const double size = std::abs(*pair.share), u = *pair.share_u, most = *pair.share_most;
  if (size - most > from)
    told.verdict = Verdict::yes;
  else if (size + most < from)
    told.verdict = Verdict::no;
  else if (size - u > from || size + u < from)
    told.reason = "it " + pair.motion;
  else if (pair.one_limit && size >= from)
    told.reason = "both schemes have one limit as the step shrinks", told.between = true;
  else
    told.reason = "that lies within what is open of it", told.between = true;
}

/// "+6.8 ± 0.1 %".
std::string share_text(const Pair& pair) {
  const double share = *pair.share;
  answers::MeasureWords words;
  words.unit = "%";
  words.factor = per_cent;
  const std::string value = answers::with_uncertainty(words, std::abs(share), pair.share_u);
  return (pair.least ? "at least " : "") + std::string(value.starts_with("0 ") ? "" : share < 0 ? "−" : "+") + value;
}

class EffectSpeaker {
 public:
  EffectSpeaker(const Ask& ask, const Evidence& evidence)
      : ask_(ask), evidence_(evidence), own_(evidence.columns_of(ask.subject())), cases_(evidence.cases(ask)) {
    from_ = ask.share_asked();
    agrees_ = ask.has("within");
    std::vector<std::string> columns = evidence.choices(cases_, ask.text("on"));
    std::erase_if(columns,
                  [&](const std::string& one) { return std::find(own_.begin(), own_.end(), one) != own_.end(); });
    others_ = columns;
    columns.insert(columns.end(), own_.begin(), own_.end());
    lines_ = lines_of(ask, evidence, ask.text("on"), columns);
    combine();
  }

  Answered answer() {
    Answered out = begin_answer(lines_);
    out.figure = figure();
    if (auto open = without_values(lines_, out)) return *open;
    if (told_.empty()) return never_alone(std::move(out), lines_, evidence_.study().spoken(ask_.subject()));
    std::vector<const Told*> yes, no, open;
    std::vector<char> shown(told_.size(), 0);
    // What decides comes first, what has no value last.
    std::vector<std::size_t> order = decides_;
    for (const std::size_t k : decides_) shown[k] = 1;
    for (std::size_t k = 0; k < told_.size(); ++k)
      if (!shown[k]) order.push_back(k);
    std::stable_partition(order.begin(), order.end(), [&](std::size_t k) { return told_[k].pair.has_value(); });
    for (const std::size_t k : order) add_row(out, told_[k]);
    for (const Line& line : lines_.all) {
      VerdictRow row = lines_.row(line);
      row.verdict = line.known() ? "value" : "no value";
      out.rows.push_back(std::move(row));
    }
    for (const std::size_t k : decides_) {
      const Told& one = told_[k];
      (one.verdict == Verdict::yes ? yes : one.verdict == Verdict::no ? no : open).push_back(&one);
    }
    say(out, yes, no, open);
    return out;
  }

 private:
  void combine() {
    InOrderMet<std::string, Combination> all;
    for (const Line& line : lines_.all) {
      Combination& one = all[evidence_.key(line.point.first(), others_) + '\n' + line.stop];
      one.stop = line.stop;
      one.level = evidence_.level(line.point.first(), others_);
      one.lines.push_back(&line);
    }
    for (auto& [key, one] : std::move(all).list()) {
      order_levels(one.lines);
      combinations_.push_back(std::move(one));
    }
    for (const Combination& one : combinations_)
      for (std::size_t a = 0; a < one.lines.size(); ++a)
        for (std::size_t b = a + 1; b < one.lines.size(); ++b)
          told_.push_back(told_of(one, *one.lines[a], *one.lines[b]));
    // What is refused is left out by name; it decides only where nothing else is there.
    const bool any = std::any_of(told_.begin(), told_.end(), [](const Told& told) { return told.applies; });
    for (std::size_t first = 0; first < told_.size();) {
      std::size_t end = first;
      while (end < told_.size() && told_[end].where == told_[first].where) ++end;
      if (const auto found = deciding(first, end, any)) decides_.push_back(*found);
      first = end;
    }
  }

  /// Numbers ascending, however the study lists them: a share is of the lower level. Words stay in the study's order.
  void order_levels(std::vector<const Line*>& lines) {
    if (own_.size() != 1) return;
    const auto number = [&](const Line* line) {
      return number_in(evidence_.study().text(line->point.first(), own_.front()));
    };
    ascending_ = std::all_of(lines.begin(), lines.end(), [&](const Line* line) { return number(line).has_value(); });
    if (ascending_)
      std::stable_sort(lines.begin(), lines.end(),
                       [&](const Line* a, const Line* b) { return *number(a) < *number(b); });
  }

  Told told_of(const Combination& where, const Line& a, const Line& b) const {
    const std::string apart = shared_parameters(a, b);
    Told told{&where, &a, &b, own_level(a) + own_parameters(a, apart), own_level(b) + own_parameters(b, apart)};
    for (const Line* line : {&a, &b})
      if (!line->known() && told.reason.empty()) told.reason = line->point.none;
    told.applies = a.applies() && b.applies();
    if (!told.reason.empty()) return told;
    told.pair = pair_of(a.point, b.point);
    judge(told, from_);
    if (told.verdict != Verdict::no) return told;
    const std::string zero = std::exchange(told.reason, "");
    if (acts_at_stops() && untouched(a.point) && untouched(b.point))
      told.reason = "no stop is touched";
    else if (doubtful(a.point) || doubtful(b.point))
      told.reason = "the runs are doubtful";
    if (!told.reason.empty())
      told.verdict = Verdict::open;
    else
      told.reason = zero;
    return told;
  }

  /// A parameter of contact that both have, otherwise: the names of their methods do not say it. "" of none.
  std::string shared_parameters(const Line& a, const Line& b) const {
    for (const std::string& column : own_) {
      const bool of_contact = std::any_of(std::begin(parameters_of_contact), std::end(parameters_of_contact),
                                          [&](const char* name) { return column.ends_with(name); });
      if (axis_role(column) == column || !of_contact) continue;
      const std::string &first = evidence_.study().text(a.point.first(), column),
                        &second = evidence_.study().text(b.point.first(), column);
      if (first.empty() || second.empty() || first == second) continue;
      if (own_level(a).find(evidence_.level(a.point.first(), {column})) == std::string::npos) return column;
    }
    return "";
  }
  static constexpr const char* parameters_of_contact[] = {".restitution", ".stiffness", ".damping", ".friction"};
  /// ", e = ½".
  std::string own_parameters(const Line& line, const std::string& column) const {
    return column.empty() ? "" : ", " + evidence_.level(line.point.first(), {column});
  }

  /// Whether the choice has a part in contact alone: the law, restitution.
  bool acts_at_stops() const {
    return std::all_of(own_.begin(), own_.end(), [](const std::string& column) {
      return column == "contact" || column.starts_with("contact.") || column.ends_with(".restitution");
    });
  }

  std::string own_level(const Line& line) const { return or_none(evidence_.level(line.point.first(), own_)); }

  /// The pair that decides, of those from `first` to `end`: one that is a yes, else one that is open, else the largest.
  /// Of those that apply alone where `applying`; nothing where none does.
  std::optional<std::size_t> deciding(std::size_t first, std::size_t end, bool applying) const {
    const auto rank = [](const Told& told) {
      // Where all agree, it is the one that could be largest.
      const double u = told.pair && told.verdict == Verdict::no ? told.pair->u.value_or(0) : 0;
      return std::pair(told.verdict == Verdict::yes    ? 2
                       : told.verdict == Verdict::open ? 1
                                                       : 0,
                       told.pair ? std::abs(told.pair->difference) + u : 0.0);
    };
    std::optional<std::size_t> best;
    for (std::size_t k = first; k < end; ++k)
      if ((told_[k].applies || !applying) && (!best || rank(told_[*best]) < rank(told_[k]))) best = k;
    return best;
  }

  void add_row(Answered& out, const Told& one) const {
    VerdictRow row;
    row.measure = ask_.text("on");
    row.stop = one.where->stop;
    row.level = one.second + " against " + one.first + (one.where->level.empty() ? "" : ", " + one.where->level);
    row.unit = "%";
    if (one.pair && one.pair->share) {
      row.value = per_cent * *one.pair->share;
      if (const auto u = one.pair->share_u) {
        row.low = *row.value - per_cent * *u;
        row.high = *row.value + per_cent * *u;
      }
    }
    const Verdict shown = one.verdict == Verdict::open               ? Verdict::open
                          : (one.verdict == Verdict::yes) != agrees_ ? Verdict::yes
                                                                     : Verdict::no;
    row.verdict = word(shown);
    row.reason = one.reason;
    if (one.pair) {
      row.cases = one.pair->first->behind.size() + one.pair->second->behind.size();
      row.left_out = one.pair->first->cases.size() + one.pair->second->cases.size() - *row.cases;
    }
    out.rows.push_back(std::move(row));
  }

  /// "with penalty 1e8 N/m at end".
  std::string place(const Told& one) const {
    return (one.where->level.empty() || combinations_.size() == 1 ? "" : " with " + one.where->level) +
           (one.where->stop.empty() || lines_.all.front().one_stop ? "" : " at " + one.where->stop);
  }

  /// Whether a share says it: not of what is nothing, nor of what is many times as large.
  static bool as_share(const Told& one) {
    constexpr double times = 10, nearly_all = 0.9;
    const std::optional<double> share = one.pair ? one.pair->share : std::nullopt;
    return share && -nearly_all < *share && *share < times;
  }

  /// "from 0 with Dumont–Paoli to 3.4 ± 0.2 with Newmark".
  std::string values(const Told& one) const {
    return fmt::format("from {} with {} to {} with {}", lines_.text(one.a->estimate()), one.first,
                       lines_.text(one.b->estimate()), one.second);
  }

  /// Of these, which have shares, those with the least share and the most.
  static std::pair<const Told*, const Told*> extremes(const std::vector<const Told*>& list) {
    const auto by_share = [](const Told* a, const Told* b) { return *a->pair->share < *b->pair->share; };
    const auto [least, most] = std::minmax_element(list.begin(), list.end(), by_share);
    return {*least, *most};
  }
  static bool both_ways(const Told& least, const Told& most) { return *least.pair->share < 0 && *most.pair->share > 0; }
  static const Told& larger(const Told& least, const Told& most) {
    return std::abs(*least.pair->share) > std::abs(*most.pair->share) ? least : most;
  }

  /// How much these differ: "by +6.8 ± 0.1 % to +30 ± 2 % (hrz against consistent)"; of what no share says, the values.
  std::string sizes(std::vector<const Told*> list) const {
    std::erase_if(list, [](const Told* one) { return !one->pair; });
    if (list.empty()) return "";
    const auto odd = std::find_if(list.begin(), list.end(), [](const Told* one) { return !as_share(*one); });
    if (odd != list.end()) return values(**odd) + place(**odd);
    const auto [least, most] = extremes(list);
    const bool one_pair = std::all_of(list.begin(), list.end(), [&](const Told* one) {
      return one->first == list.front()->first && one->second == list.front()->second;
    });
    if (one_pair) {
      const std::string which = fmt::format(" ({} against {})", list.front()->second, list.front()->first);
      const std::string low = share_text(*least->pair), high = share_text(*most->pair);
      return low == high ? "by " + low + which : fmt::format("by {} to {}{}", low, high, which);
    }
    if (both_ways(*least, *most))
      return fmt::format("by {} to {} of the {}", share_text(*least->pair), share_text(*most->pair),
                         ascending_ ? "lower level" : "level listed first");
    const Told& largest = larger(*least, *most);
    return fmt::format("by up to {} ({} against {}{})", share_text(*largest.pair), largest.second, largest.first,
                       place(largest).empty() ? "" : "," + place(largest));
  }

  /// The same in few words: "by up to +30 ± 2 %", "from 0 to 3.4 ± 0.2".
  std::string short_sizes(std::vector<const Told*> list) const {
    std::erase_if(list, [](const Told* one) { return !one->pair; });
    if (list.empty()) return "";
    const auto odd = std::find_if(list.begin(), list.end(), [](const Told* one) { return !as_share(*one); });
    if (odd != list.end())
      return fmt::format("from {} to {}{}", lines_.text((*odd)->a->estimate()), lines_.text((*odd)->b->estimate()),
                         place(**odd));
    const auto [least, most] = extremes(list);
    if (both_ways(*least, *most)) return fmt::format("by {} to {}", share_text(*least->pair), share_text(*most->pair));
    return (list.size() == 1 ? "by " : "by up to ") + share_text(*larger(*least, *most).pair);
  }

  /// The combinations of these, by name where they have one: " with stiffness 1e8 N/m", " in 2 of 6".
  std::string in_these(const std::vector<const Told*>& list, std::size_t all) const {
    if (list.size() == all) return all == 1 ? "" : " in " + all_text(all);
    std::vector<const Line*> lines;
    for (const Told* one : list) lines.insert(lines.end(), one->where->lines.begin(), one->where->lines.end());
    if (const std::string name = set_name(lines_, lines); !name.empty() && lines.size() > 1) return " " + name;
    return fmt::format(" in {} of {}", list.size(), all);
  }

  void say(Answered& out, const std::vector<const Told*>& yes, const std::vector<const Told*>& no,
           const std::vector<const Told*>& open) const {
    const std::string choice = evidence_.study().spoken(ask_.subject()), measure = lines_.words.words,
                      least = answers::percent(from_);
    const std::size_t all = yes.size() + no.size() + open.size();
    const std::string rest = !open.empty() && !yes.empty() ? fmt::format("; open in {} of {}", open.size(), all)
                             : !no.empty() && !yes.empty() ? "; elsewhere by less"
                                                           : "";
    if (!yes.empty()) {
      // A choice that matters somewhere matters: of the others the rows tell.
      const bool everywhere = yes.size() == all;
      out.passes = agrees_ ? Verdict::no : everywhere ? Verdict::yes : open.empty() ? Verdict::no : Verdict::open;
      out.verdict = agrees_ ? "no" : everywhere ? "yes" : "in part";
      out.sentence = in_thirty_words(
          fmt::format("{}: {} changes {} by {} and more{}",
                      agrees_      ? "No"
                      : everywhere ? "Yes"
                                   : "In part",
                      choice, measure, least, in_these(yes, all)),
          // What is open elsewhere is told before how large these are.
          open.empty()
              ? std::vector<std::vector<std::string>>{{": " + sizes(yes), ": " + short_sizes(yes)}, {rest}}
              : std::vector<std::vector<std::string>>{
                    {": " + sizes(yes) + rest, ": " + short_sizes(yes) + rest, rest, ": " + short_sizes(yes)}});
      return;
    }
    if (open.empty()) {
      out.passes = agrees_ ? Verdict::yes : Verdict::no;
      out.verdict = word(*out.passes);
      out.sentence =
          in_thirty_words(fmt::format("{}: {} changes {} by less than {}{}", agrees_ ? "Yes, they agree" : "No", choice,
                                      measure, least, in_these(no, all)),
                          {{": " + sizes(no), ": " + short_sizes(no)}});
      return;
    }
    const Told& first = *open.front();
    out.passes = Verdict::open;
    out.verdict = word(Verdict::open);
    out.reason = first.reason;
    const bool has_size =
        first.pair && (first.pair->share || std::abs(first.pair->base + first.pair->difference) >
                                                std::max(first.pair->first->floor, first.pair->second->floor));
    const std::vector<std::string> sizes_told = {has_size ? "; it does " + sizes({&first}) : "",
                                                 has_size ? "; it does " + short_sizes({&first}) : ""},
                                   why = {": " + first.reason, ": " + short_reason(first.reason)},
                                   rest_told = {no.empty() ? "" : fmt::format("; less in the other {}", no.size())};
    const std::string begins =
        fmt::format("Open{}: whether {} changes {} by {} is not told", in_these(open, all), choice, measure, least);
    // A size that decides comes before the reason that speaks of it.
    out.sentence = first.between ? in_thirty_words(begins, {sizes_told, why, rest_told})
                                 : in_thirty_words(begins, {why, sizes_told, rest_told});
  }

  Json figure() const {
    Json rows = Json::array();
    for (const Combination& one : combinations_)
      for (const Line* line : one.lines) {
        const VerdictRow row = lines_.row(*line);
        Json point = {{"pair", one.level + (one.stop.empty() ? "" : (one.level.empty() ? "" : ", ") + one.stop)},
                      {"name", own_level(*line)}};
        if (row.value) point["value"] = *row.value;
        if (row.low) point["low"] = *row.low, point["high"] = *row.high;
        rows.push_back(std::move(point));
      }
    return {{"form", "pairs"}, {"measure", lines_.words.words}, {"unit", lines_.words.unit}, {"rows", rows}};
  }

  const Ask& ask_;
  const Evidence& evidence_;
  std::vector<std::string> own_, others_;
  Cases cases_;
  double from_ = 0;
  bool agrees_ = false;     // asked whether levels agree, not whether they differ
  bool ascending_ = false;  // levels are numbers
  Lines lines_;
  std::vector<Combination> combinations_;
  std::vector<Told> told_;
  std::vector<std::size_t> decides_;  // of each combination the pair that does
};

void check_effect(const Ask& ask, const Study& study) {
  check_choice(ask, study, "effect", ask.subject());
  check_measure(ask, study, "on", ask.text("on"));
  check_one_unit(ask, study, ask.text("on"));
  refuse_seeds(ask, "effect", "are no choice", ask.text("on"));
  if (ask.has("from") && ask.has("within"))
    throw InputError(ask.pointer("within"), "does not go together with \"from\"; expected one of them");
}

}  // namespace

const Verb& effect_verb() {
  static const Verb verb{
      "effect",
      "Whether a choice changes a measure by a share, all else the same.",
      {keys::of_form(Field::Form::text, "effect", std::nullopt,
                     "The choice: a role, a parameter, an axis that varies."),
       keys::of_form(Field::Form::text, "on", std::nullopt, "The measure."),
       keys::quiet(
           keys::of_form(Field::Form::share, "from", Json(nullptr),
                         "Whether levels differ by this share of the one listed first, of numbers of the lower; 1 % "
                         "where absent.")),
       keys::quiet(
           keys::of_form(Field::Form::share, "within", Json(nullptr), "Whether levels agree within such a share."))},
      "",
      check_effect,
      doubt_of_one_step,
      [](const Ask& ask, const Evidence& evidence) { return EffectSpeaker(ask, evidence).answer(); }};
  return verb;
}

}  // namespace ricochet::asks
