#include <cmath>
#include <ricochet/measure/contact/stop_places.hpp>

namespace ricochet {

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
  return {first, one.other < 0 ? 0.0 : (read(one.other) - one.cosine * first) / one.sine};
}

double StopPlaces::displacement(const Marcher& marcher, int stop, const double* position, double t) const {
  const auto [first, second] = components(marcher, stop, position, t);
  return stops_[static_cast<std::size_t>(stop)].other < 0 ? first : std::hypot(first, second);
}

}  // namespace ricochet
