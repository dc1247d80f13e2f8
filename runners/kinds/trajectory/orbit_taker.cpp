#include "runners/kinds/trajectory/orbit_taker.hpp"

#include <algorithm>
#include <cmath>

namespace ricochet {

const NumberType<OrbitColumns>& orbits_type() {
  static const NumberType<OrbitColumns> all = [] {
    NumberType<OrbitColumns> type("orbits", "One sample of a place within its clearance, of one case.");
    type.add({"stop", "", "Name of the clearance."}, &OrbitColumns::stop)
        .add({"t", "s", "Time of the sample."}, &OrbitColumns::t)
        .add({"first", "m", "Displacement along the first of its components, from its axis."}, &OrbitColumns::first)
        .add({"second", "m", "Displacement along the second."}, &OrbitColumns::second)
        .add({"radius", "m", "Radius of the clearance."}, &OrbitColumns::radius);
    return type;
  }();
  return all;
}

OrbitTaker::OrbitTaker(const Marcher& marcher, const WindowParts& window, long long steps)
    : list_(stop_list(*marcher.program().problem)), places_(marcher) {
  for (int stop = 0; stop < list_.count(); ++stop)
    if (list_.round(stop)) stops_.push_back(stop);
  asks_.next_shown = never;
  if (!any()) return;
  const double h = marcher.program().h;
  from_ = std::clamp(std::llround(window.from / h), 0LL, steps);
  to_ = std::clamp(std::llround(window.to / h), from_, steps);
  count_ = std::clamp<long long>(to_ - from_, 1, most_samples);
  asks_.next_shown = step_of(next_);
}

void OrbitTaker::step_done(Marcher& marcher) {
  if (next_ > count_ || marcher.step() < step_of(next_) || !marcher.status(0).running) return;
  t_.push_back(marcher.time());
  for (const int stop : stops_) {
    const std::array<double, 2> at = places_.components(marcher, stop);
    values_.insert(values_.end(), at.begin(), at.end());
  }
  while (next_ <= count_ && step_of(next_) <= marcher.step()) ++next_;
  asks_.next_shown = next_ > count_ ? never : step_of(next_);
}

NumberTable OrbitTaker::finish() const {
  NumberTable table = orbits_type().head();
  std::vector<std::string> names;
  for (const int stop : stops_) names.push_back(list_.names[static_cast<std::size_t>(stop)]);
  table.words = {{"stop", names}};
  for (std::size_t k = 0; k < stops_.size(); ++k)
    for (std::size_t i = 0; i < t_.size(); ++i) {
      const std::size_t at = 2 * (i * stops_.size() + k);
      table.add({static_cast<double>(k), t_[i], values_[at], values_[at + 1], places_.radius(stops_[k])});
    }
  return table;
}

}  // namespace ricochet
