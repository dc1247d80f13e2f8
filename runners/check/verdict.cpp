#include "runners/check/verdict.hpp"

#include <algorithm>
#include <exception>
#include <ricochet/loader/child.hpp>

namespace ricochet::checking {
namespace {

// From child to parent: a letter for the finding, then the sentences, each with its end.
constexpr char sentence_end = '\x1e';
constexpr const char* letters = "ofan";

std::string encoded(const CheckResult& result) {
  std::string text(1, letters[static_cast<int>(result.finding)]);
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
  std::size_t at = 1;
  while (at < text.size()) {
    const std::size_t end = std::min(text.find(sentence_end, at), text.size());
    result.sentences.push_back(text.substr(at, end - at));
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
    if (first || weight(verdict.finding) > weight(result.finding)) {
      result.finding = verdict.finding;
      result.sentences.clear();
      if (!verdict.sentence.empty() && verdict.finding != Finding::fails) result.sentences = {verdict.sentence};
    }
    first = false;
    if (verdict.finding == Finding::fails && result.sentences.size() < most_sentences)
      result.sentences.push_back((trial.values.empty() ? "" : "with " + trial.values + ": ") + verdict.sentence);
  }
  return result;
}

}  // namespace

const char* finding_word(Finding finding) {
  switch (finding) {
    case Finding::ok:
      return "ok";
    case Finding::fails:
      return "FAILS";
    case Finding::not_applicable:
      return "not applicable";
    case Finding::not_declared:
      break;
  }
  return "not declared";
}

CheckResult run_check(const std::string& name, const std::vector<Trial>& trials, const Isolation& isolation,
                      bool* hangs) {
  if (hangs) *hangs = false;
  if (!isolation.child) return over_all(name, trials);
  const ChildOutcome outcome = run_in_child([&] { return encoded(over_all(name, trials)); }, isolation.seconds);
  CheckResult result{name, Finding::fails, {}};
  if (outcome.ok())
    decode(outcome.text, result);
  else
    result.sentences = {outcome.sentence()};
  if (hangs) *hangs = outcome.end == ChildOutcome::End::timeout;
  return result;
}

}  // namespace ricochet::checking
