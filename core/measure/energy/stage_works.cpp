#include <algorithm>
#include <cmath>
#include <ricochet/kernels/flight_kernels.hpp>
#include <ricochet/measure/energy/stage_works.hpp>

namespace ricochet {

StateEnergies::StateEnergies(const Marcher& marcher, const QuadraticForm& mass, const QuadraticForm& stiffness)
    : mass_(mass),
      stiffness_(stiffness),
      T_(marcher.width()),
      slot_count_(marcher.slot_count()),
      mean_velocity_(marcher.program().velocity_offset != 0),
      kept_(marcher.program().contact && marcher.law().reads().has_value()),
      place_(marcher.program().model->rows(), 1),
      scratch_(marcher.program().model->rows(), 1) {
  const Program& program = marcher.program();
  const auto slots = program.plan.slots.size();
  const int slot = program.increment_slot;
  // The share of the increment goes to the slot that holds it.
  const auto with_increment = [&](double position, double increment) {
    Combination c;
    c.slots.assign(slots, 0.0);
    c.slots[0] = position;
    if (slot >= 0) c.slots[static_cast<std::size_t>(slot)] += increment;
    return c;
  };
  const auto left_over = [&](double increment) { return slot >= 0 ? 0.0 : increment; };
  if (mean_velocity_) {
    kinetic_ = find(EnergyMatrix::M, with_increment(0, 1), left_over(1));
    elastic_ = find(EnergyMatrix::K, with_increment(1, -0.5), left_over(-0.5));
  } else {
    kinetic_ = find(EnergyMatrix::M, program.plan.velocity);
    elastic_ = find(EnergyMatrix::K, with_increment(1, 0));
  }
  for (const QuadraticTerm& term : program.plan.energy) {
    if (term.coefficient == 0) continue;
    Combination value;
    value.slots = term.slots;
    scheme_.push_back({find(term.matrix, value), term.coefficient});
  }
}

std::size_t StateEnergies::find(EnergyMatrix matrix, const Combination& c, double of_increment) {
  Form form{matrix, WeighedTerms(c)};
  form.terms.add(slot_count_, of_increment);
  for (std::size_t k = 0; k < forms_.size(); ++k)
    if (forms_[k].matrix == matrix && forms_[k].terms == form.terms) return k;
  const std::size_t count = form.terms.which.size();
  form.plain = T_ == 1 && of_increment == 0 && count > 0 && count <= CombinedForm::most_terms;
  if (form.plain) form.square = form.terms.weight[0] * form.terms.weight[0];
  forms_.push_back(std::move(form));
  return forms_.size() - 1;
}

double StateEnergies::evaluate(const Form& form, const double* const* slots, const double* increment, int lane,
                               bool kept) {
  const WeighedTerms& terms = form.terms;
  if (form.plain && !kept) {
    const double* x[CombinedForm::most_terms];
    const int count = static_cast<int>(terms.which.size());
    for (int k = 0; k < count; ++k) x[k] = slots[terms.which[static_cast<std::size_t>(k)]];
    return form.square * (form.matrix == EnergyMatrix::M ? mass_ : stiffness_)(count, x, terms.ratio.data()).form;
  }
  if (terms.which.empty()) return 0;
  const bool apart = terms.which.back() == slot_count_;
  LaneSum sum(terms, T_, lane);
  const std::size_t count = terms.which.size() - (apart ? 1 : 0);
  for (std::size_t k = 0; k < count; ++k) sum.add(slots[terms.which[k]]);
  const CombinedForm& matrix = form.matrix == EnergyMatrix::M ? mass_ : stiffness_;
  if (!apart) return sum.under(matrix, scratch_, kept ? &place_ : nullptr).form;
  // The increment is the lane's own: what it joins is gathered first.
  const double by = terms.weight.back();
  const double* rest = sum.write(scratch_);
  for (std::size_t i = 0; i < place_.size(); ++i) place_.data()[i] = rest[i] + by * increment[i];
  return matrix(place_.data()).form;
}

StateEnergies::Values StateEnergies::read(const double* const* slots, const double* increment, double duration,
                                          int lane) {
  for (std::size_t k = 0; k < forms_.size(); ++k)
    forms_[k].value = evaluate(forms_[k], slots, increment, lane, kept_ && k == elastic_);
  Values values;
  values.kinetic = 0.5 * forms_[kinetic_].value;
  if (mean_velocity_) values.kinetic /= duration * duration;
  values.elastic = 0.5 * forms_[elastic_].value;
  for (const Share& share : scheme_) values.scheme += share.coefficient * forms_[share.form].value;
  return values;
}

double StateEnergies::scheme(const double* const* slots, int lane) {
  double energy = 0;
  for (const Share& share : scheme_)
    energy += share.coefficient * evaluate(forms_[share.form], slots, nullptr, lane, false);
  return energy;
}

Works& Works::operator+=(const Works& other) {
  loads += other.loads;
  damping += other.damping;
  contact += other.contact;
  friction += other.friction;
  scheme += other.scheme;
  law += other.law;
  return *this;
}

StageWorks::StageWorks(const Marcher& marcher, const QuadraticForm& mass, const QuadraticForm& stiffness)
    : model_(*marcher.program().model),
      mass_(mass),
      stiffness_(stiffness.by_rows()),
      mass_form_(mass),
      stiffness_form_(stiffness_),
      damping_(model_.problem().damping),
      damped_(damping_.stiffness != 0 || damping_.mass != 0),
      projected_(marcher.program().support),
      T_(marcher.width()),
      displacement_(model_.rows(), 1),
      rate_(model_.rows(), 1),
      friction_works_(marcher.program().friction ? static_cast<std::size_t>(model_.rubbed().rows()) : 0),
      friction_ways_(friction_works_.size()) {
  if (model_.modal_damping().size() > 0)
    own_damping_ = QuadraticForm(SparseMatrix(model_.modal_damping().asDiagonal()));
  else if (damping_.matrix)
    own_damping_ = QuadraticForm::by_rows(*damping_.matrix);
  const double* shape = projected_ ? model_.support_shape().data() : nullptr;
  const SparseMatrix nothing(model_.rows(), model_.rows());
  const QuadraticForm first = damping_.stiffness != 0 ? stiffness_ : damped_ ? mass : QuadraticForm(nothing);
  first_ = CombinedForm(first, shape);
  const StepPlan& plan = marcher.program().plan;
  const double pulsation = model_.problem().support.pulsation, h = marcher.program().h;
  for (std::size_t k = 0; k < plan.start.size(); ++k)
    start_.push_back(describe_start(plan, k, marcher.program().start[k].facts, pulsation, h));
  for (const Stage& stage : plan.stages) stages_.push_back(describe(stage, pulsation, h));
  if (T_ > 1 || marcher.program().load || own_damping_) return;
  squares_alone_ = stages_.size() == 1 && stages_.front().losses.empty();
  if (!projected_ && !damped_) return;
  for (std::size_t k = 0; k < stages_.size(); ++k)
    if (const StageOperator* op = marcher.program().stages[k].op.get())
      if (const std::optional<int> width = op->sums_squares()) ask_for_squares(first, shape, *width, stages_[k]);
  squares_alone_ = squares_alone_ && stages_.front().fours.rows() > 0;
}

// s = w (z + ratio·x_1), damped by one form alone.
void StageWorks::ask_for_squares(const QuadraticForm& form, const double* shape, int width, StageTerms& stage) const {
  const WeighedTerms& s = stage.displacement;
  const bool alone = s.which == std::vector<int>{WeighedTerms::unknown_z};
  if (!alone && s.which != std::vector<int>{1, WeighedTerms::unknown_z}) return;
  if ((damped_ && stage.along == 0) || stage.by_mass != 0 || !stage.losses.empty()) return;
  stage.fours = CombinedForm::packed(form, shape, width);
  stage.sum.ones = form.unit();
  const double scale = s.weight.back();
  stage.sum.ratio = alone ? 0.0 : s.weight.front() / scale;
  stage.by_sum = scale * scale * stage.by_first;
  stage.sum_load = stage.load;
  stage.sum_load.along *= scale;
  stage.sum_load.across *= scale;
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
  stage.support_levels = plan.work->support;
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

// The mean of the plan's velocities before and after the stage, as a combination of what is before it and z.
StageWorks::StageTerms StageWorks::describe_start(const StepPlan& plan, std::size_t index, const StageFacts& facts,
                                                  double pulsation, double h) const {
  const Stage& stage = plan.start[index];
  StageTerms terms = describe(stage, pulsation, h);
  if (stage.work) return terms;
  Combination mean;
  mean.slots.assign(plan.slots.size(), 0.0);
  for (std::size_t j = 0; j < plan.velocity.slots.size(); ++j) {
    const double half = 0.5 * plan.velocity.slots[j];
    mean.slots[j] += half;
    const Combination& update = stage.update[j];
    for (std::size_t i = 0; i < update.slots.size(); ++i) mean.slots[i] += half * update.slots[i];
    mean.z += half * update.z;
    mean.w += half * update.w;
  }
  terms.displacement = WeighedTerms(mean);
  // The mean rate of the clamp over what the stage moves by, or around the instant at which it stands.
  const bool moves = facts.to > facts.from;
  const double from = moves ? facts.from : facts.from - 0.5, to = moves ? facts.to : facts.from + 0.5;
  const double rate = 1 / ((to - from) * h);
  terms.support_levels = {{to, rate}, {from, -rate}};
  terms.support = PhaseWeights(terms.support_levels, pulsation, h);
  terms.impulsive = true;
  return terms;
}

void StageWorks::add_all(const Marcher& marcher, const StageView& view, const StageTerms& stage, int lane, bool losses,
                         bool contact, Works& works) {
  const auto sum = [&](const WeighedTerms& terms) { return LaneSum(terms, view.slots, view.z, view.w, T_, lane); };
  if (losses)
    for (const Loss& loss : stage.losses) {
      const CombinedForm& form = loss.matrix == EnergyMatrix::M ? mass_form_ : stiffness_form_;
      works.scheme += loss.coefficient * sum(loss.value).under(form, displacement_).form;
    }
  if (stage.impulsive && contact)
    add_efforts(marcher, view, stage, lane, sum(stage.displacement).write(displacement_), works);
  if (!view.plan->work) return;
  const bool load = marcher.program().load, across = (damped_ && stage.along == 0) || own_damping_;
  if (!projected_ && !damped_ && !own_damping_ && !load && !contact) return;
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
    if (own_damping_) works.damping += (*own_damping_)(way, rate);
  }
  if (load) {
    const double* F = const_cast<Marcher&>(marcher).distributed_load(view.plan->work->load, view.time);
    works.loads += flight_kernels().dot(model_.rows(), F, way);
  }
  if (contact) add_efforts(marcher, view, stage, lane, way, works);
}

void StageWorks::add_efforts(const Marcher& marcher, const StageView& view, const StageTerms& stage, int lane,
                             const double* s, Works& works) {
  add_contact(marcher, view, stage, lane, s, works);
  if (!friction_works_.empty()) add_friction(marcher, view, stage, lane, s, works);
}

// What surfaces that move give is brought in by them.
void StageWorks::add_friction(const Marcher& marcher, const StageView& view, const StageTerms& stage, int lane,
                              const double* s, Works& works) {
  const std::vector<double>& weights = view.program->friction_work;
  const int points = model_.problem().points(), efforts = std::min(static_cast<int>(weights.size()), view.efforts);
  const bool moves = marcher.surfaces_move();
  for (int row = 0; row < model_.rubbed().rows(); ++row) {
    double effort = 0;
    for (int j = 0; j < efforts; ++j)
      if (view.effort[j]) effort += weights[static_cast<std::size_t>(j)] * view.effort[j][(points + row) * T_ + lane];
    const double lift = moves ? marcher.rubbed_levels(lane, row, view.time, stage.support_levels) : 0.0;
    const double way = model_.times(model_.rubbed(), row, s) + lift;
    friction_works_[static_cast<std::size_t>(row)] = effort * way;
    friction_ways_[static_cast<std::size_t>(row)] = way;
    works.friction += effort * way;
    works.loads -= effort * lift;
  }
}

void StageWorks::add_contact(const Marcher& marcher, const StageView& view, const StageTerms& stage, int lane,
                             const double* s, Works& works) const {
  const std::vector<double>& weights = view.program->work_effort;
  const double support = marcher.program().support ? marcher.support(lane, stage.support) : 0.0;
  const auto add_point = [&](int j) {
    double effort = 0;
    for (int k = 0; k < std::min(static_cast<int>(weights.size()), view.efforts); ++k)
      if (view.effort[k]) effort += weights[static_cast<std::size_t>(k)] * view.effort[k][j * T_ + lane];
    if (effort == 0) return;
    double lift = support;
    if (!marcher.motions().empty())
      for (const Level& level : stage.support_levels)
        lift += level.weight * marcher.motions().point(j, view.time + level.at * marcher.program().h);
    works.contact += effort * (model_.times(model_.measured(), j, s) + lift);
    works.loads -= effort * lift;
  };
  if (weights.size() > 1)
    for (int j = 0; j < model_.problem().points(); ++j) add_point(j);
  else
    for (const int j : view.pushed) add_point(j);
}

}  // namespace ricochet
