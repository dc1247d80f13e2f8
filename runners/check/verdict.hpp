#pragma once
#include <functional>
#include <string>
#include <utility>
#include <vector>

/// \file
/// What a check of a plugin says.
namespace ricochet::checking {

enum class Finding { ok, fails, not_applicable, not_declared };
/// "ok", "FAILS", "not applicable", "not declared".
const char* finding_word(Finding finding);

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
};

/// Thrown inside a check when the method refuses what the check would march; the verdict is then "not applicable".
struct Refused {
  std::string sentence;
};

/// Where checks run: each in a child process, ended after so many seconds, or in this process (for tests).
struct Isolation {
  bool child = true;
  double seconds = 60;
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

}  // namespace ricochet::checking
