#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "runners/asks/verdicts.hpp"
#include "runners/study/fields.hpp"
#include "runners/study/study_kind.hpp"

/// \file
/// What a study asks (its key `ask`), and the verbs that it may use.
namespace ricochet::asks {

struct Verb;
class Evidence;

/// One entry of the list `ask`.
struct Ask {
  std::size_t number = 1;      ///< its place in the list, from 1
  const Verb* verb = nullptr;  ///< that it has
  Json keys;                   ///< all of them, checked

  bool has(const char* key) const { return keys.contains(key); }
  /// The text after a key; "" where it is not there.
  std::string text(const char* key) const;
  std::optional<double> real(const char* key) const;
  /// The share after a key, given as a number or in per cent.
  std::optional<double> share(const char* key) const;
  /// What stands after its verb, where that is a text: the measure, the choice.
  std::string subject() const;
  /// "/ask/0/rank" of its verb, "/ask/0/over" of another key.
  std::string pointer(const std::string& key = "") const;
  /// The share from which levels differ, or within which they agree; 1 % where neither is given.
  double share_asked() const { return share("from").value_or(share("within").value_or(0.01)); }
  /// Whether the exit code depends on it.
  bool required() const { return keys.value("require", false); }
};

/// Whether a case has the levels of an ask's `where`.
bool speaks_of(const Ask& ask, const StudyCase& one);

/// A verb: what may be asked, how it is checked, and what answers it.
struct Verb {
  const char* name;         ///< its key in an entry of `ask`
  const char* text;         ///< what it asks, one sentence
  std::vector<Field> keys;  ///< the first has its name
  const char* remedy = "";  ///< of a verb of some kinds: what a study of another kind is told to do
  /// Refuses, by pointer, what this study cannot be asked. Empty: nothing.
  std::function<void(const Ask&, const Study&)> check = {};
  /// What may go unanswered, said before anything runs; "" for nothing.
  std::function<std::string(const Ask&, const Study&)> doubt = {};
  /// The verdict. Empty: the kind of study answers it (Analysis::verbs).
  std::function<Answered(const Ask&, const Evidence&)> answer = {};
};

/// All verbs, in the order in which they are told.
const std::vector<const Verb*>& verbs();

/// The verb of this name; null where there is none.
const Verb* find_verb(const std::string& name);

/// The entries of a list `ask`.
std::vector<Ask> asks_of_list(const Json& list);

/// What a study asks, complete; `study`: as it is kept. None where it asks nothing.
std::vector<Ask> asks_of(const Json& study);

/// What a kind calls the verb of an ask that it answers itself: its name, or "effect on motions".
std::string verb_of_kind(const Ask& ask);

/// Throws InputError, by pointer, for what the study cannot be asked: another kind's verb, a stop, an axis or a level
/// that it has not, and what the verb refuses.
void check(const Ask& ask, const Study& study);

/// One ask that a program makes.
Ask ask_of(const Json& keys, std::size_t number);

}  // namespace ricochet::asks
