#include "runners/run/finish_run.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "runners/run/derive.hpp"
#include "runners/run/say.hpp"
#include "runners/run/summary.hpp"
#include "runners/store/record_values.hpp"

namespace ricochet {

StudyResults write_folder(Store& store, const std::filesystem::path& folder, const RenderReport& render,
                          const std::set<std::string>* changed) {
  StudyResults results = with_tables(store.load());
  store.make_views(results);
  write_outputs(folder, results, render, changed);
  return results;
}

int tell_results(std::FILE* out, const StudyResults& results, const std::filesystem::path& folder,
                 const std::string& how, bool table) {
  constexpr int nothing_ran = 3;
  const bool nothing = std::all_of(results.cases.begin(), results.cases.end(),
                                   [](const CaseRecord& one) { return one.status == "refused"; });
  const int code = nothing ? nothing_ran : results_exit_code(results);
  say(out, fmt::format("{}{}\n{} ({})\n{}report: {}\n", table ? case_table(results) + "\n" : "", answer_text(results),
                       totals_text(results), how, extremes_text(results), (folder / "report.html").string()));
  if (nothing)
    say(out, "nothing ran: every case is refused; the reasons above and in the report say what to change\n");
  else if (code != 0)
    say(out, std::any_of(results.cases.begin(), results.cases.end(), went_wrong)
                 ? fmt::format("exit code {}: some cases diverged or failed, the others are usable; {} holds "
                               "a study of each alone\n",
                               code, (folder / "failures").string())
                 : fmt::format("exit code {}: the methods of some cases are in error\n", code));
  return code;
}

}  // namespace ricochet
