#include "runners/answers/limits.hpp"

#include <algorithm>
#include <cmath>
#include <ricochet/measure/statistics/draws.hpp>
#include <set>

#include "runners/store/study_tables.hpp"
#include "runners/study/axis_meaning.hpp"
#include "runners/table/in_order_met.hpp"
#include "runners/table/text.hpp"

namespace ricochet::answers {
namespace {

double elements_or_one(const Choices& study, const CaseRecord& record) {
  return study.elements(record).value_or(1);
}

double step_or_one(const Choices& study, const CaseRecord& record) {
  return study.step(record).value_or(1);
}

/// u of a difference along one refinement; nothing of a single size.
std::optional<double> difference_uncertainty(std::vector<SizedValue> differences) {
  const auto limit = limit_of(differences, 0);
  if (!limit || !limit->uncertainty) return std::nullopt;
  std::sort(differences.begin(), differences.end(),
            [](const SizedValue& a, const SizedValue& b) { return a.size > b.size; });
  const double last = std::abs(differences.back().value), before = std::abs(differences[differences.size() - 2].value);
  constexpr double halves = 0.5;
  // A difference that at least halves is taken to vanish.
  return last <= halves * before ? std::min(*limit->uncertainty, last) : *limit->uncertainty;
}

}  // namespace

std::optional<double> Method::at(double h, double elements) const {
  const auto found = grid.find({h, elements});
  return found == grid.end() ? std::nullopt : std::optional(found->second);
}

std::vector<const Method*> MeasureLimits::with_limit() const {
  std::vector<const Method*> out;
  for (const Method& one : methods)
    if (one.limit) out.push_back(&one);
  return out;
}

std::vector<const Method*> MeasureLimits::without_gain() const {
  std::vector<const Method*> out = with_limit();
  std::erase_if(out, [](const Method* one) { return one->gains; });
  return out;
}

std::optional<double> energy_kept(const MeasureWords& words, const CaseRecord& record) {
  if (words.most) {
    const auto value = scaled_value(words, record);
    return value ? std::optional(*value / *words.most) : std::nullopt;
  }
  return words.scale == "energy_brought_in" ? measure(record, "energy_left") : std::nullopt;
}

std::optional<double> scaled_value(const MeasureWords& words, const CaseRecord& record) {
  const auto value = told_measure(record, words.measure);
  if (!value || words.scale != "energy_brought_in") return value;
  const auto brought = measure(record, words.scale);
  return brought && *brought > 0 ? std::optional(*value / *brought) : std::nullopt;
}

bool without_limit(const Choices& study, const Cases& cases, const std::string& name) {
  const CaseRecord* finest = nullptr;
  for (const CaseRecord* record : cases)
    if (record->status == Status::done && (!finest || study.finer(*record, *finest))) finest = record;
  return finest && is_without_limit(why_left_out(*finest, name));
}

std::optional<double> bound_of(const MeasureWords& words, bool share, const Cases& cases) {
  if (words.most) return words.most;
  if (share) return words.scale == "energy_brought_in" ? std::optional(1.0) : std::nullopt;
  std::optional<double> least;
  for (const CaseRecord* record : cases)
    if (const auto scale = measure(*record, words.scale)) least = std::min(least.value_or(*scale), std::abs(*scale));
  return least;
}

namespace {

/// Whether friction at some stop changes between stick and slip, within a step as an impact does.
bool sticks_and_slips(const CaseRecord& record) {
  return std::any_of(record.measures.begin(), record.measures.end(),
                     [](const auto& one) { return one.second > 0 && one.first.starts_with("stick_slip_changes["); });
}

}  // namespace

Errors errors_of(const Cases& cases) {
  std::map<std::string, double> impacts;  // by seed
  for (const CaseRecord* record : cases) {
    const auto count = measure(*record, "impacts");
    if (sticks_and_slips(*record)) return Errors::saw_toothed;
    if (!count) continue;
    if (*count > 0 && !measure(*record, contact_steps_measure)) return Errors::saw_toothed;
    const auto [met, fresh] = impacts.emplace(axis(*record, seed_axis).text(), *count);
    if (met->second != *count) return Errors::saw_toothed;
  }
  return Errors::smooth;
}

namespace {

/// Values by step and elements, each by its seed.
using Draws = std::map<std::pair<double, double>, std::map<std::string, double>>;

/// Their means over the seeds that all sizes have, where there are such.
std::map<std::pair<double, double>, double> means_of(const Draws& draws) {
  std::set<std::string> common;
  for (const auto& [size, values] : draws)
    for (const auto& of_seed : values)
      if (std::all_of(draws.begin(), draws.end(), [&](const auto& one) { return one.second.contains(of_seed.first); }))
        common.insert(of_seed.first);
  std::map<std::pair<double, double>, double> out;
  for (const auto& [size, values] : draws) {
    double sum = 0;
    std::size_t count = 0;
    for (const auto& [seed, value] : values) {
      if (!common.empty() && !common.contains(seed)) continue;
      sum += value;
      ++count;
    }
    out[size] = sum / static_cast<double>(count);
  }
  return out;
}

/// Half the 95 % interval of a mean over seeds; of one seed, what the case says.
double half_of(const std::map<std::string, double>& values, const CaseRecord& finest, const std::string& measure_of) {
  std::vector<double> all;
  for (const auto& [seed, value] : values) all.push_back(value);
  if (const auto half = half_interval(all)) return *half;
  return measure(finest, "confidence." + measure_of).value_or(0);
}

/// The limit of a method whose `grid` and `done` are filled, at its finest case. `share`: its values are shares, whose
/// floor is round-off of 1. `coarser`: values on other meshes, in modes.
void find_limit(const Choices& study, const MeasureWords& words, bool share, const std::vector<Valued>& coarser,
                const Draws& draws, Method& method) {
  const auto& best = *std::max_element(method.done.begin(), method.done.end(), [&](const Valued& a, const Valued& b) {
    return study.finer(*b.record, *a.record);
  });
  method.finest = best.record;
  const double h = step_or_one(study, *best.record), N = elements_or_one(study, *best.record);
  std::vector<SizedValue> by_step, by_mesh;
  double largest = 0;
  for (const auto& [size, value] : method.grid) {
    if (size.second == N) by_step.push_back({size.first, value});
    if (size.first == h) by_mesh.push_back({1 / size.second, value});
    largest = std::max(largest, std::abs(value));
  }
  const double floor = 0x1p-52 * static_cast<double>(best.record->steps) * (share ? 1 : largest);
  Cases cases;
  for (const Valued& one : method.done) cases.push_back(one.record);
  const Errors errors = errors_of(cases);
  method.step = limit_of(by_step, floor, words.truth, errors);
  method.mesh = limit_of(by_mesh, floor, {}, errors);
  if (const auto most = bound_of(words, share, cases))
    for (auto* one : {&method.step, &method.mesh})
      if (*one) bound_growth(**one, *most);
  method.limit = combined(method.step, method.mesh);
  method.half = half_of(draws.at({h, N}), *best.record, words.measure);
  method.gains = energy_kept(words, *best.record).value_or(0) > gains_above;
  if (method.limit) widen(*method.limit, method.half);
  // Of modes on several meshes, what the nearest coarser mesh says otherwise.
  double most = 0, apart = 0;
  for (const auto& [record, value] : coarser) {
    const double elements = number_in(study.text(*record, "elements")).value_or(0);
    if (step_or_one(study, *record) != h || elements_or_one(study, *record) != N || elements <= most) continue;
    most = elements;
    apart = std::abs(value - method.grid.at({h, N}));
  }
  if (method.limit && most > 0) widen(*method.limit, apart);
}

}  // namespace

MeasureLimits limits_of(const Choices& study, const std::string& name, bool conservative, const Cases& cases) {
  MeasureLimits out;
  out.words = measure_words(name);
  if (!conservative && out.words.truth) {
    out.words.truth.reset();
    out.words.direction = 0;
  }
  const bool share = out.words.factor != 1 || out.words.scale == "1" || out.words.scale == "energy_brought_in";
  InOrderMet<std::string, Cases> groups;
  const std::vector<std::string> columns = without(study.columns(), {seed_axis});
  for (const CaseRecord* record : cases) groups[study.key(*record, columns)].push_back(record);
  for (auto& [key, members] : std::move(groups).list()) {
    Method method;
    method.cases = members;
    std::vector<Valued> coarser;
    Draws draws;
    if (without_limit(study, members, name)) members.clear();
    for (const CaseRecord* record : members) {
      if (record->status != Status::done) continue;
      const auto value = scaled_value(out.words, *record);
      if (!value || !std::isfinite(*value)) continue;
      if (!study.on_finest_mesh(*record)) {
        coarser.push_back({record, *value});
        continue;
      }
      method.done.push_back({record, *value});
      draws[{step_or_one(study, *record), elements_or_one(study, *record)}][study.text(*record, seed_axis)] = *value;
    }
    method.grid = means_of(draws);
    if (!method.done.empty()) find_limit(study, out.words, share, coarser, draws, method);
    out.methods.push_back(std::move(method));
  }
  std::vector<Limit*> limits;
  for (Method& method : out.methods)
    if (method.limit) limits.push_back(&*method.limit);
  doubt_chance(limits);
  return out;
}

bool is_driven(const CaseRecord& record) {
  const double work = measure(record, "work_of_loads").value_or(0);
  return work != measure(record, "work_of_steady_loads").value_or(0);
}

bool is_of_scene(const std::string& column) {
  const std::string role = axis_role(column);
  return !is_method_role(role) && !is_refinement(role) && role != residual_axis;
}

bool keeps_energy(const StudyResults& results) {
  return keeps_energy(results, all_cases(results));
}

bool keeps_energy(const StudyResults& results, const Cases& cases_of_study) {
  // A scheme that declares no work form leaves it open: those that do tell it for the scene that they share.
  std::vector<std::string> scene;
  for (const std::string& column : results.columns)
    if (is_of_scene(column)) scene.push_back(column);
  for (const Cases& cases : groups_of(with_status(cases_of_study, Status::done), scene)) {
    bool told = false;
    for (const CaseRecord* record : cases)
      if (const auto damping = measure(*record, "work_of_damping")) {
        if (*damping != 0 || is_driven(*record)) return false;
        told = true;
      }
    if (!told) return false;
  }
  return true;
}

double scale_of(const MeasureWords& words, const std::vector<const Method*>& methods) {
  if (words.scale == "1" || words.scale == "energy_brought_in") return 1;
  double scale = 0;
  for (const Method* method : methods) {
    const double own = std::abs(method->limit->value);
    scale = std::max(scale, words.scale.empty() ? own : std::abs(measure(*method->finest, words.scale).value_or(0)));
  }
  return scale;
}

Difference paired(const Method& high, const Method& low) {
  Difference out{&high, &low, 0, std::nullopt};
  double h = 0, N = 0;
  for (const auto& [size, value] : high.grid) {
    if (!low.at(size.first, size.second)) continue;
    if (size.second > N || (size.second == N && size.first < h)) h = size.first, N = size.second;
  }
  if (N == 0) {
    // No step and mesh in common.
    out.value = std::abs(high.limit->value - low.limit->value);
    if (high.limit->uncertainty && low.limit->uncertainty)
      out.uncertainty = *high.limit->uncertainty + *low.limit->uncertainty;
    return out;
  }
  std::vector<SizedValue> by_step, by_mesh;
  for (const auto& [size, value] : high.grid) {
    const auto other = low.at(size.first, size.second);
    if (!other) continue;
    if (size.second == N) by_step.push_back({size.first, value - *other});
    if (size.first == h) by_mesh.push_back({1 / size.second, value - *other});
  }
  out.value = std::abs(*high.at(h, N) - *low.at(h, N));
  const auto step = difference_uncertainty(by_step), mesh = difference_uncertainty(by_mesh);
  if (step || mesh) out.uncertainty = step.value_or(0) + mesh.value_or(0);
  // Never surer than not at all, nor less sure than both limits together.
  if (out.uncertainty && high.limit->uncertainty && low.limit->uncertainty)
    out.uncertainty = std::min(*out.uncertainty, *high.limit->uncertainty + *low.limit->uncertainty);
  if (out.uncertainty) *out.uncertainty += std::max(high.half, low.half);
  return out;
}

Difference farthest(const std::vector<const Method*>& methods) {
  const auto by_value = [](const Method* a, const Method* b) { return a->limit->value < b->limit->value; };
  return paired(**std::max_element(methods.begin(), methods.end(), by_value),
                **std::min_element(methods.begin(), methods.end(), by_value));
}

Matters ChoiceRow::matters() const {
  if (!uncertainty) return Matters::open;
  const double u = *uncertainty;
  return difference - u > tolerance ? Matters::yes : difference + u <= tolerance ? Matters::no : Matters::open;
}

ChoiceEffect choice_effect(const Choices& study, const MeasureLimits& limits, const std::string& choice,
                           const std::vector<std::string>& own) {
  ChoiceEffect out;
  out.choice = choice;
  const std::vector<std::string> others = without(study.columns(), own), scene = without(study.scene_columns(), own);
  InOrderMet<std::string, std::vector<const Method*>> groups, scenes;
  for (const Method* method : limits.without_gain()) {
    groups[study.key(method->first(), others)].push_back(method);
    scenes[study.key(method->first(), scene)].push_back(method);
  }
  for (const auto& [key, group] : groups.list()) {
    if (group.size() < 2) continue;
    const double scale = scale_of(limits.words, scenes[study.key(group.front()->first(), scene)]);
    if (scale <= 0) continue;
    const Difference difference = farthest(group);
    ChoiceRow row{
        .combination = &group.front()->first(), .levels = group.size(), .difference = difference.value / scale};
    if (difference.uncertainty) row.uncertainty = *difference.uncertainty / scale;
    const auto level = [&](const Method* method) {
      return own.size() == 1 && own.front() != choice
                 ? study.value_words(own.front(), study.text(method->first(), own.front()))
                 : study.level(method->first(), choice);
    };
    row.most = level(difference.high);
    row.least = level(difference.low);
    out.rows.push_back(std::move(row));
  }
  return out;
}

std::vector<ChoiceEffect> choice_effects(const Choices& study, const MeasureLimits& limits) {
  std::vector<ChoiceEffect> out;
  const auto add = [&](const std::string& choice, const std::vector<std::string>& own) {
    ChoiceEffect effect = choice_effect(study, limits, choice, own);
    if (!effect.rows.empty()) out.push_back(std::move(effect));
  };
  // One column of a choice, where that is asked for.
  const bool part = study.varies(study.asked()) && axis_role(study.asked()) != study.asked();
  if (part) add(study.asked(), {study.asked()});
  for (const std::string& choice : study.choices())
    if (choice != seed_axis) add(choice, study.columns_of(choice));
  return out;
}

}  // namespace ricochet::answers
