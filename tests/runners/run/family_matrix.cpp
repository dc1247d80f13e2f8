// The study that tries every method with every other: none is missing, and none is refused without a cause and a
// remedy.
#include <catch2/catch.hpp>
#include <ricochet/loader/catalogue.hpp>
#include <set>

#include "runners/run/run_study.hpp"
#include "runners/study/load_study.hpp"
#include "tests/places.hpp"
#include "tests/refusals.hpp"

using namespace ricochet;

namespace {

const std::filesystem::path file = tests::places().source + "/studies/family-matrix.json";

}  // namespace

TEST_CASE("family-matrix: every scheme, law and mass of this tree stands in it") {
  Catalogue catalogue(tests::places().plugins, {}, {});
  Registry named;
  const Study study = load_study(file, catalogue, named);
  std::set<std::string> found;
  for (const StudyCase& one : study.cases) found.insert({one.mass.name, one.contact.name, one.time.name});
  Catalogue all(tests::places().plugins, {}, {});
  Registry registry;
  all.open_all(registry);
  for (const Role role : {Role::mass, Role::contact, Role::time})
    for (const std::string& name : registry.names(role)) {
      INFO(name << ": add a line to studies/family-matrix.json");
      CHECK(found.count(name) == 1);
    }
}

TEST_CASE("family-matrix: what is not planned is refused with a cause and a remedy") {
  Catalogue catalogue(tests::places().plugins, {}, {});
  Registry registry;
  const Study study = load_study(file, catalogue, registry);
  std::set<std::string> refusals;
  std::size_t planned = 0;
  for (const StudyCase& one : study.cases) {
    const CasePlan plan = plan_for(study.kind, one, registry);
    if (plan.refusal.empty())
      ++planned;
    else
      refusals.insert(plan.refusal);
  }
  CHECK(2 * planned > study.cases.size());
  CHECK(refusals.size() > 1);
  for (const std::string& refusal : refusals) {
    INFO(refusal);
    CHECK_THAT(refusal, testing::names_cause_and_remedy());
  }
}
