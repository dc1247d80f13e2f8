#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <ricochet/measure/statistics/draws.hpp>

#include "runners/asks/lines.hpp"
#include "runners/asks/verbs.hpp"
#include "runners/store/record_values.hpp"
#include "runners/table/text.hpp"

namespace ricochet::asks {
namespace {

/// What one line would need for its parts of u to be within a share of its value.
struct Need {
  std::optional<double> seeds, duration, periods, step;
  bool enough = false, known = true;
  std::string why;
};

/// The number in two digits, rounded down: a step that is smaller does as well.
double two_digits_below(double value) {
  const double digit = std::pow(10, std::floor(std::log10(value)) - 1);
  return to_digits(std::floor(value / digit) * digit, 2);
}

/// The whole number of two digits that is no less.
double two_digits_above(double value) {
  const double digit = std::pow(10, std::floor(std::log10(value)) - 1);
  return std::round(std::ceil(value / digit) * digit);
}

/// Whether the last change of the step lies within the draws: of each with itself, its mean is not told from zero. Such
/// a change is no error of the step, and a smaller step leaves as much. Of windows alone their half-widths decide.
bool drawn_by_chance(const Point& point) {
  if (!point.finest) return false;
  const Size fine = *point.finest;
  const auto coarse = std::find_if(point.values.upper_bound(fine), point.values.end(),
                                   [&](const auto& one) { return one.first.second == fine.second; });
  if (coarse == point.values.end()) return false;
  std::vector<double> changes;
  double variance = 0;
  for (const auto& [seed, value] : point.values.at(fine)) {
    const auto other = coarse->second.find(seed);
    if (other == coarse->second.end()) continue;
    changes.push_back(value - other->second);
    for (const Size& size : {fine, coarse->first})
      if (const auto halves = point.halves.find(size); halves != point.halves.end())
        if (const auto half = halves->second.find(seed); half != halves->second.end())
          variance += half->second * half->second;
  }
  const std::optional<double> half = half_interval(changes);
  if (!half) return changes.size() == 1 && std::abs(changes.front()) <= std::sqrt(variance);
  const double sum = std::accumulate(changes.begin(), changes.end(), 0.0);
  return std::abs(sum) <= *half * static_cast<double>(changes.size());
}

class Enough {
 public:
  Enough(const Ask& ask, const Evidence& evidence) : evidence_(evidence), within_(*ask.share("within")) {
    lines_ = lines_of(ask, evidence, ask.subject());
  }

  Answered answer() const {
    Answered out = begin_answer(lines_);
    if (auto open = without_values(lines_, out)) return *open;
    std::vector<std::pair<const Line*, Need>> needs;
    std::vector<Verdict> verdicts;
    for (const Line& line : lines_.all) {
      if (!line.known()) continue;
      needs.emplace_back(&line, need_of(line));
      const Need& need = needs.back().second;
      verdicts.push_back(!need.known ? Verdict::open : need.enough ? Verdict::yes : Verdict::no);
      add_rows(out, line, need, verdicts.back());
    }
    out.passes = all_of(verdicts);
    out.verdict = word(*out.passes);
    out.figure = figure(needs);
    // Of a no the one that is told what would do.
    const auto counts = [&](const std::pair<const Line*, Need>& one) {
      return *out.passes != Verdict::no || (one.second.known && !one.second.enough);
    };
    const auto worst = std::max_element(needs.begin(), needs.end(), [&](const auto& a, const auto& b) {
      return counts(a) != counts(b) ? counts(b) : width(*a.first) < width(*b.first);
    });
    const auto& [line, need] = *worst;
    const std::string found =
        is_zero(*line) ? lines_.words.words + (is_plural(lines_.words.words) ? " are zero" : " is zero")
                       : fmt::format("{} {} known to ± {}", lines_.words.words,
                                     is_plural(lines_.words.words) ? "are" : "is", answers::percent(width(*line)));
    if (*out.passes == Verdict::yes)
      out.sentence = in_thirty_words(fmt::format("Yes: {}, within the {} asked", found, answers::percent(within_)),
                                     {{less_would_do(*line, need)}});
    else if (*out.passes == Verdict::open) {
      const auto open = std::find_if(needs.begin(), needs.end(), [](const auto& one) { return !one.second.known; });
      out.reason = open->second.why;
      out.sentence = in_thirty_words(fmt::format("Open: what {} within {} takes is not told: {}", lines_.words.words,
                                                 answers::percent(within_), out.reason),
                                     {{open->first->place()}});
    } else {
      const auto open = std::count_if(needs.begin(), needs.end(), [](const auto& one) { return !one.second.known; });
      const std::string rest = open > 0 ? fmt::format("; open in {} of {}", open, needs.size()) : "";
      out.reason = need.why;
      out.sentence = in_thirty_words(
          fmt::format(
              "No: {}; {}", found,
              need.why.empty() ? fmt::format("{} would do for {}", remedy(need), answers::percent(within_)) : need.why),
          {{line->place() + rest, rest, line->place()}});
    }
    return out;
  }

 private:
  /// Whether it is zero but for round-off.
  static bool is_zero(const Line& line) {
    const Estimate& one = line.estimate();
    return one.value == 0 && one.u() && *one.u() <= line.point.floor;
  }

  static double width(const Line& line) {
    const Estimate& one = line.estimate();
    if (is_zero(line)) return 0;
    return one.u() && one.value != 0 ? *one.u() / std::abs(one.value) : INFINITY;
  }

  Need need_of(const Line& line) const {
    const Estimate& one = line.estimate();
    Need out;
    if (is_zero(line)) {
      out.enough = true;
      out.why = "it is zero";
      return out;
    }
    if (one.grows || one.value == 0 || !one.u()) {
      out.known = false;
      out.why = one.grows               ? one.motion
                : one.value == 0        ? "it is zero"
                : one.unknown().empty() ? "nothing was refined or drawn"
                                        : one.unknown();
      return out;
    }
    const double asked = within_ * std::abs(one.value);
    out.enough = *one.u() <= asked;
    if (out.enough && (!one.unknown().empty() || *one.doubted_u() > asked || doubtful(line.point))) {
      out.known = out.enough = false;
      out.why = !one.unknown().empty()     ? one.unknown()
                : *one.doubted_u() > asked ? "it " + one.unsettled()
                                           : "the runs are doubtful";
      return out;
    }
    const double mesh = one.mesh.value_or(0), step = one.step.value_or(0), sampling = one.sampling.value_or(0);
    if (out.enough) {
      if (sampling > 0) draws_for(out, one, asked - mesh - step);
      return out;
    }
    if (mesh >= asked) {
      out.why = "the mesh alone leaves " + answers::percent(mesh / std::abs(one.value));
      return out;
    }
    const double rest = asked - mesh, half = rest / 2;
    if (sampling > 0 && step > 0 && drawn_by_chance(line.point)) {
      // Both fall with more draws.
      draws_for(out, one, sampling * rest / (sampling + step));
      return out;
    }
    // Steps and draws share what the mesh leaves of it; what one does not need is the other's.
    const double of_draws = step <= half ? rest - step : half, of_step = sampling <= half ? rest - sampling : half;
    if (sampling > of_draws) draws_for(out, one, of_draws);
    if (step > of_step) {
      constexpr double halves = 1;
      const double order = std::max(0.5, one.order.value_or(halves));
      if (!one.motion.empty() || one.vanishes) {
        out.known = !one.vanishes;
        out.why = one.vanishes ? "it falls to zero with the step" : "it " + one.motion;
      } else if (!one.order && line.point.errors == Errors::saw_toothed)
        out.why = "it falls with no order in the step";
      else
        out.step = two_digits_below(line.point.finest->first * std::pow(of_step / step, 1 / order));
    }
    return out;
  }

  /// The seeds of these windows, or the windows of these seeds, that a half-width of the mean takes. Of n seeds it is
  /// t₀.₉₇₅(n−1)/√n of their scatter; told by each seed's own interval, and of a window T, it falls as 1/√n, 1/√T.
  void draws_for(Need& out, const Estimate& one, double half) const {
    const double longer = std::pow(*one.sampling / half, 2);
    if (one.seeds > 1 && !one.scattered) out.seeds = std::ceil(longer * static_cast<double>(one.seeds));
    if (one.seeds > 1 && one.scattered) {
      const double scatter = *one.sampling / half_interval_over_scatter(one.seeds);
      constexpr std::size_t fewest = 2, large = 200;  // beyond it t changes no more
      std::size_t n = fewest;
      while (n < large && scatter * half_interval_over_scatter(n) > half) ++n;
      const double beyond = scatter * half_interval_over_scatter(n) / half;
      out.seeds = n < large ? static_cast<double>(n) : two_digits_above(static_cast<double>(n) * beyond * beyond);
    }
    // The law of 1/√T is that of many correlation times: no window of a tenth tells what a shorter one has.
    constexpr double shortest = 0.1;
    // Of a load that repeats after R its square falls as 1/T − 1/R: windows of half a repetition and more scatter less
    // than they tell.
    const double window = evidence_.window(), repeats = evidence_.repeats_after();
    if (window > 0) out.duration = 1 / ((1 / window - 1 / repeats) / std::max(longer, shortest) + 1 / repeats);
    // An orbit repeats in one period at least.
    if (const double kept = evidence_.kept_periods(); kept > 0)
      out.periods = std::max(1.0, two_digits_above(longer * kept));
    if (out.duration && std::max(*out.duration, window) > 0.5 * repeats) {
      out.duration.reset();
      if (one.seeds == 1) out.seeds = std::ceil(longer);
    }
  }

  /// "28 seeds, or windows of 4.8 s".
  static std::string draws_words(const Need& need) {
    const std::string windows = !need.duration ? "" : fmt::format("windows of {} s", short_number(*need.duration, 2));
    if (!need.seeds) return windows;
    return fmt::format("{:.0f} seeds", *need.seeds) + (windows.empty() ? "" : ", or " + windows);
  }
  std::string remedy(const Need& need) const {
    std::vector<std::string> parts;
    if (need.seeds || need.duration) parts.push_back(draws_words(need));
    if (need.periods) parts.push_back(fmt::format("{:.0f} kept periods", *need.periods));
    if (need.step) parts.push_back(evidence_.study().step_words(*need.step));
    return some_of(parts);
  }
  /// "; of 6 seeds with 7 s each 5 seeds, or windows of 4.9 s, would do"; "" where nothing was drawn.
  std::string less_would_do(const Line& line, const Need& need) const {
    if (!need.seeds && !need.duration) return "";
    const std::size_t seeds = line.estimate().seeds;
    const std::string had =
        (seeds > 1 ? fmt::format("of {} seeds", seeds) : "of") +
        (evidence_.window() > 0 ? fmt::format("{} {} s", seeds > 1 ? " with" : "", short_number(evidence_.window(), 3))
                                : "");
    return fmt::format("; {}, {} would do", had, draws_words(need));
  }

  void add_rows(Answered& out, const Line& line, const Need& need, Verdict verdict) const {
    VerdictRow row = lines_.row(line);
    row.verdict = word(verdict);
    if (!need.why.empty()) row.reason = need.why;
    out.rows.push_back(row);
    VerdictRow width_row;
    width_row.measure = line.measure;
    width_row.level = line.level;
    width_row.stop = line.stop;
    width_row.of_case = row.of_case;
    const double own = width(line);
    if (std::isfinite(own)) width_row.value = per_cent * own;
    width_row.unit = "%";
    width_row.verdict = "half-width";
    out.rows.push_back(width_row);
    const auto add = [&](const std::optional<double>& value, const char* what, const char* unit) {
      if (!value) return;
      VerdictRow needed = width_row;
      needed.value = *value;
      needed.unit = unit;
      needed.verdict = what;
      out.rows.push_back(std::move(needed));
    };
    add(need.seeds, "seeds that would do", "1");
    add(need.duration, "window that would do", "s");
    add(need.periods, "kept periods that would do", "1");
    add(need.step, "step that would do", "s");
  }

  Json figure(const std::vector<std::pair<const Line*, Need>>& needs) const {
    Json rows = Json::array();
    for (const auto& [line, need] : needs) {
      const Estimate& one = line->estimate();
      if (one.value == 0) continue;
      for (const auto& [part, value] :
           {std::pair("step", one.step), std::pair("mesh", one.mesh), std::pair("sampling", one.sampling)})
        if (value)
          rows.push_back({{"name", line->level + (line->stop.empty() ? "" : " " + line->stop)},
                          {"part", part},
                          {"value", per_cent * *value / std::abs(one.value)}});
    }
    return {{"form", "parts"},
            {"measure", lines_.words.words},
            {"unit", "%"},
            {"rows", rows},
            {"at", {per_cent * within_}}};
  }

  const Evidence& evidence_;
  double within_;
  Lines lines_;
};

void check_enough(const Ask& ask, const Study& study) {
  check_subject(ask, study);
  // Nothing refines what each step and mesh has for itself.
  if (const MeasureInfo* info = measure_info(ask.subject()); info && info->of_each_size)
    throw InputError(ask.pointer(), quote(ask.subject()) +
                                        " is told of each step and mesh, which are levels here: it has no interval; "
                                        "ask {\"cheapest\": …} or {\"value\": …}");
}

std::string doubt_enough(const Ask&, const Study& study) {
  const Planned plan = planned(study);
  return plan.steps == 1 ? "one step only: which step would do is not told" : "";
}

}  // namespace

const Verb& enough_verb() {
  static const Verb verb{
      "enough",
      "Whether steps, seeds and window are enough for a share, and what would be.",
      {keys::of_form(Field::Form::text, "enough", std::nullopt, "The measure."),
       keys::of_form(Field::Form::share, "within", std::nullopt, "The half-width of its interval as a share of it.")},
      "",
      check_enough,
      doubt_enough,
      [](const Ask& ask, const Evidence& evidence) { return Enough(ask, evidence).answer(); }};
  return verb;
}

}  // namespace ricochet::asks
