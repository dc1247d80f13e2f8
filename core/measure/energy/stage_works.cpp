#include <algorithm>
#include <array>
#include <cmath>
#include <ricochet/algebra/flight_kernels.hpp>
#include <ricochet/measure/energy/stage_works.hpp>

namespace ricochet {
namespace {

constexpr int unknown_z = -1, unknown_w = -2;

}  // namespace

Works& Works::operator+=(const Works& other) {
  loads += other.loads;
  damping += other.damping;
  contact += other.contact;
  scheme += other.scheme;
  law += other.law;
  return *this;
}

StageWorks::StageWorks(const Marcher& marcher)
    : model_(*marcher.program().model),
      kernels_(lane_kernels(1)),
      damping_(model_.problem().damping),
      T_(marcher.width()),
      displacement_(model_.rows(), 1),
      rate_(model_.rows(), 1) {
  const StepPlan& plan = marcher.program().plan;
  const double pulsation = model_.problem().support.pulsation, h = marcher.program().h;
  for (const Stage& stage : plan.start) start_.push_back(describe(stage, pulsation, h));
  for (const Stage& stage : plan.stages) stages_.push_back(describe(stage, pulsation, h));
}

StageWorks::Terms StageWorks::terms_of(const Combination& c) {
  Terms terms;
  const auto add = [&](int which, double weight) {
    if (weight == 0) return;
    terms.which.push_back(which);
    terms.weight.push_back(weight);
  };
  for (std::size_t j = 0; j < c.slots.size(); ++j) add(static_cast<int>(j), c.slots[j]);
  add(unknown_z, c.z);
  add(unknown_w, c.w);
  return terms;
}

StageWorks::StageTerms StageWorks::describe(const Stage& plan, double pulsation, double h) const {
  StageTerms stage;
  for (const LossTerm& term : plan.loss) stage.losses.push_back(terms_of(term.value));
  if (!plan.work) return stage;
  stage.displacement = terms_of(plan.work->displacement);
  stage.rate = terms_of(plan.work->rate);
  stage.load = PhaseWeights(plan.work->load, pulsation, h);
  stage.support = PhaseWeights(plan.work->support, pulsation, h);
  const std::vector<double>&s = stage.displacement.weight, &r = stage.rate.weight;
  if (s.empty() || stage.rate.which != stage.displacement.which) return stage;
  const double ratio = r[0] / s[0];
  constexpr double round_off = 1e-14;
  const bool parallel = std::equal(s.begin(), s.end(), r.begin(), [&](double a, double b) {
    return std::abs(b - ratio * a) <= round_off * std::abs(b);
  });
  if (parallel) stage.along = ratio;
  return stage;
}

// The lane's numbers of a combination; where they stand already, they are not copied.
const double* StageWorks::combine(const StageView& view, const Terms& terms, int lane, Block& out) const {
  std::array<const double*, most_slots + 2> x;
  std::array<double, most_slots + 2> weight;
  int count = 0;
  for (std::size_t k = 0; k < terms.which.size(); ++k) {
    const int which = terms.which[k];
    const double* from = which >= 0 ? view.slots[which] : which == unknown_z ? view.z : view.w;
    if (!from) continue;  // nothing jumped
    x[static_cast<std::size_t>(count)] = from;
    weight[static_cast<std::size_t>(count++)] = terms.weight[k];
  }
  if (T_ == 1 && count == 1 && weight[0] == 1) return x[0];
  if (T_ == 1 && count > 0 && count <= most_lane_slots) {
    kernels_.combine(static_cast<long>(out.size()), count, x.data(), weight.data(), out.data());
    return out.data();
  }
  out.fill(0.0);
  const auto T = static_cast<std::size_t>(T_), l = static_cast<std::size_t>(lane);
  for (int k = 0; k < count; ++k) {
    const double w = weight[static_cast<std::size_t>(k)];
    const double* from = x[static_cast<std::size_t>(k)];
    for (std::size_t i = 0; i < out.size(); ++i) out.data()[i] += w * from[i * T + l];
  }
  return out.data();
}

void StageWorks::add(const Marcher& marcher, const StageView& view, int lane, const Forms& forms, bool losses,
                     bool acting, Works& works) {
  const StageTerms& stage = (view.starting ? start_ : stages_)[static_cast<std::size_t>(view.stage)];
  for (std::size_t k = 0; losses && k < stage.losses.size(); ++k) {
    const LossTerm& term = view.plan->loss[k];
    if (term.coefficient == 0) continue;
    const double* value = combine(view, stage.losses[k], lane, displacement_);
    works.scheme += term.coefficient * (term.matrix == EnergyMatrix::M ? forms.mass : forms.stiffness).swift(value);
  }
  if (!view.plan->work) return;
  const Program& program = marcher.program();
  const bool damped = damping_.stiffness != 0 || damping_.mass != 0;
  const bool contact = view.effort && (acting || ((view.contact_lanes >> lane) & 1u));
  if (!program.support && !program.load && !damped && !contact) return;
  const double* s = combine(view, stage.displacement, lane, displacement_);
  const double* shape = program.support ? model_.support_shape().data() : nullptr;
  double along = 0;
  if (damped && stage.along != 0) {
    // The form that is asked for takes the shape along.
    const bool both = damping_.stiffness != 0 && damping_.mass != 0;
    const QuadraticForm& first = damping_.stiffness != 0 ? forms.stiffness : forms.mass;
    const double weight = damping_.stiffness != 0 ? damping_.stiffness : damping_.mass;
    works.damping += weight * (stage.along * first.swift(s, shape, &along));
    if (both) works.damping += damping_.mass * (stage.along * forms.mass.swift(s));
  } else {
    if (damped) {
      const double* r = combine(view, stage.rate, lane, rate_);
      if (damping_.stiffness != 0) works.damping += damping_.stiffness * forms.stiffness(s, r);
      if (damping_.mass != 0) works.damping += damping_.mass * forms.mass(s, r);
    }
    if (shape) along = flight_kernels().dot(model_.rows(), shape, s);
  }
  if (program.support) {
    // −φ'' = ω² φ for the harmonic support.
    const double omega = model_.problem().support.pulsation;
    works.loads += omega * omega * marcher.support(lane, stage.load) * along;
  }
  if (program.load) {
    const double* load = const_cast<Marcher&>(marcher).distributed_load(view.plan->work->load, view.time);
    works.loads += flight_kernels().dot(model_.rows(), load, s);
  }
  if (contact) add_contact(marcher, view, stage, lane, s, works);
}

void StageWorks::add_contact(const Marcher& marcher, const StageView& view, const StageTerms& stage, int lane,
                             const double* s, Works& works) const {
  const std::vector<double>& weights = view.program->work_effort;
  const double lift = marcher.program().support ? marcher.support(lane, stage.support) : 0.0;
  const auto add_point = [&](int j) {
    double effort = 0;
    for (int k = 0; k < std::min(static_cast<int>(weights.size()), view.efforts); ++k)
      if (view.effort[k]) effort += weights[static_cast<std::size_t>(k)] * view.effort[k][j * T_ + lane];
    if (effort == 0) return;
    works.contact += effort * (model_.measured().times(j, s) + lift);
    works.loads -= effort * lift;
  };
  if (weights.size() > 1)
    for (int j = 0; j < model_.problem().points(); ++j) add_point(j);
  else
    for (const int j : view.pushed) add_point(j);
}

}  // namespace ricochet
