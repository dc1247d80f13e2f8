#include <cmath>
#include <ricochet/measure/contact/stop_places.hpp>

namespace ricochet {

RowReadings::RowReadings(const Marcher& marcher, const ObservedRows& rows)
    : RowReadings(*marcher.program().model, marcher.program().model->in_model(rows.rows), rows.on_support,
                  rows.on_motions) {}

RowReadings RowReadings::of_stops(const Marcher& marcher) {
  const MarchModel& model = *marcher.program().model;
  const SemiDiscrete& problem = model.problem();
  return {model, model.contact(), Eigen::VectorXd::Ones(problem.points()), problem.motions.at_points};
}

double RowReadings::lift(const Marcher& marcher, int row, double t) const {
  const SupportMotions& motions = marcher.motions();
  double sum = on_support_[row] == 0 ? 0.0 : on_support_[row] * marcher.support(0, t);
  if (!motions.empty()) sum += motions.sum(on_motions_.row(row), t, false);
  return sum;
}

double RowReadings::velocity(const Marcher& marcher, const EnergyAudit& audit, int row) const {
  const double t = marcher.time(), lasts = audit.last_duration(0);
  const double way = audit.last_way(marcher, rows_, row, 0) + lift(marcher, row, t) - lift(marcher, row, t - lasts);
  return way / lasts;
}

StopList stop_list(const SemiDiscrete& problem) {
  StopList list;
  std::size_t next = 0;
  for (int row = 0; row < problem.points();) {
    const bool round = next < problem.clearances.size() && problem.clearances[next].first == row;
    const int last = round ? problem.clearances[next].last() : row;
    list.names.push_back(problem.stops.empty() ? "" : problem.stops[static_cast<std::size_t>(row)]);
    list.row.push_back(row);
    list.clearance.push_back(round ? static_cast<int>(next++) : -1);
    for (; row <= last; ++row) list.stop_of.push_back(list.count() - 1);
  }
  return list;
}

StopPlaces::StopPlaces(const Marcher& marcher) : rows_(RowReadings::of_stops(marcher)) {
  const SemiDiscrete& problem = *marcher.program().problem;
  const StopList list = stop_list(problem);
  for (int i = 0; i < list.count(); ++i) {
    Stop& stop = stops_.emplace_back();
    stop.first = list.row[static_cast<std::size_t>(i)];
    if (!list.round(i)) continue;
    const Clearance& clearance =
        problem.clearances[static_cast<std::size_t>(list.clearance[static_cast<std::size_t>(i)])];
    const std::vector<double>& angles = clearance.angles;
    stop.radius = clearance.radius;
    stop.centre = clearance.offset;
    // The row that is nearest to the second axis tells u₂ best.
    std::size_t best = 1;
    for (std::size_t k = 1; k < angles.size(); ++k)
      if (std::abs(std::sin(angles[k])) > std::abs(std::sin(angles[best]))) best = k;
    stop.other = stop.first + static_cast<int>(best);
    const auto [cosine, sine] = side_direction(angles[best]);
    stop.cosine = cosine;
    stop.sine = sine;
  }
}

std::array<double, 2> StopPlaces::components(const Marcher& marcher, int stop, const double* position, double t) const {
  const Stop& one = stops_[static_cast<std::size_t>(stop)];
  const auto read = [&](int row) { return rows_.relative(row, position) + rows_.lift(marcher, row, t); };
  const double first = read(one.first);
  if (one.other < 0) return {first, 0.0};
  return {first - one.centre[0], (read(one.other) - one.cosine * first) / one.sine - one.centre[1]};
}

double StopPlaces::displacement(const Marcher& marcher, int stop, const double* position, double t) const {
  const auto [first, second] = components(marcher, stop, position, t);
  return stops_[static_cast<std::size_t>(stop)].other < 0 ? first : std::hypot(first, second);
}

}  // namespace ricochet
