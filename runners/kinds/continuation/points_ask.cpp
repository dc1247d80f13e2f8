// The verb `points`: special points in the order of their branches, what is stable beside them, how far branches went.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "runners/answers/numbers_in_words.hpp"
#include "runners/answers/set_names.hpp"
#include "runners/asks/kind_verbs.hpp"
#include "runners/kinds/continuation/continuation.hpp"
#include "runners/kinds/continuation/point_tables.hpp"
#include "runners/kinds/continuation/point_words.hpp"
#include "runners/kinds/sweep/page/orbits.hpp"
#include "runners/report/choices.hpp"
#include "runners/report/quantity.hpp"
#include "runners/table/table_reader.hpp"

namespace ricochet {
namespace {

/// What becomes of a branch, in words; "" of one that ends for a reason of its own.
std::string end_words(TraceEnd ended) {
  switch (ended) {
    case TraceEnd::range:
      return "reaches an end of the range";
    case TraceEnd::closed:
      return "closes";
    case TraceEnd::joined:
      return "joins another branch";
    case TraceEnd::asked:
      return "stops at a point of stop_at";
    default:
      return "";
  }
}

/// One branch of a case.
struct Followed {
  std::string name;
  std::vector<BranchRow> rows = {};
  double from = INFINITY, to = -INFINITY;  ///< of the parameter
  const SpecialRow* end = nullptr;
};

/// A point of a method's finest case.
struct Told {
  const StudyPoint* point = nullptr;
  double value = 0;
  double less = 0, more = 0;           ///< how far below and above its own case, then step and mesh, leave it open
  bool confirmed = false;              ///< whether a second case refines it
  std::string below = {}, above = {};  ///< stable orbits on each side
};

/// A method: its finest case.
struct Followers {
  std::size_t owner = 0;
  const CaseRecord* record = nullptr;
  std::vector<Followed> branches = {};
  std::vector<Told> points = {};
};

class PointsAsk {
 public:
  PointsAsk(const asks::Ask& ask, const asks::Evidence& evidence, const PointAnalysis& of)
      : evidence_(evidence),
        study_(evidence.study()),
        of_(of),
        cases_(evidence.cases(ask)),
        columns_(evidence.varying(cases_)),
        parameter_(report::swept_parameter(evidence.results())) {
    parameter_.unit = report::shown_unit(parameter_.unit);
    for (const Json& one : ask.keys.at("points"))
      if (const auto kind = point_kind(one.get<std::string>()))
        kinds_.insert(*kind);
      else
        all_ = true;
    // A contact of stop_at and of special_points is any of these.
    if (kinds_.contains(PointKind::contact)) kinds_.insert({PointKind::first_contact, PointKind::lift_off});
    const Cases& owners = of.points.cases();
    std::map<std::string, std::size_t> best;
    std::vector<std::string> order;
    std::vector<std::string> methods = columns_;
    std::erase_if(methods, [](const std::string& one) { return is_refinement(one); });
    for (std::size_t c = 0; c < owners.size(); ++c) {
      if (std::find(cases_.begin(), cases_.end(), owners[c]) == cases_.end()) continue;
      followed_.insert(owners[c]);
      const std::string key = study_.key(*owners[c], methods);
      const auto [at, fresh] = best.emplace(key, c);
      if (fresh)
        order.push_back(key);
      else if (study_.finer(*owners[c], *owners[at->second]))
        at->second = c;
    }
    for (const std::string& key : order) read(best.at(key));
  }

  asks::Answered answer() const {
    asks::Answered out;
    out.cases = followed_.size();
    Cases left;
    for (const CaseRecord* one : cases_)
      if (!followed_.contains(one)) left.push_back(one);
    asks::leave_out(out, left);
    Json drawn = Json::array(), marks = Json::array();
    for (const Followers& one : methods_) {
      for (const Told& told : one.points) {
        add_point(out, one, told);
        marks.push_back({{"name", level(one)},
                         {"kind", point_words(told.point->kind).thing},
                         {"branch", told.point->row.branch},
                         {"value", told.value},
                         {"tip", told.point->displacement}});
      }
      for (const Followed& branch : one.branches) {
        add_end(out, one, branch);
        Json points = Json::array();
        for (const BranchRow& row : branch.rows)
          if (row.tip_displacement)
            points.push_back({*row.parameter, *row.tip_displacement, row.stable.value_or(false)});
        drawn.push_back(
            {{"name", level(one).empty() ? branch.name : level(one) + ", " + branch.name}, {"points", points}});
      }
    }
    add_shifts(out);
    tell_absent(out);
    say(out);
    out.figure = {{"form", "branches"},
                  {"x", spoken(parameter_.name)},
                  {"x_unit", parameter_.unit},
                  {"y", "displacement of the tip"},
                  {"y_unit", "m"},
                  {"series", drawn},
                  {"marks", marks}};
    return out;
  }

 private:
  std::string level(const Followers& one) const { return evidence_.level(*one.record, columns_); }

  void read(std::size_t owner) {
    Followers& out = methods_.emplace_back();
    out.owner = owner;
    out.record = of_.points.cases()[owner];
    for (BranchRow& row : branch_rows_in(*find_table(out.record->tables, branches_name))) {
      if (!row.parameter) continue;
      auto branch = std::find_if(out.branches.begin(), out.branches.end(),
                                 [&](const Followed& one) { return one.name == row.branch; });
      if (branch == out.branches.end()) branch = out.branches.insert(out.branches.end(), {row.branch});
      branch->from = std::min(branch->from, *row.parameter);
      branch->to = std::max(branch->to, *row.parameter);
      branch->rows.push_back(std::move(row));
    }
    // A turn that a step may have invented is no fold.
    const double least = of_.points.least_fold().value_or(0);
    for (const StudyPoint& point : of_.points.points()) {
      if (point.owner != owner) continue;
      if (point.row.kind == PointKind::end) {
        for (Followed& branch : out.branches)
          if (branch.name == point.row.branch && point.row.ended != TraceEnd::none &&
              point.row.ended != TraceEnd::missing)
            branch.end = &point.row;
        continue;
      }
      if (!changes_orbit(point.kind) || std::isnan(point.parameter) || !(all_ || kinds_.contains(point.kind))) continue;
      // A turn by less than its place is uncertain by may be one of the step.
      const bool small = (point.name < 0 && point.prominence < least) || point.prominence <= 2 * point.half;
      if (point.kind == PointKind::fold && (small || is_doubling(point))) continue;
      Told told{&point, point.parameter, point.half, point.half};
      if (const auto& low = point.row.low, &high = point.row.high; low && high) {
        told.less = std::max(0.0, told.value - *low);
        told.more = std::max(0.0, *high - told.value);
      }
      if (point.name >= 0) refine(told, owner, point);
      out.points.push_back(std::move(told));
    }
    std::stable_sort(out.points.begin(), out.points.end(), [](const Told& a, const Told& b) {
      return std::pair(a.point->branch, a.point->arc) < std::pair(b.point->branch, b.point->arc);
    });
    for (Told& told : out.points)
      for (const int side : {-1, 1})
        (side < 0 ? told.below : told.above) = stable_at(out, told.value + side * beside(told, owner, side));
  }

  /// Whether a turn is where its branch, of twice the period, begins at a flip of the same case: both ways from there
  /// are the same orbit, half its period later.
  bool is_doubling(const StudyPoint& turn) const {
    const std::vector<StudyPoint>& points = of_.points.points();
    return std::any_of(points.begin(), points.end(), [&](const StudyPoint& other) {
      return other.owner == turn.owner && other.kind == PointKind::flip && turn.period == 2 * other.period &&
             std::abs(other.parameter - turn.parameter) <= other.half + turn.half;
    });
  }

  /// What step and mesh leave of a point; a stiffness of a law is a level of its own. One case alone leaves what it
  /// leaves open unknown.
  void refine(Told& told, std::size_t owner, const StudyPoint& point) const {
    for (const PointConvergence::Along& along : of_.points.convergence(owner, point.name).along) {
      if (!is_refinement(of_.points.axes()[along.axis].column) || !along.limit.open) continue;
      told.value += along.limit.correction;
      told.less += *along.limit.open;
      told.more += *along.limit.open;
      told.confirmed = true;
    }
  }

  /// How far beside a point its stable orbits are read: 0.5 % of the range, or as far as it is uncertain, but no
  /// farther than half way to the next point of its case.
  double beside(const Told& told, std::size_t owner, int side) const {
    constexpr double share = 0.005;
    const double known = side < 0 ? told.less : told.more;
    double away = std::max(share * of_.points.range(), 2 * known);
    for (const StudyPoint& other : of_.points.points()) {
      const double gap = side * (other.parameter - told.value);
      if (other.owner == owner && changes_orbit(other.kind) && gap > known + other.half)
        away = std::min(away, 0.5 * gap);
    }
    return std::max(away, known);
  }

  /// The stable orbits that branches have at a value of the parameter: "period 1 and period 2"; that none was followed,
  /// or "" where no branch goes.
  std::string stable_at(const Followers& one, double value) const {
    std::set<std::string> stable;
    bool any = false;
    for (const Followed& branch : one.branches)
      for (std::size_t k = 0; k + 1 < branch.rows.size(); ++k) {
        const BranchRow &a = branch.rows[k], &b = branch.rows[k + 1];
        const auto [low, high] = std::minmax(*a.parameter, *b.parameter);
        if (value < low || value > high || !a.stable || !b.stable) continue;
        any = true;
        if (*a.stable == *b.stable ? *a.stable : stable_between(one, branch, a, b, value))
          stable.insert(fmt::format("period {}", a.period));
      }
    return stable.empty() ? (any ? "none that was followed" : "") : fmt::format("{}", fmt::join(stable, " and "));
  }

  /// Between a stable and an unstable row of a branch: on the side of the point between them, else of their middle.
  bool stable_between(const Followers& one, const Followed& branch, const BranchRow& a, const BranchRow& b,
                      double value) const {
    double turn = 0.5 * (*a.parameter + *b.parameter);
    const auto [low, high] = std::minmax(*a.parameter, *b.parameter);
    for (const StudyPoint& point : of_.points.points())
      if (point.owner == one.owner && point.row.branch == branch.name && changes_orbit(point.kind) &&
          low <= point.parameter && point.parameter <= high)
        turn = point.parameter;
    const BranchRow& own = (value < turn) == (*a.parameter < *b.parameter) ? a : b;
    return *own.stable;
  }

  void add_point(asks::Answered& out, const Followers& one, const Told& told) const {
    asks::VerdictRow row;
    row.measure = point_words(told.point->kind).thing;
    row.level = (level(one).empty() ? "" : level(one) + ", ") + told.point->row.branch;
    row.value = told.value;
    if (told.confirmed) {
      row.low = told.value - told.less;
      row.high = told.value + told.more;
    }
    row.unit = parameter_.unit;
    row.verdict =
        fmt::format("{} {}", fmt::format("period {}", told.point->period), point_words(told.point->kind).does);
    std::vector<std::string> parts;
    const auto side = [](const std::string& stable) { return stable.empty() ? "not followed" : stable; };
    parts.push_back(fmt::format("stable below: {}, above: {}", side(told.below), side(told.above)));
    if (!told.confirmed) parts.emplace_back("no second case confirms it");
    if (!told.point->row.note.empty()) parts.push_back(told.point->row.note);
    if (told.point->name >= 0)
      for (const PointOrderRow& order : of_.orders)
        if (order.name == of_.points.names()[static_cast<std::size_t>(told.point->name)].text &&
            order.method == one.record->id && order.verdict == order_told)
          parts.push_back(fmt::format("order {} in {}", short_number(*order.order, 2), spoken(order.refined)));
    for (const PointLimitRow& limit : of_.limits)
      if (told.point->name >= 0 && limit.id == one.record->id && limit.reference &&
          limit.name == of_.points.names()[static_cast<std::size_t>(told.point->name)].text)
        parts.push_back(fmt::format("reference {}", short_number(*limit.reference, 7)));
    row.reason = fmt::format("{}", fmt::join(parts, "; "));
    row.cases = 1;
    row.left_out = 0;
    out.rows.push_back(std::move(row));
  }

  void add_end(asks::Answered& out, const Followers& one, const Followed& branch) const {
    asks::VerdictRow row;
    row.measure = "end of the branch";
    row.level = (level(one).empty() ? "" : level(one) + ", ") + branch.name;
    row.unit = parameter_.unit;
    row.cases = 1;
    row.left_out = 0;
    if (branch.end) {
      row.value = branch.end->parameter;
      const std::string words = end_words(branch.end->ended);
      row.verdict = words.empty() ? "stops inside the range" : words;
      row.reason = words.empty() ? branch.end->note : "";
    } else {
      row.verdict = "has no end that is told";
    }
    // How far it went is no interval of its end.
    if (std::isfinite(branch.from))
      row.reason += (row.reason.empty() ? "" : "; ") +
                    fmt::format("goes from {} to {}", short_number(branch.from, 6), short_number(branch.to, 6));
    out.rows.push_back(std::move(row));
  }

  /// Points that a case has and the finest of its method has not, and the other way round: which cases lack a point.
  void tell_absent(asks::Answered& out) const {
    std::set<int> names;
    for (const Followers& one : methods_)
      for (const Told& told : one.points)
        if (told.point->name >= 0) names.insert(told.point->name);
    constexpr std::size_t most = 3;
    std::size_t lacking = 0;
    for (const int name : names) {
      const NamedPoint& named = of_.points.names()[static_cast<std::size_t>(name)];
      const PointKind kind = named.point->kind;
      const std::string &text = named.text, said = word(kind);
      std::size_t reached = 0, absent = 0;
      std::optional<double> least;
      for (const PointPresenceRow& row : of_.presence) {
        if (row.name != text || row.presence == word(PointPresence::not_reached) ||
            std::none_of(followed_.begin(), followed_.end(), [&](const CaseRecord* one) { return one->id == row.id; }))
          continue;
        ++reached;
        if (row.presence != word(PointPresence::absent)) continue;
        ++absent;
        if (row.passed_to) least = std::min(*row.passed_to, least.value_or(*row.passed_to));
      }
      if (absent == 0 || ++lacking > most) continue;
      const std::string at = text.starts_with(said) ? text.substr(said.size()) : " " + text;
      out.aside.push_back(fmt::format(
          "{} of {} cases have no {}{}{}{}.", absent, reached, point_words(kind).thing, at, unit(),
          least ? fmt::format(", though their branches go on to {} at least", short_number(*least, 4)) : ""));
    }
    if (lacking > most)
      out.aside.push_back(fmt::format("{} more points are not in every case: point_presence.csv.", lacking - most));
  }

  /// A named point of a method by its case.
  const Told* told_of(const std::string& id, int name) const {
    for (const Followers& one : methods_)
      if (one.record->id == id)
        for (const Told& told : one.points)
          if (told.point->name == name) return &told;
    return nullptr;
  }

  /// What choices move named points by, as rows: each against the case from which it differs in that alone.
  void add_shifts(asks::Answered& out) const {
    std::map<std::string, const StudyPoint*> names;
    for (const Followers& one : methods_)
      for (const Told& told : one.points)
        if (told.point->name >= 0)
          names.emplace(of_.points.names()[static_cast<std::size_t>(told.point->name)].text, told.point);
    for (const PointShiftRow& shift : of_.shifts) {
      const auto found = names.find(shift.name);
      if (found == names.end() || is_refinement(shift.choice) || !shift.shift) continue;
      asks::VerdictRow row;
      row.measure = std::string("shift of the ") + point_words(found->second->kind).thing;
      row.level = shift.value + " against " + shift.reference_value + ", " + shift.name;
      row.value = shift.shift;
      row.unit = parameter_.unit;
      const Told *own = told_of(shift.id, found->second->name),
                 *other = told_of(of_.points.reference()->id, found->second->name);
      if (own && other && own->confirmed && other->confirmed) {
        row.low = *row.value - own->less - other->more;
        row.high = *row.value + own->more + other->less;
        row.verdict = *row.low <= 0 && *row.high >= 0 ? "not told from none" : "moves";
      } else {
        row.verdict = "open";
        row.reason = "no second case confirms both";
      }
      row.cases = 2;
      row.left_out = 0;
      out.rows.push_back(std::move(row));
    }
  }

  /// "folds at 0.1006 ± 3e-5"; "doubles its period between 1.9705 and 5.997" where the value stands near one end.
  static std::string place(const Told& told) {
    constexpr double lopsided = 2;
    const double wide = std::max(told.less, told.more), narrow = std::min(told.less, told.more);
    const char* does = point_words(told.point->kind).does;
    if (told.confirmed && wide > lopsided * narrow) {
      constexpr int digits = 5;
      const std::string low = short_number(told.value - told.less, digits),
                        high = short_number(told.value + told.more, digits);
      if (low != high) return fmt::format("{} between {} and {}", does, low, high);
    }
    constexpr int few = 4;  // digits of what one case alone has
    return fmt::format("{} at {}", does,
                       told.confirmed ? point_value(told.value, wide) : short_number(told.value, few));
  }

  /// How the branches of all methods end.
  struct Ends {
    std::size_t branches = 0, known = 0, inside = 0, asked = 0, points = 0;
    const Followed *first = nullptr, *stopped = nullptr;  ///< of all; of those that stop inside the range
  };

  /// Of all methods, or of one.
  Ends ends(const Followers* of = nullptr) const {
    Ends ends;
    for (const Followers& one : methods_) {
      if (of && &one != of) continue;
      ends.points += one.points.size();
      for (const Followed& branch : one.branches) {
        if (ends.branches++ == 0) ends.first = &branch;
        ends.known += branch.end != nullptr;
        ends.asked += branch.end && branch.end->ended == TraceEnd::asked;
        if (!branch.end || !end_words(branch.end->ended).empty()) continue;
        ++ends.inside;
        if (!ends.stopped) ends.stopped = &branch;
      }
    }
    return ends;
  }

  std::string text(const Ends& ends) const {
    if (ends.branches == 1 && ends.stopped)
      return fmt::format("the branch stops inside the range at {}{}",
                         short_number(ends.stopped->end->parameter.value_or(ends.stopped->to), 6), unit());
    if (ends.branches == 1 && ends.first->end) return "the branch " + end_words(ends.first->end->ended);
    if (ends.known == 0) return "no end of a branch is told";
    if (ends.inside == 0 && ends.asked > 0)
      return fmt::format("{} of {} branches stop at a point of stop_at", ends.asked, ends.branches);
    if (ends.inside == 0) return fmt::format("all {} branches end at the range, closed or joined", ends.known);
    return fmt::format("{} of {} branches stop inside the range", ends.inside, ends.branches);
  }

  std::string unit() const { return parameter_.unit.empty() ? "" : " " + parameter_.unit; }

  /// The first `count` points, a period named once.
  std::string text(const std::vector<const Told*>& list, std::size_t count) const {
    std::string text;
    int period = 0;
    for (std::size_t k = 0; k < count; ++k) {
      const Told& told = *list[k];
      const bool same = told.point->period == period;
      text +=
          (k == 0 ? "" : ", ") + (same ? place(told) : fmt::format("period {} {}", told.point->period, place(told)));
      period = told.point->period;
    }
    text += unit();
    if (count < list.size()) text += fmt::format(", {} more", list.size() - count);
    return text;
  }

  void say(asks::Answered& out) const {
    const Ends branches = ends();
    if (branches.branches == 0) {
      out.passes = asks::Verdict::open;
      out.verdict = "open";
      out.reason = nothing();
      out.sentence = asks::fitting(
          {"Open: no periodic orbit was found: " + out.reason + ".", "Open: no periodic orbit was found."});
      return;
    }
    // Beyond a point of stop_at nothing was looked for.
    const bool any = branches.points > 0, inside = branches.inside + branches.asked > 0;
    out.passes = any ? asks::Verdict::yes : inside ? asks::Verdict::open : asks::Verdict::no;
    out.verdict = any ? "found" : inside ? "open" : "none";
    const std::string ends = text(branches);
    if (branches.stopped) out.reason = branches.stopped->end->note;
    // Of the first method that has points; those at one place once.
    const auto first =
        std::find_if(methods_.begin(), methods_.end(), [](const Followers& one) { return !one.points.empty(); });
    if (first == methods_.end()) {
      const std::string asked = all_ ? "special point" : kinds_text();
      out.sentence = asks::fitting({fmt::format("{}: no {} was met; {}.", inside ? "Open" : "No", asked, ends)});
      return;
    }
    // What a second case confirms is told; where nothing is, what there is.
    std::vector<const Told*> confirmed, single;
    for (const bool sure : {true, false})
      for (const Told& told : first->points) {
        const auto there = [&](const Told* other) { return at_one_place(*told.point, *other->point); };
        if (told.confirmed == sure && std::none_of(confirmed.begin(), confirmed.end(), there) &&
            std::none_of(single.begin(), single.end(), there))
          (sure ? confirmed : single).push_back(&told);
      }
    const std::vector<const Told*>& list = confirmed.empty() ? single : confirmed;
    const std::string unsure = confirmed.empty() ? ", which no second case confirms"
                               : single.empty()  ? ""
                                                 : fmt::format(", {} unconfirmed", single.size());
    std::vector<std::string> texts;
    const std::string own_ends = text(this->ends(&*first));
    const bool several = methods_.size() > 1;
    const std::string who = several ? "with " + study_.name(*first->record) + ", " : "",
                      one = several ? fmt::format("with the first of {} methods, ", methods_.size()) : "";
    for (const bool named : {true, false})
      for (std::size_t count = list.size(); count > 0; --count) {
        if (named && count < list.size() && count < 2) continue;
        texts.push_back(answers::capitalised((named ? who : one) + text(list, count) + unsure + "; " +
                                             (named ? own_ends : ends) + "."));
      }
    out.sentence = asks::fitting(texts);
  }

  std::string kinds_text() const {
    const bool contacts = kinds_.contains(PointKind::contact);
    std::set<std::string> names;
    for (const PointKind kind : kinds_)
      if (!contacts || (kind != PointKind::first_contact && kind != PointKind::lift_off)) names.insert(word(kind));
    return fmt::format("{}", fmt::join(names, " or "));
  }

  std::string nothing() const {
    for (const CaseRecord* one : cases_)
      for (const SpecialRow& row : special_points_type().read(one->tables))
        if (!row.note.empty()) return row.note;
    return "no case left a branch";
  }

  const asks::Evidence& evidence_;
  const Choices& study_;
  const PointAnalysis& of_;
  Cases cases_;
  std::set<const CaseRecord*> followed_;
  std::vector<std::string> columns_;
  report::Quantity parameter_;
  std::set<PointKind> kinds_;
  bool all_ = false;
  std::vector<Followers> methods_;
};

}  // namespace

asks::Answered points_ask(const asks::Ask& ask, const asks::Evidence& evidence, const PointAnalysis& points) {
  return PointsAsk(ask, evidence, points).answer();
}

}  // namespace ricochet
