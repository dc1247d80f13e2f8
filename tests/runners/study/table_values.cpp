// Tables as parameters: one value or an axis, with defaults, refusals by row, and the same as data of a process.
#include <catch2/catch.hpp>
#include <ricochet/loader/library.hpp>

#include "runners/study/case_id.hpp"
#include "runners/study/fields.hpp"
#include "tests/runners/study/study_fixture.hpp"

using namespace ricochet;
using namespace ricochet::tests;
using namespace ricochet::testing;
using Catch::Matchers::Contains;

namespace table_values_tests {

namespace {

const Json soft = Json::parse("[[0, 0], [1e-4, 50], [3e-4, 400]]"), hard = Json::parse("[[0, 0], [1e-4, 500]]");

Json with_table(const Json& force, const Json& back = "absent") {
  Json study = small_study();
  study["methods"]["contact"] = {{"name", "rows"}, {"force", force}};
  if (back != "absent") study["methods"]["contact"]["back"] = back;
  study["methods"]["mass"] = "full";
  study["methods"]["time"] = "three-level";
  study["step"] = 1e-3;
  return study;
}

std::string refusal_of(const Json& force, const Json& back = "absent") {
  return input_error([&] { parse(with_table(force, back)); });
}

}  // namespace

TEST_CASE("a table is one value, a list of tables is an axis") {
  const Study one = parse(with_table(soft));
  REQUIRE(one.cases.size() == 1);
  const Parameters& given = one.cases[0].contact.parameters;
  CHECK(given.table("force") == ParameterTable{{0, 0}, {1e-4, 50}, {3e-4, 400}});
  CHECK(given.table("back").empty());
  CHECK(one.resolved["methods"]["contact"][0]["back"].is_null());

  const Study two = parse(with_table({soft, hard}, {nullptr, soft}));
  REQUIRE(two.cases.size() == 4);
  CHECK(two.cases[0].contact.parameters.table("back").empty());
  CHECK(two.cases[1].contact.parameters.table("back").size() == 3);
  CHECK(two.cases[3].contact.parameters.table("force") == ParameterTable{{0, 0}, {1e-4, 500}});
  // The values of the columns are the tables, and cases differ by them alone.
  for (std::size_t i = 0; i < 4; ++i) {
    for (const auto& [axis, value] : two.cases[i].axes)
      if (axis == "contact.force") CHECK(value.size() == (i < 2 ? 3 : 2));
    for (std::size_t j = 0; j < i; ++j) CHECK(two.cases[i].id != two.cases[j].id);
  }
  CHECK(two.cases[0].id == one.cases[0].id);
  // What a study was resolved to is read as the same study.
  Json again = two.resolved;
  CHECK(parse(again).cases[3].id == two.cases[3].id);
}

TEST_CASE("a table that is none is refused with the row") {
  const std::string here = "/methods/contact/force";
  const std::string expected =
      ": expected a table, rows [x, y] from [0, 0] on, x growing, y never falling, in N against m";
  const auto refused = [&](const Json& table, const std::string& where, const std::string& what) {
    INFO(table);
    CHECK_THAT(refusal_of(table), Catch::Matchers::StartsWith(here + where + expected) && Contains(what));
  };
  refused(3, "", "found 3");
  refused(nullptr, "", "found null");
  refused("table", "", "found \"table\"");
  refused(Json::array(), "", "there is no row");
  refused(Json::parse("[[0, 0]]"), "", "there is one row");
  refused(Json::parse("[[0, 1], [1, 2]]"), "/0", "the first row is [0, 1]");
  refused(Json::parse("[[1e-4, 0], [1, 2]]"), "/0", "the first row is [0.0001, 0]");
  refused(Json::parse("[[0, 0], [2, 2], [1, 3]]"), "/2", "x does not grow from [2, 2] to [1, 3]");
  refused(Json::parse("[[0, 0], [1, 2], [1, 3]]"), "/2", "x does not grow from [1, 2] to [1, 3]");
  refused(Json::parse("[[0, 0], [1, 2], [2, 1.5]]"), "/2", "y falls from [1, 2] to [2, 1.5]");
  refused(Json::parse("[[0, 0], [1, -2]]"), "/1", "y falls from [0, 0] to [1, -2]");
  refused(Json::parse("[[0, 0], [-1, 2]]"), "/1", "x does not grow");
  refused(Json::parse("[[0, 0], [1, \"2\"]]"), "/1", "found [1,\"2\"] as a row");
  refused(Json::parse("[[0, 0], [1, 2, 3]]"), "/1", "found [1,2,3] as a row");
  refused(Json::parse("[[[0, 0], [1, 2]], [[0, 0], [1, -2]]]"), "/1/1", "y falls");
  refused({soft, nullptr}, "/1", "found null");
  CHECK_THAT(refusal_of({soft, soft}), Contains(here + "/1: repeats the value"));
  CHECK_THAT(input_error([&] {
               Json study = with_table(soft);
               study["methods"]["contact"].erase("force");
               parse(study);
             }),
             Contains(here + ": missing; expected a table, rows [x, y]"));
}

TEST_CASE("what a factory says of tables that do not go together is told where they stand") {
  const auto said = [](const Json& force, const Json& back) {
    Registry registry = stand_ins();
    registry.add_contact(stand_in("rows-of-one-end", {table_parameter("force", "N against m", false, "p."),
                                                      table_parameter("back", "N against m", true, "b.")}),
                         [](const Parameters& p) -> std::unique_ptr<ContactLaw> {
                           if (!p.table("back").empty() && p.table("back").back() != p.table("force").back())
                             throw InputError("/back/1", "another end");
                           return std::make_unique<NoLaw>();
                         });
    Catalogue catalogue("/nonexistent", {}, {});
    Json study = with_table(force, back);
    study["methods"]["contact"]["name"] = "rows-of-one-end";
    study["methods"]["contact"] = Json::array({"rigid", study["methods"]["contact"]});
    return input_error([&] { parse_study(study.dump(1), catalogue, registry); });
  };
  CHECK(said(soft, soft) == "no error");
  CHECK(said(soft, hard) == "/methods/contact/1/back/1: another end");
  CHECK(said(soft, {nullptr, soft, hard}) == "/methods/contact/1/back/2/1: another end");
}

TEST_CASE("tables in manuals come out of a process as they went in") {
  Registry registry = stand_ins();
  ParameterSpec spec = table_parameter("curve", "N against m", true, "c.");
  spec.fallback = ParameterTable{{0, 0}, {0.1, 1.0 / 3}};
  registry.add_contact(stand_in("curved", {spec}), [](const Parameters&) { return std::make_unique<NoLaw>(); });
  const Registry again = methods_of_manuals(manuals_to_bytes(registry), "here.so");
  for (const char* name : {"curved", "rows", "spring"}) {
    const auto& before = registry.manual(Role::contact, name)->parameters;
    const auto& after = again.manual(Role::contact, name)->parameters;
    REQUIRE(after.size() == before.size());
    for (std::size_t i = 0; i < after.size(); ++i) {
      CHECK(after[i].type == before[i].type);
      CHECK(after[i].fallback == before[i].fallback);
    }
  }
}

}  // namespace table_values_tests
