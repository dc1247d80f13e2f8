// The verb `steps`: which step is allowed, and whether the mesh or the closed stop bounds it.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "runners/answers/numbers_in_words.hpp"
#include "runners/answers/set_names.hpp"
#include "runners/asks/kind_verbs.hpp"
#include "runners/kinds/stability/stability.hpp"
#include "runners/kinds/stability/stability_tables.hpp"

namespace ricochet {
namespace {

/// What bounds the step of a case.
enum class Bound { stop, mesh, marched, none, everywhere, unknown };

/// `meshed`: whether the structure has a mesh; an oscillator and matrices have none.
const char* bound_word(Bound bound, bool meshed) {
  constexpr const char* words[] = {"the stop", "the mesh", "marches alone", "no limit", "no step is stable", "open"};
  return bound == Bound::mesh && !meshed ? "the structure" : words[static_cast<int>(bound)];
}

struct StepLimit {
  const CaseRecord* record = nullptr;
  LimitRow open, closed;
  Bound bound = Bound::unknown;
  /// s: allowed, the predicted one or a smaller one beyond which marches grow; from and to these two.
  std::optional<double> step = {}, low = {}, high = {};
  std::string reason = {};
};

bool made(RangeLimit one) {
  return one != RangeLimit::not_made;
}

/// A stop adds its stiffness over its mass to ω² of the mesh: h_c⁻² ≤ h_o⁻² + h_s⁻². It bounds the step where its part
/// is the larger one, h_c < h_o/√2.
bool by_the_stop(double open, double closed) {
  return 2 * closed * closed < open * open;
}

/// Whether marches with contact grow at a step that the open structure allows.
bool by_contact(double open, const LimitRow& closed) {
  constexpr double tolerance = 0.05;  // of bisections
  return *closed.observed < (1 - tolerance) * open;
}

/// A largest step in three digits, rounded down: a step that is read off a sentence must be allowed.
std::string step_words(double step) {
  return short_number_down(step, 3);
}

class StepsAsk {
 public:
  StepsAsk(const asks::Ask& ask, const asks::Evidence& evidence, const std::vector<LimitRow>& rows)
      : evidence_(evidence), study_(evidence.study()), cases_(evidence.cases(ask)), columns_(evidence.varying(cases_)) {
    const Json& resolved = evidence.results().study;
    const Json range = resolved.is_object() ? resolved.value("steps", Json::object()) : Json::object();
    from_ = range.value("from", 0.0);
    range_ = fmt::format("{} to {} s", short_number(from_), short_number(range.value("to", 0.0)));
    const std::vector<std::string>& columns = evidence.results().columns;
    meshed_ = resolved.contains("mesh") || std::find(columns.begin(), columns.end(), "elements") != columns.end();
    // Matrices and modes of another program have no mesh of their own.
    const Json scene = resolved.is_object() ? resolved.value("scene", Json::object()) : Json::object();
    const std::string type = scene.value("structure", Json::object()).value("type", "");
    meshed_ = meshed_ && type != "assembled" && type != "modal";
    std::map<std::string, StepLimit> by_id;
    for (const LimitRow& row : rows) (row.closed ? by_id[row.id].closed : by_id[row.id].open) = row;
    for (const CaseRecord* one : cases_)
      if (const auto found = by_id.find(one->id);
          found != by_id.end() && one->status == Status::done && !found->second.open.id.empty()) {
        StepLimit limit = found->second;
        limit.record = one;
        judge(limit);
        limits_.push_back(std::move(limit));
      }
    for (const RootRow& row : stability_roots_type().read(evidence.results().derived))
      if (row.twofold) double_roots_.insert(row.id);
  }

  asks::Answered answer() const {
    asks::Answered out;
    out.cases = limits_.size();
    asks::leave_out(out, cases_, limits_);
    Json bars = Json::array();
    std::size_t unlike = 0;
    for (const StepLimit& one : limits_) {
      asks::VerdictRow row;
      row.measure = "step";
      row.level = level(one);
      row.value = one.step;
      row.allowed = true;
      row.low = one.low;
      row.high = one.high;
      row.unit = "s";
      row.verdict = bound_word(one.bound, meshed_);
      row.reason = one.reason;
      row.cases = 1;
      row.left_out = 0;
      bars.push_back({{"name", row.level}, {"group", row.verdict}});
      if (one.step)
        bars.back().update(
            {{"value", *one.step}, {"low", one.low.value_or(*one.step)}, {"high", one.high.value_or(*one.step)}});
      out.rows.push_back(std::move(row));
      unlike += apart(one);
    }
    out.figure = {{"form", "bars"}, {"measure", "largest step"}, {"unit", "s"},
                  {"rows", bars},   {"at", Json::array()},       {"log", true}};
    if (const Members alone = members(predicted_alone); !alone.empty())
      out.aside.push_back(
          fmt::format("What contact allows is predicted and not marched in {} of {}.", alone.size(), limits_.size()));
    if (unlike > 0)
      out.aside.push_back(
          fmt::format("Marches have another limit than the spectrum with {} of {}.", unlike, limits_.size()));
    const Members marched = members(
        [](const StepLimit& one) { return one.step && one.closed.observed && *one.step == *one.closed.observed; });
    if (!marched.empty())
      out.aside.push_back(
          "What marches with contact allow is that of their duration: longer ones may grow at smaller steps.");
    say_mesh(out);
    say_gains(out);
    const Members twofold = members(
        [&](const StepLimit& one) { return one.bound == Bound::none && double_roots_.contains(one.record->id); });
    if (!twofold.empty())
      out.aside.push_back(
          fmt::format("A double root on the unit circle grows linearly, though no limit shows, in {} of {}.",
                      twofold.size(), limits_.size()));
    say(out);
    return out;
  }

 private:
  std::string level(const StepLimit& one) const { return evidence_.level(*one.record, columns_); }

  /// What is marched is the scene, open as well as closed: it may have either limit.
  static bool apart(const StepLimit& one) {
    const LimitRow& row = one.closed.id.empty() ? one.open : one.closed;
    return row.agrees == false;
  }

  /// Whether the open structure was marched, and no scene showed anything of contact.
  static bool predicted_alone(const StepLimit& one) {
    return made(one.closed.prediction) && !made(one.closed.observation) && made(one.open.observation);
  }

  void judge(StepLimit& out) const {
    const LimitRow &open = out.open, &closed = out.closed;
    std::vector<std::string> parts;
    const bool has_closed = !closed.id.empty() && made(closed.prediction);
    if (open.prediction == RangeLimit::below || (has_closed && closed.prediction == RangeLimit::below)) {
      out.bound = Bound::everywhere;
      parts.emplace_back(open.prediction == RangeLimit::below
                             ? "unstable at every step of the range"
                             : "unstable with the stop closed at every step of the range");
    } else if (!made(open.prediction)) {
      parts.emplace_back("no prediction was made");
    } else {
      std::optional<double> step = open.predicted;
      out.bound = step ? Bound::mesh : Bound::none;
      if (has_closed && closed.predicted) {
        if (!step || by_the_stop(*step, *closed.predicted)) out.bound = Bound::stop;
        step = step ? std::min(*step, *closed.predicted) : *closed.predicted;
      }
      // Of a stop without a spectrum its marches tell, where they grow below what the open structure allows.
      const bool alone = !has_closed && made(closed.observation);
      const LimitRow& own = has_closed || (alone && closed.observed) ? closed : open;
      if (alone && closed.observation == RangeLimit::below) {
        out.bound = Bound::everywhere;
        parts.emplace_back("no march with contact is stable at any step of the range");
      } else if (alone && closed.observed && (!step || by_contact(*step, closed))) {
        out.bound = Bound::marched;
        out.step = closed.observed;
        parts.push_back(fmt::format("marches with contact are stable to {} s", step_words(*closed.observed)));
        if (step) parts.push_back(fmt::format("without contact {} s", step_words(*step)));
        parts.emplace_back("the closed stop was not predicted");
      } else if (!step && own.observed) {
        // No spectrum grows, and yet the scene does.
        out.bound = Bound::marched;
        out.step = own.observed;
        parts.push_back(fmt::format("every spectrum is stable; marches are to {} s", step_words(*own.observed)));
      } else if (step) {
        out.step = own.observed && own.agrees == false ? std::min(*step, *own.observed) : *step;
        if (own.observed) {
          out.low = std::min(*step, *own.observed);
          out.high = std::max(*step, *own.observed);
          parts.push_back(fmt::format("predicted {} s, marched {} s", step_words(*step), step_words(*own.observed)));
        }
        if (predicted_alone(out)) parts.emplace_back("contact not marched");
        if (has_closed && open.predicted)
          parts.push_back(fmt::format("without contact {} s", step_words(*open.predicted)));
        if (!closed.id.empty() && !made(closed.prediction)) parts.emplace_back("the closed stop was not predicted");
      } else {
        parts.push_back("every step of the range is stable");
      }
    }
    if (out.step && *out.step < from_) {
      out.bound = Bound::everywhere;
      parts.emplace_back("the limit lies below the range");
    }
    out.reason = fmt::format("{}", fmt::join(parts, "; "));
  }

  template <class Holds>
  Members members(Holds holds) const {
    Members out;
    for (std::size_t k = 0; k < limits_.size(); ++k)
      if (holds(limits_[k])) out.push_back(k);
    return out;
  }

  void say_gains(asks::Answered& out) const {
    const Members gain = members([](const StepLimit& one) {
      return one.open.prediction == RangeLimit::none && one.closed.prediction == RangeLimit::none &&
             one.closed.disagreeing > 0 && made(one.closed.observation) && one.closed.observation != RangeLimit::none;
    });
    if (!gain.empty())
      out.aside.push_back(fmt::format("Impacts make energy though every spectrum is stable in {} of {}: {}.",
                                      gain.size(), limits_.size(), names().of(gain)));
  }

  /// How limits fall with the element's length.
  void say_mesh(asks::Answered& out) const {
    std::map<std::string, std::vector<std::pair<double, double>>> groups;
    for (const StepLimit& one : limits_)
      if (one.open.predicted && study_.varies("elements"))
        groups[study_.key(*one.record)].emplace_back(study_.elements(*one.record).value_or(1), *one.open.predicted);
    double least = INFINITY, most = -INFINITY;
    for (auto& [key, points] : groups) {
      if (points.size() < 3) continue;
      std::sort(points.begin(), points.end());
      const double power =
          std::log(points.front().second / points.back().second) / std::log(points.back().first / points.front().first);
      least = std::min(least, power);
      most = std::max(most, power);
    }
    if (least > most) return;
    const std::string a = fmt::format("{:.2f}", least), b = fmt::format("{:.2f}", most);
    out.aside.push_back(
        fmt::format("Limits of the mesh fall with the element's length to the power {}.", a == b ? a : a + " to " + b));
  }

  answers::SetNames names() const {
    Cases records;
    for (const StepLimit& one : limits_) records.push_back(one.record);
    return answers::SetNames(study_, records, columns_);
  }

  /// "3.54e-5 s", or the range of them.
  std::string steps(const Members& of) const {
    double low = INFINITY, high = 0;
    for (const std::size_t k : of) {
      low = std::min(low, *limits_[k].step);
      high = std::max(high, *limits_[k].step);
    }
    const std::string a = step_words(low), b = step_words(high);
    return a == b ? a + " s" : a + " to " + b + " s";
  }

  void say(asks::Answered& out) const {
    std::map<Bound, Members> bounds;
    for (std::size_t k = 0; k < limits_.size(); ++k) bounds[limits_[k].bound].push_back(k);
    out.passes = limits_.empty() || bounds.contains(Bound::unknown) ? asks::Verdict::open
                 : bounds.contains(Bound::everywhere)               ? asks::Verdict::no
                                                                    : asks::Verdict::yes;
    out.verdict = limits_.empty()      ? "open"
                  : bounds.size() == 1 ? bound_word(bounds.begin()->first, meshed_)
                                       : "by level";
    if (limits_.empty()) {
      out.reason = "no case has a spectrum";
      out.sentence = "Open: " + out.reason + ".";
      return;
    }
    const answers::SetNames sets = names();
    std::vector<std::string> texts;
    // Of two groups one is named.
    const auto named = [&](const auto& of) {
      const std::string name = sets.of(of);
      return bounds.size() == 2 && name.starts_with("all but ") ? "the others" : name;
    };
    for (const int brief : {0, 1, 2}) {
      std::vector<std::string> parts;
      // The largest group needs no name beside the others; of several the last.
      Bound largest = bounds.begin()->first;
      for (const auto& [bound, of] : bounds)
        if (of.size() >= bounds.at(largest).size()) largest = bound;
      std::string verb = " bounds the step";  // once
      std::vector<std::pair<Bound, Members>> told(bounds.begin(), bounds.end());
      // What is elsewhere follows what is named.
      if (brief == 1)
        std::stable_partition(told.begin(), told.end(), [&](const auto& one) { return one.first != largest; });
      for (const auto& [bound, of] : told) {
        const std::string who = of.size() == limits_.size() ? (limits_.size() == 1 ? "" : " with every case")
                                : brief == 2 ? fmt::format(" in {} of {} cases", of.size(), limits_.size())
                                : brief == 1 && bound == largest && bounds.size() > 1 ? " elsewhere"
                                                                                      : " with " + named(of);
        switch (bound) {
          case Bound::stop:
          case Bound::mesh:
            parts.push_back(fmt::format("{}{}{} ({})",
                                        bound == Bound::stop ? "the closed stop" : bound_word(bound, meshed_), verb,
                                        who, steps(of)));
            verb.clear();
            break;
          case Bound::marched:
            parts.push_back(fmt::format(
                "marches grow{} beyond {}{}", who, steps(of),
                std::all_of(of.begin(), of.end(), [&](std::size_t k) { return made(limits_[k].closed.prediction); })
                    ? ", though no spectrum does"
                    : ""));
            break;
          case Bound::none:
            parts.push_back(fmt::format("no limit{} from {}", who, range_));
            break;
          case Bound::everywhere:
            parts.push_back(fmt::format("no stable step{} from {}", who, range_));
            break;
          case Bound::unknown:
            parts.push_back("open" + who);
            break;
        }
      }
      texts.push_back(answers::capitalised(fmt::format("{}.", fmt::join(parts, "; "))));
    }
    std::vector<std::string> counts;
    for (const auto& [bound, of] : bounds)
      counts.push_back(fmt::format("{} {}", bound_word(bound, meshed_), of.size()));
    texts.push_back(fmt::format("What bounds the step of {} cases: {}.", limits_.size(), fmt::join(counts, ", ")));
    out.sentence = asks::fitting(texts);
  }

  const asks::Evidence& evidence_;
  const Choices& study_;
  Cases cases_;
  std::vector<std::string> columns_;
  std::vector<StepLimit> limits_;
  std::string range_;
  double from_ = 0;  ///< s, of the range
  bool meshed_ = true;
  std::set<std::string> double_roots_;
};

}  // namespace

asks::Answered steps_ask(const asks::Ask& ask, const asks::Evidence& evidence, const std::vector<LimitRow>& limits) {
  return StepsAsk(ask, evidence, limits).answer();
}

}  // namespace ricochet
