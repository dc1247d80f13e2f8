#include "runners/march/struck_together.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <ricochet/contract/said_format.hpp>
#include <ricochet/engine/marcher.hpp>
#include <ricochet/engine/stage_delassus.hpp>
#include <set>

namespace ricochet {
namespace {

// The columns of W of the first stage that the law looks at.
std::unique_ptr<DelassusColumns> columns_of(const Program& program) {
  for (const StageProgram& stage : program.stages) {
    if (!stage.reads_contact || !stage.op) continue;
    if (stage.impulse.op) return std::make_unique<StageImpulse>(stage.impulse, *stage.op, *program.model);
    return std::make_unique<StageDelassus>(*stage.op, *program.model, nullptr);
  }
  return nullptr;
}

}  // namespace

StruckTogether::StruckTogether(const Marcher& marcher) : list_(stop_list(*marcher.program().problem)) {
  const Program& program = marcher.program();
  watches_ = program.contact && list_.count() > 1 && !program.problem->stops.empty() && !program.law->reads();
  if (watches_) pushed_.reserve(static_cast<std::size_t>(program.problem->points()));
}

void StruckTogether::instant(const ContactInstant& one) {
  if (!watches_ || !(one.given > 0)) return;
  pushed_.emplace_back(one.point, one.side == StopSide::lower ? 1 : -1);
  struck_ = struck_ || (one.closes && one.speed_in > 0);
}

void StruckTogether::over(double time) {
  if (struck_ && pushed_.size() > 1 && sets_.size() < most_sets) {
    std::sort(pushed_.begin(), pushed_.end());
    if (std::none_of(sets_.begin(), sets_.end(), [&](const auto& known) { return known.first == pushed_; }))
      sets_.emplace_back(pushed_, time);
  }
  pushed_.clear();
  struck_ = false;
}

Said StruckTogether::told(const Marcher& marcher, std::optional<double> restitution) const {
  constexpr double negligible = 1e-3;
  if (sets_.empty()) return {};
  const std::unique_ptr<DelassusColumns> columns = columns_of(marcher.program());
  if (!columns) return {};
  const auto W = [&](int i, int j) { return columns->column(j)[i]; };
  const auto stop_of = [&](int point) { return list_.stop_of[static_cast<std::size_t>(point)]; };
  std::size_t most = 0;
  double first = 0;
  for (const auto& [points, time] : sets_) {
    std::set<int> chosen;
    for (const auto& [i, sign_i] : points)
      for (const auto& [j, sign_j] : points) {
        if (stop_of(i) >= stop_of(j)) continue;
        const double coupling = sign_i * sign_j * W(i, j), size = std::sqrt(W(i, i) * W(j, j));
        const bool chooses = restitution == 0.0 ? coupling > negligible * size : std::abs(coupling) > negligible * size;
        if (chooses) chosen.insert({stop_of(i), stop_of(j)});
      }
    if (chosen.size() > most) {
      most = chosen.size();
      first = time;
    }
  }
  if (most == 0) return {};
  return said("{} contacts were struck in one step: rigid laws choose among outcomes, first at t = {:.9g} s", most,
              first);
}

}  // namespace ricochet
