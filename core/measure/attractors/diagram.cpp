#include <algorithm>
#include <cmath>
#include <ricochet/measure/attractors/diagram.hpp>
#include <set>
#include <tuple>
#include <utility>

namespace ricochet {

int DiagramRun::cycle() const {
  return cycle_of(motion, period);
}

bool DiagramCase::any_decided() const {
  return std::any_of(runs.begin(), runs.end(), [](const DiagramRun& run) { return run.decided(); });
}

const DiagramRun* Diagram::run(std::size_t case_index, int value, int start) const {
  const DiagramCase& owner = cases[case_index];
  const int k = owner.at[static_cast<std::size_t>(value) * starts.size() + static_cast<std::size_t>(start)];
  return k < 0 ? nullptr : &owner.runs[static_cast<std::size_t>(k)];
}

DiagramRun* Diagram::run(std::size_t case_index, int value, int start) {
  return const_cast<DiagramRun*>(std::as_const(*this).run(case_index, value, start));
}

void Diagram::number_values() {
  std::set<double> all;
  for (const DiagramCase& owner : cases)
    for (const DiagramRun& run : owner.runs) all.insert(run.parameter);
  values.assign(all.begin(), all.end());
  for (DiagramCase& owner : cases) {
    owner.at.assign(values.size() * starts.size(), -1);
    for (std::size_t k = 0; k < owner.runs.size(); ++k) {
      DiagramRun& run = owner.runs[k];
      run.value = static_cast<int>(std::lower_bound(values.begin(), values.end(), run.parameter) - values.begin());
      owner.at[static_cast<std::size_t>(run.value) * starts.size() + static_cast<std::size_t>(run.start)] =
          static_cast<int>(k);
    }
  }
}

std::optional<std::size_t> reference_case(const Diagram& diagram) {
  std::optional<std::size_t> best;
  std::tuple<double, double, double, double> best_rank;
  for (std::size_t c = 0; c < diagram.cases.size(); ++c) {
    const DiagramCase& one = diagram.cases[c];
    if (!one.any_decided()) continue;
    const std::tuple rank(-one.compliance.value_or(INFINITY), one.steps_per_period, one.elements, one.modes);
    if (!best || rank > best_rank) {
      best = c;
      best_rank = rank;
    }
  }
  return best;
}

Agreement agreement(const DiagramCase& one, const DiagramCase& other) {
  Agreement out;
  for (std::size_t k = 0; k < one.at.size(); ++k) {
    if (one.at[k] < 0 || other.at[k] < 0) continue;
    const DiagramRun &a = one.runs[static_cast<std::size_t>(one.at[k])],
                     &b = other.runs[static_cast<std::size_t>(other.at[k])];
    if (!a.decided() || !b.decided()) continue;
    ++out.compared;
    out.same_class += a.motion == b.motion;
    out.same_attractor += a.attractor == b.attractor;
  }
  return out;
}

}  // namespace ricochet
