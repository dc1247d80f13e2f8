#include "runners/run/run_words.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace ricochet {

std::string versions_text(const Store& store) {
  const auto counted = [](int count) { return fmt::format("{} result{}", count, count == 1 ? "" : "s"); };
  const int back = store.returned(), aside = store.aside(), others = store.of_other_arithmetic();
  std::string text;
  if (back > 0)
    text += fmt::format("{} that {} kept aside {} back\n", counted(back), back == 1 ? "was" : "were",
                        back == 1 ? "is" : "are");
  if (aside > 0)
    text += fmt::format(
        "{} of an earlier version {} kept aside: {} back when the study (and its plugins) are again as "
        "they were, and {} with --fresh\n",
        counted(aside), aside == 1 ? "is" : "are", aside == 1 ? "it comes" : "they come", aside == 1 ? "goes" : "go");
  if (others > 0)
    text += fmt::format(
        "{} case{} computed with other last digits than those of this processor and C library, and kept; "
        "the environment says which\n",
        others, others == 1 ? " was" : "s were");
  return text;
}

std::string other_part_text(const std::filesystem::path& folder, const std::string& study, const StudyPart& held,
                            const StudyPart& wanted) {
  return fmt::format(
      "{}: this folder holds {} of \"{}\", and {} was asked for: go on with that one, choose another folder with "
      "--out, or forget what is there with --fresh{}",
      folder.string(), held.whole() ? "all the cases" : held.text(), study,
      wanted.whole() ? "the whole study" : wanted.text(), held.whole() ? "" : " (`ricochet merge` joins parts)");
}

std::string interrupted_text(const std::filesystem::path& folder, const StudyResults& results) {
  const auto under_way =
      std::count_if(results.cases.begin(), results.cases.end(), [](const CaseRecord& one) { return one.partial; });
  return fmt::format(
      "interrupted: {} of {} cases are finished{} and kept in {}. Run the same command again to go on; \"ricochet "
      "report {}\" shows what is there\n",
      results.cases.size() - static_cast<std::size_t>(under_way), results.expected_cases,
      under_way > 0 ? fmt::format(", {} under way,", under_way) : "", folder.string(), folder.string());
}

}  // namespace ricochet
