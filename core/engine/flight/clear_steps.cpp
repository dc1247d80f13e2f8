#include <algorithm>
#include <bit>
#include <cmath>
#include <ricochet/engine/flight/flight_set.hpp>
#include <ricochet/kernels/flight_kernels.hpp>

namespace ricochet {

StepReadings::StepReadings(const StepRows& rows, const FlightWatch& watch, int point)
    : size_(rows.slots() * rows.modes()),
      drives_(rows.drive().count()),
      weights_(static_cast<std::size_t>(rows_read * size_)),
      drive_(static_cast<std::size_t>(rows_read * drives_)) {
  const int modes = rows.modes(), slots = rows.slots();
  const Eigen::MatrixXd turn = rows.drive().change(1);
  const auto add_drive = [&](int at, const auto& more) {
    for (int k = 0; k < drives_; ++k) drive_[static_cast<std::size_t>(at * drives_ + k)] += more[k];
  };
  // `own` at each step, and its differences: `differ`() is what it changes by from step to step.
  const auto put_all = [&](const Eigen::RowVectorXd& own, auto&& put, auto&& differ) {
    Eigen::RowVectorXd now = own;
    for (int step = 0; step <= block; ++step) {
      put(step, now);
      now += differ(now);
    }
    now = own;
    for (int order = 0; order < differences_read; ++order) {
      put(differences_from + order, now);
      now = differ(now);
    }
  };
  Eigen::RowVectorXd change(rows.width());
  for (int mode = 0; mode < modes; ++mode)
    put_all(
        watch.rows(point, mode) * rows.of(mode, watch.stage, watch.value),
        [&](int at, const Eigen::RowVectorXd& own) {
          for (int j = 0; j < slots; ++j) weights_[static_cast<std::size_t>(at * size_ + j * modes + mode)] = own[j];
          add_drive(at, own.tail(drives_));
        },
        [&](const Eigen::RowVectorXd& own) -> const Eigen::RowVectorXd& {
          change.noalias() = own.head(slots).lazyProduct(rows.change(mode));
          if (drives_ > 0) change.tail(drives_) += own.tail(drives_).lazyProduct(turn);
          return change;
        });
  if (drives_ > 0)
    put_all(watch.drive.row(point), add_drive,
            [&](const Eigen::RowVectorXd& own) -> Eigen::RowVectorXd { return own * turn; });
}

std::vector<double> StepReadings::row() const {
  std::vector<double> row(weights_.begin(), weights_.begin() + size_);
  row.insert(row.end(), drive_.begin(), drive_.begin() + drives_);
  return row;
}

double StepReadings::operator()(int step, const double* x, const double* e) const {
  double value;
  read(step, 1, x, e, &value);
  return value;
}

void StepReadings::read(int first, int count, const double* x, const double* e, double* out) const {
  flight_kernels().dots(size_, count, weights_.data() + static_cast<std::ptrdiff_t>(first) * size_, x, out);
  for (int row = 0; row < count; ++row)
    for (int k = 0; k < drives_; ++k) out[row] += drive_[static_cast<std::size_t>((first + row) * drives_ + k)] * e[k];
}

namespace {

constexpr int block = StepReadings::block;
constexpr long long least_leap = 4;  // below it steps are read one by one

// The largest whole k with g − k s > 0 or g + k d − ½ k (k−1) z > 0, less a thousandth. So many steps cannot use up g.
// It changes by d in the next of them, at most by s in any, and its change by z.
double steps_within(double g, double d, double s, double z) {
  const double by_pace = g / s, slope = d + 0.5 * z, by_bend = (slope + std::sqrt(slope * slope + 2 * z * g)) / z;
  const double most = std::max(by_pace, by_bend);
  return most > 0 ? std::floor(0.999 * most) : 0.0;
}

// Whether gap + k d₁ + C(k, 2) d₂ + C(k, 3) d₃ − C(k, 4) m₄ > 0 for all k ≤ steps, by its Bernstein coefficients. The
// first difference that round-off hides is put at its least, −m, for all of these steps, and ends the sum.
bool stays(double gap, double sign, const double* now, const FlightBound::Differences& most, double lost,
           double steps) {
  const double bounds[] = {most.first, most.second, most.third, most.fourth};
  double d[5] = {gap, 0, 0, 0, 0};
  for (int order = 1; order <= 4; ++order) {
    const double bound = bounds[order - 1];
    const bool known = order < 4 && lost < 0.5 * bound;
    d[order] = known ? std::max(sign * now[order] - lost, -bound) : -bound;
    if (!known) break;
  }
  const double a1 = (d[1] - d[2] / 2 + d[3] / 3) * steps, a2 = (d[2] - d[3]) / 2 * (steps * steps),
               a3 = d[3] / 6 * (steps * steps * steps), a4 = d[4] / 24 * (steps * steps) * (steps * steps);
  return gap + a1 / 4 > 0 && gap + a1 / 2 + a2 / 6 > 0 && gap + 0.75 * a1 + a2 / 2 + a3 / 4 > 0 &&
         gap + a1 + a2 + a3 + a4 > 0;
}

}  // namespace

const StepReadings& ClearSteps::readings(int watch, int point) {
  readings_.resize(static_cast<std::size_t>(bound_.watches()));
  auto& points = readings_[static_cast<std::size_t>(watch)];
  points.resize(static_cast<std::size_t>(bound_.watch(watch).rows.rows()));
  auto& made = points[static_cast<std::size_t>(point)];
  if (!made) made = std::make_unique<StepReadings>(rows_, bound_.watch(watch), point);
  return *made;
}

void ClearSteps::advance(long long k) {
  motion_.advance(k, x_.data(), e_);
}

long long ClearSteps::count(const std::vector<double>& x, const double* e, long long most, long long& ask) {
  x_ = x;
  std::copy_n(e, 3, e_);
  read_ = 0;
  long long done = 0;
  while (done < most) {
    const long long left = std::min(most - done, bound_.longest());
    bound_.set_state(x_.data(), e_);
    long long k = std::min(ask, left);
    while (!bound_.find_exposed(k, exposed_, k > block ? few : static_cast<std::size_t>(-1))) k /= 2;
    const bool all = exposed_.empty();
    while (all && k < left && bound_.holds(std::min(2 * k, left))) k = std::min(2 * k, left);
    ask = std::max<long long>(k, block);
    if (all) {
      if (done + k < most) advance(k);
      done += k;
      continue;
    }
    const long long clear = follow(k);
    if (clear < k) return done + clear;
    done += k;
    ask = 2 * k;
  }
  return done;
}

// Goes on by up to `steps` steps, as long as the exposed points are between their bounds in each. The bound was set at
// where they begin. Returns over how many they are; −1: not in the first.
long long ClearSteps::follow(long long steps) {
  followed_.clear();
  for (const auto& [watch, point] : exposed_)
    followed_.push_back({&readings(watch, point), bound_.differences(watch, point),
                         bound_.watch(watch).lower[static_cast<std::size_t>(point)],
                         bound_.watch(watch).upper[static_cast<std::size_t>(point)]});
  long long gone = 0;
  while (gone < steps) {
    // Points of which enough is known are not read.
    long long clear = steps;
    for (Followed& one : followed_) {
      if (one.clear < std::min(steps, gone + least_leap)) {
        const long long more = clear_steps(one);
        if (more < 0) return gone - 1;
        one.clear = gone + more;
      }
      clear = std::min(clear, one.clear);
    }
    long long leap = clear - gone;
    if (leap >= least_leap) {
      // In one leap: what it leaves costs less than another.
      leap = static_cast<long long>(std::bit_floor(static_cast<unsigned long long>(leap)));
    } else {
      leap = std::min<long long>(block, steps - gone);
      for (int step = 1; step <= leap; ++step)
        for (const Followed& one : followed_)
          if (one.clear < gone + step && !inside(one, step)) return gone + step - 1;
    }
    advance(leap);
    gone += leap;
  }
  return steps;
}

// How many steps a point stays between its bounds from here on. It follows from where it is, how it moves now, and what
// its differences can be at most. −1: it is not between them.
long long ClearSteps::clear_steps(const Followed& one) {
  const auto& bounds = one.most;
  read_ += 4;
  double now[4];
  one.reading->differences(x_.data(), e_, now);
  const double below = now[0] - one.lower - bounds.margin, above = one.upper - now[0] - bounds.margin;
  if (!(below > 0 && above > 0)) return -1;
  // The round-off of a difference is that of the values, once a step.
  const double lost = 1e-3 * bounds.margin;
  const double by_bend = std::min(steps_within(below, now[1] - lost, bounds.first, bounds.second),
                                  steps_within(above, -now[1] - lost, bounds.first, bounds.second));
  const auto most = static_cast<long long>(std::min(by_bend, static_cast<double>(motion_.longest())));
  // Of powers of two: leaps have no other lengths.
  long long steps = most < least_leap
                        ? least_leap
                        : 2 * static_cast<long long>(std::bit_floor(static_cast<unsigned long long>(most)));
  while (steps <= motion_.longest() && stays(below, 1, now, bounds, lost, static_cast<double>(steps)) &&
         stays(above, -1, now, bounds, lost, static_cast<double>(steps)))
    steps *= 2;
  return steps / 2 > most && steps > least_leap ? steps / 2 : most;
}

// Whether it is, `step` steps on.
bool ClearSteps::inside(const Followed& one, int step) {
  ++read_;
  const double value = (*one.reading)(step, x_.data(), e_);
  return value - one.most.margin > one.lower && value + one.most.margin < one.upper;
}

}  // namespace ricochet
