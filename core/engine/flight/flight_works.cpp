#include <algorithm>
#include <cmath>
#include <ricochet/algebra/eigenvalues.hpp>
#include <ricochet/algebra/flight_kernels.hpp>
#include <ricochet/engine/flight/flight_works.hpp>

namespace ricochet {

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
