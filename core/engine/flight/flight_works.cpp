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

FlightWorks::FlightWorks(const StepRows& rows, const Forms& forms, int powers)
    : modes_(rows.modes()),
      slots_(rows.slots()),
      drives_(rows.drive().count()),
      damping_(tables(rows, forms.damping, powers)),
      loads_(tables(rows, forms.loads, powers)),
      scheme_(tables(rows, forms.scheme, powers)) {
  const int width = rows.width();
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

FlightWorks::Tables FlightWorks::tables(const StepRows& rows, const Form& form, int powers) {
  Tables tables;
  if (form.empty()) return tables;
  const int width = rows.width(), slots = rows.slots(), drives = rows.drive().count();
  const auto n = static_cast<std::size_t>(rows.modes());
  tables.assign(static_cast<std::size_t>(powers),
                std::vector<double>(static_cast<std::size_t>(width * (width + 1) / 2) * n));
  for (int mode = 0; mode < rows.modes(); ++mode) {
    MatrixXd G = form[static_cast<std::size_t>(mode)], change = rows.change(mode);
    for (int power = 0; power < powers; ++power) {
      std::size_t entry = 0;
      for (Index a = 0; a < width; ++a)
        for (Index b = a; b < width; ++b, ++entry)
          tables[static_cast<std::size_t>(power)][entry * n + static_cast<std::size_t>(mode)] =
              (a == b ? 1.0 : 2.0) * G(a, b);
      const MatrixXd turn = rows.drive().change(static_cast<double>(1LL << power));
      MatrixXd A = MatrixXd::Identity(width, width);
      A.topRows(slots) += change;
      A.bottomRightCorner(drives, drives) += turn;
      G += A.transpose() * G.eval() * A;
      double_change(change, slots, turn);
    }
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
