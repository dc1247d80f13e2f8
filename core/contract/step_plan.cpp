#include <fmt/format.h>

#include <cmath>
#include <ricochet/contract/step_plan.hpp>

namespace ricochet {
namespace {

// Collects the first thing that is wrong.
class Checker {
 public:
  Checker(std::size_t slots) : slots_(slots) {}
  std::optional<std::string> wrong;

  void demand(bool holds, const std::string& sentence) {
    if (!holds && !wrong) wrong = sentence;
  }
  void number(double x, const std::string& what) { demand(std::isfinite(x), what + " is not finite"); }
  void levels(const Levels& list, const std::string& what) {
    for (const Level& level : list) {
      number(level.at, what);
      number(level.weight, what);
    }
  }
  void combination(const Combination& c, const std::string& what) {
    demand(c.slots.size() <= slots_, what + " combines more slots than the plan has");
    for (const double w : c.slots) number(w, what);
    number(c.z, what);
  }
  void effort(const std::vector<double>& weights, const std::string& what) {
    demand(!weights.empty() && weights.size() <= 3, what + " has one to three effort weights");
    for (const double w : weights) number(w, what);
  }
  void partition(const Levels& list, const std::string& what) {
    double sum = 0;
    for (const Level& level : list) sum += level.weight;
    demand(std::abs(sum - 1) < 1e-9, what + " must weight its levels to one");
  }
  void stage(const Stage& stage, const std::string& name) {
    number(stage.matrix.M, name + ": S");
    number(stage.matrix.C, name + ": S");
    number(stage.matrix.K, name + ": S");
    demand(stage.history.size() <= slots_, name + ": history names more slots than the plan has");
    for (const OperatorWeights& w : stage.history) {
      number(w.M, name + ": history");
      number(w.C, name + ": history");
      number(w.K, name + ": history");
    }
    levels(stage.load, name + ": load");
    demand(stage.update.size() == slots_, name + ": update must give one combination per slot");
    for (const Combination& c : stage.update) combination(c, name + ": update");
    combination(stage.increment, name + ": increment");
    if (stage.impact) {
      combination(stage.impact->value, name + ": impact measure");
      levels(stage.impact->bound, name + ": impact bound");
      if (!stage.impact->gate) partition(stage.impact->bound, name + ": position-level impact bound");
      if (stage.impact->gate) {
        combination(stage.impact->gate->predictor, name + ": gate predictor");
        combination(stage.impact->gate->approach, name + ": gate approach");
        partition(stage.impact->gate->predictor_bound, name + ": gate predictor bound");
        levels(stage.impact->gate->approach_bound, name + ": gate approach bound");
        number(stage.impact->gate->restitution, name + ": restitution");
      }
    }
    for (const auto& compliance : stage.compliance) {
      if (!compliance) continue;
      combination(compliance->displacement, name + ": compliance");
      combination(compliance->rate, name + ": compliance rate");
      partition(compliance->bound, name + ": compliance bound");
      levels(compliance->rate_bound, name + ": compliance rate bound");
      effort(compliance->effort, name + ": compliance");
    }
    if (stage.work) {
      combination(stage.work->displacement, name + ": work displacement");
      combination(stage.work->rate, name + ": work rate");
      levels(stage.work->load, name + ": work load");
      effort(stage.work->effort, name + ": work");
      levels(stage.work->support, name + ": work support");
    }
  }

 private:
  std::size_t slots_;
};

void append_term(std::string& text, double weight, const std::string& symbol) {
  if (weight == 0) return;
  const bool first = text.empty();
  const double size = std::abs(weight);
  if (weight < 0)
    text += first ? "−" : " − ";
  else if (!first)
    text += " + ";
  if (size != 1) text += fmt::format("{:.6g} ", size);
  text += symbol;
}

std::string combination_text(const Combination& c, const std::vector<std::string>& slots) {
  std::string text;
  for (std::size_t j = 0; j < c.slots.size(); ++j) append_term(text, c.slots[j], slots[j]);
  append_term(text, c.z, "z");
  return text.empty() ? "0" : text;
}

std::string levels_text(const Levels& levels, const std::string& symbol) {
  std::string text;
  for (const Level& level : levels) {
    std::string at = "t";
    if (level.at != 0) at += fmt::format("{}{:g}h", level.at > 0 ? "+" : "−", std::abs(level.at));
    append_term(text, level.weight, symbol + "(" + at + ")");
  }
  return text.empty() ? "0" : text;
}

std::string operator_text(const OperatorWeights& w) {
  std::string text;
  append_term(text, w.M, "M");
  append_term(text, w.C, "C");
  append_term(text, w.K, "K");
  return text;
}

std::string effort_text(const std::vector<double>& weights) {
  static const char* names[] = {"p", "p₋₁", "p₋₂"};
  std::string text;
  for (std::size_t k = 0; k < weights.size(); ++k) append_term(text, weights[k], names[k]);
  return text;
}

std::string stage_text(const Stage& stage, const StepPlan& plan) {
  std::string text;
  const std::string s = operator_text(stage.matrix);
  if (!s.empty()) {
    text += "    S = " + s + "\n    b = ";
    std::string b;
    for (std::size_t j = 0; j < stage.history.size(); ++j) {
      const std::string term = operator_text(stage.history[j]);
      if (!term.empty()) b += (b.empty() ? "(" : " + (") + term + ") " + plan.slots[j];
    }
    const std::string load = levels_text(stage.load, "F");
    text += b + (load == "0" ? "" : (b.empty() ? "" : " + ") + load) + "\n";
  }
  if (stage.impact) {
    text += "    y = H(" + combination_text(stage.impact->value, plan.slots) + "), bounded by " +
            levels_text(stage.impact->bound, stage.impact->gate ? "bound'" : "bound") + "\n";
    if (const auto& gate = stage.impact->gate)
      text += "    closed where H(" + combination_text(gate->predictor, plan.slots) + ") passes " +
              levels_text(gate->predictor_bound, "bound") +
              fmt::format(", rebound e = {:g} of an approaching H({})\n", gate->restitution,
                          combination_text(gate->approach, plan.slots));
  }
  static const char* evaluations[] = {"implicit", "averaged", "explicit"};
  for (int k = 0; k < 3; ++k)
    if (const auto& c = stage.compliance[static_cast<std::size_t>(k)])
      text += fmt::format("    g ({}) = H({}), effort {}\n", evaluations[k],
                          combination_text(c->displacement, plan.slots), effort_text(c->effort));
  for (std::size_t j = 0; j < stage.update.size(); ++j)
    text += "    " + plan.slots[j] + " ← " + combination_text(stage.update[j], plan.slots) + "\n";
  return text;
}

}  // namespace

std::optional<std::string> check_plan(const StepPlan& plan) {
  Checker check(plan.slots.size());
  check.demand(!plan.slots.empty() && plan.slots.front() == "q", "the first slot of a plan is the position q");
  check.demand(plan.initial.size() == plan.slots.size(), "a plan says for each slot how it starts");
  for (const auto& [position, velocity] : plan.initial) {
    check.number(position, "initial");
    check.number(velocity, "initial");
  }
  check.demand(!plan.stages.empty() && plan.stages.size() <= 3, "a plan has one to three stages");
  for (const Stage& stage : plan.start) check.stage(stage, "start");
  for (std::size_t k = 0; k < plan.stages.size(); ++k) check.stage(plan.stages[k], fmt::format("stage {}", k + 1));
  for (const QuadraticTerm& term : plan.energy) {
    check.demand(term.slots.size() <= plan.slots.size(), "energy: more slots than the plan has");
    check.number(term.coefficient, "energy");
    for (const double w : term.slots) check.number(w, "energy");
  }
  check.combination(plan.velocity, "velocity");
  check.demand(plan.velocity.z == 0, "velocity combines slots after the step, not z");
  check.demand(std::isfinite(plan.facts.order) && plan.facts.order > 0, "facts: the order is positive");
  check.demand(!plan.facts.stability_limit || *plan.facts.stability_limit > 0,
               "facts: the stability limit is positive");
  return check.wrong;
}

std::string print_plan(const StepPlan& plan) {
  std::string text = "slots: ";
  for (std::size_t j = 0; j < plan.slots.size(); ++j) text += (j ? ", " : "") + plan.slots[j];
  text += "\n";
  for (std::size_t k = 0; k < plan.start.size(); ++k)
    text += fmt::format("start{}\n", plan.start_advances ? " (moves time by h)" : "") + stage_text(plan.start[k], plan);
  for (std::size_t k = 0; k < plan.stages.size(); ++k)
    text += fmt::format("stage {}: S z = b + Hᵀp\n", k + 1) + stage_text(plan.stages[k], plan);
  std::string energy;
  for (const QuadraticTerm& term : plan.energy) {
    Combination c;
    c.slots = term.slots;
    append_term(
        energy, term.coefficient,
        fmt::format("|{}|²_{}", combination_text(c, plan.slots), term.matrix == QuadraticTerm::Matrix::M ? "M" : "K"));
  }
  if (!energy.empty()) text += "scheme energy: " + energy + "\n";
  return text;
}

}  // namespace ricochet
