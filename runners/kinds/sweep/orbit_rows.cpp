#include "runners/kinds/sweep/orbit_rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>
#include <span>
#include <stdexcept>
#include <tuple>

#include "runners/json/json_text.hpp"
#include "runners/kinds/sweep/march_point.hpp"
#include "runners/kinds/sweep/sweep_tables.hpp"
#include "runners/kinds/sweep/with_parameter.hpp"
#include "runners/march/prepare_case.hpp"
#include "runners/store/record_values.hpp"
#include "runners/table/table_reader.hpp"

namespace ricochet {
namespace {

constexpr const char* contact_word = "contact";  // beyond a grazing, whatever class of motion it is

OrbitRow orbit_row(const OrbitView& view, const std::string& start, const SectionPlan& plan) {
  OrbitRow row;
  row.parameter = view.value;
  row.start = start;
  row.regime = word(view.complete() ? view.judged.verdict.motion.regime : Regime::failed);
  for (const Interval& one : view.exponents.values) row.exponents.push_back({one.value, one.low, one.high});
  row.exponent_method = view.exponents.method;
  if (view.exponents.twin) row.exponent_twin = view.exponents.twin->value;
  row.marginal = view.marginal;
  if (view.viscosity) row.alpha_equivalent = view.viscosity->numerical;
  const auto [status, reason] = status_of(view);
  row.status = word(status);
  row.reason = reason;
  if (!view.complete()) return row;
  const Orbit& orbit = *view.orbit;
  const RegimeVerdict& verdict = view.judged.verdict;
  if (verdict.period > 0) row.period = verdict.period;
  row.impacts_per_period = impacts_per_period(orbit);
  row.symmetric = view.judged.symmetric;
  row.recurrence = view.judged.recurrence.distance;
  row.contraction = view.judged.recurrence.contraction;
  row.zero_one = view.judged.zero_one;
  row.transient_periods = orbit.transient_periods;
  row.settled = orbit.settled;
  row.chatter = orbit.most_on_a_side >= chatter_impacts;
  row.sticking =
      static_cast<double>(orbit.contact_steps) / (static_cast<double>(orbit.kept_periods) * plan.steps_per_period);
  row.open = verdict.open * plan.scale;
  row.evidence = verdict.evidence;
  return row;
}

// The impacts of one period of what repeats, of all periods kept otherwise.
std::span<const ImpactPoint> impacts_shown(const OrbitView& view) {
  const std::span<const ImpactPoint> all(view.orbit->impacts);
  const std::vector<int>& counts = view.orbit->impact_counts;
  const auto periods = static_cast<std::size_t>(view.judged.recurrence.period);
  if (periods == 0 || periods > counts.size()) return all;
  const auto last =
      static_cast<std::size_t>(std::accumulate(counts.end() - static_cast<std::ptrdiff_t>(periods), counts.end(), 0));
  return all.last(std::min(last, all.size()));
}

Table changes(const std::vector<OrbitView>& views, const std::vector<std::string>& starts) {
  Table table = bifurcations_head();
  const RowType<ChangeRow> type = change_row_type();
  std::vector<std::optional<MotionClass>> classes;
  for (const OrbitView& view : views)
    classes.push_back(view.complete() ? std::optional(view.judged.verdict.motion) : std::nullopt);
  for (const auto& [below, above] : class_changes(classes)) {
    const OrbitView &before = views[below], &view = views[above];
    if (before.start != view.start) continue;
    const MotionClass &from = *classes[below], &to = *classes[above];
    const auto either = [&](Regime one) { return (from.regime == one) != (to.regime == one); };
    const char* kind = either(Regime::no_contact) ? "grazing" : either(Regime::at_rest) ? "lift-off" : "change";
    table.rows.push_back(type.row(ChangeRow({starts[view.start], text(from), text(to), kind,
                                             0.5 * (before.value + view.value), before.value, view.value})));
  }
  return table;
}

}  // namespace

std::vector<std::pair<std::size_t, std::size_t>> class_changes(const std::vector<std::optional<MotionClass>>& row) {
  std::vector<std::pair<std::size_t, std::size_t>> changes;
  std::optional<std::size_t> before;
  for (std::size_t i = 0; i < row.size(); ++i) {
    if (!row[i]) continue;
    if (before && !(*row[*before] == *row[i])) changes.emplace_back(*before, i);
    before = i;
  }
  return changes;
}

std::pair<Status, std::string> status_of(const OrbitView& view) {
  return view.orbit ? status_of(*view.orbit) : std::pair(Status::refused, view.refusal);
}

std::pair<Status, std::string> status_of(const Orbit& orbit) {
  if (orbit.stage != Orbit::Stage::stopped) return {Status::done, ""};
  return {orbit.end.failed() ? Status::failed : Status::diverged,
          fmt::format("period {}: {}", orbit.stopped_period, end_text(orbit))};
}

SectionPlan section_plan(const StudyCase& study_case, const ForcedScenes& scenes) {
  const Json& settings = study_case.settings;
  SectionPlan plan;
  plan.steps_per_period = study_case.steps_per_period;
  plan.transient = settings.at("transient").at("periods").get<int>();
  plan.at_most = settings.at("transient").at("at_most").get<int>();
  plan.keep = settings.at("keep").get<int>();
  const auto word = settings.at("section").get<std::string>();
  plan.section =
      word == "impact" ? SectionKind::impact : (word == "extremum" ? SectionKind::extremum : SectionKind::strobe);
  const double turns = settings.at("phase").get<double>() / (2 * std::numbers::pi);
  const auto strobe = std::llround((turns - std::floor(turns)) * plan.steps_per_period);
  plan.strobe = static_cast<int>(strobe % plan.steps_per_period);
  for (int i = 0; i < scenes.count(); ++i) {
    const ForcedScene& scene = scenes[i];
    if (!scene.refusal.empty()) continue;
    plan.pulsation = scene.pulsation;
    double gap = std::numeric_limits<double>::infinity();
    for (Eigen::Index p = 0; p < scene.lane.lower.size(); ++p) {
      const double lower = scene.lane.lower[p], upper = scene.lane.upper[p];
      if (std::isfinite(lower) && std::isfinite(upper))
        gap = std::min(gap, std::abs(upper - lower) / 2);
      else if (std::isfinite(lower) || std::isfinite(upper))
        gap = std::min(gap, std::abs(std::isfinite(lower) ? lower : upper));
    }
    plan.scale = std::isfinite(gap) && gap > 0 ? gap : std::max(std::abs(scene.lane.amplitude), 0.0);
    if (plan.scale == 0) plan.scale = 1;
    break;
  }
  return plan;
}

std::optional<EquivalentViscosity> numerical_viscosity(const ForcedScenes& scenes, int group,
                                                       const StudyCase& study_case, const Registry& registry) {
  const SemiDiscrete& problem = scenes.problem(group);
  ProblemFacts facts = problem_facts(problem, *make_law(study_case, registry));
  facts.damped = false;
  const auto plan = make_scheme(study_case, registry)->plan(scenes.step(group), facts);
  // A scheme that does not apply without damping has no undamped decay to speak of.
  if (!std::holds_alternative<StepPlan>(plan)) return std::nullopt;
  return equivalent_viscosity(problem, std::get<StepPlan>(plan), scenes.step(group));
}

void judge(OrbitView& view, const SectionPlan& plan) {
  if (!view.complete()) return;
  std::optional<Interval> exponent;
  if (!view.exponents.values.empty()) exponent = view.exponents.values.front();
  constexpr double least = -std::numeric_limits<double>::infinity();
  if (view.exponents.superstable) exponent = Interval{least, least, least};
  view.judged = judge(*view.orbit, plan, exponent);
}

void add_orbit_tables(CaseRecord& record, const std::vector<OrbitView>& views, const std::vector<std::string>& starts,
                      int exponents, const SectionPlan& plan) {
  Table values = values_head(exponents);
  const RowType<OrbitRow> type = orbit_row_type(exponents);
  NumberTable points = points_type().head(), impacts = impacts_type().head();
  points.words = {{start_name, starts}};
  impacts.words = {{start_name, starts}, {"side", {"lower", "upper"}}};
  std::vector<double> stops;
  for (const OrbitView& view : views) {
    values.rows.push_back(type.row(orbit_row(view, starts[view.start], plan)));
    if (!view.complete()) continue;
    const auto start = static_cast<double>(view.start);
    const auto& section = plan.section == SectionKind::strobe ? view.orbit->strobed : view.orbit->points;
    for (std::size_t i = 0; i < section.size(); ++i)
      points.add({view.value, start, static_cast<double>(i), section[i].displacement, section[i].velocity,
                  section[i].opposite_displacement, section[i].opposite_velocity});
    for (const ImpactPoint& impact : impacts_shown(view))
      impacts.add({view.value, start, impact.phase, static_cast<double>(impact.side), impact.speed,
                   view.problem->contact_x[static_cast<std::size_t>(impact.point)], impact.time});
    for (const ImpactPoint& impact : impacts_shown(view)) stops.push_back(static_cast<double>(impact.point));
  }
  if (!views.empty() && views.front().problem && !views.front().problem->stops.empty()) {
    impacts.columns.push_back(stop_column);
    impacts.values.emplace_back(std::move(stops));
    impacts.words.emplace_back(stop_column.name, views.front().problem->stops);
  }
  record.tables.push_back(std::move(values));
  record.tables.push_back(changes(views, starts));
  record.numbers.push_back(std::move(points));
  record.numbers.push_back(std::move(impacts));
}

void add_shares(CaseRecord& record, const std::vector<OrbitView>& views) {
  double orbits = 0, periodic = 0, chaotic = 0, impacts = 0;
  std::optional<Interval> largest;
  for (const OrbitView& view : views) {
    if (!view.complete()) continue;
    ++orbits;
    periodic += view.judged.verdict.motion.repeats();
    chaotic += view.judged.verdict.motion.regime == Regime::chaotic;
    impacts += impacts_per_period(*view.orbit);
    if (view.exponents.values.empty()) continue;
    if (const Interval& own = view.exponents.values[0]; !largest || own.value > largest->value) largest = own;
  }
  if (orbits == 0) return;
  record.measures.insert(record.measures.end(), {{"share_periodic", periodic / orbits},
                                                 {"share_chaotic", chaotic / orbits},
                                                 {"impacts_per_period", impacts / orbits}});
  if (!largest) return;
  put_measure(record, "largest_exponent", largest->value);
  put_measure(record, "confidence.largest_exponent",
              std::max(largest->high - largest->value, largest->value - largest->low));
}

void add_grazing_row(CaseRecord& record, const Grazing& grazing) {
  const char *below = contact_word, *above = word(Regime::no_contact);
  if (grazing.opens_below) std::swap(below, above);
  if (Table* changes = find_table(record.tables, "bifurcations"))
    changes->rows.push_back(change_row_type().row(
        ChangeRow({"open orbit", below, above, "grazing", grazing.value, grazing.low, grazing.high}, grazing.steps)));
}

namespace {

constexpr std::size_t state_counts = 3, entry_columns = 4;  // numbers in front of a state; columns of the table

std::vector<double> flat(const LaneState& state) {
  std::vector<double> all;
  for (const auto* part : {&state.slots, &state.efforts, &state.fastest})
    all.push_back(static_cast<double>(part->size()));
  for (const auto* part : {&state.slots, &state.efforts, &state.fastest})
    all.insert(all.end(), part->begin(), part->end());
  // What the law remembers stands last: the count of the others says where.
  all.insert(all.end(), state.memory.begin(), state.memory.end());
  return all;
}

LaneState lane_state(const std::vector<double>& all) {
  LaneState state;
  std::array<std::vector<double>*, state_counts> parts = {&state.slots, &state.efforts, &state.fastest};
  std::size_t at = state_counts;
  for (std::size_t k = 0; k < state_counts; ++k) {
    const double count = k < all.size() ? all[k] : -1;
    if (!(count >= 0) || count > static_cast<double>(all.size() - at))
      throw std::runtime_error("a stored state is cut short");
    const auto first = all.begin() + static_cast<std::ptrdiff_t>(at);
    parts[k]->assign(first, first + static_cast<std::ptrdiff_t>(count));
    at += static_cast<std::size_t>(count);
  }
  state.memory.assign(all.begin() + static_cast<std::ptrdiff_t>(at), all.end());
  return state;
}

}  // namespace

void add_entries(CaseRecord& record, const std::vector<OrbitView>& views, const std::vector<std::string>& starts) {
  NumberTable table = entries_type().head();
  table.words = {{start_name, starts}};
  for (const OrbitView& view : views) {
    if (!view.complete()) continue;
    const std::vector<double> state = flat(view.orbit->entry);
    if (entry_columns * (table.rows() + state.size()) > most_entry_numbers) {
      record.notes.push_back(
          fmt::format("the states that \"ricochet point\" begins with would take more than {} numbers: none are kept",
                      most_entry_numbers));
      return;
    }
    for (std::size_t i = 0; i < state.size(); ++i)
      table.add({view.value, static_cast<double>(view.start), static_cast<double>(i), state[i]});
  }
  record.numbers.push_back(std::move(table));
}

std::optional<LaneState> find_entry(const CaseRecord& record, double parameter, const std::string& start) {
  const std::vector<double> all = orbit_numbers(record, entries_type(), &EntryColumns::value, parameter, start);
  if (all.size() >= state_counts) return lane_state(all);
  return std::nullopt;
}

namespace {

constexpr std::size_t most_portraits = 400;  // per case
constexpr int samples_per_period = 100, longest = 4, portrait_width = 8;

struct TipSample {
  double time, displacement, velocity;
};

}  // namespace

void add_portraits(CaseRecord& record, const ForcedScenes& scenes, const std::vector<OrbitView>& views,
                   const SectionPlan& plan) {
  std::vector<const OrbitView*> complete;
  for (const OrbitView& view : views)
    if (view.complete()) complete.push_back(&view);
  if (complete.empty()) return;
  if (complete.size() > most_portraits) {
    record.notes.push_back(
        fmt::format("phase portraits are stored for up to {} orbits per case; this one has {}: "
                    "\"ricochet point\" marches any of them again",
                    most_portraits, complete.size()));
    return;
  }
  NumberTable table = portraits_type().head();
  if (const NumberTable* points = points_type().find(record.numbers)) table.words = {points->words.front()};
  const int stride = std::max(2, plan.steps_per_period / samples_per_period);
  std::map<std::pair<int, int>, std::vector<const OrbitView*>> batches;  // by group and periods
  for (const OrbitView* view : complete) {
    const int period = view->judged.verdict.period > 0 ? std::min(view->judged.verdict.period, longest) : longest;
    batches[{view->group, period}].push_back(view);
  }
  for (const auto& [key, members] : batches)
    for (std::size_t first = 0; first < members.size(); first += portrait_width) {
      std::vector<const Orbit*> orbits;
      std::vector<LaneSpec> lanes;
      const std::size_t last = std::min(first + portrait_width, members.size());
      for (std::size_t i = first; i < last; ++i) {
        orbits.push_back(members[i]->orbit);
        lanes.push_back(members[i]->orbit->lane);
      }
      TipMarch tips(scenes.program(key.first, lanes), orbits, plan);
      std::vector<std::vector<TipSample>> portraits(orbits.size());
      tips.march(static_cast<long long>(key.second) * plan.steps_per_period - 1,
                 [&](std::size_t lane, long long step, double displacement, double velocity) {
                   if (step % stride == 0)
                     portraits[lane].push_back({static_cast<double>(step) * tips.h(), displacement, velocity});
                 });
      for (std::size_t i = first; i < last; ++i)
        for (const auto& [time, displacement, velocity] : portraits[i - first])
          table.add({members[i]->value, static_cast<double>(members[i]->start), time, displacement, velocity});
    }
  record.numbers.push_back(std::move(table));
}

}  // namespace ricochet
