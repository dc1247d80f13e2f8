#include <algorithm>
#include <cmath>
#include <ricochet/engine/flight/flight_motion.hpp>
#include <ricochet/kernels/eigenvalues.hpp>
#include <ricochet/kernels/flight_kernels.hpp>

namespace ricochet {

void double_change(Eigen::MatrixXd& change, int slots, const Eigen::MatrixXd& turn) {
  const Eigen::Index drives = change.cols() - slots;
  const Eigen::MatrixXd D = change.leftCols(slots), B = change.rightCols(drives);
  change.leftCols(slots) = 2 * D + D * D;
  if (drives > 0) change.rightCols(drives) = 2 * B + D * B + B * turn;
}

FlightMotion::FlightMotion(const StepRows& rows, int powers)
    : modes_(rows.modes()), slots_(rows.slots()), width_(rows.width()), drive_(rows.drive()) {
  const int drives = drive_.count();
  const auto n = static_cast<std::size_t>(modes_);
  tables_.assign(static_cast<std::size_t>(powers), std::vector<double>(static_cast<std::size_t>(slots_ * width_) * n));
  for (int power = 0; power < powers; ++power) {
    const Eigen::MatrixXd R = drive_.change(static_cast<double>(1LL << power));
    std::vector<double>& rotation = rotations_.emplace_back();
    for (int i = 0; i < drives; ++i)
      for (int j = 0; j < drives; ++j) rotation.push_back(R(i, j));
  }
  for (int mode = 0; mode < modes_; ++mode) {
    const Eigen::MatrixXd& change = rows.change(mode);
    for (int i = 0; i < slots_; ++i)
      for (int j = 0; j < width_; ++j)
        tables_[0][static_cast<std::size_t>(i * width_ + j) * n + static_cast<std::size_t>(mode)] = change(i, j);
  }
  for (std::size_t power = 1; power < tables_.size(); ++power)
    double_table(tables_[power - 1].data(), rotations_[power - 1].data(), tables_[power].data());
  next_.resize(static_cast<std::size_t>(slots_) * n);
}

// (2), all modes at once.
void FlightMotion::double_table(const double* change, const double* turn, double* __restrict twice) const {
  const int n = modes_, drives = width_ - slots_;
  const auto entry = [&](int i, int j) { return static_cast<std::ptrdiff_t>(i * width_ + j) * n; };
  for (int i = 0; i < slots_; ++i)
    for (int j = 0; j < width_; ++j) {
      double* const out = twice + entry(i, j);
      const auto add = [&](const double* a, auto&& factor) {
        for (int m = 0; m < n; ++m) out[m] += a[m] * factor(m);
      };
      for (int k = 0; k < slots_; ++k) {
        const double* const b = change + entry(k, j);
        add(change + entry(i, k), [b](int m) { return b[m]; });
      }
      const double* const own = change + entry(i, j);
      for (int m = 0; m < n; ++m) out[m] = 2 * own[m] + out[m];
      for (int l = 0; j >= slots_ && l < drives; ++l)
        if (const double turned = turn[l * drives + j - slots_]; turned != 0)
          add(change + entry(i, slots_ + l), [turned](int) { return turned; });
    }
}

void FlightMotion::leap(int power, double* x, double* e) const {
  if (slots_ <= FlightKernels::in_place) return leap_to(power, x, e, x);
  leap_to(power, x, e, next_.data());
  std::copy(next_.begin(), next_.end(), x);
}

void FlightMotion::leap_to(int power, const double* x, double* e, double* next) const {
  const auto at = static_cast<std::size_t>(power);
  flight_kernels().leap(modes_, slots_, drive_.count(), tables_[at].data(), x, e, next);
  double turned[3] = {};
  const int drives = drive_.count();
  for (int i = 0; i < drives; ++i) {
    turned[i] = e[i];
    for (int j = 0; j < drives; ++j) turned[i] += rotations_[at][static_cast<std::size_t>(i * drives + j)] * e[j];
  }
  std::copy_n(turned, drives, e);
}

void FlightMotion::advance(long long k, double* x, double* e) const {
  for (int power = 0; k >> power != 0; ++power)
    if ((k >> power) & 1) leap(power, x, e);
}

using Eigen::Index;
using Eigen::MatrixXd;

FlightSums& FlightSums::operator+=(const FlightSums& other) {
  damping += other.damping;
  loads += other.loads;
  scheme += other.scheme;
  contact += other.contact;
  law += other.law;
  gain = std::max(gain, other.gain);
  return *this;
}

FlightWorks::FlightWorks(const FlightMotion& motion, const Forms& forms)
    : modes_(motion.modes()),
      slots_(motion.slots()),
      drives_(motion.drive().count()),
      damping_(tables(motion, forms.damping)),
      loads_(tables(motion, forms.loads)),
      scheme_(tables(motion, forms.scheme)) {
  const int width = slots_ + drives_;
  for (int mode = 0; mode < modes_; ++mode) {
    MatrixXd lost = MatrixXd::Zero(width, width);
    for (const Form* form : {&forms.damping, &forms.scheme})
      if (!form->empty()) lost += (*form)[static_cast<std::size_t>(mode)];
    // In slots of like size.
    Eigen::VectorXd scale(width);
    for (Index a = 0; a < width; ++a) scale[a] = lost(a, a) > 0 ? 1 / std::sqrt(lost(a, a)) : 1.0;
    const MatrixXd like = scale.asDiagonal() * lost * scale.asDiagonal();
    constexpr double round_off = 1e-9;
    never_gains_ = never_gains_ && symmetric_modes(like, EigenVectors::none).values[0] >= -round_off;
  }
}

// (5), all modes at once.
FlightWorks::Tables FlightWorks::tables(const FlightMotion& motion, const Form& form) {
  Tables tables;
  if (form.empty()) return tables;
  const int slots = motion.slots(), drives = motion.drive().count(), width = slots + drives, n = motion.modes();
  const auto size = static_cast<std::size_t>(width * width) * static_cast<std::size_t>(n);
  std::vector<double> G(size), GA(size), A(size);
  const auto at = [&](std::vector<double>& all, int a, int b) {
    return all.data() + static_cast<std::ptrdiff_t>(a * width + b) * n;
  };
  for (int a = 0; a < width; ++a)
    for (int b = 0; b < width; ++b)
      for (int m = 0; m < n; ++m) at(G, a, b)[m] = form[static_cast<std::size_t>(m)](a, b);
  // out += x y
  const auto add_product = [n](const double* x, const double* y, double* __restrict out) {
    for (int m = 0; m < n; ++m) out[m] += x[m] * y[m];
  };
  for (int power = 0; power < motion.powers(); ++power) {
    std::vector<double>& table = tables.emplace_back();
    table.reserve(static_cast<std::size_t>(width * (width + 1) / 2) * static_cast<std::size_t>(n));
    for (int a = 0; a < width; ++a)
      for (int b = a; b < width; ++b)
        for (int m = 0; m < n; ++m) table.push_back((a == b ? 1.0 : 2.0) * at(G, a, b)[m]);
    std::copy_n(motion.table(power), static_cast<std::ptrdiff_t>(slots * width) * n, A.data());
    for (int a = 0; a < width; ++a) {
      for (int b = 0; b < width && a >= slots; ++b) {
        const double turned = b >= slots ? motion.rotation(power)[(a - slots) * drives + b - slots] : 0.0;
        std::fill_n(at(A, a, b), n, turned);
      }
      for (int m = 0; m < n; ++m) at(A, a, a)[m] += 1;
    }
    std::fill(GA.begin(), GA.end(), 0.0);
    for (int a = 0; a < width; ++a)
      for (int b = 0; b < width; ++b)
        for (int c = 0; c < width; ++c)
          if (c < slots || b >= slots) add_product(at(G, a, c), at(A, c, b), at(GA, a, b));
    for (int a = 0; a < width; ++a)
      for (int b = 0; b < width; ++b)
        for (int c = 0; c < width; ++c)
          if (c < slots || a >= slots) add_product(at(A, c, a), at(GA, c, b), at(G, a, b));
  }
  return tables;
}

void FlightWorks::add(int power, const double* x, const double* e, FlightSums& sums) const {
  const auto sum = [&](const Tables& tables) {
    if (tables.empty()) return 0.0;
    return flight_kernels().quadratic(modes_, slots_, drives_, tables[static_cast<std::size_t>(power)].data(), x, e);
  };
  sums.damping += sum(damping_);
  sums.loads += sum(loads_);
  sums.scheme += sum(scheme_);
}

}  // namespace ricochet
