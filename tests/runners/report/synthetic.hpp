#pragma once
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "runners/asks/default_asks.hpp"
#include "runners/kinds/trajectory/energy_tables.hpp"
#include "runners/run/finish_run.hpp"
#include "runners/store/record.hpp"

/// \file
/// Results as a store would hold them, made from formulas: what the report's tests are about does not depend on any
/// engine.
namespace ricochet::synthetic {

struct Shape {
  std::vector<double> steps = {1e-4, 1e-5, 1e-6};
  int samples = 200;
  int repeat = 1;  ///< values of a further axis, to make large studies
};

/// A bouncing tip: free oscillation cut at ±0.1 m.
inline double tip(double t, double phase) {
  return 0.1 * std::clamp(1.25 * std::sin(26.2 * t + phase) + 0.2 * std::sin(160 * t), -1.0, 1.0);
}

inline CaseRecord make_case(const std::string& mass, const std::string& velocity, const std::string& time, double beta,
                            double step, int extra, const Shape& shape) {
  CaseRecord record;
  record.axes = {{"mass", mass}};
  if (!velocity.empty()) record.axes.emplace_back("mass.velocity", velocity);
  record.axes.emplace_back("contact", "signorini");
  record.axes.emplace_back("time", time);
  record.axes.emplace_back("time.beta", beta);
  if (shape.repeat > 1) record.axes.emplace_back("support.amplitude", 0.01 * (extra + 1));
  record.axes.emplace_back("elements", 50);
  record.axes.emplace_back("step", step);
  record.id = mass + velocity + time + std::to_string(beta) + std::to_string(extra) + std::to_string(-std::log10(step));
  record.operator_name = "band";
  record.status = Status::done;
  record.left_out = {{"damping matrix", "no damping is given"}, {"load assembly", "no load and no support motion"}};
  if (mass == "singular" && velocity == "P0")
    record.left_out.emplace_back("factored mass", "P0 velocities give a band");
  const double duration = 0.5, start = 3.612908;
  record.steps = std::llround(duration / step);
  if (time == "newmark" && mass == "singular") {
    record.status = Status::refused;
    record.reasons = {"the implicit step is singular on the kernel of this mass <M>: use beta ≥ 1/4 & gamma ≥ 1/2"};
    record.steps = 0;
    return record;
  }
  const bool diverges = time == "newmark" && step < 5e-6;
  const double lost = mass == "consistent" ? 0.28
                      : mass == "lumped"   ? 0.2
                      : velocity == "P0"   ? 8 * std::pow(step, 0.6)
                                           : 40 * step;
  Curve& curve = record.curve;
  curve.names = {"t",      "tip_displacement", "tip_velocity",  "kinetic",     "elastic", "contact",
                 "energy", "scheme_energy",    "contact_force", "penetration", "active",  "contact_force_peak"};
  curve.columns.resize(curve.names.size());
  double energy = start;
  for (int i = 0; i <= shape.samples; ++i) {
    const double t = duration * i / shape.samples;
    const double impacts = std::floor(t / 0.06), share = 1 - std::pow(0.55, impacts);
    energy = start * (1 - lost * share);
    if (time == "newmark")
      energy = start * (1 + 0.05 * impacts) * std::exp(diverges ? 60 * t : 0.5 * t * -std::log10(step));
    if (diverges && energy > 1e9) break;
    const double x = tip(t, beta), force = std::abs(x) >= 0.1 ? 40 * (1 + std::sin(900 * t)) * (x > 0 ? -1 : 1) : 0;
    // Between two samples the force was larger than at either.
    const double row[] = {t,      x,     0, 0.4 * energy,           0.6 * energy,         0, energy,
                          energy, force, 0, force != 0 ? 1.0 : 0.0, 1.5 * std::abs(force)};
    for (size_t c = 0; c < curve.columns.size(); ++c) curve.columns[c].push_back(row[c]);
  }
  if (diverges) {
    record.status = Status::diverged;
    record.reasons = {"the energy passed 1e9 J at step 77: \"no bound\" holds"};
    return record;
  }
  record.setup_seconds = 0.0021;
  record.run_seconds = 6e-7 * static_cast<double>(record.steps);
  const double ratio = energy / start;
  record.measures = {{"scheme_energy_start", start},
                     {"scheme_energy_end", energy},
                     {"energy_start", start},
                     {"energy_end", energy},
                     {"energy_ratio", ratio},
                     {"energy_brought_in", start},
                     {"energy_left", ratio},
                     {"largest_step_gain", time == "newmark" ? 0.05 * start : 3e-14},
                     {"drift_per_impact", (energy - start) / 8},
                     {"work_of_damping", 0},
                     {"work_of_loads", 0},
                     {"dissipated_at_contact", start - energy},
                     {"balance_residual", 1e-12 * start},
                     {"deepest_penetration", mass == "singular" ? 0 : 0.03 * step},
                     {"impacts", 8},
                     {"impulse", 5.75 + lost},
                     {"tip_displacement_end", tip(duration, beta) + 10 * step},
                     {"microseconds_per_step", 0.6}};
  if (step == 1e-5) record.notes = {"the duration is no multiple of the step: the run ends at 0.49999 s"};
  return record;
}

/// The tables that the answer of a study of trajectories speaks of, from the measures that its cases have now.
inline void derive_energies(StudyResults& out) {
  out.derived = {energy_ends_table(out), energy_ledger_table(out)};
  const Choices choices(out);
  for (Table& table : evidence_tables(choices)) out.derived.push_back(std::move(table));
  const asks::Evidence evidence(choices);
  const asks::Asked asked =
      asks::answer_asks(asks::asks_of_measures(evidence, observed_measures(out), false), evidence, {});
  out.derived.push_back(asks::verdicts_table(asked));
  out.derived.push_back(asked_table(choices, asked));
}

/// Masses × time methods × steps, some refused, some diverged.
inline StudyResults results(const Shape& shape = {}) {
  StudyResults out;
  out.name = "energy-undamped";
  out.question = "Which mass matrix keeps the energy as the step is refined?";
  out.kind = "trajectory";
  out.study = {{"name", out.name},
               {"scene", {{"stops", {{"lower", "-0.1"}, {"upper", "0.1"}, {"at", "tip"}}}}},
               {"duration", 0.5}};
  out.columns = {"mass", "mass.velocity", "contact", "time", "time.beta", "elements", "step"};
  if (shape.repeat > 1) out.columns.insert(out.columns.begin() + 5, "support.amplitude");
  out.environment.entries = {
      {"program", "0.1.0"}, {"compiler", "GNU 12.2.0"}, {"flags", "-O3"}, {"processor", "a processor, 2 cores"}};
  const std::pair<const char*, const char*> masses[] = {
      {"consistent", ""}, {"lumped", ""}, {"singular", "P1"}, {"singular", "P0"}};
  const std::pair<const char*, double> times[] = {
      {"newmark-dumont-paoli", 0.25}, {"newmark-dumont-paoli", 0.5}, {"newmark", 0.25}};
  for (const auto& [mass, velocity] : masses)
    for (const auto& [time, beta] : times)
      for (int extra = 0; extra < shape.repeat; ++extra)
        for (const double step : shape.steps)
          out.cases.push_back(make_case(mass, velocity, time, beta, step, extra, shape));
  out.expected_cases = static_cast<int>(out.cases.size());
  derive_energies(out);
  return out;
}

/// How often a text has a part.
inline std::size_t count(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; at += part.size()) ++n;
  return n;
}

}  // namespace ricochet::synthetic
