#include "runners/kinds/comparison/comparison_answers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <ricochet/measure/statistics/quantiles.hpp>

#include "runners/kinds/comparison/comparison_tables.hpp"
#include "runners/kinds/kind.hpp"
#include "runners/report/case_view.hpp"
#include "runners/report/html.hpp"
#include "runners/table/in_order_met.hpp"
#include "runners/table/table_reader.hpp"
#include "runners/table/text.hpp"

namespace ricochet {
namespace {

/// The orders in the step of one time scheme, over errors and everything else that varies.
struct SchemeOrders {
  std::size_t confirmed = 0, refuted = 0, undecided = 0, saturated = 0;
  std::optional<double> declared;
  std::vector<double> orders;  ///< that were fitted
  std::size_t declaring() const { return confirmed + refuted + undecided; }
  const char* verdict() const {
    // Of intervals that hold the order in 95 of 100 cases some do not, by chance.
    constexpr double by_chance = 0.05;
    const bool not_chance = static_cast<double>(refuted) > by_chance * static_cast<double>(declaring());
    return declaring() == 0                    ? "no order declared"
           : not_chance || refuted > confirmed ? "not as declared"
           : confirmed > 0                     ? "as declared"
                                               : "not decided";
  }
};

std::string span(const SchemeOrders& scheme) {
  if (scheme.orders.empty()) return scheme.saturated > 0 ? "errors do not fall" : "no order found";
  const auto [least, most] = std::minmax_element(scheme.orders.begin(), scheme.orders.end());
  const std::string low = fmt::format("{:.2f}", *least), high = fmt::format("{:.2f}", *most);
  return low == high ? low : low + " to " + high;
}

std::string clause(const std::string& name, const SchemeOrders& scheme) {
  const std::string verdict = scheme.verdict();
  if (verdict == "as declared")
    return fmt::format("{} (declared {}, found {}; {} of {} confirmed{})", name,
                       report::number_text(*scheme.declared, 3), span(scheme), scheme.confirmed, scheme.declaring(),
                       scheme.refuted > 0 ? fmt::format(", {} refuted, as chance would have it", scheme.refuted) : "");
  if (verdict == "not as declared")
    return fmt::format("{} (declared {}, found {}; {} of {} refuted)", name, report::number_text(*scheme.declared, 3),
                       span(scheme), scheme.refuted, scheme.declaring());
  // Where no order is known beforehand, the errors fall each in their own way: the middle one says more than the ends.
  constexpr std::size_t few = 3;
  const std::string middle =
      scheme.orders.size() >= few ? fmt::format("median {:.2f}; ", median(scheme.orders)) : std::string();
  return fmt::format("{} ({}{})", name, middle, span(scheme));
}

std::string opening(const std::string& verdict) {
  if (verdict == "as declared") return "Converge with the order that they declare: ";
  if (verdict == "not as declared") return "Do not converge as they declare: ";
  if (verdict == "not decided") return "Not decided by these points: ";
  return "Orders where none is declared, which through contact is the rule: ";
}

}  // namespace

void say_orders(const StudyResults& results, Table& answers) {
  const Table* orders = find_table(results.derived, "orders");
  if (!orders) return;
  const TableReader rows(*orders);
  const report::CaseView view(results);
  std::vector<std::string> columns;
  for (const std::string& column : view.varying())
    if (report::role_of(column) == "time") columns.push_back(column);
  std::vector<std::pair<std::string, SchemeOrders>> schemes;
  for (std::size_t row = 0; row < rows.size(); ++row) {
    const CaseRecord* record = view.find(rows.text(row, "case"));
    if (!record || rows.text(row, "refined") != "step") continue;
    SchemeOrders& scheme = in_order_met(schemes, view.name(*record, columns));
    if (const auto declared = rows.number(row, "declared")) {
      scheme.declared = declared;
      const std::string verdict = rows.text(row, "verdict");
      ++(verdict == "confirmed" ? scheme.confirmed : verdict == "refuted" ? scheme.refuted : scheme.undecided);
    }
    if (const auto order = rows.number(row, "order")) scheme.orders.push_back(*order);
    scheme.saturated += !rows.text(row, rows.column_if_any("saturates_at")).empty();
  }
  for (const std::string verdict : {"as declared", "not as declared", "no order declared", "not decided"}) {
    std::vector<std::string> said;
    for (const auto& [name, scheme] : schemes)
      if (scheme.verdict() == verdict) said.push_back(clause(name, scheme));
    const std::string sentence = opening(verdict) + report::list_text(said);
    bool first = true;
    for (const auto& [name, scheme] : schemes) {
      if (scheme.verdict() != verdict) continue;
      answers.rows.push_back(AnswerRow{.choice = name,
                                       .measure = "order in the step",
                                       .verdict = verdict,
                                       .combinations = scheme.orders.size(),
                                       .sentence = first ? Cell(sentence + ".") : Cell()}
                                 .row());
      first = false;
    }
  }
}

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
