#pragma once
#include <cmath>
#include <string>
#include <vector>

#include "runners/kinds/continuation/branch_orbits.hpp"
#include "runners/store/record.hpp"

/// \file
/// A study of kind `continuation` made from formulas: points that move with known powers of step, mesh and compliance.
namespace ricochet::synthetic {

/// What the points of the synthetic study go to.
struct PointLaw {
  double fold = 0.1005653, contact = 0.07917924475, torus = 0.08495;
  double of_step = 279.2, of_mesh = 0.1, mesh_order = 3.8, of_compliance = 11;  ///< of the fold
  double noise = 1e-7;  ///< half intervals of fold and first contact
  double spread = 0;    ///< of_step of one mass and stop over that of the one before, less 1
};

/// Portraits of every fifth orbit: a circle of the tip over half a period, between stops that push at its ends.
inline void add_portraits(CaseRecord& record, const std::vector<BranchRow>& rows) {
  NumberTable portraits = branch_portraits_type().head(), samples = branch_samples_type().head(),
              runs = branch_runs_type().head();
  std::vector<std::string> names;
  constexpr int count = 20;
  for (const BranchRow& row : rows) {
    if (names.empty() || names.back() != row.branch) names.push_back(row.branch);
    if (row.row % 5 != 0 && !row.point) continue;
    const double branch = static_cast<double>(names.size()) - 1, at = static_cast<double>(row.row);
    portraits.add({branch, at, count, -0.1, 0.1});
    for (int k = 0; k < count; ++k) {
      const double phase = 3.14159265358979323846 * k / count;
      samples.add({*row.tip_displacement + 0.1 * std::sin(phase), std::cos(phase)});
    }
    runs.add({branch, at, 1.501, 1, 0.1, 0.2, 0.05});
    runs.add({branch, at, 1.501, 0, -0.1, 0.7, 0.05});
  }
  for (NumberTable* table : {&portraits, &runs}) table->words = {{"branch", names}};
  record.numbers = {std::move(portraits), std::move(samples), std::move(runs)};
}

/// A case with one branch both ways from λ = 0.08: up to the fold and back, down through the first contact.
inline CaseRecord points_case(const std::string& mass, double stiffness, int elements, int steps,
                              const PointLaw& law = {}) {
  CaseRecord record;
  record.axes = {{"mass", mass}, {"contact", stiffness > 0 ? "spring" : "rigid"}};
  record.axes.emplace_back("contact.stiffness",
                           stiffness > 0 ? nlohmann::ordered_json(stiffness) : nlohmann::ordered_json(nullptr));
  record.axes.emplace_back("time", "three-level");
  record.axes.emplace_back("elements", elements);
  record.axes.emplace_back("steps_per_period", steps);
  record.id = mass + std::to_string(static_cast<long long>(stiffness)) + "-" + std::to_string(elements) + "-" +
              std::to_string(steps);
  record.status = Status::done;
  const double h2 = 1.0 / steps / steps, compliance = stiffness > 0 ? 1 / stiffness : 0;
  const bool folds = !(mass == "rough" && elements == 10);
  const double method = (mass == "rough" ? 4 : 0) + (stiffness > 0 ? std::log10(stiffness) - 3 : 0);
  double fold = law.fold - law.of_step * std::pow(1 + law.spread, method) * h2 -
                law.of_mesh * std::pow(elements, -law.mesh_order) - law.of_compliance * compliance -
                (mass == "rough" ? 3e-5 : 0);
  // The softest stop has another fold.
  if (stiffness > 0 && stiffness < 2e4) fold = 0.0931;
  const double contact = law.contact - 0.0466 * h2, torus = law.torus + 40 * h2, start = 0.08;
  std::vector<BranchRow> rows;
  std::vector<SpecialRow> points;
  const auto add_row_at = [&](const std::string& branch, double arc, double parameter, double tip, int unstable) {
    BranchRow row;
    row.branch = branch;
    row.row = rows.empty() || rows.back().branch != branch ? 0 : rows.back().row + 1;
    row.arc = arc;
    row.parameter = parameter;
    row.tip_displacement = tip;
    row.tip_velocity = 10 * parameter;
    row.symmetric = true;
    row.stable = unstable == 0;
    row.unstable = unstable;
    const double size = unstable > 0 ? 1.05 + 8 * std::abs(parameter - torus) : 1 - 12 * std::abs(parameter - torus);
    row.half_step_pair = std::complex<double>(-0.6 * size, 0.8 * size);
    row.multipliers = {std::complex<double>(-0.6 * size, 0.8 * size), std::complex<double>(-0.6 * size, -0.8 * size),
                       std::complex<double>(0.3, 0), std::complex<double>(-0.1, 0.05)};
    row.impacts_per_period = parameter > contact ? 2 : 0;
    row.contact_runs = parameter > contact ? 2 : 0;
    row.iterations = 2;
    row.residual = 1e-14;
    row.pieces = 10;
    row.direction = 1;
    rows.push_back(row);
  };
  const auto add_point = [&](const std::string& branch, PointKind kind, double arc, double parameter, double tip,
                             double half) {
    SpecialRow row;
    row.branch = branch;
    row.point = 1 + static_cast<int>(std::count_if(points.begin(), points.end(),
                                                   [&](const SpecialRow& one) { return one.branch == branch; }));
    row.kind = kind;
    row.parameter = parameter;
    row.low = parameter - half;
    row.high = parameter + half;
    row.arc = arc;
    row.tip_displacement = tip;
    rows.back().point = row.point;
    points.push_back(row);
  };
  constexpr int count = 120;
  const double top = folds ? fold : 0.125, length = top - start;
  bool turned = false, round = false;
  for (int k = 0; k <= count; ++k) {
    // Along the branch the parameter rises to its turn and falls back to 0.082.
    const double s = 1.9 * length * k / count, back = std::max(0.0, s - length);
    const double parameter = folds ? top - std::pow((length - s) / length, 2) * length : start + 0.526 * s;
    const double tip = 0.004 - 0.12 * s;
    if (!round && parameter >= torus) {
      round = true;
      add_row_at("orbit-1+", s, torus, 0.004 - 0.12 * s, 0);
      add_point("orbit-1+", PointKind::torus, s, torus, -0.001, 3e-5);
      points.back().angle = std::atan2(0.8, -0.6);
      points.back().crossings = 9;
    }
    if (folds && !turned && back > 0) {
      turned = true;
      add_row_at("orbit-1+", length, top, 0.004 - 0.12 * length, 2);
      add_point("orbit-1+", PointKind::fold, length, top, 0.004 - 0.12 * length, law.noise);
      points.back().prominence = 0.018;
      points.back().side = "below";
    }
    // Stable up to the torus, and again from 0.0958 to the fold.
    add_row_at("orbit-1+", s, parameter, tip, back > 0 ? 1 : parameter > torus && parameter < 0.0958 ? 2 : 0);
  }
  add_point("orbit-1+", PointKind::end, *rows.back().arc, *rows.back().parameter, *rows.back().tip_displacement, 0);
  points.back().note = "range";
  for (int k = 0; k <= count; ++k) {
    const double s = 0.02 * k / count, parameter = start - s;
    if (k > 0 && parameter < contact && parameter + 0.02 / count >= contact) {
      add_row_at("orbit-1−", start - contact, contact, 0.004 + 0.1 * (start - contact), 0);
      add_point("orbit-1−", PointKind::contact, start - contact, contact, 0.004 + 0.1 * (start - contact),
                law.noise / 100);
      points.back().runs_before = 2;
      points.back().runs_after = 0;
      points.back().contact_phase = 1.2;
      points.back().contact_x = 1.501;
    }
    add_row_at("orbit-1−", s, parameter, 0.004 + 0.1 * s, 0);
  }
  add_point("orbit-1−", PointKind::end, 0.02, 0.06, 0.006, 0);
  points.back().note = "range";
  std::vector<TurnRow> turns;
  for (int k = 0; k <= 12; ++k) {
    const double prominence = 1e-6 * std::pow(10, k / 3.0);
    const double invented = 2e-2 * std::pow(steps / 2000.0, -3) / prominence;
    turns.push_back({record.id, "orbit-1+", prominence,
                     (folds ? 1 : 0) + static_cast<int>(prominence < 2e-4 ? invented * 1e-2 : 0)});
  }
  record.tables = {branches_type(4).with(rows), special_points_type().with(points), turns_type().with(turns)};
  add_portraits(record, rows);
  return record;
}

/// Two mass matrices, rigid stops and three springs, two meshes, three steps; and a case that was refused.
inline StudyResults points(const std::vector<int>& steps = {2000, 4000, 8000}, const PointLaw& law = {}) {
  StudyResults out;
  out.name = "points";
  out.question = "Where do orbits fold, whatever the method?";
  out.kind = "continuation";
  out.columns = {"mass", "contact", "contact.stiffness", "time", "elements", "steps_per_period"};
  out.study = {{"parameter", {{"pointer", "/scene/support/amplitude"}, {"from", 0.06}, {"to", 0.12}}}};
  for (const std::string mass : {"smooth", "rough"})
    for (const double stiffness : {0.0, 1e4, 1e5, 1e6})
      for (const int elements : {10, 20})
        for (const int count : steps) out.cases.push_back(points_case(mass, stiffness, elements, count, law));
  CaseRecord refused = out.cases.front();
  refused.id = "refused";
  refused.axes[0].second = "none at all";
  refused.status = Status::refused;
  refused.reasons = {"nothing to follow"};
  refused.tables.clear();
  out.cases.push_back(std::move(refused));
  out.expected_cases = static_cast<int>(out.cases.size());
  return out;
}

}  // namespace ricochet::synthetic
