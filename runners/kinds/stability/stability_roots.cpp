#include "runners/kinds/stability/stability_roots.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "runners/report/html.hpp"
#include "runners/table/in_order_met.hpp"
#include "runners/table/table_reader.hpp"

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

Table stability_roots_head() {
  return {
      "stability_roots",
      "One root on the unit circle that is the scheme's own, over the steps of the range: of a motion that is damped "
      "or has no inertia, or of points that are held.",
      {{"closed", "", "Whether contact is closed: points held on both sides. Otherwise the structure alone."},
       {"place", "", "Where it lives: kernel of the mass, held points, or modes."},
       {"root", "", "Which root; on modes, angles that go with the step are one."},
       {"double", "", "Whether it is defective: what it multiplies grows like the number of steps."},
       {"from", "s", "Smallest step of the range that has it."},
       {"to", "s", "The largest."},
       {"steps", "1", "Steps of the range that have it."},
       {"of", "1", "Steps of the range."},
       {"times", "1", "How many such roots a step has at most."}},
      {}};
}

void add_roots(Table& table, bool closed, double h, std::size_t of, const StepSpectrum& spectrum) {
  std::vector<int> times;  // of this step, by row
  for (const MarginalRoot& root : spectrum.marginal_roots) {
    const Row key = {closed, place_word(root.place), name_of(root), root.defective};
    auto row = std::find_if(table.rows.begin(), table.rows.end(),
                            [&](const Row& one) { return std::equal(key.begin(), key.end(), one.begin()); });
    if (row == table.rows.end()) {
      Row begun = key;
      begun.insert(begun.end(), {h, h, 0, of, 0});
      row = table.rows.insert(row, begun);
    }
    // Roots of several modes are one row, and one step.
    const auto at = static_cast<std::size_t>(row - table.rows.begin());
    times.resize(table.rows.size());
    if (times[at] == 0) (*row)[6] = (*row)[6].whole().value_or(0) + 1;
    times[at] += root.count;
    (*row)[5] = h;
    (*row)[8] = std::max((*row)[8].whole().value_or(0), std::int64_t{times[at]});
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
  for (const CaseRecord& record : results.cases) {
    const Table* table = find_table(record.tables, "stability_roots");
    if (!table) continue;
    known.push_back(&record);
    const std::string method = method_name(view, record, columns);
    const TableReader rows(*table);
    in_order_met(methods, method) += rows.size();
    for (std::size_t row = 0; row < rows.size(); ++row) {
      const std::string root = rows.text(row, "root"),
                        place = spoken_place(rows.text(row, "place"), rows.truth(row, "closed") == true);
      const bool grows = rows.truth(row, "double") == true;
      Told& told = in_order_met(in_order_met(found, place), grows ? "double " + root + ", which grows linearly" : root);
      if (told.cases.empty() || told.cases.back() != &record) told.cases.push_back(&record);
      Share& share = in_order_met(told.methods, method);
      share.steps += rows.number(row, "steps").value_or(0);
      share.of += rows.number(row, "of").value_or(0);
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
