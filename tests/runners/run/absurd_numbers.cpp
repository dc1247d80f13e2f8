// Numbers that are in range and absurd, in the place of every number of the shipped studies. Each makes rows, or is an
// error of the input; nothing else.
#include <catch2/catch.hpp>
#include <limits>
#include <ricochet/loader/catalogue.hpp>

#include "runners/run/run_study.hpp"
#include "runners/study/load_study.hpp"
#include "tests/places.hpp"
#include "tests/runners/scratch_folder.hpp"

using namespace ricochet;

namespace {

/// The pointers of the positive numbers below a value.
void find_numbers(const Json& value, const Json::json_pointer& at, std::vector<Json::json_pointer>& found) {
  if (value.is_number() && value.get<double>() > 0) found.push_back(at);
  if (value.is_object())
    for (const auto& [key, inner] : value.items()) find_numbers(inner, at / key, found);
  // One entry of a list stands for all.
  if (value.is_array() && !value.empty()) find_numbers(value.front(), at / 0, found);
}

std::vector<Json::json_pointer> numbers_of(const Json& study) {
  std::vector<Json::json_pointer> found;
  for (const char* key : {"scene", "step", "steps", "duration", "parameter", "methods"})
    if (study.contains(key)) find_numbers(study[key], Json::json_pointer("/" + std::string(key)), found);
  return found;
}

}  // namespace

TEST_CASE("absurd numbers: every case of a study with one is planned, refused, or an error of the input") {
  Catalogue catalogue(tests::places().plugins, {}, {});
  Registry registry;
  int planned = 0, refused_input = 0;
  for (const char* name : {"quick", "orders-linear", "orders-bar", "orders-oscillator", "restitution", "stability-map",
                           "contact-laws", "energy-damped", "extreme-sections", "bifurcation-reference-tip-quick",
                           "bifurcation-penalty-quick", "basins-quick"}) {
    const Json shipped = Json::parse(read_text(tests::places().source + "/studies/" + name + ".json"));
    for (const Json::json_pointer& pointer : numbers_of(shipped))
      for (const double absurd : {1e-300, 1e300, std::numeric_limits<double>::denorm_min(),
                                  std::numeric_limits<double>::max(), 1e-20, 1e20}) {
        Json text = shipped;
        text[pointer] = absurd;
        INFO(name << ", " << pointer.to_string() << " = " << absurd);
        try {
          const Study study = parse_study(text.dump(1), catalogue, registry);
          for (const StudyCase* one : {&study.cases.front(), &study.cases.back()}) {
            if (one->excluded) continue;
            const CasePlan plan = plan_for(study.kind, *one, registry);
            CHECK(plan.predicted_seconds >= 0);
            ++planned;
          }
        } catch (const InputError&) {
          ++refused_input;
        } catch (const std::exception& error) {
          FAIL_CHECK("neither a row nor an error of the input: " << error.what());
        }
      }
  }
  CHECK(planned > 100);
  CHECK(refused_input > 100);
}

TEST_CASE(
    "absurd numbers: a length that leaves an element no stiffness is told where it stands, before anything runs") {
  Catalogue catalogue(tests::places().plugins, {}, {});
  Registry registry;
  Json text = Json::parse(read_text(tests::places().source + "/studies/orders-linear.json"));
  for (const double length : {1e-300, 1e300}) {
    text["scene"]["structure"]["length"] = length;
    try {
      parse_study(text.dump(1), catalogue, registry);
      FAIL_CHECK("accepted: " << length);
    } catch (const InputError& error) {
      CHECK(error.pointer() == "/scene/structure/length");
      CHECK_THAT(error.what(), Catch::Contains("comes out as"));
    }
  }
}
