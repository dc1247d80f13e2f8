/// What is made of a folder's store alone: its report and tables anew, or the tables elsewhere.
#include <fmt/format.h>

#include "runners/run/derive.hpp"
#include "runners/run/say.hpp"
#include "runners/run/study_runner.hpp"
#include "runners/run/summary.hpp"
#include "runners/store/curve_files.hpp"
#include "runners/store/store.hpp"
#include "runners/store/store_error.hpp"

namespace ricochet {
namespace {

/// 0, or the code of a store that cannot be used, with its cause said.
int unless_unusable(const std::function<void()>& work) {
  constexpr int store_unusable = 5;
  try {
    work();
    return 0;
  } catch (const StoreError& error) {
    say(stderr, fmt::format("ricochet: {}\n", error.what()));
    return store_unusable;
  }
}

}  // namespace

int rebuild_report_with(const RenderReport& render, const std::filesystem::path& folder) {
  return unless_unusable([&] {
    const StudyResults results = with_tables(read_store(folder));
    write_outputs(folder, results, render);
    say(stdout, fmt::format("{}\nreport: {}\n", totals_text(results), (folder / "report.html").string()));
  });
}

int export_tables(const std::filesystem::path& folder, const std::filesystem::path& to, bool one_file) {
  return unless_unusable([&] {
    const StudyResults results = with_tables(read_store(folder));
    write_tables(to, results, one_file);
    say(stdout, fmt::format("tables: {}\n", to.string()));
    if (!one_file && !has_curve_files(results))
      say(stdout,
          fmt::format("curves: not written, for more than {} cases have one; --curves writes them all into one file\n",
                      kMostCurveFiles));
  });
}

}  // namespace ricochet
