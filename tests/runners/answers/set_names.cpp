// Names of sets of methods.
#include "runners/answers/set_names.hpp"

#include <catch2/catch.hpp>
#include <map>

#include "tests/runners/answers/small_studies.hpp"

using namespace ricochet;
using answers::SetNames;

namespace {

struct Named {
  StudyResults results;
  Choices study;
  Cases firsts;
  explicit Named(const std::vector<synthetic::Choice>& choices)
      : results(synthetic::full_factorial(choices, {1e-4}, [](const auto&, double) { return 0.5; })), study(results) {
    for (const CaseRecord& record : results.cases) firsts.push_back(&record);
  }
};

}  // namespace

TEST_CASE("no two sets of methods have one exact name") {
  const Named three({{"mass", {"full", "lumped"}}, {"contact", {"hard", "soft"}}, {"time", {"a", "b"}}});
  const Named two({{"mass", {"full", "lumped", "empty"}}, {"time", {"a", "b", "c"}}});
  for (const Named* one : {&three, &two}) {
    const SetNames names(one->study, one->firsts);
    std::map<std::string, std::size_t> met;
    const std::size_t count = one->firsts.size();
    std::size_t exact = 0;
    for (std::size_t set = 1; set < (std::size_t{1} << count); ++set) {
      Members members;
      for (std::size_t k = 0; k < count; ++k)
        if (set >> k & 1) members.push_back(k);
      const SetNames::Name name = names.found(members);
      CHECK_FALSE(name.text.empty());
      if (!name.exact) continue;
      ++exact;
      const auto [at, fresh] = met.emplace(name.text, set);
      INFO(name.text << ": " << at->second << " and " << set);
      CHECK(fresh);
    }
    CHECK(2 * exact > std::size_t{1} << count);
  }
}

TEST_CASE("a parameter that one method alone has is told with it") {
  const Named laws({{"contact", {"hard", "damped"}}, {"contact.damping", {"0.5", "2"}}, {"mass", {"full", "lumped"}}});
  // The hard law has no damping.
  StudyResults results = laws.results;
  std::erase_if(results.cases,
                [](const CaseRecord& one) { return one.axes[0].second == "hard" && one.axes[1].second == "2"; });
  for (CaseRecord& one : results.cases)
    if (one.axes[0].second == "hard") one.axes[1].second = nullptr;
  const Choices study(results);
  Cases firsts;
  Members strong;
  for (const CaseRecord& record : results.cases) {
    if (record.axes[1].second == "2") strong.push_back(firsts.size());
    firsts.push_back(&record);
  }
  CHECK(SetNames(study, firsts).of(strong).find("damped damping 2") == 0);
}

TEST_CASE("rules that differ in one level of either choice are said together") {
  const Named one({{"contact", {"none", "rigid"}}, {"time", {"a", "b", "c", "d"}}});
  Members members;
  for (std::size_t k = 0; k < one.firsts.size(); ++k) {
    const bool rigid = one.firsts[k]->axes[0].second == "rigid";
    const std::string time = one.firsts[k]->axes[1].second.get<std::string>();
    if (rigid ? time == "a" || time == "b" : time != "a") members.push_back(k);
  }
  const SetNames::Name name = SetNames(one.study, one.firsts).found(members);
  INFO(name.text);
  CHECK(name.exact);
  CHECK(name.text.size() < 60);
}
