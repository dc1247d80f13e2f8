#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <exception>
#include <ricochet/contract/float_control.hpp>
#include <ricochet/loader/child.hpp>

#include "runners/check/checks.hpp"

namespace ricochet::checking {
namespace {

// From child to parent: a letter for the finding, what changed the floating-point state, the sentences, each with its
// end.
constexpr char sentence_end = '\x1e';
constexpr const char* letters = "ofan";

std::string encoded(const CheckResult& result) {
  std::string text(1, letters[static_cast<int>(result.finding)]);
  text += result.float_changer + sentence_end;
  for (const std::string& sentence : result.sentences) text += sentence + sentence_end;
  return text;
}

void decode(const std::string& text, CheckResult& result) {
  const std::string all = letters;
  const auto letter = text.empty() ? std::string::npos : all.find(text.front());
  if (letter == std::string::npos) {
    result.finding = Finding::fails;
    result.sentences = {"the check left no answer"};
    return;
  }
  result.finding = static_cast<Finding>(letter);
  bool first = true;
  for (std::size_t at = 1; at < text.size(); first = false) {
    const std::size_t end = std::min(text.find(sentence_end, at), text.size());
    std::string part = text.substr(at, end - at);
    if (first)
      result.float_changer = std::move(part);
    else
      result.sentences.push_back(std::move(part));
    at = end + 1;
  }
}

Verdict taken(const Trial& trial) {
  try {
    return trial.take();
  } catch (const Refused& refused) {
    return not_applicable("refused: " + refused.sentence);
  } catch (const std::exception& error) {
    return fails(error.what());
  } catch (...) {
    return fails("an exception that says nothing");
  }
}

// Failures of all values; else the first of what was found most: measured before declared before applicable.
CheckResult over_all(const std::string& name, const std::vector<Trial>& trials) {
  CheckResult result{name, Finding::not_applicable, {}};
  take_float_changer();
  const auto weight = [](Finding finding) {
    switch (finding) {
      case Finding::fails:
        return 3;
      case Finding::ok:
        return 2;
      case Finding::not_declared:
        return 1;
      case Finding::not_applicable:
        break;
    }
    return 0;
  };
  constexpr std::size_t most_sentences = 4;
  bool first = true;
  for (const Trial& trial : trials) {
    const Verdict verdict = taken(trial);
    const std::string with = trial.values.empty() ? "" : "with " + trial.values + ": ";
    const char* const changer = take_float_changer();
    if (changer && result.float_changer.empty()) result.float_changer = fmt::format("{}{}()", with, changer);
    if (first || weight(verdict.finding) > weight(result.finding)) {
      result.finding = verdict.finding;
      result.sentences.clear();
      if (!verdict.sentence.empty() && verdict.finding != Finding::fails) result.sentences = {verdict.sentence};
    }
    first = false;
    if (verdict.finding == Finding::fails && result.sentences.size() < most_sentences)
      result.sentences.push_back(with + verdict.sentence);
  }
  return result;
}

}  // namespace

CheckResult run_check(const std::string& name, const std::vector<Trial>& trials, const Isolation& isolation,
                      bool* hangs) {
  if (hangs) *hangs = false;
  if (!isolation.child) return over_all(name, trials);
  const ChildOutcome outcome = run_in_child([&] { return encoded(over_all(name, trials)); }, isolation.seconds,
                                            [&] {
                                              if (isolation.lasts) isolation.lasts(name);
                                            });
  CheckResult result{name, Finding::fails, {}};
  if (outcome.ok())
    decode(outcome.text, result);
  else
    result.sentences = {outcome.sentence()};
  if (hangs) *hangs = outcome.end == ChildOutcome::End::timeout;
  return result;
}

CheckResult float_state(const std::vector<CheckResult>& results) {
  CheckResult state{"floating-point state", Finding::ok, {}};
  for (const CheckResult& one : results)
    if (!one.float_changer.empty()) {
      state.finding = Finding::fails;
      state.sentences = {
          one.float_changer +
          " leaves the rounding, or what is trapped or flushed, other than it found it. What runs in the "
          "same thread afterwards would compute other numbers; put it back before you return"};
      break;
    }
  return state;
}

void name_equal_failure(const std::vector<CheckResult>& before, CheckResult& result) {
  if (result.finding != Finding::fails) return;
  for (const CheckResult& one : before)
    if (one.finding == Finding::fails && one.sentences == result.sentences) {
      result.sentences = {fmt::format("as in the check \"{}\"", one.check)};
      return;
    }
}

namespace {

using Type = ParameterSpec::Type;

bool bounded(const Range& range) {
  return std::isfinite(range.low) && std::isfinite(range.high);
}

ParameterValue number(const ParameterSpec& spec, double x) {
  if (spec.type == Type::integer) return static_cast<long long>(std::llround(x));
  return x;
}
double as_real(const ParameterValue& value) {
  if (const auto* whole = std::get_if<long long>(&value)) return static_cast<double>(*whole);
  return std::get<double>(value);
}

// Of 100 N at 1 mm: one slope, and two.
const ParameterTable straight = {{0, 0}, {1e-3, 100}}, bent = {{0, 0}, {5e-4, 25}, {1e-3, 100}};

ParameterValue first_value(const ParameterSpec& spec) {
  if (spec.fallback) return *spec.fallback;
  switch (spec.type) {
    case Type::table:
      return straight;
    case Type::word:
      return spec.words.empty() ? std::string() : spec.words.front();
    case Type::boolean:
      return false;
    case Type::real:
    case Type::integer:
      break;
  }
  // N/m, and the force of that stiffness at a depth of 1 mm, N: benches go from 1e-5 to 0.01 m.
  const double usual = spec.unit == "N" ? 100 : 1e5;
  if (bounded(spec.range)) return number(spec, 0.5 * (spec.range.low + spec.range.high));
  return number(spec, spec.range.contains(usual) ? usual : spec.range.low + 1);
}

std::vector<ParameterValue> further_values(const ParameterSpec& spec) {
  std::vector<ParameterValue> values;
  if (spec.type == Type::word)
    for (const std::string& word : spec.words) values.emplace_back(word);
  if (spec.type == Type::boolean) values = {true, false};
  if (spec.type == Type::table) values = {straight, bent};
  if (spec.type != Type::real && spec.type != Type::integer) return values;
  const Range& range = spec.range;
  if (bounded(range)) {
    const double width = range.high - range.low, inside = spec.type == Type::integer ? 1 : 1e-3 * width;
    values = {number(spec, range.low + (range.low_open ? inside : 0)), number(spec, range.low + 0.5 * width),
              number(spec, range.high - (range.high_open ? inside : 0))};
  } else {
    const double base = as_real(first_value(spec));
    for (const double factor : {0.01, 100.0}) values.push_back(number(spec, base * factor));
    if (std::isfinite(range.low) && !range.low_open) values.push_back(number(spec, range.low));
    if (std::isfinite(range.high) && !range.high_open) values.push_back(number(spec, range.high));
  }
  return values;
}

std::string value_text(const ParameterValue& value) {
  if (const auto* word = std::get_if<std::string>(&value)) return *word;
  if (const auto* flag = std::get_if<bool>(&value)) return *flag ? "true" : "false";
  if (const auto* table = std::get_if<ParameterTable>(&value))
    return table->empty() ? "none" : fmt::format("of {} rows", table->size());
  return fmt::format("{:g}", as_real(value));
}

}  // namespace

ParameterSet parameter_set(const std::vector<ParameterSpec>& specs, Parameters values) {
  std::string text;
  for (const ParameterSpec& spec : specs)
    text += (text.empty() ? "" : ", ") + spec.key + " " + value_text(values.values().at(spec.key));
  return {std::move(values), std::move(text)};
}

std::vector<ParameterSet> parameter_sets(const std::vector<ParameterSpec>& specs) {
  constexpr std::size_t most_sets = 24;
  Parameters base;
  for (const ParameterSpec& spec : specs) base.set(spec.key, first_value(spec));
  std::vector<ParameterSet> sets = {parameter_set(specs, base)};
  for (const ParameterSpec& spec : specs)
    for (const ParameterValue& value : further_values(spec)) {
      if (check_parameter(spec, value)) continue;
      Parameters values = base;
      values.set(spec.key, value);
      ParameterSet set = parameter_set(specs, std::move(values));
      const bool known =
          std::any_of(sets.begin(), sets.end(), [&](const ParameterSet& other) { return other.text == set.text; });
      if (!known && sets.size() < most_sets) sets.push_back(std::move(set));
    }
  return sets;
}

Verdict manual_complete(const PluginManual& manual) {
  const auto lacks = [](const std::string& what) { return fails("the manual has no " + what); };
  if (manual.summary.empty()) return lacks("summary: one line for `ricochet list`");
  if (manual.text.empty()) return lacks("text: one paragraph for `ricochet describe`");
  if (manual.source.empty()) return lacks("source: author, year, equation");
  for (const ParameterSpec& spec : manual.parameters) {
    if (spec.text.empty()) return lacks("sentence about the parameter " + spec.key);
    if (spec.unit.empty()) return lacks("unit of the parameter " + spec.key + " (\"1\" when it has none)");
    if (spec.type == Type::word && spec.words.empty()) return lacks("words for the parameter " + spec.key);
  }
  return fine();
}

std::string poor_refusal(const std::string& sentence, const PluginManual& manual) {
  constexpr std::size_t shortest = 20;
  if (sentence.size() < shortest)
    return fmt::format("it refuses with \"{}\": {} characters name neither cause nor remedy", sentence,
                       sentence.size());
  std::string lower = sentence;
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  std::vector<std::string> words = {"mass",       "damp",      "step",    "element",   "mesh", "stop",
                                    "contact",    "load",      "support", "structure", "beam", "bar",
                                    "oscillator", "reference", "law",     "initial"};
  for (const ParameterSpec& spec : manual.parameters) words.push_back(spec.key);
  for (const std::string& word : words)
    if (lower.find(word) != std::string::npos) return {};
  return "its refusal names no parameter and nothing of the problem, hence no remedy: \"" + sentence + "\"";
}

}  // namespace ricochet::checking
