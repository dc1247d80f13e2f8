#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ricochet/contract/momentum_weights.hpp>
#include <ricochet/contract/stage_facts.hpp>
#include <ricochet/contract/step_plan.hpp>

namespace ricochet {
namespace {

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

std::string slot_name(const std::vector<std::string>& slots, std::size_t j) {
  return j < slots.size() ? slots[j] : fmt::format("(slot {})", j + 1);
}

std::string combination_text(const Combination& c, const std::vector<std::string>& slots) {
  std::string text;
  for (std::size_t j = 0; j < c.slots.size(); ++j) append_term(text, c.slots[j], slot_name(slots, j));
  append_term(text, c.z, "z");
  append_term(text, c.w, "w");
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
  static const char* digits[] = {"₀", "₁", "₂", "₃", "₄", "₅", "₆", "₇", "₈", "₉"};
  std::string text;
  for (std::size_t k = 0; k < weights.size(); ++k) {
    std::string name = "p";
    if (k > 0) name += "₋" + (k >= 10 ? std::string(digits[k / 10 % 10]) : "") + digits[k % 10];
    append_term(text, weights[k], name);
  }
  return text.empty() ? "0" : text;
}

const char* matrix_name(EnergyMatrix matrix) {
  return matrix == EnergyMatrix::M ? "M" : "K";
}

// ι p and what of it: nothing where the stage has no w.
std::string impulse_text(const Stage& stage, double impulse) {
  if (!stage.impulse) return "";
  std::string text;
  append_term(text, impulse, "p");
  return ", impulse " + (text.empty() ? "0" : text);
}

std::string impact_text(const Stage& stage, const std::vector<std::string>& slots) {
  const ImpactMeasure& impact = *stage.impact;
  if (impact.restores > 0)
    return fmt::format("    y = H({}) against {}, p y gives back the work of contact in the stage {}before\n",
                       combination_text(impact.value, slots), levels_text(impact.bound, "bound"),
                       impact.restores == 1 ? "" : std::to_string(impact.restores) + " ");
  std::string text = "    y = H(" + combination_text(impact.value, slots) + "), bounded by " +
                     levels_text(impact.bound, impact.gate ? "bound'" : "bound") +
                     (impact.effort == std::vector{1.0} ? "" : ", effort " + effort_text(impact.effort)) +
                     impulse_text(stage, impact.impulse) + "\n";
  if (const auto& gate = impact.gate)
    text += "    closed where H(" + combination_text(gate->predictor, slots) + ") passes " +
            levels_text(gate->predictor_bound, "bound") +
            fmt::format(", rebound e = {:g} of an approaching H({}) against {}\n", gate->restitution,
                        combination_text(gate->approach, slots), levels_text(gate->approach_bound, "bound'"));
  return text;
}

std::string compliance_text(const Stage& stage, Evaluation evaluation, const std::vector<std::string>& slots) {
  const ComplianceMeasure& c = *stage.at(evaluation);
  std::string text = fmt::format("    g ({}) = H({}) against {}, effort {}{}\n", evaluation_word(evaluation),
                                 combination_text(c.displacement, slots), levels_text(c.bound, "bound"),
                                 effort_text(c.effort), impulse_text(stage, c.impulse));
  if (!c.rate.slots.empty() || c.rate.z != 0 || c.rate.w != 0)
    text +=
        "        rate H(" + combination_text(c.rate, slots) + ") against " + levels_text(c.rate_bound, "bound'") + "\n";
  if (c.before)
    text += "        one step before H(" + combination_text(*c.before, slots) + ") against " +
            levels_text(c.before_bound, "bound") + "\n";
  return text;
}

std::string work_text(const WorkForm& work, const std::vector<std::string>& slots) {
  return "    work: s = " + combination_text(work.displacement, slots) + ", r = " + combination_text(work.rate, slots) +
         ", load " + levels_text(work.load, "F") + ", effort " + effort_text(work.effort) +
         (work.impulse == 0 ? "" : fmt::format(" and {:g} of the impulse", work.impulse)) + ", stops move by " +
         levels_text(work.support, "φ") + "\n";
}

std::string stage_text(const Stage& stage, const std::vector<std::string>& slots) {
  std::string text;
  const std::string s = operator_text(stage.matrix);
  if (!s.empty()) {
    text += "    S = " + s + "\n    b = ";
    std::string b;
    for (std::size_t j = 0; j < stage.history.size(); ++j) {
      const std::string term = operator_text(stage.history[j]);
      if (!term.empty()) b += (b.empty() ? "(" : " + (") + term + ") " + slot_name(slots, j);
    }
    if (stage.impulse)
      if (const std::string fed = operator_text(stage.impulse->feed); !fed.empty())
        b += (b.empty() ? "(" : " + (") + fed + ") w";
    const std::string load = levels_text(stage.load, "F");
    text += b + (load == "0" ? "" : (b.empty() ? "" : " + ") + load) + "\n";
  }
  if (stage.impulse) text += "    impulse: (" + operator_text(stage.impulse->R) + ") w = Hᵀp\n";
  if (stage.impact) text += impact_text(stage, slots);
  for (int k = 0; k < evaluations; ++k)
    if (const auto evaluation = static_cast<Evaluation>(k); stage.at(evaluation))
      text += compliance_text(stage, evaluation, slots);
  for (std::size_t j = 0; j < stage.update.size(); ++j)
    text += "    " + slot_name(slots, j) + " ← " + combination_text(stage.update[j], slots) + "\n";
  if (stage.work) text += work_text(*stage.work, slots);
  std::string loss;
  for (const LossTerm& term : stage.loss)
    append_term(loss, term.coefficient,
                fmt::format("|{}|²_{}", combination_text(term.value, slots), matrix_name(term.matrix)));
  if (!loss.empty()) text += "    dissipated by the scheme: " + loss + "\n";
  return text;
}

// "from t to t+½h" and what an effort gives.
std::string stands_text(const StageFacts& facts, std::size_t stages, double momentum, double h) {
  std::string text;
  if (stages > 1) text += fmt::format(", from t{:+g}h to t{:+g}h", facts.from, facts.to);
  if (std::isfinite(momentum) && (stages > 1 || std::abs(momentum - h) > 1e-9 * h))
    text += fmt::format(", an effort of 1 N gives {:.6g} h", momentum / h);
  return text;
}

}  // namespace

const char* evaluation_word(Evaluation evaluation) {
  switch (evaluation) {
    case Evaluation::implicit_end:
      return "implicit";
    case Evaluation::averaged:
      return "averaged";
    case Evaluation::explicit_start:
      return "explicit";
    case Evaluation::conserving:
      break;
  }
  return "conserving";
}

std::string print_plan(const StepPlan& given) {
  const std::optional<std::string> wrong = check_plan(given);
  DerivedPlan derived;
  if (wrong)
    derived.plan = given;
  else
    derived = derive(given);
  const StepPlan& plan = derived.plan;
  std::string text = "slots: ";
  for (std::size_t j = 0; j < plan.slots.size(); ++j) text += (j ? ", " : "") + plan.slots[j];
  text += "; at first ";
  for (std::size_t j = 0; j < std::min(plan.slots.size(), plan.initial.size()); ++j) {
    std::string start;
    append_term(start, plan.initial[j][0], "q₀");
    append_term(start, plan.initial[j][1], "v₀");
    text += (j ? ", " : "") + plan.slots[j] + " = " + (start.empty() ? "0" : start);
  }
  text += "\n";
  for (const Stage& stage : plan.start)
    text += fmt::format("start{}\n", plan.start_advances ? " (moves time by h)" : "") + stage_text(stage, plan.slots);
  const EffortMomenta momenta = wrong ? EffortMomenta{} : effort_momenta(plan, std::nullopt);
  for (std::size_t k = 0; k < plan.stages.size(); ++k)
    text += fmt::format("stage {}: S z = b + Hᵀp{}\n", k + 1,
                        wrong ? "" : stands_text(derived.stages[k], plan.stages.size(), momenta.stages[k], derived.h)) +
            stage_text(plan.stages[k], plan.slots);
  Combination velocity = plan.velocity;
  text += "velocity: " + combination_text(velocity, plan.slots);
  if (derived.velocity_offset != 0) text += fmt::format(", which stands at t{:+g}h", 1 + derived.velocity_offset);
  text += "\n";
  std::string energy;
  for (const QuadraticTerm& term : plan.energy) {
    Combination c;
    c.slots = term.slots;
    append_term(energy, term.coefficient,
                fmt::format("|{}|²_{}", combination_text(c, plan.slots), matrix_name(term.matrix)));
  }
  text += "scheme energy: " + (energy.empty() ? "none is declared" : energy) + "\n";
  if (!momenta.why_none.empty()) text += "no contact: " + momenta.why_none + "\n";
  if (wrong) text += "ill-formed: " + *wrong + "\n";
  return text;
}

}  // namespace ricochet
