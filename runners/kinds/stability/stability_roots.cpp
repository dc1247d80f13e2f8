#include <fmt/format.h>

#include <algorithm>
#include <ricochet/measure/stability/stability.hpp>

#include "runners/kinds/stability/stability_tables.hpp"

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
      "One root on the unit circle that is the scheme's own, over the steps of the range. It is of a motion that is "
      "damped or has no inertia, or of points that are held.",
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

std::string growth_text(const StepSpectrum& known, bool closed) {
  const double growth = known.radius - 1;
  return fmt::format("grows {} per step{} on {}",
                     growth < 1 ? fmt::format("by {:.3g} %", 100 * growth) : fmt::format("{:.3g} times", known.radius),
                     closed ? " with " + known.contact + " closed" : "", known.mode);
}

}  // namespace ricochet
