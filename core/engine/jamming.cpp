#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <ricochet/contract/said_format.hpp>
#include <ricochet/engine/jamming.hpp>
#include <ricochet/engine/stage_friction.hpp>
#include <ricochet/scene/stop_parameters.hpp>

namespace ricochet {
namespace {

constexpr double round_off = 1e-9;

// The least 1/(ηκ) over lanes; 0 where the law is rigid or not linear.
double given_way(const Program& program, const StageProgram& stage, int point) {
  if (!program.law->reads()) return 0;
  double most = 0;
  for (int lane = 0; lane < static_cast<int>(program.lanes.size()); ++lane) {
    const auto slopes = program.law->linear_slopes(program.law_set(point, lane));
    if (!slopes) return 0;
    most = std::max(most, slopes->stiffness + slopes->before);
  }
  return most > 0 && stage.measure_z > 0 ? 1 / (stage.measure_z * most) : 0.0;
}

// |W_nt| over `own`, W_nn and what gives way; `rubbed`: a column of W along n, of the rows that rub.
double coupling_along(const RubbingPoint& one, const std::array<double, 2>& normal, const double* rubbed, double own) {
  double across = 0;
  for (int tangent = 0; tangent < one.tangents(); ++tangent) {
    const Tangent way = tangent_of(one, tangent, normal);
    across = std::hypot(across, way.of(rubbed + way.row));
  }
  return own > 0 ? across / own : 0.0;
}

// That of the direction of a circle in which it is largest.
template <class Columns>
double round_coupling(const RubbingPoint& one, int points, const Columns& column_of, double gives_way) {
  constexpr int directions = 180;
  std::array<std::vector<double>, 2> columns;  // a column holds till the next one is asked for
  for (const int axis : {0, 1}) {
    const double* column = column_of(one.point + axis);
    columns[static_cast<std::size_t>(axis)].assign(column, column + points + one.row + one.rows);
  }
  double most = 0;
  std::vector<double> turned(columns[0].size());
  for (int k = 0; k < directions; ++k) {
    const double angle = std::numbers::pi * k / directions;
    const std::array<double, 2> normal{std::cos(angle), std::sin(angle)};
    for (std::size_t row = 0; row < turned.size(); ++row)
      turned[row] = normal[0] * columns[0][row] + normal[1] * columns[1][row];
    const auto at = static_cast<std::size_t>(one.point);
    const double own = normal[0] * turned[at] + normal[1] * turned[at + 1] + gives_way;
    most = std::max(most, coupling_along(one, normal, turned.data() + points, own));
  }
  return most;
}

// W_tt along the coupling; of a flat point.
double along_coupling(const RubbingPoint& one, const double* normal, const auto& column_of, int points) {
  double squares = 0, sum = 0;
  for (int a = 0; a < one.rows; ++a) {
    const double* column = column_of(points + one.row + a);
    for (int b = 0; b < one.rows; ++b) sum += normal[one.row + a] * column[points + one.row + b] * normal[one.row + b];
    squares += normal[one.row + a] * normal[one.row + a];
  }
  return squares > 0 ? sum / squares : 0.0;
}

void add_stage(Program& program, StageProgram& stage, std::vector<JamNumber>& numbers) {
  if (!stage.reads_contact || !stage.op || stage.friction_momentum == 0) return;
  StageDelassus plain(*stage.op, *program.model, nullptr);
  std::optional<StageImpulse> impulse;
  if (stage.impulse.op) impulse.emplace(stage.impulse, *stage.op, *program.model);
  const SemiDiscrete& problem = *program.problem;
  for (std::size_t i = 0; i < problem.rubbing.size(); ++i) {
    const RubbingPoint& one = problem.rubbing[i];
    if (one.given.normal_force) continue;
    const auto column = [&](int point) { return impulse ? impulse->column(point) : plain.column(point); };
    const double gives_way = given_way(program, stage, one.point);
    JamNumber found;
    double& coupling = found.coupling;
    if (one.round) {
      coupling = round_coupling(one, problem.points(), column, gives_way);
    } else {
      const double* kept = column(one.point);  // a column holds till the next one is asked for
      const std::vector<double> normal(kept, kept + problem.points() + one.row + one.rows);
      const double own = normal[static_cast<std::size_t>(one.point)] + gives_way;
      coupling = coupling_along(one, {}, normal.data() + problem.points(), own);
      if (!program.law->reads() && own > 0)
        found.across = along_coupling(one, normal.data() + problem.points(), column, problem.points()) / own;
    }
    if (coupling <= numbers[i].coupling) continue;
    for (const LaneSpec& lane : program.lanes) found.mu = std::max(found.mu, lane.rubbing[i].largest());
    found.number = found.mu * coupling;
    numbers[i] = found.number > round_off ? found : JamNumber{};
  }
}

// One impact of a point at −1 m/s along its normal and τ along its coupling c, d across, W_nn = 1: E after over E
// before.
struct ObliqueImpact {
  double coupling, across, mu, restitution;

  double energy(double normal, double tangent) const {
    return across * normal * normal - 2 * coupling * normal * tangent + tangent * tangent;
  }
  /// What sliding against `way` leaves along the tangent, less τ.
  double slid(double way) const {
    return (1 + restitution) * (coupling - way * mu * across) / (1 - way * mu * coupling);
  }
  double kept(double tau) const {
    const double up = slid(1), down = slid(-1);
    const double after = tau + up > 0 ? tau + up : tau + down < 0 ? tau + down : 0.0;
    return energy(restitution, after) / energy(-1, tau);
  }
};

}  // namespace

double largest_gain(const JamNumber& point, double restitution) {
  const double c = point.coupling, d = point.across;
  if (c == 0 || restitution == 0 || !(d > c * c)) return 0;
  const ObliqueImpact impact{c, d, point.mu, restitution};
  double most = std::max(impact.kept(-c), 1.0);
  for (const double way : {1.0, -1.0}) {
    // While it slides both energies are quadratic in τ: τ² + 2Aτ + B over τ² + 2cτ + d.
    const double k = impact.slid(way), A = k - c * restitution, B = impact.energy(restitution, k);
    const double a = c - A, b = d - B, e = A * d - c * B, root = b * b - 4 * a * e;
    most = std::max(most, impact.kept(-k));
    if (a == 0 || root < 0) continue;
    for (const double sign : {1.0, -1.0}) most = std::max(most, impact.kept((-b + sign * std::sqrt(root)) / (2 * a)));
  }
  return most - 1;
}

std::vector<JamNumber> jam_numbers(Program& program) {
  std::vector<JamNumber> numbers(program.problem->rubbing.size());
  std::vector<Parameters> lanes;
  for (const LaneSpec& lane : program.lanes) lanes.push_back(lane.law);
  prepare_law(*program.law, program.problem->points(), lanes, program.problem->own);
  for (StageProgram& stage : program.stages) add_stage(program, stage, numbers);
  return numbers;
}

std::optional<Refusal> refuse_jamming(Program& program) {
  program.jam = jam_numbers(program);
  for (std::size_t i = 0; i < program.jam.size(); ++i) {
    const RubbingPoint& one = program.problem->rubbing[i];
    if (program.jam[i].number < 1) continue;
    return Refusal{said(
        "stop {} may jam: μ = {:.4g} times the coupling {:.4g} of its normal and tangent is {:.4g}, and 1 or more has "
        "several motions. Use a smaller friction",
        program.problem->stops[static_cast<std::size_t>(one.point)], program.jam[i].mu, program.jam[i].coupling,
        program.jam[i].number)};
  }
  return std::nullopt;
}

}  // namespace ricochet
