#include "runners/plan_files/plan_reader.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "runners/json/json_text.hpp"

namespace ricochet {
namespace {

class StageReader {
 public:
  explicit StageReader(PlanValues& values) : values_(values) {}

  std::vector<Stage> stages(const JsonPlace& list) {
    std::vector<Stage> result;
    for (const JsonPlace& one : list.items("a list of stages")) result.push_back(stage(one));
    return result;
  }

  Combination combination(const JsonPlace& place) { return values_.combination(place); }

  Levels levels(const JsonPlace& place) {
    Levels result;
    for (const auto& [at, weight] : place.members("an object of time levels and weights, {\"0\": 0.5, \"1\": 0.5}"))
      result.push_back({values_.number(at, weight.pointer()), values_.number(weight)});
    return result;
  }

  static EnergyMatrix matrix(const JsonPlace& place) {
    return place.word({"M", "K"}) == "M" ? EnergyMatrix::M : EnergyMatrix::K;
  }

 private:
  Stage stage(const JsonPlace& place) {
    place.close({"matrix", "history", "load", "impulse", "impact", "compliance", "update", "work", "loss"});
    Stage stage;
    if (place.has("matrix")) stage.matrix = values_.matrices(place.at("matrix"));
    if (place.has("history")) stage.history = history(place.at("history"));
    if (place.has("load")) stage.load = levels(place.at("load"));
    if (place.has("impulse")) stage.impulse = impulse(place.at("impulse"));
    if (place.has("impact")) stage.impact = impact(place.at("impact"));
    if (place.has("compliance")) compliances(place.at("compliance"), stage);
    stage.update = update(place.at("update", "a stage says what becomes of the slots: {\"q\": \"q + h*v\"}"));
    if (place.has("work")) stage.work = work(place.at("work"));
    if (place.has("loss"))
      for (const JsonPlace& one : place.at("loss").items("a list of terms {matrix, coefficient, value}"))
        if (LossTerm term = loss(one); term.coefficient != 0) stage.loss.push_back(std::move(term));
    return stage;
  }

  std::vector<OperatorWeights> history(const JsonPlace& place) {
    place.close(values_.slots());
    std::vector<OperatorWeights> rows;
    for (const std::string& slot : values_.slots())
      rows.push_back(place.has(slot) ? values_.matrices(place.at(slot)) : OperatorWeights{});
    return rows;
  }

  // A slot that is not named stays what it is.
  std::vector<Combination> update(const JsonPlace& place) {
    place.close(values_.slots());
    std::vector<Combination> rows;
    for (std::size_t j = 0; j < values_.slots().size(); ++j) {
      const std::string& slot = values_.slots()[j];
      if (place.has(slot)) {
        rows.push_back(combination(place.at(slot)));
        continue;
      }
      Combination same;
      same.slots.assign(j + 1, 0.0);
      same.slots[j] = 1;
      rows.push_back(std::move(same));
    }
    return rows;
  }

  Impulse impulse(const JsonPlace& place) {
    place.close({"R", "feed"});
    Impulse impulse;
    impulse.R = values_.matrices(place.at("R", "what an impulse moves: \"M/h\""));
    if (place.has("feed")) impulse.feed = values_.matrices(place.at("feed"));
    return impulse;
  }

  double weight_of_impulse(const JsonPlace& place, double absent) {
    return place.has("impulse") ? values_.number(place.at("impulse")) : absent;
  }

  std::vector<double> effort(const JsonPlace& place) {
    if (!place.has("effort")) return {1.0};
    std::vector<double> weights;
    const JsonPlace list = place.at("effort");
    for (const JsonPlace& one : list.items("a list of weights of p, p₋₁, p₋₂, …"))
      weights.push_back(values_.number(one));
    return weights;
  }

  int stages_before(const JsonPlace& place) {
    const double stages = values_.number(place);
    for (int k = 1; k < most_stages; ++k)
      if (stages == k) return k;
    place.unexpected(fmt::format("how many stages before, a whole number from 1 to {}", most_stages - 1));
  }

  Levels levels_in(const JsonPlace& place, const char* key) {
    return place.has(key) ? levels(place.at(key)) : Levels{};
  }

  ImpactMeasure impact(const JsonPlace& place) {
    place.close({"value", "bound", "gate", "effort", "restores", "impulse"});
    ImpactMeasure measure;
    measure.value = combination(place.at("value", "a combination of slots and z between the stops"));
    measure.bound = levels_in(place, "bound");
    measure.effort = effort(place);
    if (place.has("restores")) measure.restores = stages_before(place.at("restores"));
    measure.impulse = weight_of_impulse(place, measure.impulse);
    if (!place.has("gate")) return measure;
    const JsonPlace gate = place.at("gate");
    gate.close({"predictor", "predictor_bound", "approach", "approach_bound", "restitution"});
    measure.gate = VelocityGate{
        combination(gate.at("predictor", "the position that closes a stop")), levels_in(gate, "predictor_bound"),
        combination(gate.at("approach", "the velocity that rebounds")), levels_in(gate, "approach_bound"),
        gate.has("restitution") ? values_.number(gate.at("restitution")) : 0.0};
    return measure;
  }

  void compliances(const JsonPlace& place, Stage& stage) {
    std::vector<std::string> words;
    for (int k = 0; k < evaluations; ++k) words.emplace_back(evaluation_word(static_cast<Evaluation>(k)));
    place.close(words);
    for (int k = 0; k < evaluations; ++k)
      if (place.has(words[static_cast<std::size_t>(k)]))
        stage.compliance[static_cast<std::size_t>(k)] = compliance(place.at(words[static_cast<std::size_t>(k)]));
  }

  ComplianceMeasure compliance(const JsonPlace& place) {
    place.close({"displacement", "bound", "rate", "rate_bound", "effort", "impulse", "before", "before_bound"});
    ComplianceMeasure measure;
    measure.displacement = combination(place.at("displacement", "where the law sees the contact point"));
    measure.bound = levels_in(place, "bound");
    if (place.has("rate")) measure.rate = combination(place.at("rate"));
    measure.rate_bound = levels_in(place, "rate_bound");
    measure.effort = effort(place);
    measure.impulse = weight_of_impulse(place, measure.impulse);
    if (place.has("before")) measure.before = combination(place.at("before"));
    measure.before_bound = levels_in(place, "before_bound");
    return measure;
  }

  WorkForm work(const JsonPlace& place) {
    place.close({"displacement", "rate", "load", "effort", "impulse", "support"});
    WorkForm work;
    work.displacement = combination(place.at("displacement", "the test displacement of the balance"));
    if (place.has("rate")) work.rate = combination(place.at("rate"));
    work.load = levels_in(place, "load");
    work.effort = effort(place);
    work.impulse = weight_of_impulse(place, work.impulse);
    work.support = levels_in(place, "support");
    return work;
  }

  LossTerm loss(const JsonPlace& place) {
    place.close({"matrix", "coefficient", "value"});
    return {matrix(place.at("matrix", "expected one of \"M\", \"K\"")), values_.number(place.at("coefficient")),
            combination(place.at("value"))};
  }

  PlanValues& values_;
};

std::vector<double> without_z(const JsonPlace& place, PlanValues& values) {
  const Combination found = values.combination(place);
  if (found.z != 0 || found.w != 0)
    throw InputError(place.pointer(), fmt::format("expected a combination of slots: after the step there is no {}",
                                                  found.z != 0 ? "z" : "w"));
  return found.slots;
}

Combination velocity(const JsonPlace& plan, PlanValues& values) {
  if (plan.has("velocity")) return {.slots = without_z(plan.at("velocity"), values)};
  const auto v = std::find(values.slots().begin(), values.slots().end(), "v");
  if (v == values.slots().end())
    throw InputError(plan.pointer_of("velocity"),
                     "missing; where no slot is called v, a plan says which combination of slots is its velocity");
  Combination combination;
  combination.slots.assign(static_cast<std::size_t>(v - values.slots().begin()) + 1, 0.0);
  combination.slots.back() = 1;
  return combination;
}

SchemeFacts facts(const JsonPlace& place, PlanValues& values) {
  place.close(
      {"order", "contact_order", "restitution", "needs_regular_mass", "stability_limit", "contact_never_gains"});
  SchemeFacts facts;
  facts.order = values.number(place.at("order", "the order in h without contact"));
  if (place.has("contact_order")) facts.contact_order = values.optional_number(place.at("contact_order"));
  if (place.has("restitution")) {
    // In the order of the enumeration.
    const std::vector<std::string> words = {"exact", "asymptotic", "ignored"};
    const std::string word = place.at("restitution").word(words);
    facts.restitution = static_cast<Restitution>(std::find(words.begin(), words.end(), word) - words.begin());
  }
  if (place.has("needs_regular_mass")) facts.needs_regular_mass = values.truth(place.at("needs_regular_mass"));
  if (place.has("stability_limit")) facts.stability_limit = values.optional_number(place.at("stability_limit"));
  if (place.has("contact_never_gains")) facts.contact_never_gains = values.truth(place.at("contact_never_gains"));
  return facts;
}

}  // namespace

std::optional<Refusal> plan_refusal(const JsonPlace& plan, PlanValues& values) {
  std::optional<Refusal> first;
  if (!plan.has("refuse")) return first;
  for (const JsonPlace& one : plan.at("refuse").items("a list of refusals {when, because}")) {
    one.close({"when", "because"});
    const bool holds = values.truth(one.at("when", "the formula that decides"));
    Said because = values.sentence(one.at("because", "the sentence that says why, and what to do"));
    if (holds && !first) first = Refusal{std::move(because)};
  }
  return first;
}

StepPlan read_step_plan(const JsonPlace& plan, PlanValues& values) {
  StageReader reader(values);
  StepPlan result;
  result.slots = values.slots();
  for (const auto& [ignored, place] : plan.at("slots").members("an object of slots")) {
    const std::string expected = "the slot's weights of q₀ and v₀ before the start, such as [1, 0]";
    const std::vector<JsonPlace> pair = place.items(expected);
    if (pair.size() != 2) place.unexpected(expected);
    result.initial.push_back({values.number(pair[0]), values.number(pair[1])});
  }
  if (plan.has("start")) result.start = reader.stages(plan.at("start"));
  if (plan.has("start_advances")) result.start_advances = values.truth(plan.at("start_advances"));
  result.stages = reader.stages(plan.at("stages", "a plan has one stage or more"));
  if (plan.has("energy"))
    for (const JsonPlace& term : plan.at("energy").items("a list of terms {matrix, coefficient, of}")) {
      term.close({"matrix", "coefficient", "of"});
      result.energy.push_back({StageReader::matrix(term.at("matrix", "expected one of \"M\", \"K\"")),
                               values.number(term.at("coefficient")), without_z(term.at("of"), values)});
    }
  result.velocity = velocity(plan, values);
  result.facts = facts(plan.at("facts", "a plan declares at least its order: {\"order\": 2}"), values);
  return result;
}

}  // namespace ricochet
