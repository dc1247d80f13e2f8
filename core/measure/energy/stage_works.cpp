#include <algorithm>
#include <cmath>
#include <ricochet/algebra/flight_kernels.hpp>
#include <ricochet/measure/energy/stage_works.hpp>

namespace ricochet {
Works& Works::operator+=(const Works& other) {
  loads += other.loads;
  damping += other.damping;
  contact += other.contact;
  scheme += other.scheme;
  law += other.law;
  return *this;
}

StageWorks::StageWorks(const Marcher& marcher, const QuadraticForm& mass, const QuadraticForm& stiffness)
    : model_(*marcher.program().model),
      mass_(mass),
      stiffness_(stiffness),
      mass_form_(mass),
      stiffness_form_(stiffness),
      damping_(model_.problem().damping),
      damped_(damping_.stiffness != 0 || damping_.mass != 0),
      projected_(marcher.program().support),
      T_(marcher.width()),
      displacement_(model_.rows(), 1),
      rate_(model_.rows(), 1) {
  const double* shape = projected_ ? model_.support_shape().data() : nullptr;
  const SparseMatrix nothing(model_.rows(), model_.rows());
  first_ = CombinedForm(damping_.stiffness != 0 ? stiffness : damped_ ? mass : QuadraticForm(nothing), shape);
  const StepPlan& plan = marcher.program().plan;
  const bool alone = T_ == 1 && !marcher.program().load && (projected_ || damped_);
  const double pulsation = model_.problem().support.pulsation, h = marcher.program().h;
  for (const Stage& stage : plan.start) start_.push_back(describe(stage, pulsation, h));
  for (const Stage& stage : plan.stages) stages_.push_back(describe(stage, pulsation, h));
  for (auto* stages : {&start_, &stages_})
    for (StageTerms& stage : *stages) {
      const std::vector<int>& which = stage.displacement.which;
      const bool jumps = std::find(which.begin(), which.end(), WeighedTerms::unknown_w) != which.end();
      const bool across = damped_ && stage.along == 0;
      if (!alone || which.empty() || which.size() > CombinedForm::most_terms || jumps || across || stage.by_mass != 0 ||
          !stage.losses.empty())
        continue;
      const double scale = stage.displacement.weight[0];
      stage.passes = static_cast<int>(which.size());
      stage.by_pass = scale * scale * stage.by_first;
      stage.pass_load = stage.load;
      stage.pass_load.along *= scale;
      stage.pass_load.across *= scale;
    }
}

StageWorks::StageTerms StageWorks::describe(const Stage& plan, double pulsation, double h) const {
  StageTerms stage;
  for (const LossTerm& term : plan.loss)
    if (term.coefficient != 0) stage.losses.push_back({term.matrix, term.coefficient, WeighedTerms(term.value)});
  if (!plan.work) return stage;
  stage.displacement = WeighedTerms(plan.work->displacement);
  stage.rate = WeighedTerms(plan.work->rate);
  stage.load = PhaseWeights(plan.work->load, pulsation, h);
  stage.load.along *= pulsation * pulsation;
  stage.load.across *= pulsation * pulsation;
  stage.support = PhaseWeights(plan.work->support, pulsation, h);
  const std::vector<double>&s = stage.displacement.weight, &r = stage.rate.weight;
  if (!damped_ || s.empty() || stage.rate.which != stage.displacement.which) return stage;
  const double ratio = r[0] / s[0];
  constexpr double round_off = 1e-14;
  const bool parallel = std::equal(s.begin(), s.end(), r.begin(), [&](double a, double b) {
    return std::abs(b - ratio * a) <= round_off * std::abs(b);
  });
  if (!parallel) return stage;
  stage.along = ratio;
  stage.by_first = ratio * (damping_.stiffness != 0 ? damping_.stiffness : damping_.mass);
  stage.by_mass = damping_.stiffness != 0 ? ratio * damping_.mass : 0.0;
  return stage;
}

void StageWorks::add_all(const Marcher& marcher, const StageView& view, const StageTerms& stage, int lane, bool losses,
                         bool contact, Works& works) {
  const auto sum = [&](const WeighedTerms& terms) { return LaneSum(terms, view.slots, view.z, view.w, T_, lane); };
  if (losses)
    for (const Loss& loss : stage.losses) {
      const CombinedForm& form = loss.matrix == EnergyMatrix::M ? mass_form_ : stiffness_form_;
      works.scheme += loss.coefficient * sum(loss.value).under(form, displacement_).form;
    }
  if (!view.plan->work) return;
  const bool load = marcher.program().load, across = damped_ && stage.along == 0;
  if (!projected_ && !damped_ && !load && !contact) return;
  const LaneSum s = sum(stage.displacement);
  const bool passes = projected_ || (damped_ && !across), numbers = contact || load || across;
  if (passes) {
    const CombinedForm::Value value = s.under(first_, displacement_, numbers ? &displacement_ : nullptr);
    works.damping += stage.by_first * value.form;
    if (projected_) works.loads += marcher.support(lane, stage.load) * value.projection;
    if (stage.by_mass != 0) works.damping += stage.by_mass * s.under(mass_form_, rate_).form;
  }
  if (!numbers) return;
  const double* way = passes ? displacement_.data() : s.write(displacement_);
  if (across) {
    const double* rate = sum(stage.rate).write(rate_);
    if (damping_.stiffness != 0) works.damping += damping_.stiffness * stiffness_(way, rate);
    if (damping_.mass != 0) works.damping += damping_.mass * mass_(way, rate);
  }
  if (load) {
    const double* F = const_cast<Marcher&>(marcher).distributed_load(view.plan->work->load, view.time);
    works.loads += flight_kernels().dot(model_.rows(), F, way);
  }
  if (contact) add_contact(marcher, view, stage, lane, way, works);
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
    works.contact += effort * (model_.times(model_.measured(), j, s) + lift);
    works.loads -= effort * lift;
  };
  if (weights.size() > 1)
    for (int j = 0; j < model_.problem().points(); ++j) add_point(j);
  else
    for (const int j : view.pushed) add_point(j);
}

}  // namespace ricochet
