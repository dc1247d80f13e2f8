#pragma once
#include <ricochet/contract/stage_facts.hpp>
#include <vector>

namespace ricochet::tests {

/// The numbers of a plan in one row, sizes included; missing trailing slots are the zeros that they stand for. Terms
/// whose coefficient is 0 say nothing.
class StepNumbers {
 public:
  explicit StepNumbers(const StepPlan& given) : plan_(derive(given).plan), slots_(plan_.slots.size()) {
    for (const auto& pair : plan_.initial) add({pair[0], pair[1]});
    stages(plan_.start);
    stages(plan_.stages);
    add({plan_.start_advances ? 1.0 : 0.0});
    for (const QuadraticTerm& term : plan_.energy) {
      add({term.matrix == EnergyMatrix::M ? 0.0 : 1.0, term.coefficient});
      combination({term.slots, 0});
    }
    combination(plan_.velocity);
    const SchemeFacts& facts = plan_.facts;
    add({facts.order, facts.contact_order.value_or(-1), static_cast<double>(facts.restitution),
         facts.needs_regular_mass ? 1.0 : 0.0, facts.stability_limit.value_or(-1),
         facts.contact_never_gains ? 1.0 : 0.0});
  }
  const std::vector<double>& all() const { return numbers_; }

 private:
  void add(const std::vector<double>& values) { numbers_.insert(numbers_.end(), values.begin(), values.end()); }
  void list(const std::vector<double>& values) {
    add({static_cast<double>(values.size())});
    add(values);
  }
  void combination(const Combination& c) {
    std::vector<double> padded = c.slots;
    padded.resize(slots_, 0.0);
    add(padded);
    add({c.z, c.w});
  }
  void levels(const Levels& levels) {
    add({static_cast<double>(levels.size())});
    for (const Level& level : levels) add({level.at, level.weight});
  }
  void compliance(const ComplianceMeasure& measure) {
    combination(measure.displacement);
    levels(measure.bound);
    combination(measure.rate);
    levels(measure.rate_bound);
    list(measure.effort);
    add({measure.impulse});
    add({measure.before ? 1.0 : 0.0});
    if (measure.before) combination(*measure.before);
    levels(measure.before_bound);
  }
  void stages(const std::vector<Stage>& all) {
    add({static_cast<double>(all.size())});
    for (const Stage& stage : all) {
      add({stage.matrix.M, stage.matrix.C, stage.matrix.K});
      std::vector<OperatorWeights> rows = stage.history;
      rows.resize(slots_);
      for (const OperatorWeights& row : rows) add({row.M, row.C, row.K});
      levels(stage.load);
      add({stage.impulse ? 1.0 : 0.0});
      if (stage.impulse)
        for (const OperatorWeights& w : {stage.impulse->R, stage.impulse->feed}) add({w.M, w.C, w.K});
      add({stage.impact ? 1.0 : 0.0});
      if (stage.impact) {
        combination(stage.impact->value);
        levels(stage.impact->bound);
        list(stage.impact->effort);
        add({stage.impact->gate ? 1.0 : 0.0, static_cast<double>(stage.impact->restores)});
        add({stage.impact->impulse});
        if (const auto& gate = stage.impact->gate) {
          combination(gate->predictor);
          levels(gate->predictor_bound);
          combination(gate->approach);
          levels(gate->approach_bound);
          add({gate->restitution});
        }
      }
      for (const auto& measure : stage.compliance) {
        add({measure ? 1.0 : 0.0});
        if (measure) compliance(*measure);
      }
      for (const Combination& row : stage.update) combination(row);
      add({stage.work ? 1.0 : 0.0});
      if (stage.work) {
        combination(stage.work->displacement);
        combination(stage.work->rate);
        levels(stage.work->load);
        list(stage.work->effort);
        add({stage.work->impulse});
        levels(stage.work->support);
      }
      for (const LossTerm& term : stage.loss) {
        if (term.coefficient == 0) continue;
        add({term.matrix == EnergyMatrix::M ? 0.0 : 1.0, term.coefficient});
        combination(term.value);
      }
    }
  }

  StepPlan plan_;
  std::size_t slots_;
  std::vector<double> numbers_;
};

inline std::vector<double> step_numbers(const StepPlan& plan) {
  return StepNumbers(plan).all();
}

}  // namespace ricochet::tests
