#include "runners/kinds/trajectory/window_means.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ricochet/engine/flight/flight.hpp>

#include "runners/answers/answer.hpp"
#include "runners/store/record_values.hpp"

namespace ricochet {

WindowMeans::WindowMeans(const Json& settings, const Marcher& marcher, EnergyAudit& audit, long long steps,
                         const StopContacts* contacts)
    : audit_(audit), contacts_(contacts && contacts->merges() ? contacts : nullptr) {
  if (!has_window(settings)) return;
  const Json& window = settings.at("window");
  from_ = window.at("from").get<double>();
  to_ = std::min(window.at("to").get<double>(), static_cast<double>(steps) * marcher.program().h);
  if (window.contains("parts") && window["parts"].is_number()) parts_ = window["parts"].get<int>();
  constexpr double rounding = 1e-6;
  too_many_ = parts_ > 0 && (to_ - from_) / marcher.program().h < (1 - rounding) * parts_;
  if (parts_ > 0 && marcher.law().reads()) audit.sample_every_step();
  for (std::vector<double>& one : series_) one.reserve(static_cast<std::size_t>(parts_));
  asks_.next_shown = next_shown(marcher);
}

WindowMeans::Totals WindowMeans::now(const Marcher& marcher) const {
  if (contacts_)
    return {marcher.time(), audit_.lost_at_stops(0), contacts_->impulse(), static_cast<double>(contacts_->count())};
  const ContactTotals& contact = audit_.contact(0);
  return {marcher.time(), audit_.lost_at_stops(0), contact.impulse, static_cast<double>(contact.impacts)};
}

// Whether no step of the window is made.
bool WindowMeans::before_window(const Marcher& marcher) const {
  return series_[tip].empty() && steps_ == 0 && marcher.time() < from_ + marcher.program().h / 2;
}

// Of the part under way, s.
double WindowMeans::part_end() const {
  return from_ + (to_ - from_) * static_cast<double>(series_[tip].size() + 1) / parts_;
}

// Every step, and of flights the last one before the window and the one that ends a part. Two steps are for the
// rounding of times.
long long WindowMeans::next_shown(const Marcher& marcher) const {
  if (!marcher.program().flight) return 0;
  if (over()) return never;
  const double h = marcher.program().h, step = static_cast<double>(marcher.step());
  const double begins = std::floor(from_ / h) - 2 - step, ends = std::floor(part_end() / h) - 3 - step;
  const double left = before_window(marcher) && begins > 0 ? begins : before_window(marcher) ? 0 : ends;
  return left > 0 ? marcher.step() + 1 + static_cast<long long>(std::min(left, 1e18)) : 0;
}

void WindowMeans::interval(Marcher& marcher, const StepInterval& steps) {
  if (!over() && !before_window(marcher)) {
    steps.each_tip([&](double displacement) { squares_ += displacement * displacement; });
    steps_ += steps.steps;
  }
  asks_.next_shown = next_shown(marcher);
}

void WindowMeans::step_done(Marcher& marcher) {
  if (!over() && marcher.status(0).running) see_step(marcher);
  asks_.next_shown = next_shown(marcher);
}

void WindowMeans::see_step(const Marcher& marcher) {
  const double half_step = marcher.program().h / 2, t = marcher.time();
  if (before_window(marcher)) {
    begin_ = now(marcher);
    return;
  }
  const double displacement = marcher.tip(0);
  squares_ += displacement * displacement;
  ++steps_;
  if (t + half_step < part_end()) return;
  const Totals end = now(marcher);
  const double length = end.t - begin_.t;
  series_[power].push_back((end.lost - begin_.lost) / length);
  series_[force].push_back((end.impulse - begin_.impulse) / length);
  series_[rate].push_back((end.impacts - begin_.impacts) / length);
  series_[tip].push_back(squares_ / static_cast<double>(steps_));
  lengths_.push_back(length);
  begin_ = end;
  squares_ = 0;
  steps_ = 0;
}

// Parts are whole steps, and where these do not divide the window some are longer than others.
bool WindowMeans::uneven() const {
  const auto [least, most] = std::minmax_element(lengths_.begin(), lengths_.end());
  constexpr double rounding = 1e-6;
  return *most - *least > rounding * *most;
}

double WindowMeans::mean_by_length(const std::vector<double>& series) const {
  double sum = 0, all = 0;
  for (std::size_t part = 0; part < series.size(); ++part) {
    sum += lengths_[part] * series[part];
    all += lengths_[part];
  }
  return sum / all;
}

void WindowMeans::put(CaseRecord& record) const {
  if (parts_ == 0) return;
  if (too_many_) {
    record.notes.push_back(
        fmt::format("no means over the window: it has fewer steps than its {} parts; use fewer parts", parts_));
    return;
  }
  if (series_[tip].size() < static_cast<std::size_t>(parts_)) {
    record.notes.push_back(
        fmt::format("no means over the window: the run ended in part {} of {}", series_[tip].size() + 1, parts_));
    return;
  }
  const char* const names[means] = {"window_power", "window_force", "window_impact_rate", "window_tip_rms"};
  for (int mean = 0; mean < means; ++mean) {
    // Without a work form it is not known what the stops take.
    if (mean == power && !audit_.balances()) {
      record.left_out.emplace_back(names[mean], answers::no_work_form);
      continue;
    }
    Interval found = block_bootstrap_mean(series_[static_cast<std::size_t>(mean)]);
    if (uneven()) {
      const double apart = mean_by_length(series_[static_cast<std::size_t>(mean)]) - found.value;
      for (double* one : {&found.value, &found.low, &found.high}) *one += apart;
    }
    // The series has the squares: a mean of roots would depend on the number of parts.
    if (mean == tip)
      for (double* one : {&found.value, &found.low, &found.high}) *one = std::sqrt(std::max(*one, 0.0));
    put_measure(record, names[mean], found.value);
    put_measure(record, std::string("confidence.") + names[mean],
                std::max(found.high - found.value, found.value - found.low));
  }
}

ForceWindow::ForceWindow(const Json& settings, const Marcher& marcher) {
  // Of steps with several instants each has a weight of its own: they are all seen.
  if (marcher.program().flight && marcher.program().stages.size() == 1) asks_.next_shown = never;
  if (!has_window(settings)) return;
  from_ = settings.at("window").at("from").get<double>();
  to_ = settings.at("window").at("to").get<double>();
  const SemiDiscrete& problem = *marcher.program().problem;
  shares_.assign(static_cast<std::size_t>(problem.points()), 1.0);
  for (const Clearance& one : problem.clearances)
    for (std::size_t k = 0; k < one.angles.size(); ++k)
      shares_[static_cast<std::size_t>(one.first) + k] = side_direction(one.angles[k])[0];
}

void ForceWindow::stage_solved(const Marcher& marcher, const StageView& view) {
  if (!view.effort) return;
  const StageProgram& program = *view.program;
  if (program.opens_instant) given_ = lasts_ = 0;
  lasts_ = program.lasts;
  if (view.contact_lanes & 1u)
    for (int j = 0; j < marcher.program().model->problem().points(); ++j)
      given_ += program.momentum * shares_[static_cast<std::size_t>(j)] * view.effort[0][j * marcher.width()];
  if (program.closes_instant && lasts_ > 0 && within(view.time + 0.5 * marcher.program().h))
    add(given_ / lasts_, lasts_);
}

// Welford's sums: no difference of large squares.
void ForceWindow::add(double force, double lasts) {
  weight_ += lasts;
  const double apart = force - mean_;
  mean_ += lasts / weight_ * apart;
  squares_ += lasts * apart * (force - mean_);
}

void ForceWindow::interval(Marcher& marcher, const StepInterval& steps) {
  const StageProgram& program = marcher.program().stages.front();
  const double h = marcher.program().h, lasts = program.momentum, middle = steps.from + 0.5 * h;
  if (!(lasts > 0) || !program.reads_contact) return;
  if (!steps.closed.empty()) {
    long long step = 0;
    steps.each_stage([&](int, std::span<const double> efforts, std::span<const double>) {
      double force = 0;
      for (std::size_t i = 0; i < efforts.size(); ++i)
        force += shares_[static_cast<std::size_t>(steps.closed[i].point)] * efforts[i];
      if (within(middle + static_cast<double>(step++) * h)) add(force, lasts);
    });
    return;
  }
  // Instants without a force, in one: they have no spread of their own.
  const double begin = std::max(0.0, std::ceil((from_ - middle) / h)),
               end = std::min(static_cast<double>(steps.steps), std::ceil((to_ - middle) / h));
  if (end > begin) add(0, (end - begin) * lasts);
}

double ForceWindow::deviation() const {
  return std::sqrt(squares_ / weight_);
}

}  // namespace ricochet
