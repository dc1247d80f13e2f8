#include "runners/kinds/stability/stability_roots.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "runners/report/html.hpp"
#include "runners/table/in_order_met.hpp"

namespace ricochet {
namespace {

constexpr const char* places[] = {"kernel of the mass", "held points", "modes"};

const char* place_word(RootPlace place) {
  return places[static_cast<std::size_t>(place)];
}

/// The angle of a root on a mode goes with the step: the same root all the same.
std::string name_of(const MarginalRoot& root) {
  const std::string text = root_text(root.value), any = "roots of modulus 1";
  return root.place == RootPlace::mode && text.starts_with(any) ? any : text;
}

/// The steps that have a root, of all steps of one method's cases that have it.
struct Share {
  double steps = 0, of = 0;
};
/// What one root is over all cases that have it.
struct Told {
  std::vector<std::pair<std::string, Share>> methods;
  Cases cases;
};
/// By place, by root: each in the order met.
using ByRoot = std::vector<std::pair<std::string, Told>>;
using ByPlace = std::vector<std::pair<std::string, ByRoot>>;

std::string spoken_place(const std::string& place, bool closed) {
  if (place == places[2]) return closed ? "modes of the held structure" : "modes of the structure";
  return "the " + place + (closed && place == places[0] ? " while contact is closed" : "");
}

std::string methods_text(const Told& told) {
  constexpr std::size_t most = 8;
  std::vector<std::string> said;
  for (const auto& [method, share] : told.methods)
    said.push_back(share.steps < share.of
                       ? fmt::format("{} (at {} of the steps)", method, report::share_text(share.steps / share.of))
                       : method);
  return report::list_text(said, most);
}

}  // namespace

TableType<RootRow> stability_roots_type() {
  RowType<RootRow> rows;
  rows.of_case(&RootRow::id)
      .add({"closed", "", "Whether contact is closed: points held on both sides. Otherwise the structure alone."},
           &RootRow::closed)
      .add({"place", "", "Where it lives: kernel of the mass, held points, or modes."}, &RootRow::place)
      .add({"root", "", "Which root; on modes, angles that go with the step are one."}, &RootRow::root)
      .add({"double", "", "Whether it is defective: what it multiplies grows like the number of steps."},
           &RootRow::twofold)
      .add({"from", "s", "Smallest step of the range that has it."}, &RootRow::from)
      .add({"to", "s", "The largest."}, &RootRow::to)
      .add({"steps", "1", "Steps of the range that have it."}, &RootRow::steps)
      .add({"of", "1", "Steps of the range."}, &RootRow::of)
      .add({"times", "1", "How many such roots a step has at most."}, &RootRow::times);
  return {
      "stability_roots",
      "One root on the unit circle that is the scheme's own, over the steps of the range: of a motion that is damped "
      "or has no inertia, or of points that are held.",
      rows};
}

void add_roots(std::vector<RootRow>& rows, bool closed, double h, std::size_t of, const StepSpectrum& spectrum) {
  std::vector<int> times;  // of this step, by row
  for (const MarginalRoot& root : spectrum.marginal_roots) {
    const std::string place = place_word(root.place), name = name_of(root);
    auto row = std::find_if(rows.begin(), rows.end(), [&](const RootRow& one) {
      return one.closed == closed && one.place == place && one.root == name && one.twofold == root.defective;
    });
    if (row == rows.end()) row = rows.insert(row, {"", closed, place, name, root.defective, h, h, 0, of, 0});
    // Roots of several modes are one row, and one step.
    const auto at = static_cast<std::size_t>(row - rows.begin());
    times.resize(rows.size());
    if (times[at] == 0) ++row->steps;
    times[at] += root.count;
    row->to = h;
    row->times = std::max(row->times, times[at]);
  }
}

std::string method_name(const report::CaseView& view, const CaseRecord& record,
                        const std::vector<std::string>& columns) {
  std::string name = view.name(record, columns);
  if (const std::size_t comma = name.find(", "); comma != std::string::npos)
    name.replace(comma, 2, " (").push_back(')');
  return name;
}

std::vector<std::string> roots_told(const StudyResults& results, const std::vector<std::string>& columns) {
  const report::CaseView view(results);
  ByPlace found;
  for (const char* place : places)
    for (const bool closed : {false, true}) in_order_met(found, spoken_place(place, closed));
  std::vector<std::pair<std::string, std::size_t>> methods;  // how many rows each has
  Cases known;
  const std::vector<std::string> others = view.varying_without({"time"});
  const TableType<RootRow> type = stability_roots_type();
  for (const CaseRecord& record : results.cases) {
    const Table* table = type.find(record.tables);
    if (!table) continue;
    known.push_back(&record);
    const std::string method = method_name(view, record, columns);
    in_order_met(methods, method) += table->rows.size();
    for (const RootRow& row : type.rows.read(*table)) {
      Told& told = in_order_met(in_order_met(found, spoken_place(row.place, row.closed)),
                                row.twofold ? "double " + row.root + ", which grows linearly" : row.root);
      if (told.cases.empty() || told.cases.back() != &record) told.cases.push_back(&record);
      Share& share = in_order_met(told.methods, method);
      share.steps += static_cast<double>(row.steps);
      share.of += static_cast<double>(row.of);
    }
  }
  std::vector<std::string> out, none;
  std::string before;
  for (const auto& [place, roots] : found) {
    std::vector<std::string> said;
    for (const auto& [root, told] : roots) {
      const std::string where = report::CaseView::set_apart(told.cases, known, others);
      said.push_back(fmt::format("{}{}: {}", root, where.empty() ? "" : " (" + where + ")", methods_text(told)));
    }
    const std::string all = fmt::format("{}", fmt::join(said, "; "));
    // Motions without mass mostly do the same whatever contact does.
    if (!said.empty() && all == before)
      out.back() += " The same on " + place + ".";
    else if (!said.empty())
      out.push_back(fmt::format("On the unit circle by the scheme alone, on {}, are {}.", place, all));
    before = said.empty() ? before : all;
  }
  for (const auto& [method, count] : methods)
    if (count == 0) none.push_back(method);
  if (!none.empty())
    out.push_back(fmt::format("No root on the unit circle but the motion's own: {}.", report::list_text(none)));
  return out;
}

}  // namespace ricochet
