#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <ricochet/measure/orbits/impact_jump.hpp>
#include <utility>

#include "runners/kinds/trajectory/stop_measures.hpp"
#include "runners/kinds/trajectory/stop_tables.hpp"
#include "runners/store/record_values.hpp"
#include "runners/store/study_tables.hpp"

namespace ricochet {
namespace {

constexpr const char* side_names[] = {"lower", "upper"};

const Column point_column{"point", "1", "Number of the contact point of the scene, from 0."};
const Column x_column{"x", "m", "Place of the contact point."};
const Column stop_column{"stop", "", "Name of the stop."};
const Column tangent_speed_column{"tangent_speed", "m/s",
                                  "Velocity along the surface over the sub-step before the one that closes the point."};
const Column shock_column{"shock", "1", "Row of shocks.csv of this case that it belongs to, from 0; empty: none."};

NumberTable impacts_head() {
  NumberTable table = number_table(
      "impacts",
      {{"t", "s", "Time at which the point closes: that of the first effort."},
       point_column,
       x_column,
       {"side", "", "The stop that is hit: lower or upper."},
       {"speed_in", "m/s",
        "Velocity of the point towards the stop, over the sub-step before the one that closes it: a difference of "
        "positions over the time between them."},
       {"speed_out", "m/s",
        "Velocity away from the stop over the second sub-step without an effort; over the first where the point closes "
        "again after it. Empty where the point did not leave."},
       {"impulse", "N s", "Momentum that the efforts give, by magnitude."},
       {"peak_force", "N",
        "Largest force; that of an impact on a rigid stop is its impulse over a step or two, and grows as they "
        "shrink."},
       {"duration", "s", "Time for which the point is pushed, whole sub-steps."},
       {"release_force", "N", "The last force; where the point is still closed, that of the last instant."},
       {"open_end", "", "Whether the point was still closed when the integration ended."}});
  table.text = "One impact of one case: a contact point closes, is pushed, and opens. Contact from the start is none.";
  return table;
}

Table stops_head() {
  return {
      "stops",
      "One stop of one contact point of one case that was ever touched; or a friction damper, which has no sides.",
      {point_column,
       x_column,
       {"side", "", "The stop: lower or upper; empty of a friction damper."},
       {"impacts", "1", "Number of times that the point closed there; contact from the start is none."},
       {"peak_force", "N", "Largest force."},
       {"mean_force", "N", "Mean of the force over the time in contact."},
       {"rms_force", "N", "Root mean square of the force over the time in contact."},
       {"contact_time", "s", "Time in contact."},
       {"impulse", "N s", "Momentum that the efforts gave, by magnitude."},
       {"normal_work", "J",
        "∫F|v|dt over the run: what the force works on the point, in and out alike; on a free mass ½mv²(1 + e²) per "
        "impact."},
       {"largest_speed_in", "m/s", "Largest velocity with which the point came; empty where it hit nothing."}},
      {}};
}

// Whether a stop has no bounds: it rubs under a force that is given.
bool is_damper(int stop, const StopList& list, const SemiDiscrete& problem) {
  return std::any_of(problem.rubbing.begin(), problem.rubbing.end(), [&](const RubbingPoint& one) {
    return one.given.normal_force && list.stop_of[static_cast<std::size_t>(one.point)] == stop;
  });
}

// Where a stop stands, m.
double position_of(int stop, const StopList& list, const SemiDiscrete& problem) {
  return problem.contact_x[static_cast<std::size_t>(list.row[static_cast<std::size_t>(stop)])];
}

void add_impacts(CaseRecord& record, const StopContacts& contacts, const SemiDiscrete& problem,
                 const StopWatches& watches) {
  const StopList& list = contacts.list();
  NumberTable table = impacts_head();
  table.words = {{"side", {side_names[0], side_names[1]}}, {"open_end", {"false", "true"}}};
  for (const Impact& impact : contacts.impacts())
    table.add({impact.time, static_cast<double>(impact.point), position_of(impact.point, list, problem),
               static_cast<double>(impact.side), impact.speed_in, impact.speed_out, impact.impulse, impact.peak_force,
               impact.duration, impact.release_force, impact.open_end ? 1.0 : 0.0});
  if (!problem.stops.empty()) {
    table.columns.push_back(stop_column);
    table.values.push_back(*table.series(point_column.name));
    table.words.emplace_back(stop_column.name, list.names);
  }
  const std::vector<Impact>& impacts = contacts.impacts();
  if (watches.tangents && watches.tangents->any()) {
    table.columns.push_back(tangent_speed_column);
    Series& speeds = table.values.emplace_back();
    for (std::size_t i = 0; i < impacts.size(); ++i) speeds.push_back(watches.tangents->speed_at(i));
  }
  if (watches.outputs && watches.outputs->shocks()) {
    table.columns.push_back(shock_column);
    Series& numbers = table.values.emplace_back();
    const std::vector<Shock> shocks = shocks_in_order(*watches.outputs->shocks());
    for (const Impact& impact : impacts) numbers.push_back(shock_of(impact, shocks));
  }
  const auto listed = static_cast<long long>(table.rows());
  if (listed < contacts.count())
    record.notes.push_back(fmt::format("impacts.csv has the first {} of {} impacts; counts and sums have all of them",
                                       listed, contacts.count()));
  record.numbers.push_back(std::move(table));
}

// Blanks measures that have no limit as the step shrinks: forces of points with mass that a rigid law has thrown back.
void blank_without_limit(CaseRecord& record, const StopContacts& contacts, const Marcher& marcher) {
  if (marcher.law().reads() || contacts.count() == 0) return;
  const StopList& list = contacts.list();
  const std::vector<bool> massive = points_with_mass(*marcher.program().problem);
  std::vector<std::string> names;
  for (int stop = 0; stop < list.count(); ++stop) {
    bool thrown = false;
    for (std::size_t point = 0; point < massive.size(); ++point)
      thrown = thrown || (massive[point] && list.stop_of[point] == stop);
    if (!thrown || contacts.totals(stop, StopSide::lower).impacts + contacts.totals(stop, StopSide::upper).impacts == 0)
      continue;
    if (names.empty()) names.emplace_back("peak_contact_force");
    if (const std::string& name = list.names[static_cast<std::size_t>(stop)]; !name.empty())
      for (std::string& one : forces_while_they_act(name)) names.push_back(std::move(one));
  }
  for (const std::string& name : names)
    if (std::erase_if(record.measures, [&](const auto& measure) { return measure.first == name; }) > 0)
      record.left_out.emplace_back(name, no_limit);
}

/// Stops on which a point comes to rest by rebounds: it flies ever shorter, and then stays for longer than it flew.
std::vector<bool> chattered_to_rest(const std::vector<Impact>& impacts, int stops, double h) {
  constexpr double short_flight = 10, lasting = 10, at_once = 3.5;  // steps
  std::vector<bool> found(static_cast<std::size_t>(stops), false);
  std::map<std::pair<int, StopSide>, const Impact*> before;
  for (const Impact& one : impacts) {
    const Impact*& last = before[{one.point, one.side}];
    const bool rests = one.open_end || one.duration > lasting * h;
    if (rests && last && last->duration < at_once * h && one.time - last->time < short_flight * h)
      found[static_cast<std::size_t>(one.point)] = true;
    last = &one;
  }
  return found;
}

// Counts of impacts have no limit there. What was counted stays in the tables.
void leave_out_counts(CaseRecord& record, const StopContacts& contacts, const Marcher& marcher,
                      std::optional<double> restitution) {
  if (marcher.law().reads() || restitution.value_or(0) <= 0) return;
  const StopList& list = contacts.list();
  const std::vector<bool> chattered = chattered_to_rest(contacts.impacts(), list.count(), marcher.program().h);
  if (std::find(chattered.begin(), chattered.end(), true) == chattered.end()) return;
  record.left_out.emplace_back("impacts", no_count);
  for (std::size_t stop = 0; stop < chattered.size(); ++stop)
    if (chattered[stop] && !list.names[stop].empty())
      record.left_out.emplace_back("impacts[" + list.names[stop] + "]", no_count);
}

}  // namespace

void add_contact(CaseRecord& record, const StopContacts& contacts, const Marcher& marcher,
                 std::optional<double> restitution, const StopWatches& watches) {
  put_measure(record, "impacts", static_cast<double>(contacts.count()));
  const SemiDiscrete& problem = *marcher.program().problem;
  if (!marcher.program().contact) return add_stop_tables(record, problem, watches);
  const StopList& list = contacts.list();
  Table stops = stops_head();
  const bool named = !problem.stops.empty();
  if (named) stops.columns.push_back(stop_column);
  // Means over a window that was not reached are none.
  const StopWatches ended = record.status == Status::done ? watches : StopWatches{};
  StopReading known;
  for (int point = 0; point < list.count(); ++point) {
    const StopReading one = stop_reading(contacts, ended, point);
    if (one.pushed) known.pushed = one.pushed;
    if (one.shocks) known.shocks = one.shocks;
    if (one.wear_power) known.wear_power = one.wear_power;
    if (one.friction) known.friction = one.friction;
  }
  const std::vector<Column> readings = stop_reading_columns(known);
  stops.columns = joined(stops.columns, readings);
  double peak = 0, time = 0;
  for (int point = 0; point < list.count(); ++point) {
    if (named)
      put_stop_measures(record, list.names[static_cast<std::size_t>(point)], stop_reading(contacts, ended, point));
    const auto add_row = [&](Row row, std::optional<StopSide> side) {
      if (named) row.push_back(list.names[static_cast<std::size_t>(point)]);
      const Row cells = stop_reading_cells(stop_reading(contacts, ended, point, side));
      row.insert(row.end(), cells.begin(), cells.end());
      row.resize(stops.columns.size());
      stops.rows.push_back(std::move(row));
    };
    if (is_damper(point, list, problem)) {
      Row row(stops_head().columns.size());
      row[0] = point;
      row[1] = position_of(point, list, problem);
      add_row(std::move(row), std::nullopt);
      continue;
    }
    for (const StopSide side : {StopSide::lower, StopSide::upper}) {
      const StopTotals& totals = contacts.totals(point, side);
      if (totals.impacts == 0 && totals.contact_time == 0) continue;
      peak = std::max(peak, totals.peak_force);
      time += totals.contact_time;
      add_row({point, position_of(point, list, problem), side_names[static_cast<std::size_t>(side)], totals.impacts,
               totals.peak_force, totals.mean_force(), totals.rms_force(), totals.contact_time, totals.impulse,
               totals.normal_work, totals.impacts > 0 ? Cell(totals.fastest) : Cell()},
              side);
    }
  }
  put_measure(record, "peak_contact_force", peak);
  put_measure(record, "contact_time", time);
  add_impacts(record, contacts, problem, watches);
  record.tables.push_back(std::move(stops));
  add_stop_tables(record, problem, watches);
  blank_without_limit(record, contacts, marcher);
  leave_out_counts(record, contacts, marcher, restitution);
}

void describe_contact(std::vector<CaseRecord>& records) {
  std::vector<Table> heads = stop_table_heads();
  heads.push_back(stops_head());
  heads.back().columns = joined(joined(heads.back().columns, {stop_column}), all_stop_reading_columns());
  NumberTable impacts = impacts_head();
  impacts.columns = joined(impacts.columns, {stop_column, tangent_speed_column, shock_column});
  describe(records, heads, {impacts, shocks_type().head(), spectra_type().head(), orbits_type().head()});
}

namespace {

// What is known of every curve.
Table common_curves() {
  return {
      "curves",
      "One sample of the motion of one case; the name of the file is the case.",
      {{"t", "s", "Time of the sample."},
       {"tip_displacement", "m", "Displacement of the tip: absolute, unless scene.frame is supports."},
       {"tip_velocity", "m/s", "Absolute velocity of the tip, the mean over the last sub-step."},
       {"kinetic", "J", "Kinetic energy ½vᵀMv in the frame of the clamp, where the scheme's velocity stands."},
       {"elastic", "J", "Elastic energy ½qᵀKq."},
       {"contact", "J", "Energy that the springs at the stops store; 0 where they are rigid."},
       {"load", "J", "Potential of the steady loads; with elastic and contact it is 0 where these are lowest."},
       {"energy", "J", "The common mechanical energy: kinetic, elastic, contact and load."},
       {"scheme_energy", "J", "The scheme's own discrete energy; kinetic, elastic and contact where it declares none."},
       {"contact_force", "N", "Sum of the contact efforts over the points at the last step, positive upwards."},
       {"penetration", "m", "Distance by which a contact point is past its stop, the largest over the points."},
       {"active", "1", "Number of contact points that are closed."},
       {"contact_force_total", "N",
        "Sum of the forces at the contact points by magnitude at the last step: those of opposite stops do not "
        "cancel."},
       {"contact_force_peak", "N", "Largest force of one contact point since the sample before, from every step."},
       {"tip_displacement_low", "m", "Smallest displacement of the tip since the sample before, from every step."},
       {"tip_displacement_high", "m", "Largest displacement of the tip since the sample before."},
       {"penetration_peak", "m", "Largest penetration since the sample before, from every step."}},
      {}};
}

}  // namespace

Table curves_head(const std::vector<std::string>& points, const std::vector<std::string>& fields) {
  Table curves = common_curves();
  for (const std::string& name : points) {
    curves.columns.push_back(
        {name + "_displacement", "m", "Displacement of the point " + name + ", in its own frame."});
    curves.columns.push_back({name + "_velocity", "m/s", "Its velocity, the mean over the last sub-step."});
  }
  for (const std::string& name : fields) {
    const bool moment = name.ends_with("_moment");
    curves.columns.push_back({name, moment ? "N m" : "N",
                              moment ? "Bending moment EI θ' there." : "Derivative of the bending moment along x."});
  }
  return curves;
}

}  // namespace ricochet
