#include <algorithm>
#include <cmath>
#include <ricochet/engine/march_loads.hpp>
#include <set>
#include <utility>

namespace ricochet {

namespace {

// Times of a step at which the load is asked, of stages and of their work forms.
std::size_t distinct_load_levels(const StepPlan& plan) {
  std::set<long long> levels;
  const auto add = [&](const Levels& list) {
    for (const Level& level : list) levels.insert(std::llround(level.at * 1e6));
  };
  for (const auto* stages : {&plan.start, &plan.stages})
    for (const Stage& stage : *stages) {
      add(stage.load);
      if (stage.work) add(stage.work->load);
    }
  return levels.size();
}

}  // namespace

LoadWindow::LoadWindow(const Program& program)
    : problem_(program.problem.get()), model_(program.model.get()), h_(program.h), constant_(program.load_constant) {
  const auto rows = static_cast<std::size_t>(model_->rows());
  entries_.resize(distinct_load_levels(program.plan) + 1);
  for (Entry& entry : entries_) entry.value.resize(rows);
  sum_.resize(rows);
  nodal_.resize(rows);
  const DistributedLoad& load = *problem_->load;
  for (int k = 0; k < load.terms(); ++k) model_->load_to_model(load.shape(k).data(), terms_.emplace_back(rows).data());
}

// What scales is brought into model coordinates once, and costs a multiply-add per dof.
void LoadWindow::assemble(double t, std::vector<double>& out) {
  const DistributedLoad& load = *problem_->load;
  if (load.has_formula()) {
    load.assemble_formula(t, nodal_.data());
    model_->load_to_model(nodal_.data(), out.data());
  } else {
    std::fill(out.begin(), out.end(), 0.0);
  }
  for (std::size_t k = 0; k < terms_.size(); ++k) {
    const double scale = load.scale(static_cast<int>(k), t);
    for (std::size_t i = 0; i < out.size(); ++i) out[i] += scale * terms_[k][i];
  }
}

const double* LoadWindow::sum(const Levels& levels, double t) {
  std::fill(sum_.begin(), sum_.end(), 0.0);
  for (const Level& level : levels) {
    const double key = constant_ ? 0.0 : t / h_ + level.at;
    auto found = std::find_if(entries_.begin(), entries_.end(),
                              [&](const Entry& entry) { return std::abs(entry.level - key) < 1e-6; });
    if (found == entries_.end()) {
      found = std::min_element(entries_.begin(), entries_.end(),
                               [](const Entry& a, const Entry& b) { return a.used < b.used; });
      found->level = key;
      assemble(t + level.at * h_, found->value);
    }
    found->used = ++clock_;
    for (std::size_t i = 0; i < sum_.size(); ++i) sum_[i] += level.weight * found->value[i];
  }
  return sum_.data();
}

ClampMotion::ClampMotion(double pulsation, int width)
    : pulsation_(pulsation), amplitude_(1, width), cos_phase_(1, width), sin_phase_(1, width) {}

void ClampMotion::place(int lane, double amplitude, double phase) {
  amplitude_.at(0, lane) = amplitude;
  cos_phase_.at(0, lane) = std::cos(phase);
  sin_phase_.at(0, lane) = std::sin(phase);
  phases_ = phases_ || phase != 0;
}

void ClampMotion::set_time(double t) {
  if (t == time_) return;
  time_ = t;
  sine_ = std::sin(pulsation_ * t);
  cosine_ = std::cos(pulsation_ * t);
}

void ClampMotion::set_step(long long step, double h) {
  const auto at = static_cast<std::size_t>(step);
  const double t = static_cast<double>(step) * h;
  if (at >= known_.size()) return set_time(t);
  Known& known = known_[at];
  if (!(known.sine == known.sine)) known = {std::sin(pulsation_ * t), std::cos(pulsation_ * t)};
  time_ = t;
  sine_ = known.sine;
  cosine_ = known.cosine;
}

void ClampMotion::expect(long long last_step) {
  constexpr long long most = 1 << 17;  // 2 MB
  if (const auto size = static_cast<std::size_t>(std::min(last_step, most) + 1); size > known_.size())
    known_.resize(size);
}

void ClampMotion::offsets(const PhaseWeights& phase, double* out, bool rate) const {
  double s = sine_ * phase.along + cosine_ * phase.across, c = cosine_ * phase.along - sine_ * phase.across;
  if (rate) {
    std::swap(s, c);
    s *= pulsation_;
    c *= -pulsation_;
  }
  for (int lane = 0; lane < amplitude_.lanes(); ++lane)
    out[lane] = amplitude_.at(0, lane) * (phases_ ? s * cos_phase_.at(0, lane) + c * sin_phase_.at(0, lane) : s);
}

void ClampMotion::accelerations(const PhaseWeights& phase, double* out) const {
  offsets(phase, out, false);
  for (int lane = 0; lane < amplitude_.lanes(); ++lane) out[lane] *= pulsation_ * pulsation_;
}

}  // namespace ricochet
