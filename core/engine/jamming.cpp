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

void add_stage(Program& program, StageProgram& stage, std::vector<JamNumber>& numbers) {
  if (!stage.reads_contact || !stage.op || stage.friction_momentum == 0) return;
  StageDelassus plain(*stage.op, *program.model, nullptr);
  std::optional<StageImpulse> impulse;
  if (stage.impulse.op) impulse.emplace(stage.impulse, *stage.op, *program.model);
  const SemiDiscrete& problem = *program.problem;
  for (std::size_t i = 0; i < problem.rubbing.size(); ++i) {
    const RubbingPoint& one = problem.rubbing[i];
    if (one.normal_force) continue;
    const auto column = [&](int point) { return impulse ? impulse->column(point) : plain.column(point); };
    const double gives_way = given_way(program, stage, one.point);
    double coupling = 0;
    if (one.round) {
      coupling = round_coupling(one, problem.points(), column, gives_way);
    } else {
      const double* normal = column(one.point);
      coupling = coupling_along(one, {}, normal + problem.points(), normal[one.point] + gives_way);
    }
    if (coupling <= numbers[i].coupling) continue;
    const double number = std::max(one.held, one.sliding) * coupling;
    numbers[i] = number > round_off ? JamNumber{coupling, number} : JamNumber{};
  }
}

}  // namespace

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
        program.problem->stops[static_cast<std::size_t>(one.point)], std::max(one.held, one.sliding),
        program.jam[i].coupling, program.jam[i].number)};
  }
  return std::nullopt;
}

}  // namespace ricochet
