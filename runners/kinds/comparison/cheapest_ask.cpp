// The verb `cheapest`: which method reaches an error for the least time, and stays there at all finer sizes.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "runners/answers/numbers_in_words.hpp"
#include "runners/answers/set_names.hpp"
#include "runners/asks/kind_verbs.hpp"
#include "runners/kinds/comparison/comparison_answers.hpp"
#include "runners/table/in_order_met.hpp"

namespace ricochet {
namespace {

std::string seconds_text(double seconds) {
  constexpr double thousand = 1e3, micro = 1e6;
  if (seconds >= 1) return short_number(seconds, 2) + " s";
  return seconds >= 1 / thousand ? short_number(thousand * seconds, 2) + " ms"
                                 : short_number(micro * seconds, 2) + " µs";
}

struct Timed {
  double seconds = 0, low = 0, high = 0;
  /// What repeats were off by; of a single timing nobody knows, and a fifth is common.
  bool once() const { return !(high > low); }
  double least() const { return once() ? seconds / 1.2 : low; }
  double most() const { return once() ? 1.2 * seconds : high; }
};

/// What becomes of one method.
struct Reach {
  Cases cases = {};                   ///< with and without an error
  const CaseRecord* first = nullptr;  ///< the cheapest that is there and stays there
  const CaseRecord* best = nullptr;   ///< with the least error
  Timed time = {};
  std::string reason = {};  ///< why it never gets there
};

class CheapestAsk {
 public:
  CheapestAsk(const asks::Ask& ask, const asks::Evidence& evidence)
      : evidence_(evidence),
        study_(evidence.study()),
        error_(error_name(ask.subject())),
        within_(*ask.share("within")),
        cases_(evidence.cases(ask)) {
    InOrderMet<std::string, Reach> methods;
    for (const CaseRecord* one : cases_) methods[study_.key(*one)].cases.push_back(one);
    for (auto& [key, method] : std::move(methods).list()) {
      look(method);
      methods_.push_back(std::move(method));
    }
  }

  asks::Answered answer() const {
    asks::Answered out;
    for (const CaseRecord* one : cases_) out.cases += share(*one).has_value();
    out.left_out = cases_.size() - out.cases;
    out.aside = evidence_.left_out("error." + error_, cases_).told();
    for (std::string& one : reference_words(cases_)) out.aside.push_back(std::move(one));
    std::vector<const Reach*> there, never;
    for (const Reach& one : methods_) (one.first ? there : never).push_back(&one);
    std::stable_sort(there.begin(), there.end(),
                     [](const Reach* a, const Reach* b) { return a->time.seconds < b->time.seconds; });
    std::stable_sort(never.begin(), never.end(), [&](const Reach* a, const Reach* b) {
      return (a->best ? *share(*a->best) : INFINITY) < (b->best ? *share(*b->best) : INFINITY);
    });
    for (const Reach* one : there) {
      add_row(out, *one,
              one == there.front()        ? "cheapest"
              : tie(*one, *there.front()) ? "the same within the timing noise"
                                          : "there");
    }
    for (const Reach* one : never) add_row(out, *one, "not there");
    for (const Reach* one : there) add_error(out, *one, *one->first);
    for (const Reach* one : never)
      if (one->best) add_error(out, *one, *one->best);
    say(out, there, never);
    out.figure = figure();
    return out;
  }

 private:
  /// The error over what a motion at rest would err by, its floor at least.
  std::optional<double> share(const CaseRecord& record) const {
    const auto value = measure(record, "error." + error_), size = measure(record, "size." + error_);
    if (record.status != Status::done || !value || !size || !(*size > 0)) return std::nullopt;
    return std::max(*value, measure(record, "floor." + error_).value_or(0)) / *size;
  }
  double floor_share(const CaseRecord& record) const {
    return measure(record, "floor." + error_).value_or(0) / measure(record, "size." + error_).value_or(INFINITY);
  }

  /// Whether no size of another case is coarser.
  bool as_fine(const CaseRecord& one, const CaseRecord& other) const {
    return study_.step(one).value_or(1) <= study_.step(other).value_or(1) &&
           study_.elements(one).value_or(1) >= study_.elements(other).value_or(1);
  }

  static bool tie(const Reach& one, const Reach& winner) { return one.time.least() <= winner.time.most(); }

  void look(Reach& out) const {
    bool by_chance = false, unknown = false, untimed = false;
    for (const CaseRecord* one : out.cases) {
      const auto own = share(*one);
      if (!own) continue;
      if (!out.best || *own < *share(*out.best)) out.best = one;
      if (*own > within_) continue;
      bool stays = true;
      for (const CaseRecord* finer : out.cases) {
        // What is refused was never to be run.
        if (!as_fine(*finer, *one) || finer->status == Status::refused) continue;
        const auto there = share(*finer);
        unknown = unknown || !there;
        by_chance = by_chance || (there && *there > within_);
        stays = stays && there && *there <= within_;
      }
      const auto seconds = measure(*one, "timed_seconds");
      untimed = untimed || (stays && !seconds);
      if (!stays || !seconds || (out.first && out.time.seconds <= *seconds)) continue;
      out.first = one;
      out.time = {*seconds, measure(*one, "timed_low").value_or(*seconds),
                  measure(*one, "timed_high").value_or(*seconds)};
    }
    if (out.first) return;
    if (!out.best)
      out.reason = evidence_.left_out("error." + error_, out.cases).count > 0
                       ? evidence_.left_out("error." + error_, out.cases).reasons.front().said()
                       : "nothing to take a share of";
    else if (untimed)
      out.reason = "it was not timed";
    else if (floor_share(*out.best) > within_)
      out.reason = "the reference itself is known to " + answers::percent(floor_share(*out.best));
    else if (by_chance)
      out.reason = "within it by chance: finer sizes leave it";
    else if (unknown)
      out.reason = "a finer size has no error";
    else
      out.reason = "its least error is " + answers::percent_beside(*share(*out.best), within_);
  }

  std::string level(const Reach& one) const { return study_.words(*one.cases.front(), study_.columns()); }
  std::string size_words(const CaseRecord& one) const {
    std::string out;
    if (study_.varies("step") && study_.step(one)) out = study_.step_words(*study_.step(one));
    if (study_.varies(study_.mesh_column()) && study_.elements(one))
      out += (out.empty() ? "" : ", ") + study_.mesh_words(*study_.elements(one));
    return out;
  }
  std::string at(const CaseRecord& one) const {
    const std::string size = size_words(one);
    return size.empty() ? "" : " at " + size;
  }
  std::string at_level(const Reach& one, const CaseRecord& record) const {
    const std::string own = level(one), size = size_words(record);
    return own.empty() || size.empty() ? own + size : own + ", " + size;
  }

  void add_row(asks::Answered& out, const Reach& one, const char* verdict) const {
    asks::VerdictRow row;
    row.measure = "timed_seconds";
    row.level = one.first ? at_level(one, *one.first) : level(one);
    row.unit = "s";
    row.verdict = verdict;
    row.reason = one.reason;
    row.cases = static_cast<std::size_t>(std::count_if(one.cases.begin(), one.cases.end(),
                                                       [&](const CaseRecord* of) { return share(*of).has_value(); }));
    row.left_out = one.cases.size() - *row.cases;
    if (one.first) {
      row.value = one.time.seconds;
      if (one.time.once() && row.reason.empty()) row.reason = "timed once: how far repeats differ is not known";
      if (!one.time.once()) {
        row.low = std::min(one.time.low, one.time.seconds);
        row.high = std::max(one.time.high, one.time.seconds);
      }
    }
    out.rows.push_back(std::move(row));
  }

  /// The error with which a method gets there, or the least that it has.
  void add_error(asks::Answered& out, const Reach& one, const CaseRecord& record) const {
    asks::VerdictRow row;
    row.measure = "error." + error_;
    row.level = at_level(one, record);
    row.value = asks::per_cent * *share(record);
    row.unit = "%";
    row.verdict = *share(record) <= within_ ? "within" : "beyond";
    row.cases = 1;
    row.left_out = 0;
    out.rows.push_back(std::move(row));
  }

  void say(asks::Answered& out, const std::vector<const Reach*>& there, const std::vector<const Reach*>& never) const {
    const std::string asked = answers::percent(within_), error = error_words(error_);
    Cases firsts;
    for (const Reach& one : methods_) firsts.push_back(one.cases.front());
    const auto name = [&](const Reach& one) { return study_.name(*one.cases.front()); };
    if (there.empty()) {
      // Where the reference is not known so well nobody can be told to fail.
      const bool hidden = std::any_of(never.begin(), never.end(),
                                      [&](const Reach* one) { return one->best && floor_share(*one->best) > within_; });
      out.verdict = hidden || never.empty() || !never.front()->best ? "open" : "nobody";
      out.passes = out.verdict == "open" ? asks::Verdict::open : asks::Verdict::no;
      if (never.empty() || !never.front()->best) {
        out.reason = never.empty() ? "no case" : never.front()->reason;
        out.sentence = fmt::format("Open: no case has {} as a share: {}.", error, out.reason);
        return;
      }
      const Reach& best = *never.front();
      out.reason = best.reason;
      const std::string least = answers::percent_beside(*share(*best.best), within_);
      out.sentence = asks::fitting(
          {fmt::format("{}: no method brings {} within {} and keeps it there; the least is {} with {}{}{}.",
                       hidden ? "Open" : "Nobody", error, asked, least, name(best), at(*best.best),
                       hidden || best.reason.starts_with("it ends") ? hidden ? ", for " + best.reason : ""
                                                                    : ", " + best.reason),
           fmt::format("{}: no method keeps {} within {}; the least is {} with {}.", hidden ? "Open" : "Nobody", error,
                       asked, least, name(best)),
           fmt::format("{}: no method keeps {} within {}; the least is {}.", hidden ? "Open" : "Nobody", error, asked,
                       least)});
      return;
    }
    const Reach& winner = *there.front();
    Members tied, missed;
    for (std::size_t k = 0; k < methods_.size(); ++k) {
      if (!methods_[k].first) missed.push_back(k);
      if (methods_[k].first && &methods_[k] != &winner && tie(methods_[k], winner)) tied.push_back(k);
    }
    const answers::SetNames names(study_, firsts);
    out.verdict = tied.empty() ? "one" : "tie";
    out.passes = asks::Verdict::yes;
    const std::string got = fmt::format("{}{} brings {} within {} for the least time, {}", name(winner),
                                        at(*winner.first), error, asked, seconds_text(winner.time.seconds));
    const auto add = [&](bool named) {
      std::string text = got;
      if (!tied.empty())
        text +=
            fmt::format("; {} within its timing noise", named ? names.of(tied) : fmt::format("{} more", tied.size()));
      else if (there.size() > 1)
        text += fmt::format("; next {}, {}", name(*there[1]), seconds_text(there[1]->time.seconds));
      if (!missed.empty())
        text += fmt::format("; {} never",
                            named ? names.of(missed) : fmt::format("{} of {} methods", missed.size(), methods_.size()));
      return answers::capitalised(text) + ".";
    };
    if (tied.empty()) {
      out.sentence = asks::fitting({add(true), add(false), answers::capitalised(got) + "."});
      return;
    }
    // A tie is never told as a single winner.
    const std::string together = fmt::format("{} methods bring {} within {} for the least time, {}, not told apart",
                                             tied.size() + 1, error, asked, seconds_text(winner.time.seconds));
    out.sentence = asks::fitting(
        {add(true), add(false), answers::capitalised(got) + fmt::format("; {} more within its noise.", tied.size()),
         fmt::format("{}: {} and {} more.", together, name(winner), tied.size()), together + "."});
  }

  /// A curve of each method on each mesh, its steps from the largest on.
  Json figure() const {
    Json series = Json::array();
    for (const Reach& one : methods_) {
      InOrderMet<double, Cases> met;
      for (const CaseRecord* record : one.cases) met[study_.elements(*record).value_or(0)].push_back(record);
      auto meshes = std::move(met).list();
      for (auto& [elements, cases] : meshes) {
        std::stable_sort(cases.begin(), cases.end(), [&](const CaseRecord* a, const CaseRecord* b) {
          return study_.step(*a).value_or(1) > study_.step(*b).value_or(1);
        });
        std::vector<std::pair<double, double>> points;
        double floor = 0;
        for (const CaseRecord* record : cases) {
          const auto seconds = measure(*record, "timed_seconds");
          if (!share(*record) || !seconds) continue;
          floor = std::max(floor, floor_share(*record));
          if (*share(*record) > floor_share(*record)) points.emplace_back(*seconds, asks::per_cent * *share(*record));
        }
        if (points.empty()) continue;
        std::string name = level(one);
        if (meshes.size() > 1) name += (name.empty() ? "" : ", ") + study_.mesh_words(elements);
        series.push_back({{"name", name}, {"points", points}});
        if (floor > 0) series.back()["floor"] = asks::per_cent * floor;
      }
    }
    return {{"form", "curves"}, {"x", "processor time"}, {"x_unit", "s"},    {"y", error_words(error_)},
            {"y_unit", "%"},    {"log", true},           {"series", series}, {"at", {asks::per_cent * within_}}};
  }

  const asks::Evidence& evidence_;
  const Choices& study_;
  std::string error_;
  double within_;
  Cases cases_;
  std::vector<Reach> methods_;
};

}  // namespace

asks::Answered cheapest_ask(const asks::Ask& ask, const asks::Evidence& evidence) {
  return CheapestAsk(ask, evidence).answer();
}

}  // namespace ricochet
