#include <algorithm>
#include <ricochet/measure/energy/state_energies.hpp>

namespace ricochet {

StateEnergies::StateEnergies(const Marcher& marcher, const QuadraticForm& mass, const QuadraticForm& stiffness)
    : mass_(mass),
      stiffness_(stiffness),
      T_(marcher.width()),
      slot_count_(marcher.slot_count()),
      mean_velocity_(marcher.program().velocity_offset != 0),
      compliant_(marcher.program().contact && marcher.law().reads().has_value()),
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
    forms_[k].value = evaluate(forms_[k], slots, increment, lane, compliant_ && k == elastic_);
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

}  // namespace ricochet
