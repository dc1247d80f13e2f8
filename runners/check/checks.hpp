#pragma once
#include <array>
#include <functional>
#include <ricochet/contract/registry.hpp>
#include <ricochet/contract/worded.hpp>
#include <string>
#include <utility>
#include <vector>

/// \file
/// What a check of a plugin says.
namespace ricochet::checking {

enum class Finding { ok, fails, not_applicable, not_declared };
constexpr std::array<const char*, 4> words_of(Finding) {
  return {"ok", "FAILS", "not applicable", "not declared"};
}

/// What one trial of a method found: a sentence with what was measured and, where it fails, what was declared.
struct Verdict {
  Finding finding = Finding::ok;
  std::string sentence;  ///< may be empty where it is ok
};
inline Verdict fine(std::string measured = {}) {
  return {Finding::ok, std::move(measured)};
}
inline Verdict fails(std::string sentence) {
  return {Finding::fails, std::move(sentence)};
}
inline Verdict not_applicable(std::string why) {
  return {Finding::not_applicable, std::move(why)};
}
inline Verdict not_declared(std::string what) {
  return {Finding::not_declared, std::move(what)};
}

/// One line of a report, over all parameter values that were tried.
struct CheckResult {
  std::string check;
  Finding finding = Finding::ok;
  std::vector<std::string> sentences;  ///< of a failure one for each parameter value, else at most one
  std::string float_changer = {};      ///< "with beta 1: prepare()": what first left the floating-point state changed
};

/// Thrown inside a check when the method refuses what the check would march; the verdict is then "not applicable".
struct Refused {
  std::string sentence;
};

/// Where checks run: each in a child process, ended after so many seconds, or in this process (for tests).
struct Isolation {
  bool child = true;
  double seconds = 60;  ///< by the clock
  /// Told once of a check that lasts longer than some seconds, while it runs.
  std::function<void(const std::string& check)> lasts = {};
};

/// A trial of the method with one set of parameter values.
struct Trial {
  std::string values;  ///< "beta 0.25, gamma 0.5", "" where it has no parameters
  std::function<Verdict()> take;
};
/// Makes every trial; what is thrown, and what ends the child process, is a failure with its own sentence. `hangs`
/// tells whether the limit ended it.
CheckResult run_check(const std::string& name, const std::vector<Trial>& trials, const Isolation& isolation,
                      bool* hangs = nullptr);

/// One set of parameter values of a method.
struct ParameterSet {
  Parameters values;
  std::string text;  ///< "beta 0.25, gamma 0.5"
};

/// The values a method is tried with. First its defaults; of a parameter without one the middle of its range, else 1e5
/// (100 N). Then one parameter at a time. Of a bounded range the ends (just inside an open one) and the middle. Of an
/// unbounded default a hundredth and a hundredfold. Each word, both truths.
std::vector<ParameterSet> parameter_sets(const std::vector<ParameterSpec>& specs);

ParameterSet parameter_set(const std::vector<ParameterSpec>& specs, Parameters values);

/// A method with one set of values.
template <class Interface>
struct Subject {
  const Entry<Interface>* entry = nullptr;
  ParameterSet set;
  std::unique_ptr<Interface> make() const {
    auto made = entry->make(set.values);
    if (!made) throw std::runtime_error("its factory returns no object");
    return made;
  }
};

template <class Interface>
std::vector<Subject<Interface>> subjects_of(const Entry<Interface>& entry) {
  std::vector<Subject<Interface>> subjects;
  for (ParameterSet& set : parameter_sets(entry.manual.parameters)) subjects.push_back({&entry, std::move(set)});
  return subjects;
}

/// A failure with the sentences of one in `before` says whose they are.
void name_equal_failure(const std::vector<CheckResult>& before, CheckResult& result);

/// What all of them saw of the floating-point state.
CheckResult float_state(const std::vector<CheckResult>& results);

/// A check of one kind of method.
template <class Interface>
struct Check {
  const char* name;
  Verdict (*of)(const Subject<Interface>& subject);
};

/// Runs all checks of a kind, each over all parameter values, then tells the floating-point state that they left. One
/// that does not come to an end is the last. A failure with the words of an earlier one names that check alone.
template <class Interface>
std::vector<CheckResult> run_checks(const std::vector<Check<Interface>>& checks, const Entry<Interface>& entry,
                                    const Isolation& isolation) {
  const std::vector<Subject<Interface>> subjects = subjects_of(entry);
  std::vector<CheckResult> results;
  for (const Check<Interface>& check : checks) {
    std::vector<Trial> trials;
    for (const Subject<Interface>& subject : subjects)
      trials.push_back({subject.set.text, [&check, &subject] { return check.of(subject); }});
    bool hangs = false;
    CheckResult result = run_check(check.name, trials, isolation, &hangs);
    name_equal_failure(results, result);
    results.push_back(std::move(result));
    if (hangs) return results;
  }
  results.push_back(float_state(results));
  return results;
}

/// What a user reads of a method: summary, text, source, the meaning and unit of each parameter.
Verdict manual_complete(const PluginManual& manual);

/// What is wrong with a refusal: it names neither cause nor remedy. "" when nothing is.
std::string poor_refusal(const std::string& sentence, const PluginManual& manual);

/// Measures what a method declares, over its parameter values; one result per check.
std::vector<CheckResult> check_scheme(const Entry<TimeScheme>& entry, const Isolation& isolation);
std::vector<CheckResult> check_law(const Entry<ContactLaw>& entry, const Isolation& isolation);
const std::vector<Check<FrictionLaw>>& friction_checks();
std::vector<CheckResult> check_friction(const Entry<FrictionLaw>& entry, const Isolation& isolation);
std::vector<CheckResult> check_mass(const Entry<MassStrategy>& entry, const Isolation& isolation);
std::vector<CheckResult> check_reference(const Entry<ReferenceSolver>& entry, const Isolation& isolation);

}  // namespace ricochet::checking
