#include "runners/march/load_changes.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <limits>
#include <numbers>
#include <ricochet/contract/said_format.hpp>
#include <ricochet/measure/stability/structure_physics.hpp>
#include <ricochet/scene/checks.hpp>
#include <ricochet/scene/whole_load.hpp>
#include <set>

namespace ricochet {
namespace {

constexpr double no_gap = std::numeric_limits<double>::infinity();

// Between the stops of a point, m.
double gap_of(const Marcher& marcher, int point) {
  const LaneSpec& lane = marcher.program().lanes.front();
  const double gap = lane.upper[point] - lane.lower[point];
  return gap > 0 ? gap : no_gap;
}

int points_of(const Marcher& marcher) {
  return marcher.program().contact ? marcher.program().problem->points() : 0;
}

}  // namespace

GapWatch::GapWatch(const Marcher& marcher) : known_(no_gap) {
  for (int j = 0; j < points_of(marcher); ++j) known_ = std::min(known_, gap_of(marcher, j));
}

void GapWatch::update(const Marcher& marcher, double penetration) {
  const MarchModel& model = *marcher.program().model;
  const double support = marcher.support(0, marcher.time());
  double most = 0;
  const LaneSpec& lane = marcher.program().lanes.front();
  for (int j = 0; j < points_of(marcher); ++j) {
    const double place =
        model.times(model.contact(), j, marcher.slot(0)) + support + marcher.motions().point(j, marcher.time());
    most = std::max(most, std::max(lane.lower[j] - place, place - lane.upper[j]) / gap_of(marcher, j));
  }
  known_ = penetration;
  if (!(most > 1)) return;
  if (times_ == 0) first_ = marcher.time();
  times_ = std::max(times_, most);
}

Said GapWatch::passed(bool resolved) const {
  constexpr double soft = 10;
  if (times_ == 0 || (resolved && times_ < soft)) return {};
  return said("a point passes its stop by more than the gap, up to {:.3g} times, first at t = {:.9g} s", times_,
              first_);
}

Said GapWatch::crossed(const Marcher& marcher, const ImpactRecorder& recorder) {
  const double h = marcher.program().h;
  constexpr double round_off = 1e-9;  // a point that a rigid law takes from stop to stop moves by the gap itself
  double most = 0;
  for (int j = 0; j < points_of(marcher); ++j)
    for (const StopSide side : {StopSide::lower, StopSide::upper})
      most = std::max(most, recorder.totals(0, j, side).fastest * h / gap_of(marcher, j));
  if (!(most >= 1 - round_off)) return {};
  const auto crosses = [&](const Impact& impact) {
    return impact.speed_in * h >= (1 - round_off) * gap_of(marcher, impact.point);
  };
  const auto first = std::find_if(recorder.impacts(0).begin(), recorder.impacts(0).end(), crosses);
  Said doubt = said("a step of {:g} s takes a point further than the gap, {:.3g} times as far", h, most);
  if (first != recorder.impacts(0).end()) doubt += said(", first at t = {:.9g} s", first->time);
  return doubt;
}

namespace {

constexpr double beyond_ends = 0.1, beyond_neighbours = 0.5, jumps = 0.25;  // of the largest load
constexpr long long fewest_looks = 500, most_looks = 2500, steps_per_look = 4;
constexpr std::size_t most_numbers = 64, most_told = 3;

/// A part of what drives as a function of time, its text, and the table that it is made of, where it is.
struct Signal {
  std::function<double(double)> at;
  std::string text;
  const TimeTable* table = nullptr;
};

/// Signals of one unit, and what a sentence calls them.
struct Drive {
  std::string what;
  std::vector<Signal> signals;
  double largest = 0;  ///< at least
};

/// One step of a signal: its ends, and what was met between them.
struct Seen {
  long long step = 0;
  double begin = 0, end = 0, low = 0, high = 0, low_at = 0, high_at = 0;
};

/// The load, N; the motions of supports, stops and surfaces whose tables give them, each as it gives it.
std::vector<Drive> drives_of(const SceneSpec& scene) {
  std::vector<Drive> drives(1);
  drives.front().what = "the load";
  for (const HarmonicForce& one : harmonic_forces(scene))
    drives.front().largest = std::max(drives.front().largest, std::abs(one.force.amplitude));
  std::vector<Signal>& signals = drives.front().signals;
  const double length = structure_length(scene), tip = tip_position(scene);
  const double whole = length > 0 ? length : 1;
  const LoadSpec& load = scene.load;
  if (load.formula.uses_t())
    for (const double x : length > 0 ? std::vector<double>{0.37 * length, tip} : std::vector<double>{0.0})
      signals.push_back(
          {[f = load.formula, x, whole](double t) { return whole * f.value(x, t); }, load.formula.text()});
  for (const LoadTerm& term : load.terms) {
    if (!term.history.uses_t()) continue;
    double size = term.force ? 1 : 0;
    if (!term.force)
      for (const double x : {0.0, 0.37 * length, 0.5 * length, 0.81 * length, length})
        size = std::max(size, whole * std::abs(term.shape.value(x, 0)));
    if (size > 0)
      signals.push_back({[f = term.history, size](double t) { return size * f.value(0, t); },
                         term.table ? "" : term.history.text(), term.table.get()});
  }
  for (const GivenMotion& one : given_motions(scene))
    if (const TimeTable* table = one.motion->table.get()) {
      const auto curve = std::make_shared<const PiecewiseCubic>(PiecewiseCubic::interpolate(*table));
      Drive& drive = drives.emplace_back();
      drive.what = one.what;
      drive.signals.push_back({[curve](double t) { return curve->value(t); }, "", table});
    }
  return drives;
}

/// The numbers of a formula within ]0, end[, where conditions and pulses of it mostly are.
std::set<double> numbers_in(const std::string& text, double end) {
  std::set<double> numbers;
  for (std::size_t i = 0; i < text.size();) {
    const bool digit = (text[i] >= '0' && text[i] <= '9') || text[i] == '.';
    if (!digit) {
      ++i;
      continue;
    }
    char* stop = nullptr;
    const double number = std::strtod(text.c_str() + i, &stop);
    const auto next = static_cast<std::size_t>(stop - text.c_str());
    if (number > 0 && number < end) numbers.insert(number);
    i = std::max(next, i + 1);
  }
  return numbers;
}

class SignalSampler {
 public:
  SignalSampler(const Signal& signal, double h, long long steps) : signal_(signal), h_(h), steps_(steps) {
    look_evenly();
    look_around_numbers();
    if (signal.table) look_at_entries(*signal.table);
    std::sort(seen_.begin(), seen_.end(), [](const Seen& a, const Seen& b) { return a.step < b.step; });
  }

  double largest() const { return largest_; }

  /// Times at which the signal comes and goes, and steps in which it jumps, ascending.
  void tell(double largest, std::set<double>& passing, std::set<long long>& jumping) {
    for (const Seen& one : seen_) {
      const double high = one.high - std::max(one.begin, one.end), low = std::min(one.begin, one.end) - one.low;
      if (std::max(high, low) > beyond_ends * largest) {
        passing.insert(high > low ? one.high_at : one.low_at);
        continue;
      }
      const double change = one.end - one.begin;
      if (!(std::abs(change) > jumps * largest)) continue;
      const auto stands_out = [&](long long instant, double here, double there, double other) {
        const double to = here - there, back = here - other;
        const bool out = std::min(std::abs(to), std::abs(back)) > beyond_neighbours * largest && (to > 0) == (back > 0);
        if (out) passing.insert(time(instant));
        return out;
      };
      if (one.step + 2 <= steps_ && stands_out(one.step + 1, one.end, one.begin, value(time(one.step + 2)))) continue;
      if (one.step > 0 && stands_out(one.step, one.begin, one.end, value(time(one.step - 1)))) continue;
      if (is_jump(one)) jumping.insert(one.step);
    }
  }

 private:
  double time(long long instant) const { return static_cast<double>(instant) * h_; }
  double value(double t) {
    const double found = signal_.at(t);
    if (!std::isfinite(found)) return 0;
    largest_ = std::max(largest_, std::abs(found));
    return found;
  }

  Seen begin(long long step, double value_there) {
    Seen one;
    one.step = step;
    one.begin = value_there;
    one.end = value(time(step + 1));
    one.low = std::min(one.begin, one.end);
    one.high = std::max(one.begin, one.end);
    return one;
  }
  void sample(Seen& one, double t) {
    const double found = value(t);
    if (found < one.low) one.low = found, one.low_at = t;
    if (found > one.high) one.high = found, one.high_at = t;
  }

  // One instant inside of each step, nowhere twice at the same phase of it.
  void look_evenly() {
    const long long count = std::min(steps_, std::clamp(steps_ / steps_per_look, fewest_looks, most_looks));
    double phase = 0.5;
    for (long long i = 0; i < count; ++i) {
      const long long step = count == steps_
                                 ? i
                                 : static_cast<long long>(static_cast<double>(steps_) / static_cast<double>(count) *
                                                          static_cast<double>(i));
      if (!seen_.empty() && seen_.back().step == step) continue;
      const bool next = !seen_.empty() && seen_.back().step + 1 == step;
      Seen one = begin(step, next ? seen_.back().end : value(time(step)));
      sample(one, (static_cast<double>(step) + phase) * h_);
      phase += std::numbers::phi - 1;
      phase -= std::floor(phase);
      seen_.push_back(one);
    }
  }

  void look_around_numbers() {
    const std::set<double> found = numbers_in(signal_.text, time(steps_));
    const std::vector<double> numbers(found.begin(), found.end());
    const std::size_t count = std::min(numbers.size(), most_numbers);
    for (std::size_t k = 0; k < count; ++k) {
      const double centre = numbers[k * numbers.size() / count];
      const auto middle = static_cast<long long>(std::floor(centre / h_));
      for (long long step = std::max(0LL, middle - 1); step <= std::min(steps_ - 1, middle + 1); ++step) {
        Seen one = begin(step, value(time(step)));
        for (const double part : {1e-6, 1e-4, 1e-3, 0.01, 0.05, 0.2, 0.5})
          for (const double t : {centre - part * h_, centre + part * h_})
            if (t > time(step) && t < time(step + 1)) sample(one, t);
        seen_.push_back(one);
      }
    }
  }

  // Between entries a table has nothing of its own; those at an instant are seen by the march.
  void look_at_entries(const TimeTable& table) {
    constexpr double at_instant = 1e-9;  // of a step
    constexpr long long most_entries = 100000;
    const double end = time(steps_);
    long long looked = 0, last = -1;
    for (double shift = 0; table.times.front() + shift < end; shift += table.period) {
      for (const double entry : table.times) {
        const double t = entry + shift, whole = std::floor(t / h_), part = t / h_ - whole;
        if (t <= 0 || t >= end || part < at_instant || part > 1 - at_instant) continue;
        if (++looked > most_entries) return;
        const auto step = static_cast<long long>(whole);
        if (step != last) seen_.push_back(begin(step, value(time(step))));
        last = step;
        sample(seen_.back(), t);
      }
      if (!(table.period > 0)) return;
    }
  }

  // Whether half of the change is in an eighth of the step.
  bool is_jump(const Seen& one) {
    double left = time(one.step), right = time(one.step + 1), at_left = one.begin, at_right = one.end;
    for (int halving = 0; halving < 3; ++halving) {
      const double middle = 0.5 * (left + right), there = value(middle);
      if (std::abs(there - at_left) > std::abs(at_right - there))
        right = middle, at_right = there;
      else
        left = middle, at_left = there;
    }
    return std::abs(at_right - at_left) >= 0.5 * std::abs(one.end - one.begin);
  }

  const Signal& signal_;
  double h_;
  long long steps_;
  double largest_ = 0;
  std::vector<Seen> seen_;
};

Said some_of(const std::vector<std::string>& times) {
  const std::size_t count = std::min(times.size(), most_told);
  return as_number(fmt::format("{} s{}",
                               fmt::join(times.begin(), times.begin() + static_cast<std::ptrdiff_t>(count), ", "),
                               times.size() > count ? fmt::format(" and {} more", times.size() - count) : ""));
}

}  // namespace

namespace {

void tell_changes(const Drive& drive, double step, long long steps, std::vector<Said>& changes) {
  std::vector<SignalSampler> samplers;
  samplers.reserve(drive.signals.size());
  double largest = drive.largest;
  for (const Signal& signal : drive.signals)
    largest = std::max(largest, samplers.emplace_back(signal, step, steps).largest());
  std::set<double> passing;
  std::set<long long> jumping;
  for (SignalSampler& sampler : samplers) sampler.tell(largest, passing, jumping);
  std::vector<std::string> times;
  double last = -step;
  for (const double t : passing) {
    if (t - last < step) continue;  // seen twice
    times.push_back(fmt::format("{:.9g}", last = t));
  }
  if (!times.empty())
    changes.push_back(drive.what + said(" comes and goes within a step of {:g} s, at t = {}", step, some_of(times)));
  times.clear();
  for (const long long one : jumping)
    times.push_back(
        fmt::format("{:.9g} to {:.9g}", static_cast<double>(one) * step, static_cast<double>(one + 1) * step));
  if (!times.empty()) changes.push_back(drive.what + said(" jumps within a step, at t = {}", some_of(times)));
}

}  // namespace

std::vector<Said> load_changes(const SceneSpec& shared, double step, long long steps) {
  std::vector<Said> changes;
  const std::vector<GivenMotion> motions = given_motions(shared);
  const bool varies = shared.load.uses_t() || std::any_of(motions.begin(), motions.end(), [](const GivenMotion& one) {
                        return one.motion->table != nullptr;
                      });
  if (!varies || steps < 1) return changes;
  const SceneSpec scene = shared;  // formulas keep their variables inside: evaluate our own copies
  for (const Drive& drive : drives_of(scene))
    if (!drive.signals.empty()) tell_changes(drive, step, steps, changes);
  return changes;
}

namespace {

std::vector<const TimeTable*> tables_of(const SceneSpec& scene) {
  std::vector<const TimeTable*> found;
  for (const LoadTerm& term : scene.load.terms)
    if (term.table) found.push_back(term.table.get());
  for (const GivenMotion& one : given_motions(scene))
    if (one.motion->table) found.push_back(one.motion->table.get());
  return found;
}

// The shortest and the longest way from an entry to the next, s.
std::pair<double, double> spacing(const TimeTable& table) {
  double least = HUGE_VAL, most = 0;
  for (std::size_t i = 1; i < table.times.size(); ++i) {
    least = std::min(least, table.times[i] - table.times[i - 1]);
    most = std::max(most, table.times[i] - table.times[i - 1]);
  }
  return {least, most};
}

const char* pieces(TimeTable::Between between) {
  if (between == TimeTable::Between::cubic) return "cubic pieces";
  return between == TimeTable::Between::step ? "constant pieces" : "linear pieces";
}

}  // namespace

std::vector<std::string> table_notes(const StudyCase& study_case) {
  constexpr double many = 20, enough = 5;
  const double h = study_case.step;
  std::vector<std::string> notes;
  if (!(h > 0)) return notes;
  for (const TimeTable* table : tables_of(study_case.scene)) {
    const auto [least, most] = spacing(*table);
    const double steps = std::floor(least / h * (1 + 1e-9));
    if (steps < many) continue;
    const bool even = most <= least * (1 + 1e-6);
    notes.push_back(fmt::format("{} has {:.0f} steps of the march{} between entries: {}", table->name, steps,
                                even ? "" : " or more", pieces(table->between)));
  }
  const Json load = study_case.scene_json.is_object() ? study_case.scene_json.value("load", Json()) : Json();
  for (std::size_t k = 0; load.is_array() && k < load.size(); ++k)
    for (const char* key : {"force", "time"}) {
      const Json::json_pointer at(fmt::format("/{}/psd/to", key));
      if (!load[k].contains(at)) continue;
      const double longest = 1 / (enough * load[k].at(at).get<double>());
      if (h > longest * (1 + 1e-9))
        notes.push_back(
            fmt::format("the spectrum of the load {} to {:.6g} Hz needs h ≤ {:.3g} s, {:.0f} steps per period", k,
                        load[k].at(at).get<double>(), longest, enough));
    }
  return notes;
}

Said short_run(const SemiDiscrete& problem, double duration) {
  constexpr double times = 100;
  const auto period = slowest_period(problem);
  if (!period || !(duration * times < *period)) return {};
  return said("the run of {:.3g} s lasts {:.2g} of the slowest period, {:.3g} s: nothing of that motion is seen",
              duration, duration / *period, *period);
}

Said beyond_table(const MethodChoice& law, const PluginManual& manual, double deepest) {
  for (const ParameterSpec& spec : manual.parameters) {
    if (spec.type != ParameterSpec::Type::table || !spec.unit.ends_with(" against m")) continue;
    const auto value = law.parameters.values().find(spec.key);
    const auto* table = value == law.parameters.values().end() ? nullptr : std::get_if<ParameterTable>(&value->second);
    if (!table || table->empty() || !(deepest > table->back()[0])) continue;
    return said("a point passes its stop by {:.4g} m, {} ends at {:g} m: its last slope is taken beyond", deepest,
                spec.key, table->back()[0]);
  }
  return {};
}

std::vector<Said> run_doubts(const StudyCase& study_case, const Prepared& prepared) {
  std::vector<Said> out = load_changes(study_case.scene, study_case.step, prepared.steps);
  out.push_back(short_run(*prepared.problem, static_cast<double>(prepared.steps) * study_case.step));
  return out;
}

std::vector<std::string> coarse_tables(const SceneSpec& scene, const std::vector<double>& pulsations) {
  constexpr std::size_t samples = 16;  // fewer entries are a shape that somebody drew
  std::vector<std::string> found;
  for (const TimeTable* table : tables_of(scene)) {
    if (table->times.size() < samples || table->between == TimeTable::Between::step) continue;
    const double step = spacing(*table).first, highest = 1 / (2 * step);
    const auto above = std::find_if(pulsations.begin(), pulsations.end(),
                                    [&](double omega) { return omega > 2 * std::numbers::pi * highest; });
    if (above == pulsations.end()) continue;
    found.push_back(fmt::format("{}: its step {:.4g} s resolves nothing above {:.4g} Hz; mode {} is at {:.4g} Hz",
                                table->name, step, highest, above - pulsations.begin() + 1,
                                *above / (2 * std::numbers::pi)));
  }
  return found;
}

}  // namespace ricochet
