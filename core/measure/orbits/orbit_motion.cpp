#include <algorithm>
#include <ricochet/measure/orbits/orbit_motion.hpp>

namespace ricochet {
namespace {

// What lane 0 does in each step: its tip, and the impulses of its points.
class MotionWatch final : public StepObserver {
 public:
  MotionWatch(const Marcher& marcher, OrbitMotion& motion) : motion_(motion), before_(marcher.step()) {}

  void stage_solved(const Marcher& marcher, const StageView& view) override {
    if (!view.effort || !view.effort[0] || (view.contact_lanes & 1u) == 0) return;
    for (const int point : view.pushed)
      if (const double p = view.effort[0][static_cast<std::ptrdiff_t>(point) * marcher.width()]; p != 0)
        pushed_.push_back({point, p < 0, 0, 1, view.program->momentum * p});
  }
  void step_done(Marcher& marcher) override {
    double sum = 0;
    for (const ContactRun& one : pushed_) {
      sum += one.impulse;
      add(one, marcher.step() - before_);
    }
    if (!pushed_.empty()) motion_.penetration = std::max(motion_.penetration, marcher.penetration(0));
    pushed_.clear();
    motion_.time.push_back(marcher.time());
    motion_.displacement.push_back(marcher.tip(0));
    motion_.force.push_back(sum / marcher.program().h);
  }

 private:
  void add(const ContactRun& one, long long step) {
    // The latest run of the point goes on, or a new one begins.
    const auto last = std::find_if(motion_.runs.rbegin(), motion_.runs.rend(),
                                   [&](const ContactRun& run) { return run.point == one.point; });
    if (last != motion_.runs.rend() && last->upper == one.upper && last->begin + last->steps >= step) {
      last->steps = step - last->begin + 1;
      last->impulse += one.impulse;
      return;
    }
    motion_.runs.push_back(one);
    motion_.runs.back().begin = step;
  }

  OrbitMotion& motion_;
  long long before_;
  std::vector<ContactRun> pushed_;
};

// A run that goes on over the strobe is one.
void join_ends(std::vector<ContactRun>& runs, long long steps) {
  for (std::size_t i = 0; i < runs.size(); ++i) {
    ContactRun& first = runs[i];
    if (first.begin != 1 || first.steps >= steps) continue;
    const auto last = std::find_if(runs.begin(), runs.end(), [&](const ContactRun& run) {
      return &run != &first && run.point == first.point && run.upper == first.upper &&
             run.begin + run.steps == steps + 1;
    });
    if (last == runs.end()) continue;
    last->steps += first.steps;
    last->impulse += first.impulse;
    runs.erase(runs.begin() + static_cast<std::ptrdiff_t>(i));
    --i;
  }
}

}  // namespace

OrbitMotion march_orbit(Marcher& marcher, long long steps, StepObserver* beside) {
  OrbitMotion motion;
  for (auto* const column : {&motion.time, &motion.displacement, &motion.velocity, &motion.force})
    column->reserve(static_cast<std::size_t>(steps) + 1);
  motion.time.push_back(marcher.time());
  motion.displacement.push_back(marcher.tip(0));
  motion.force.push_back(0);
  MotionWatch watch(marcher, motion);
  Observers observers(&watch);
  observers.add(beside);
  marcher.march(steps, observers);
  motion.end = marcher.status(0).end;
  motion.force.front() = motion.force.back();
  const std::size_t last = motion.time.size() - 1;
  const double h = marcher.program().h;
  for (std::size_t k = 0; k <= last; ++k) {
    const double before = motion.displacement[k > 0 ? k - 1 : last - std::min<std::size_t>(last, 1)],
                 after = motion.displacement[k < last ? k + 1 : std::min<std::size_t>(last, 1)];
    motion.velocity.push_back((after - before) / (2 * h));
  }
  join_ends(motion.runs, steps);
  std::stable_sort(motion.runs.begin(), motion.runs.end(),
                   [](const ContactRun& a, const ContactRun& b) { return a.point < b.point; });
  return motion;
}

}  // namespace ricochet
