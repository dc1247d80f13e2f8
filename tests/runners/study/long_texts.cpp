#include <catch2/catch.hpp>
#include <functional>
#include <string>
#include <vector>

#include "runners/json/json_text.hpp"
#include "tests/runners/study/study_fixture.hpp"

using namespace ricochet;
using namespace ricochet::tests;

TEST_CASE("No error is long, whatever a study has in a place") {
  const std::string text(20000, 'q');
  const Json study = small_study();
  const auto said = [](const Json& changed) -> std::string {
    const std::string written = changed.dump(1);
    try {
      parse(changed);
    } catch (const InputError& error) {
      return explained(error, "study.json", written);
    }
    return "";
  };
  int refused = 0;
  const std::function<void(const std::string&)> visit = [&](const std::string& pointer) {
    const Json& here = study.at(Json::json_pointer(pointer));
    Json changed = study;
    changed[Json::json_pointer(pointer)] = text;
    std::vector<std::string> errors = {said(changed)};
    if (here.is_object()) {
      changed = study;
      changed[Json::json_pointer(pointer)][text] = 1;
      errors.push_back(said(changed));
    }
    for (const std::string& error : errors) {
      CAPTURE(pointer, error.substr(0, 2000));
      CHECK(error.size() < 1000);  // names of keys and methods are listed
      refused += !error.empty();
    }
    if (!here.is_structured()) return;
    for (const auto& [key, ignored] : here.items())
      visit(here.is_array() ? pointer + "/" + key : pointer_to(pointer, key));
  };
  for (const auto& [key, ignored] : study.items()) visit(pointer_to("", key));
  CHECK(refused > 30);
}

TEST_CASE("A long question is cut between two characters where it is kept") {
  Json study = small_study();
  std::string question;
  for (int k = 0; k < 3000; ++k) question += "é";
  study["question"] = question;
  const std::string kept = parse(study).question;
  CHECK(kept.size() <= longest_text);
  CHECK(kept.size() > longest_text - 4);
  CHECK(kept.ends_with("éé…"));
  study["question"] = std::string(longest_text, 'q');
  CHECK(parse(study).question == study["question"]);
}
