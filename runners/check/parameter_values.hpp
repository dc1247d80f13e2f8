#pragma once
#include <ricochet/contract/registry.hpp>
#include <string>
#include <vector>

#include "runners/check/verdict.hpp"

namespace ricochet::checking {

/// One set of parameter values of a method.
struct ParameterSet {
  Parameters values;
  std::string text;  ///< "beta 0.25, gamma 0.5"
};

/// The values a method is tried with. First its defaults; of a parameter without one the middle of its range, else 1e5.
/// Then one parameter at a time: the ends and the middle of bounded ranges (just inside an open end), a hundredth and a
/// hundredfold of an unbounded default, each word, both truths.
std::vector<ParameterSet> parameter_sets(const std::vector<ParameterSpec>& specs);

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

/// A check of one kind of method.
template <class Interface>
struct Check {
  const char* name;
  Verdict (*of)(const Subject<Interface>& subject);
};

/// Runs all checks of a kind, each over all parameter values. One that does not come to an end is the last.
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
    results.push_back(run_check(check.name, trials, isolation, &hangs));
    if (hangs) break;
  }
  return results;
}

/// What a user reads of a method: summary, text, source, the meaning and unit of each parameter.
Verdict manual_complete(const PluginManual& manual);

/// What is wrong with a refusal: it names neither cause nor remedy. "" when nothing is.
std::string poor_refusal(const std::string& sentence, const PluginManual& manual);

}  // namespace ricochet::checking
