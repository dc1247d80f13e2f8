#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "runners/kinds/comparison/comparison_answers.hpp"
#include "runners/kinds/comparison/precision_targets.hpp"
#include "runners/kinds/kind.hpp"
#include "runners/report/case_view.hpp"
#include "runners/report/html.hpp"
#include "runners/table/plain_text.hpp"
#include "runners/table/table_reader.hpp"

namespace ricochet {
namespace {

/// An error as a sentence has it: "the largest error of the tip".
std::string error_words(const std::string& error) {
  if (error == "tip-linf") return "the largest error of the tip";
  if (error == "impact-times") return "the largest error of the impact times";
  if (error == "impulse") return "the largest error of the impulse";
  if (error == "energy") return "the mean error of the energy";
  const std::string mean = "the root mean square error of the ";
  return mean + (error == "tip-l2"            ? "tip"
                 : error == "displacement-l2" ? "displacement"
                 : error == "displacement-h2" ? "curvature"
                 : error == "velocity-l2"     ? "velocity"
                                              : error);
}

/// "singular · newmark at h = 5e-5 s (0.7 ms)".
std::string how(const report::CaseView& view, const CaseRecord& record, double seconds) {
  std::vector<std::string> methods;
  std::copy_if(view.varying().begin(), view.varying().end(), std::back_inserter(methods), is_method);
  std::string at;
  if (view.varies("step")) at = fmt::format(" at h = {} s", report::CaseView::text(record, "step"));
  if (view.varies("elements")) at += fmt::format(" on {} elements", report::CaseView::text(record, "elements"));
  return fmt::format("{}{} ({})", view.name(record, methods), at, duration_text(seconds));
}

}  // namespace

void say_precision(const StudyResults& results, Table& answers) {
  const Table* targets = find_table(results.derived, "precision_targets");
  if (!targets || targets->rows.empty()) return;
  const TableReader rows(*targets);
  const report::CaseView view(results);
  std::vector<std::string> scene;
  std::copy_if(view.varying().begin(), view.varying().end(), std::back_inserter(scene), is_scene);
  const std::string error = rows.text(0, "error");
  constexpr std::size_t most = 6;
  std::size_t said = 0;
  for (std::size_t row = 0; row < rows.size() && said < most; ++row) {
    const CaseRecord* record = view.find(rows.text(row, "case"));
    const auto share = rows.number(row, rows.column_if_any("share"));
    if (!record || !share || rows.text(row, "error") != error || *share > 0.1) continue;
    const std::string where = scene.empty() ? "" : ", " + view.label(*record, scene);
    // A reference of the mesh has the errors of mesh and mass itself.
    const bool of_the_scheme = measure(*record, "reference_of_mesh").value_or(0) > 0;
    std::string sentence = fmt::format("Cheapest with {}{} at most {} % of the motion{}: {}", error_words(error),
                                       of_the_scheme ? ", against the same mesh and mass exact in time," : "",
                                       report::number_text(100 * *share, 2), where,
                                       how(view, *record, rows.number(row, "seconds").value_or(0)));
    const CaseRecord* other = view.find(rows.text(row, "other_case"));
    if (other) {
      const bool tie = rows.truth(row, "overlap") == true;
      sentence += fmt::format("; {} {}", tie ? "not told apart from" : "next",
                              how(view, *other, rows.number(row, "other_seconds").value_or(0)));
    }
    answers.rows.push_back(AnswerRow{.measure = "error." + error,
                                     .verdict = "cheapest",
                                     .effect = *share,
                                     .scale = "size." + error,
                                     .sentence = sentence + "."}
                               .row());
    ++said;
  }
}

}  // namespace ricochet
